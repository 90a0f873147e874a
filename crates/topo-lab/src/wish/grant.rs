//! The setting that grants a wish, and what the error of its runs came to.

use serde::{Deserialize, Serialize};

use super::Wish;
use super::setting::Setting;

/// One setting, as measured over the cases of a trade-off in the time that wishes are about.
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

    /// Estimate, up to the factor of the table, of the relative error of a run: what the coarser run tells, and no less than
    /// a quarter of what nine cases of ten stay below. None where nothing is told.
    pub(super) fn raw_estimate(&self, told: Option<f64>) -> Option<f64> {
        told.map(|told| told.max(LEAST * self.high_error))
    }
}

/// Least estimate, in 90th percentiles of the setting: two runs may agree by chance.
const LEAST: f64 = 0.25;

/// A wish with the setting that grants it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Grant {
    /// What was asked for.
    pub wish: Wish,
    /// The setting and what was measured of it.
    pub point: Point,
    /// What its resolution counts, such as `edges`.
    pub unit: &'static str,
    /// Factor of the estimates.
    pub scale: f64,
    /// Why the table does not speak of the present code, if it does not.
    pub stale: Option<String>,
    /// Processor seconds expected, the runs included that tell the error.
    pub cpu_seconds: f64,
}

impl Grant {
    /// Estimate of the relative error of a run of which a coarser one tells so much; without that nothing is known, and it is
    /// one.
    pub(super) fn estimate(&self, told: Option<f64>) -> f64 {
        let raw = self.point.raw_estimate(told);
        raw.map_or(1.0, |raw| self.scale * raw)
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
}
