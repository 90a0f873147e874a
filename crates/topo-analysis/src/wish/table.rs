//! The measured table: what a resolution and a tolerance cost, and how far off they are.

use serde::{Deserialize, Serialize};

use super::pair::{Measurement, Pair, cases, quantity};
use crate::statistics::{median, quantile};
use crate::system::System;
use crate::tradeoff::{TradeoffRow, ladder_of};

/// One setting, as measured over the cases of a trade-off in the time that wishes are about.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Edges of a rod, or the spacing of a colloid's grid in xi_N.
    pub resolution: f64,
    /// Tolerance of the local error.
    pub tolerance: f64,
    /// Median of the relative errors of the last time listed; of a colloid that extrapolated with the coarser run.
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

/// A setting with the coarser one beside it: resolutions and tolerances.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Setting {
    pub fine: (f64, f64),
    pub coarse: (f64, f64),
}

impl Setting {
    /// By how much it is finer than the coarser one.
    pub(super) fn ratio(&self) -> f64 {
        let ratio = self.coarse.0 / self.fine.0;
        ratio.max(1.0 / ratio)
    }
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

    /// Estimate, up to the factor of the table, of the relative error of a pair of runs: what their difference tells, and no
    /// less than the median error. None where the difference is not known.
    pub(super) fn raw_estimate(&self, pair: &Pair) -> Option<f64> {
        pair.told.map(|told| told.max(self.median_error))
    }
}

/// The settings that wishes choose from, as a trade-off measured them, from coarse to fine.
///
/// # Validation
/// `each_setting_is_compared_with_the_next_coarser`
pub fn points(system: System, rows: &[TradeoffRow]) -> Vec<Point> {
    let names = cases(rows);
    let of = |pair: &[(f64, f64)]| {
        let setting = Setting {
            coarse: pair[0],
            fine: pair[1],
        };
        let found: Vec<Measurement> = names
            .iter()
            .map(|case| Measurement::of(system, &setting, case, rows))
            .filter(|m| m.reference.is_some())
            .collect();
        // a run that did not come so far is off by all of it
        let errors = || found.iter().map(|m| m.error.unwrap_or(1.0));
        let bytes = rows
            .iter()
            .filter(|r| quantity(system) == Some(r.quantity.as_str()))
            .filter(|r| r.value == system.resolution_name(pair[1].0, pair[1].1));
        Some(Point {
            resolution: setting.fine.0,
            tolerance: setting.fine.1,
            median_error: median(errors())?,
            high_error: quantile(errors(), 0.9)?,
            cpu_seconds: found.iter().map(|m| m.cpu_seconds).sum::<f64>() / found.len() as f64,
            peak_bytes: bytes.map(|r| r.peak_bytes).max()?,
            check_resolution: setting.coarse.0,
            check_tolerance: setting.coarse.1,
            n_cases: found.len(),
        })
    };
    ladder_of(system).windows(2).filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tradeoff::{REFERENCE, TradeoffRun, compared};

    /// Runs of the whole ladder whose time is that of `time` at the resolution.
    fn rows(system: System, time: impl Fn(f64) -> Option<f64>) -> Vec<TradeoffRow> {
        let mut runs = Vec::new();
        for case in ["a", "b", "c"] {
            let mut put = |setting: &str, value: String, result| {
                runs.push(TradeoffRun {
                    case: case.to_owned(),
                    setting: setting.to_owned(),
                    value,
                    quantity: quantity(system).unwrap().to_owned(),
                    result,
                    cpu_seconds: 1.5,
                    peak_bytes: 7,
                });
            };
            put(REFERENCE, "finest".to_owned(), Some(10.0));
            for (resolution, tolerance) in ladder_of(system) {
                let value = system.resolution_name(resolution, tolerance);
                put("resolution", value, time(resolution));
            }
        }
        compared(system, &runs)
    }

    #[test]
    fn each_setting_is_compared_with_the_next_coarser() {
        let rods = points(
            System::Rod,
            &rows(System::Rod, |n| (n != 140.0).then(|| 10.0 + 10.0 / n)),
        );
        let ladder = ladder_of(System::Rod);
        assert_eq!(
            rods.len(),
            ladder.len() - 1,
            "the coarsest has none beside it"
        );
        for (p, pair) in rods.iter().zip(ladder.windows(2)) {
            assert_eq!((p.check_resolution, p.check_tolerance), pair[0]);
            assert_eq!((p.resolution, p.tolerance), pair[1]);
            assert_eq!((p.n_cases, p.cpu_seconds, p.peak_bytes), (3, 3.0, 7));
            // a run that failed is off by all of it
            let error = if p.resolution == 140.0 {
                1.0
            } else {
                1.0 / p.resolution
            };
            assert!((p.median_error - error).abs() < 1e-12 && (p.high_error - error).abs() < 1e-12);
        }
        // of colloids the extrapolated time counts: with errors of second order nothing is left, of fourth order little
        let of = |power: i32| {
            points(
                System::Nematic,
                &rows(System::Nematic, |h| Some(10.0 + h.powi(power))),
            )
        };
        assert!(of(2).iter().all(|p| p.high_error < 1e-12));
        let p = of(4)[1];
        assert_eq!((p.resolution, p.check_resolution), (1.2, 1.5));
        let left = 0.1 * (1.2_f64.powi(4) + (1.2_f64.powi(4) - 1.5_f64.powi(4)) / 0.5625);
        assert!((p.high_error - left.abs()).abs() < 1e-12);
        assert!(points(System::Knots, &[]).is_empty());
    }
}
