//! What work will take: a model of the cost of a case, measured once and set to this machine by the cases it has finished, or
//! by a short run.

mod probe;

use std::time::Instant;

use serde::{Deserialize, Serialize};

use probe::Pace;
pub use probe::Probe;
use topo_analysis::median;

/// What the cases still to be computed are expected to take.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Cases to be computed.
    pub n_cases: usize,
    /// Processor seconds of all of them.
    pub cpu_seconds: f64,
    /// The same on the machine that the models were measured on.
    #[serde(default)]
    pub reference_seconds: f64,
    /// Seconds until all are done.
    pub wall_seconds: f64,
    /// Threads they run on.
    pub threads: usize,
    /// Most bytes held at a time.
    pub bytes: u64,
    /// Finished cases whose times have set the model to this machine; 0: a short run has.
    pub n_calibrated: usize,
}

impl Estimate {
    /// What parts that take these processor seconds on the models' machine take here, at the pace of a probe, one after another,
    /// all threads in each.
    pub fn of_parts(seconds: &[f64], jobs: usize, probe: &'static Probe) -> Self {
        let costs: Vec<Cost> = seconds
            .iter()
            .map(|&seconds| Cost { seconds, bytes: 0 })
            .collect();
        estimate(&costs, Speed::Probed(probe), threads(jobs), false)
    }

    /// Two stages, one after the other.
    pub fn then(self, next: Self) -> Self {
        Self {
            n_cases: self.n_cases + next.n_cases,
            cpu_seconds: self.cpu_seconds + next.cpu_seconds,
            reference_seconds: self.reference_seconds + next.reference_seconds,
            wall_seconds: self.wall_seconds + next.wall_seconds,
            threads: self.threads.max(next.threads),
            bytes: self.bytes.max(next.bytes),
            n_calibrated: self.n_calibrated + next.n_calibrated,
        }
    }
}

/// Share of the threads' time that cases side by side use.
pub(crate) const EFFICIENCY: f64 = 0.93;
/// The same of one case with all threads in it, as measured of colloids of six million cells on two.
const WITHIN: f64 = 0.8;

/// The expected cost of one case, on the machine that the battery's [`Probe`] was measured on.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Cost {
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
    if costs.is_empty() {
        return Estimate {
            threads,
            ..Estimate::default()
        };
    }
    let pace = speed.pace(threads);
    let sum: f64 = costs.iter().map(|c| c.seconds).sum();
    let largest = costs.iter().map(|c| c.bytes).max().unwrap_or(0);
    let (alone, together) = if side_by_side {
        let shared = sum / (threads as f64 * EFFICIENCY);
        (
            shared.max(longest(costs, threads)),
            threads.min(costs.len()),
        )
    } else {
        (sum / (threads as f64 * WITHIN).max(1.0), 1)
    };
    Estimate {
        n_cases: costs.len(),
        cpu_seconds: sum * pace.factor,
        reference_seconds: sum,
        wall_seconds: alone * pace.factor * pace.waiting,
        threads,
        bytes: largest * together as u64,
        n_calibrated: pace.n_cases,
    }
}

/// Time of the thread with most work when each takes the largest case left: three equal cases on two threads take two of them.
fn longest(costs: &[Cost], threads: usize) -> f64 {
    let mut seconds: Vec<f64> = costs.iter().map(|c| c.seconds).collect();
    seconds.sort_by(|a, b| b.total_cmp(a));
    let mut loads: Vec<f64> = vec![0.0; threads.clamp(1, costs.len().max(1))];
    for case in seconds {
        if let Some(least) = loads.iter_mut().min_by(|a, b| a.total_cmp(b)) {
            *least += case;
        }
    }
    loads.into_iter().fold(0.0, f64::max)
}

/// What tells how much slower than the models' machine this one is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Speed {
    /// Cases that it has finished.
    Finished {
        /// Median of the processor seconds taken over those expected.
        factor: f64,
        /// How many.
        n_cases: usize,
        /// How long its threads wait.
        probe: &'static Probe,
    },
    /// A short run, made when it is asked for.
    Probed(&'static Probe),
    /// It is that machine, idle.
    #[cfg(test)]
    Reference,
}

/// Fewest finished cases that say anything about a machine.
const FEWEST: usize = 3;

impl Speed {
    /// From the seconds that finished cases were expected to take and took, or else from a probe.
    pub(crate) fn of(probe: &'static Probe, finished: &[(f64, f64)]) -> Self {
        let ratios = finished
            .iter()
            .filter(|(model, taken)| *model > 0.0 && *taken > 0.0)
            .map(|(model, taken)| taken / model);
        match median(ratios.clone()) {
            Some(factor) if ratios.clone().count() >= FEWEST => Self::Finished {
                factor,
                n_cases: ratios.count(),
                probe,
            },
            _ => Self::Probed(probe),
        }
    }

    fn pace(self, threads: usize) -> Pace {
        match self {
            Self::Finished {
                factor,
                n_cases,
                probe,
            } => Pace {
                factor,
                n_cases,
                ..probe::pace(probe, threads)
            },
            Self::Probed(probe) => probe::pace(probe, threads),
            #[cfg(test)]
            Self::Reference => Pace {
                factor: 1.0,
                waiting: 1.0,
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
    use crate::elastic::ROD_PROBE;

    const ONE: Cost = Cost {
        seconds: 10.0,
        bytes: 5,
    };

    #[test]
    fn cases_share_threads_and_a_long_one_is_waited_for() {
        let plain = Speed::Reference;
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
        // the third of three equal cases has a thread to itself
        assert_eq!(estimate(&[ONE; 3], plain, 2, true).wall_seconds, 20.0);
    }

    #[test]
    fn finished_cases_tell_the_speed_of_the_machine() {
        let probed = Speed::Probed(&ROD_PROBE);
        assert_eq!(Speed::of(&ROD_PROBE, &[(1.0, 9.0), (1.0, 9.0)]), probed);
        let finished = [(1.0, 2.0), (2.0, 4.0), (1.0, 50.0), (0.0, 3.0)];
        let slow = Speed::of(&ROD_PROBE, &finished);
        let estimated = estimate(&[ONE], slow, 1, true);
        assert_eq!((estimated.cpu_seconds, estimated.n_calibrated), (20.0, 3));
        assert!(estimated.wall_seconds >= estimated.cpu_seconds);
    }
}
