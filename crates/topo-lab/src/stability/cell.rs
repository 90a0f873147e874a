//! One run of a map.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

use serde::{Deserialize, Serialize};
use topo_core::{CpuClock, Interrupt};

/// How a run of a map ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Ending {
    /// It finished.
    Converged,
    /// It stopped with a reason.
    Stopped,
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Converged => "converged",
            Self::Stopped => "stopped",
        })
    }
}

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
    /// How it ended.
    pub outcome: Ending,
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
    /// Whether it finished.
    pub fn has_converged(&self) -> bool {
        self.outcome == Ending::Converged
    }
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Verdict {
    /// Why it stopped; none when it converged.
    pub reason: Option<String>,
    pub violations: u32,
}

impl Verdict {
    pub(super) fn stopped(reason: impl ToString, violations: u32) -> Self {
        Self {
            reason: Some(reason.to_string()),
            violations,
        }
    }

    pub(super) fn converged(violations: u32) -> Self {
        Self {
            reason: None,
            violations,
        }
    }
}

/// A run to come.
pub(crate) struct Cell {
    pub axes: [&'static str; 2],
    pub at: [String; 2],
    pub is_inner: bool,
    pub run: Box<dyn Fn(&Interrupt) -> Verdict + Send + Sync>,
}

impl Cell {
    pub(super) fn is_of(&self, row: &StabilityRow) -> bool {
        self.axes == [&row.axis_x, &row.axis_y] && self.at == [&*row.x, &*row.y]
    }

    /// Runs it; even a panic is an outcome.
    pub(super) fn run(&self, interrupt: &Interrupt) -> StabilityRow {
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
            outcome: match verdict.reason {
                None => Ending::Converged,
                Some(_) => Ending::Stopped,
            },
            reason: verdict.reason.unwrap_or_default(),
            seconds: clock.seconds(),
            violations: verdict.violations,
            is_inner: self.is_inner,
        }
    }
}
