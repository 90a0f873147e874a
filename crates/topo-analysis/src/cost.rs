//! What work will take: a model of the cost of a case, measured once and set to this machine by the cases it has finished.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::statistics::median;

/// What the cases still to be computed are expected to take.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Cases to be computed.
    pub n_cases: usize,
    /// Processor seconds of all of them.
    pub cpu_seconds: f64,
    /// Seconds until all are done.
    pub wall_seconds: f64,
    /// Threads they run on.
    pub threads: usize,
    /// Most bytes held at a time.
    pub bytes: u64,
    /// Finished cases whose times have set the model to this machine; 0: it is taken to be as fast as the one it was measured on.
    pub n_calibrated: usize,
}

impl Estimate {
    /// Two stages, one after the other.
    pub fn then(self, next: Self) -> Self {
        Self {
            n_cases: self.n_cases + next.n_cases,
            cpu_seconds: self.cpu_seconds + next.cpu_seconds,
            wall_seconds: self.wall_seconds + next.wall_seconds,
            threads: self.threads.max(next.threads),
            bytes: self.bytes.max(next.bytes),
            n_calibrated: self.n_calibrated + next.n_calibrated,
        }
    }
}

/// Share of the threads' time that cases side by side use.
pub(crate) const EFFICIENCY: f64 = 0.93;

/// The expected cost of one case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cost {
    /// Processor seconds.
    pub seconds: f64,
    /// Bytes held.
    pub bytes: u64,
}

/// Adds costs up for cases side by side, or one after another with all threads in each.
pub(crate) fn estimate(
    costs: &[Cost],
    speed: Speed,
    threads: usize,
    side_by_side: bool,
) -> Estimate {
    let cpu: f64 = costs.iter().map(|c| c.seconds).sum::<f64>() * speed.factor;
    let longest = costs.iter().map(|c| c.seconds).fold(0.0, f64::max) * speed.factor;
    let largest = costs.iter().map(|c| c.bytes).max().unwrap_or(0);
    let shared = cpu / (threads as f64 * EFFICIENCY);
    let together = if side_by_side {
        threads.min(costs.len())
    } else {
        1
    };
    Estimate {
        n_cases: costs.len(),
        cpu_seconds: cpu,
        wall_seconds: if side_by_side {
            shared.max(longest)
        } else {
            shared
        },
        threads,
        bytes: largest * together as u64,
        n_calibrated: speed.n_cases,
    }
}

/// How much slower than the model's machine this one is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Speed {
    factor: f64,
    n_cases: usize,
}

/// Fewest finished cases that say anything about a machine.
const FEWEST: usize = 3;

impl Speed {
    /// From the seconds that finished cases were expected to take and took.
    pub(crate) fn of(finished: &[(f64, f64)]) -> Self {
        let ratios = finished
            .iter()
            .filter(|(model, taken)| *model > 0.0 && *taken > 0.0)
            .map(|(model, taken)| taken / model);
        match median(ratios.clone()) {
            Some(factor) if ratios.clone().count() >= FEWEST => Self {
                factor,
                n_cases: ratios.count(),
            },
            _ => Self {
                factor: 1.0,
                n_cases: 0,
            },
        }
    }
}

/// Threads of a pool of `jobs` (0: one a core).
pub(crate) fn threads(jobs: usize) -> usize {
    if jobs > 0 {
        jobs
    } else {
        std::thread::available_parallelism().map_or(1, usize::from)
    }
}

/// Wall time of a stage.
pub(crate) struct Stopwatch(Instant);

impl Stopwatch {
    pub(crate) fn start() -> Self {
        Self(Instant::now())
    }

    pub(crate) fn seconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: Cost = Cost {
        seconds: 10.0,
        bytes: 5,
    };

    #[test]
    fn cases_share_threads_and_a_long_one_is_waited_for() {
        let plain = Speed::of(&[]);
        let four = estimate(&[ONE; 4], plain, 2, true);
        assert_eq!((four.n_cases, four.cpu_seconds, four.bytes), (4, 40.0, 10));
        assert!((four.wall_seconds - 20.0 / EFFICIENCY).abs() < 1e-9);
        let long = Cost {
            seconds: 100.0,
            bytes: 7,
        };
        let waited = estimate(&[ONE, long], plain, 8, true);
        assert_eq!((waited.wall_seconds, waited.bytes), (100.0, 14));
        let alone = estimate(&[ONE, long], plain, 8, false);
        assert!(alone.wall_seconds < 20.0 && alone.bytes == 7);
        let both = four.then(alone);
        assert_eq!((both.n_cases, both.bytes), (6, 10));
        assert_eq!(estimate(&[], plain, 2, true).wall_seconds, 0.0);
    }

    #[test]
    fn finished_cases_tell_the_speed_of_the_machine() {
        assert_eq!(Speed::of(&[(1.0, 9.0), (1.0, 9.0)]).n_cases, 0);
        let slow = Speed::of(&[(1.0, 2.0), (2.0, 4.0), (1.0, 50.0), (0.0, 3.0)]);
        assert_eq!((slow.factor, slow.n_cases), (2.0, 3));
        assert_eq!(estimate(&[ONE], slow, 1, true).cpu_seconds, 20.0);
    }
}
