//! Maps of the extremes: runs over grids of two parameters, each of which converges or stops with a named reason.

mod knots;
mod nematic;
pub(crate) mod rod;
mod watch;

use std::panic::{AssertUnwindSafe, catch_unwind};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use topo_core::{CpuClock, Interrupt};

use crate::system::{Effort, System};

/// One run of a map, as tables hold it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StabilityRow {
    /// Name of the parameter along x.
    pub axis_x: String,
    /// Its value.
    pub x: String,
    /// Name of the parameter along y.
    pub axis_y: String,
    /// Its value.
    pub y: String,
    /// `converged` or `stopped`.
    pub outcome: String,
    /// Why it stopped; empty when it converged.
    pub reason: String,
    /// Processor seconds.
    pub seconds: f64,
    /// Broken rules: numbers that are not finite, crossings, panics, energy gained from nowhere.
    pub violations: u32,
    /// Whether it lies where every run must converge.
    #[serde(skip)]
    pub is_inner: bool,
}

impl StabilityRow {
    /// Whether it came to its end.
    pub fn has_converged(&self) -> bool {
        self.outcome == "converged"
    }
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Verdict {
    /// Why it stopped; none when it converged.
    reason: Option<String>,
    violations: u32,
}

impl Verdict {
    fn stopped(reason: impl ToString, violations: u32) -> Self {
        Self {
            reason: Some(reason.to_string()),
            violations,
        }
    }

    fn converged(violations: u32) -> Self {
        Self {
            reason: None,
            violations,
        }
    }
}

/// A run to come.
pub(crate) struct Cell {
    axes: [&'static str; 2],
    at: [String; 2],
    is_inner: bool,
    run: Box<dyn Fn(&Interrupt) -> Verdict + Send + Sync>,
}

impl Cell {
    fn is_of(&self, row: &StabilityRow) -> bool {
        self.axes == [&row.axis_x, &row.axis_y] && self.at == [&*row.x, &*row.y]
    }

    /// Runs it; even a panic is an outcome.
    fn run(&self, interrupt: &Interrupt) -> StabilityRow {
        let clock = CpuClock::start();
        let verdict = catch_unwind(AssertUnwindSafe(|| (self.run)(interrupt)));
        let verdict = verdict.unwrap_or_else(|panic| {
            let text = panic
                .downcast_ref::<String>()
                .map(String::as_str)
                .or_else(|| panic.downcast_ref::<&str>().copied());
            Verdict::stopped(format!("panic: {}", text.unwrap_or("no message")), 1)
        });
        StabilityRow {
            axis_x: self.axes[0].to_owned(),
            x: self.at[0].clone(),
            axis_y: self.axes[1].to_owned(),
            y: self.at[1].clone(),
            outcome: if verdict.reason.is_none() {
                "converged"
            } else {
                "stopped"
            }
            .to_owned(),
            reason: verdict.reason.unwrap_or_default(),
            seconds: clock.seconds(),
            violations: verdict.violations,
            is_inner: self.is_inner,
        }
    }
}

/// Runs all maps of a system on the present pool of threads, telling of each finished run; `known` ones are not run again.
///
/// Budgets are counted in steps, not in seconds: the outcome does not depend on the machine. Maps follow each other in the
/// table, the value along x running fastest. When interrupted, what is finished is returned.
///
/// # Validation
/// `maps_are_as_large_as_promised`, `a_panic_is_an_outcome`
pub fn stability(
    system: System,
    effort: Effort,
    known: &[StabilityRow],
    interrupt: &Interrupt,
    told: &(dyn Fn(&StabilityRow) + Sync),
) -> Vec<StabilityRow> {
    cells(system, effort)
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
            told(&row);
            Some(row)
        })
        .collect()
}

/// Number of runs of all maps of a system.
pub fn n_extremes(system: System) -> usize {
    cells(system, Effort::Draft).len()
}

fn cells(system: System, effort: Effort) -> Vec<Cell> {
    match system {
        System::Rod => rod::cells(effort),
        System::Nematic => nematic::cells(effort),
        System::Knots => knots::cells(effort),
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
        assert_eq!((row.outcome.as_str(), row.violations), ("stopped", 1));
        assert_eq!(row.reason, "panic: on purpose");
    }
}
