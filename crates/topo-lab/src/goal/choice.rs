//! The setting that meets a goal, and what the error of its runs came to.

use serde::{Deserialize, Serialize};

use super::Goal;
use super::setting::Setting;

/// One setting, as measured over the cases of a trade-off in the time that goals are about.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Edges of a rod, or the spacing of a colloid's grid in xi_N.
    pub resolution: f64,
    /// Tolerance of the local error.
    pub tolerance: f64,
    /// Median of the relative errors of the last time listed.
    pub median_error: f64,
    /// Their 90th percentile.
    pub high_error: f64,
    /// Mean processor seconds of a case, with the coarser run.
    pub cpu_seconds: f64,
    /// Most bytes of a case.
    pub peak_bytes: u64,
    /// Resolution of the coarser run beside it.
    pub check_resolution: f64,
    /// Tolerance of that run.
    pub check_tolerance: f64,
    /// Cases it was measured on.
    pub n_cases: usize,
}

impl Point {
    pub(super) fn setting(&self) -> Setting {
        Setting {
            fine: (self.resolution, self.tolerance),
            coarse: (self.check_resolution, self.check_tolerance),
        }
    }

    /// By how much it is finer than the coarser run.
    pub(super) fn ratio(&self) -> f64 {
        self.setting().ratio()
    }

    /// Estimate, up to the factor of the table, of the relative error of a run: the error that a coarser run shows, and no less than
    /// a quarter of what nine cases of ten stay below. None without one.
    pub(super) fn raw_estimate(&self, coarser_error: Option<f64>) -> Option<(f64, ErrorKind)> {
        let floor = LEAST * self.high_error;
        coarser_error.map(|error| {
            if error > floor {
                (error, ErrorKind::Own)
            } else {
                (floor, ErrorKind::Floor)
            }
        })
    }
}

/// Where an estimate of an error comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ErrorKind {
    /// The difference to the coarser run of the same case.
    Own,
    /// The least estimate of the setting, as the two runs differ by less.
    Floor,
}

/// Least estimate, in 90th percentiles of the setting: two runs may agree by chance.
const LEAST: f64 = 0.25;

/// A goal with the setting chosen for it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Choice {
    /// What was asked for.
    pub goal: Goal,
    /// The setting and what was measured of it.
    pub point: Point,
    /// What its resolution counts, such as `edges`.
    pub unit: &'static str,
    /// Factor of the estimates.
    pub scale: f64,
    /// Why the table does not speak of the present code, if it does not.
    pub stale: Option<String>,
    /// Processor seconds expected, the runs that show the error included.
    pub cpu_seconds: f64,
}

impl Choice {
    /// Estimate of the relative error of a run, from what a coarser one shows; without that nothing is known, and it is one.
    pub(super) fn estimate(&self, coarser_error: Option<f64>) -> (f64, Option<ErrorKind>) {
        let raw = self.point.raw_estimate(coarser_error);
        raw.map_or((1.0, None), |(raw, kind)| (self.scale * raw, Some(kind)))
    }
}

/// The last discharge time of a case with an estimate of its error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorRow {
    /// Which case.
    pub case: String,
    /// Place of the cut, s/L; empty for a colloid.
    pub cut: Option<f64>,
    /// Which time.
    pub quantity: String,
    /// The time; empty if the run did not come so far.
    pub result: Option<f64>,
    /// The same of the coarser run.
    pub coarser: Option<f64>,
    /// Estimate of the relative error of the result.
    pub relative_error: Option<f64>,
    /// Where the estimate comes from; empty where the coarser run gave no time.
    pub kind: Option<ErrorKind>,
}
