//! The speed of this machine, from a short run that is always the same.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use topo_core::CpuClock;

/// A short run, always the same, whose time on this machine tells how much slower it is than the one that a battery's costs were
/// measured on.
#[derive(Debug, Clone, Copy)]
pub struct Probe {
    /// Of the battery; each name is measured once a process.
    pub name: &'static str,
    /// Processor seconds that it took there, with all processors at work; about a tenth of a second is enough.
    pub reference_seconds: f64,
    /// The run; `None` if it cannot be run here.
    pub run: fn() -> Option<()>,
}

impl PartialEq for Probe {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// How much slower a machine is than the models', and how long its threads wait.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pace {
    /// Processor seconds over those of the models' machine.
    pub factor: f64,
    /// Elapsed over processor seconds of threads that never rest: above 1 where others are at work too.
    pub waiting: f64,
    /// Finished cases that say so.
    pub n_cases: usize,
}

/// A probe that was over sooner says nothing.
const LEAST: f64 = 1e-3;

/// Paces by the name of the probe.
static PACES: Mutex<BTreeMap<&'static str, Pace>> = Mutex::new(BTreeMap::new());

/// The pace of this machine in a probe, measured at the first call.
pub(super) fn pace(probe: &Probe, threads: usize) -> Pace {
    // held while it is measured, so that two probes do not disturb each other
    let mut paces = PACES.lock().unwrap_or_else(PoisonError::into_inner);
    let known = paces.entry(probe.name);
    *known.or_insert_with(|| measured(probe, threads))
}

/// Runs the probe in all threads at once, as cases do: they share caches, memory and, on a busy machine, processors.
fn measured(probe: &Probe, threads: usize) -> Pace {
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    let n = threads.clamp(1, most);
    let timed = || {
        let (clock, start) = (CpuClock::start(), Instant::now());
        (probe.run)().map(|()| (clock.seconds(), start.elapsed().as_secs_f64()))
    };
    let runs: Vec<Option<(f64, f64)>> = std::thread::scope(|scope| {
        let spawned: Vec<_> = (0..n).map(|_| scope.spawn(timed)).collect();
        spawned
            .into_iter()
            .map(|thread| thread.join().ok().flatten())
            .collect()
    });
    pace_of(&runs, probe.reference_seconds, threads as f64 / n as f64)
}

/// The pace that runs of (processor, elapsed) seconds tell when `crowd` threads share a processor; that of the models' machine
/// where they tell nothing.
fn pace_of(runs: &[Option<(f64, f64)>], reference: f64, crowd: f64) -> Pace {
    let measured = runs.iter().flatten();
    let (cpu, wall) = measured.fold((0.0, 0.0), |sum, run| (sum.0 + run.0, sum.1 + run.1));
    let n = runs.iter().flatten().count();
    if n == 0 || cpu < LEAST * n as f64 {
        return Pace {
            factor: 1.0,
            waiting: crowd.max(1.0),
            n_cases: 0,
        };
    }
    Pace {
        factor: cpu / (n as f64 * reference),
        waiting: (wall / cpu).max(1.0) * crowd.max(1.0),
        n_cases: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elastic::ROD_PROBE;
    use crate::nematic::COLLOID_PROBE;

    #[test]
    fn slow_and_busy_machines_show() {
        // twice the processor time, and as long waited for
        let pace = pace_of(&[Some((0.2, 0.4)), Some((0.2, 0.4))], 0.1, 1.0);
        assert_eq!((pace.factor, pace.waiting), (2.0, 2.0));
        // eight threads on two processors
        let pace = pace_of(&[Some((0.1, 0.1)), None], 0.1, 4.0);
        assert_eq!((pace.factor, pace.waiting), (1.0, 4.0));
        // a clock of the thread may be ahead of the clock on the wall by rounding
        assert_eq!(pace_of(&[Some((0.1, 0.09))], 0.1, 0.5).waiting, 1.0);
        for nothing in [&[None][..], &[Some((0.0, 0.0))]] {
            let pace = pace_of(nothing, 0.1, 1.0);
            assert_eq!((pace.factor, pace.waiting), (1.0, 1.0));
        }
    }

    #[test]
    fn a_machine_is_probed_once() {
        let first = pace(&COLLOID_PROBE, 1);
        assert!(first.factor > 0.0 && first.waiting >= 1.0);
        // no two runs take the same time to the nanosecond
        assert_eq!(pace(&COLLOID_PROBE, 2), first);
        assert_ne!(pace(&ROD_PROBE, 1), first);
    }

    /// Processor seconds of the probes here, to set their constants by.
    #[test]
    fn probes_come_to_their_end() {
        for probe in [&ROD_PROBE, &COLLOID_PROBE] {
            let clock = CpuClock::start();
            assert_eq!((probe.run)(), Some(()), "{}", probe.name);
            println!("{}: {:.3} s", probe.name, clock.seconds());
        }
    }
}
