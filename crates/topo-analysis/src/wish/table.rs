//! The measured table: what a resolution and a tolerance cost, and how far off they are.

use serde::{Deserialize, Serialize};

use crate::statistics::{median, quantile};
use crate::system::System;
use crate::tradeoff::{TradeoffRow, resolution_of};

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
    /// Mean processor seconds of a case.
    pub cpu_seconds: f64,
    /// Most bytes of a case.
    pub peak_bytes: u64,
    /// Resolution of the coarser run that it is compared with to estimate its error.
    pub check_resolution: f64,
    /// Tolerance of that run.
    pub check_tolerance: f64,
    /// An error is estimated as this times the larger of the median error and the difference to the coarser run.
    pub scale: f64,
    /// Cases it was measured on.
    pub n_cases: usize,
}

/// Share of the cases whose error the estimate is to cover; more than promised, as other cases are less alike.
const COVERED: f64 = 0.95;

/// A quantile of a dozen cases is no sure one. With this factor, the smallest number of quarters that does, estimates covered nine
/// tenths of 78 other cases; it was then checked on cases that it was not set on.
const SAFETY: f64 = 1.75;

impl Point {
    /// Estimate of the relative error of a run at this setting that differs by `difference` (relative) from the coarser one.
    pub fn estimate(&self, difference: Option<f64>) -> f64 {
        self.scale * difference.unwrap_or(1.0).abs().max(self.median_error)
    }
}

/// The points that a trade-off measured: each setting with a coarser one beside it.
pub fn points(system: System, rows: &[TradeoffRow]) -> Vec<Point> {
    let quantity = match system {
        System::Rod => "t99",
        System::Nematic => "t99.9",
        System::Knots => return Vec::new(),
    };
    let of: Vec<(f64, f64, &TradeoffRow)> = rows
        .iter()
        .filter(|r| r.setting == "resolution" && r.quantity == quantity)
        .filter_map(|r| resolution_of(system, &r.value).map(|(n, t)| (n, t, r)))
        .collect();
    let distinct = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.dedup();
    };
    let (mut resolutions, mut tolerances): (Vec<f64>, Vec<f64>) =
        of.iter().map(|r| (r.0, r.1)).unzip();
    distinct(&mut resolutions);
    distinct(&mut tolerances);
    if system == System::Nematic {
        // from coarse to fine, as edges are
        resolutions.reverse();
    }
    let mut points = Vec::new();
    for (place, &resolution) in resolutions.iter().enumerate() {
        for &tolerance in &tolerances {
            let at = |n: f64, t: f64| -> Vec<&TradeoffRow> {
                let same = of.iter().filter(|r| r.0 == n && r.1 == t);
                same.map(|r| r.2).collect()
            };
            let own = at(resolution, tolerance);
            // the nearest coarser setting that was measured
            let looser = tolerances.iter().filter(|t| **t >= 1.9 * tolerance);
            let check = resolutions[..place].iter().rev().find_map(|&n| {
                looser
                    .clone()
                    .map(|&t| (n, t, at(n, t)))
                    .find(|c| !c.2.is_empty())
            });
            let Some((check_resolution, check_tolerance, coarser)) = check else {
                continue;
            };
            let errors: Vec<f64> = own
                .iter()
                .map(|r| r.relative_error.unwrap_or(1.0))
                .collect();
            let (Some(median_error), Some(high_error)) = (
                median(errors.iter().copied()),
                quantile(errors.iter().copied(), 0.9),
            ) else {
                continue;
            };
            let mut point = Point {
                resolution,
                tolerance,
                median_error,
                high_error,
                cpu_seconds: own.iter().map(|r| r.cpu_seconds).sum::<f64>() / own.len() as f64,
                peak_bytes: own.iter().map(|r| r.peak_bytes).max().unwrap_or(0),
                check_resolution,
                check_tolerance,
                scale: 1.0,
                n_cases: own.len(),
            };
            let ratios = own.iter().zip(&errors).map(|(row, error)| {
                let other = coarser.iter().find(|r| r.case == row.case);
                let difference = other
                    .and_then(|o| o.result)
                    .zip(row.result)
                    .map(|(b, a)| b / a - 1.0);
                error / point.estimate(difference)
            });
            point.scale = SAFETY * quantile(ratios, COVERED).unwrap_or(1.0).max(0.2);
            points.push(point);
        }
    }
    points
}

/// Tables of both systems, as this version was measured by `cargo xtask tradeoff --quality standard --record`.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Measured {
    Rod,
    Nematic,
}

impl Measured {
    /// Its points, cheapest first.
    pub(crate) fn points(self) -> Vec<Point> {
        let text = match self {
            Self::Rod => include_str!("../../data/tradeoff-rod.csv"),
            Self::Nematic => include_str!("../../data/tradeoff-nematic.csv"),
        };
        let rows = csv::Reader::from_reader(text.as_bytes()).into_deserialize::<Point>();
        // a test reads every row
        let mut points: Vec<Point> = rows.filter_map(Result::ok).collect();
        points.sort_by(|a, b| a.cpu_seconds.total_cmp(&b.cpu_seconds));
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tables_are_whole() {
        for (system, text) in [
            (Measured::Rod, include_str!("../../data/tradeoff-rod.csv")),
            (
                Measured::Nematic,
                include_str!("../../data/tradeoff-nematic.csv"),
            ),
        ] {
            let points = system.points();
            assert_eq!(points.len() + 1, text.lines().count(), "{system:?}");
            assert!(points.len() >= 6, "{system:?}");
            for p in points {
                assert!(p.cpu_seconds > 0.0 && p.scale > 0.0 && p.high_error >= p.median_error);
                assert!(p.n_cases > 1);
            }
        }
    }

    #[test]
    fn estimates_cover_what_they_were_measured_on() {
        let mut rows = Vec::new();
        for case in 0..20 {
            let wobble = f64::from(case % 5) * 1e-3;
            for (value, error) in [
                ("N = 100, 2e-3 h", 0.05 + wobble),
                ("N = 200, 1e-3 h", 0.01 + wobble),
            ] {
                rows.push(TradeoffRow {
                    system: "rod".to_owned(),
                    case: case.to_string(),
                    setting: "resolution".to_owned(),
                    value: value.to_owned(),
                    quantity: "t99".to_owned(),
                    result: Some(1.0 + error),
                    reference: Some(1.0),
                    relative_error: Some(error),
                    cpu_seconds: 1.0,
                    peak_bytes: 1,
                    pareto: false,
                });
            }
        }
        let found = points(System::Rod, &rows);
        assert_eq!(found.len(), 1, "the coarsest has nothing to compare with");
        let p = found[0];
        assert_eq!((p.resolution, p.check_resolution), (200.0, 100.0));
        assert!((p.median_error - 0.012).abs() < 1e-12);
        // differences are four per cent, errors 1 to 1.4; the rest is the factor of safety
        let estimate = p.estimate(Some(0.04 / 1.01));
        assert!((0.0135..0.02).contains(&(estimate / SAFETY)), "{estimate}");
        assert!(p.estimate(None) > 0.1);
    }
}
