//! The speed of this machine, told by a short run that is always the same.

use std::sync::OnceLock;
use std::time::Instant;

use topo_core::{CpuClock, Interrupt};
use topo_nematic::{
    NematicAccuracy, NematicBattery, NematicParameters, RunHooks, SurfacePattern, Threads,
};
use topo_rod::{Accuracy, Guards, RodBattery, RodParameters};

use crate::stability::rod::trefoil;
use crate::system::System;

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

/// Processor seconds of the runs on the models' machine, with both of its processors at work.
const ROD_SECONDS: f64 = 0.089;
const NEMATIC_SECONDS: f64 = 0.096;
/// A probe that was over sooner says nothing.
const LEAST: f64 = 1e-3;

/// Paces of rods and of nematics.
static PACES: [OnceLock<Pace>; 2] = [OnceLock::new(), OnceLock::new()];

/// The pace of this machine in a system, measured at the first call; knots go at the pace of rods.
pub(super) fn pace(system: System, threads: usize) -> Pace {
    let (place, probe, reference): (_, fn() -> Option<()>, _) = match system {
        System::Rod | System::Knots => (0, rod, ROD_SECONDS),
        System::Nematic => (1, nematic, NEMATIC_SECONDS),
    };
    *PACES[place].get_or_init(|| measured(probe, reference, threads))
}

/// Runs the probe in all threads at once, as cases do: they share caches, memory and, on a busy machine, processors.
fn measured(probe: fn() -> Option<()>, reference: f64, threads: usize) -> Pace {
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    let n = threads.clamp(1, most);
    let timed = || {
        let (clock, start) = (CpuClock::start(), Instant::now());
        probe().map(|()| (clock.seconds(), start.elapsed().as_secs_f64()))
    };
    let runs: Vec<Option<(f64, f64)>> = std::thread::scope(|scope| {
        let spawned: Vec<_> = (0..n).map(|_| scope.spawn(timed)).collect();
        spawned
            .into_iter()
            .map(|thread| thread.join().ok().flatten())
            .collect()
    });
    pace_of(&runs, reference, threads as f64 / n as f64)
}

/// The pace that runs of (processor, elapsed) seconds tell when `crowd` threads share a processor; that of the models' machine
/// where they tell nothing.
fn pace_of(runs: &[Option<(f64, f64)>], reference: f64, crowd: f64) -> Pace {
    let told = runs.iter().flatten();
    let (cpu, wall) = told.fold((0.0, 0.0), |sum, run| (sum.0 + run.0, sum.1 + run.1));
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

/// The charge of a twisted trefoil of 200 edges; `None` if it cannot be run.
fn rod() -> Option<()> {
    let rod = RodParameters {
        twist: Some(1.0),
        ..RodParameters::default()
    };
    let accuracy = Accuracy {
        tolerance: ROD_TOLERANCE,
        ..Accuracy::default()
    };
    let battery = RodBattery::new(&rod, &accuracy, Guards::default(), &trefoil()).ok()?;
    let settings = topo_rod::ChargeSettings::default();
    battery.charge(&settings, &Interrupt::new()).ok()?;
    Some(())
}

/// The first steps of the charge of a colloid of 70 000 cells; `None` if it cannot be run.
fn nematic() -> Option<()> {
    let colloid = NematicParameters {
        radius: 12.0,
        spacing: 1.5,
        pattern: SurfacePattern::Charge(2),
        ..NematicParameters::default()
    };
    let settings = topo_nematic::ChargeSettings {
        max_steps: NEMATIC_STEPS,
        ..topo_nematic::ChargeSettings::default()
    };
    let accuracy = NematicAccuracy {
        threads: Threads::One,
        ..NematicAccuracy::default()
    };
    let battery = NematicBattery::new(&colloid, &accuracy).ok()?;
    let stop = Interrupt::new();
    battery.charge(&settings, &mut RunHooks::new(&stop)).ok()?;
    Some(())
}

/// Tolerance of the probe's rod, in h.
const ROD_TOLERANCE: f64 = 2e-4;
/// Steps of the probe's colloid.
const NEMATIC_STEPS: u64 = 75;

#[cfg(test)]
mod tests {
    use super::*;

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
        let first = pace(System::Nematic, 1);
        assert!(first.factor > 0.0 && first.waiting >= 1.0);
        // no two runs take the same time to the nanosecond
        assert_eq!(pace(System::Nematic, 2), first);
        assert_eq!(pace(System::Knots, 1), pace(System::Rod, 1));
    }

    /// Processor seconds of the probes here, to set their constants by.
    #[test]
    fn probes_come_to_their_end() {
        for (name, probe) in [("rod", rod as fn() -> Option<()>), ("nematic", nematic)] {
            let clock = CpuClock::start();
            assert_eq!(probe(), Some(()), "{name}");
            println!("{name}: {:.3} s", clock.seconds());
        }
    }
}
