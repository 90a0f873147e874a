//! How much of a stage is done and what is left of it.

use topo_lab::Estimate;

/// Parts of a stage, and the work that each was expected to be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Work {
    n: usize,
    n_done: usize,
    /// In seconds of the estimate's reference machine, or in parts where they are not weighed.
    total: f64,
    done: f64,
    is_weighed: bool,
    threads: usize,
    /// Seconds expected for all; 0: nothing was.
    expected: f64,
}

impl Work {
    pub(super) fn new(n: usize, estimate: &Estimate) -> Self {
        let is_weighed = estimate.reference_seconds > 0.0;
        Self {
            n,
            n_done: 0,
            total: if is_weighed {
                estimate.reference_seconds
            } else {
                n as f64
            },
            done: 0.0,
            is_weighed,
            threads: estimate.threads,
            expected: estimate.wall_seconds,
        }
    }

    /// One part is done, of a weight that counts where parts are weighed.
    pub(super) fn add(&mut self, weight: f64) {
        self.n_done += 1;
        self.done += if self.is_weighed { weight } else { 1.0 };
    }

    pub(super) fn n(&self) -> usize {
        self.n
    }

    pub(super) fn n_done(&self) -> usize {
        self.n_done
    }

    pub(super) fn is_done(&self) -> bool {
        self.n_done >= self.n
    }

    /// Seconds left after `elapsed` seconds; `None` where nothing tells them, or nothing is left.
    ///
    /// What is done tells the speed, parts at work counted as half done; before the first is done, the estimate tells it.
    pub(super) fn left(&self, elapsed: f64) -> Option<f64> {
        let (left, n_left) = (self.total - self.done, self.n.saturating_sub(self.n_done));
        if n_left == 0 || left <= 0.0 {
            return None;
        }
        let seconds = if self.done > 0.0 {
            // the thread that has just finished one has none at work
            let at_work = self.threads.saturating_sub(1).min(n_left) as f64;
            let half_done = 0.5 * at_work * left / n_left as f64;
            (left - half_done) * elapsed / (self.done + half_done)
        } else {
            self.expected - elapsed
        };
        (seconds > 0.0).then_some(seconds)
    }
}

impl std::fmt::Display for Work {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.n_done, self.n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn work(n: usize, estimate: &Estimate, done: &[f64]) -> Work {
        let mut work = Work::new(n, estimate);
        done.iter().for_each(|weight| work.add(*weight));
        work
    }

    #[test]
    fn time_left_is_in_proportion_to_the_work() {
        let unknown = Estimate::default();
        let some = work(10, &unknown, &[0.0, 0.0]);
        assert_eq!(
            (some.left(4.0), some.to_string().as_str()),
            (Some(16.0), "2/10")
        );
        // a large part of three is done: a third of the parts, three quarters of the work
        let weighed = Estimate {
            reference_seconds: 40.0,
            wall_seconds: 80.0,
            threads: 1,
            ..unknown
        };
        assert_eq!(work(3, &weighed, &[30.0]).left(60.0), Some(20.0));
        // of four equal parts on two threads one is done and one half done
        let shared = Estimate {
            threads: 2,
            ..weighed
        };
        assert_eq!(work(4, &shared, &[10.0]).left(30.0), Some(50.0));
    }

    #[test]
    fn no_time_left_is_reported_where_none_is_known() {
        let unknown = Estimate::default();
        assert_eq!(work(9, &unknown, &[]).left(100.0), None);
        assert_eq!(work(2, &unknown, &[0.0, 0.0]).left(100.0), None);
        let expected = Estimate {
            reference_seconds: 10.0,
            wall_seconds: 120.0,
            threads: 2,
            ..unknown
        };
        // the estimate speaks until the first part is done, and not beyond its end
        assert_eq!(work(9, &expected, &[]).left(20.0), Some(100.0));
        assert_eq!(work(9, &expected, &[]).left(121.0), None);
        // parts without a weight say nothing of weighed work
        assert_eq!(work(9, &expected, &[0.0]).left(20.0), Some(100.0));
    }
}
