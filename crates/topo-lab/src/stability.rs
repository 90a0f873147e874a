//! Maps of the extremes: runs over grids of two parameters, each of which converges or stops with a named reason.

mod cell;
mod knots;
mod nematic;
pub(crate) mod rod;
mod watch;

use rayon::prelude::*;
use topo_core::Interrupt;

use crate::preset::Preset;
use crate::system::System;
use cell::Cell;
pub use cell::{Ending, StabilityRow};

/// Runs all maps of a system on the present pool of threads, telling of each finished run; `known` ones are not run again.
///
/// Budgets are counted in steps, not in seconds: the outcome does not depend on the machine. Maps follow each other in the
/// table, the value along x running fastest. When interrupted, what is finished is returned.
///
/// # Validation
/// `maps_are_as_large_as_promised`, `a_panic_is_an_outcome`
pub fn stability(
    system: System,
    preset: Preset,
    known: &[StabilityRow],
    interrupt: &Interrupt,
    report: &(dyn Fn(&StabilityRow) + Sync),
) -> Vec<StabilityRow> {
    cells(system, preset)
        .par_iter()
        .with_max_len(1)
        .filter_map(|cell| {
            let known = known.iter().find(|row| cell.is_of(row));
            let row = match known {
                Some(row) => StabilityRow {
                    is_inner: cell.is_inner,
                    ..row.clone()
                },
                None if interrupt.is_requested() => return None,
                None => cell.run(interrupt),
            };
            // A run that was interrupted has not ended as it would.
            if known.is_none() && interrupt.is_requested() {
                return None;
            }
            report(&row);
            Some(row)
        })
        .collect()
}

/// Number of runs of all maps of a system.
pub fn n_extremes(system: System) -> usize {
    cells(system, Preset::Draft).len()
}

fn cells(system: System, preset: Preset) -> Vec<Cell> {
    match system {
        System::Rod => rod::cells(preset),
        System::Nematic => nematic::cells(preset),
        System::Knots => knots::cells(preset),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_are_as_large_as_promised() {
        let n = n_extremes;
        assert!(n(System::Rod) >= 300, "{}", n(System::Rod));
        assert!(n(System::Nematic) >= 150, "{}", n(System::Nematic));
        assert!(n(System::Knots) >= 60, "{}", n(System::Knots));
    }

    #[test]
    fn a_panic_is_an_outcome() {
        let cell = Cell {
            axes: ["a", "b"],
            at: ["1".to_owned(), "2".to_owned()],
            is_inner: true,
            run: Box::new(|_| panic!("on purpose")),
        };
        let row = cell.run(&Interrupt::new());
        assert_eq!((row.outcome, row.violations), (Ending::Stopped, 1));
        assert_eq!(row.reason, "panic: on purpose");
    }
}
