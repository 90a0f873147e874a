//! Do estimated errors hold? The settings of goals on cases that the table was not measured on, against converged references.

use serde::{Deserialize, Serialize};

use super::Goal;
use super::choice::Point;
use super::choose::{Load, choose_from};
use super::pair::{Measurement, cases};
use crate::system::System;
use crate::tradeoff::TradeoffRow;
use topo_analysis::quantile;

/// Accuracies asked for in the check.
const ASKED: [f64; 5] = [0.1, 0.05, 0.03, 0.02, 0.01];

/// Share of the errors that estimates are to cover on cases they were not scaled on.
const PROMISED: f64 = 0.9;
/// Standard normal quantile of the confidence, three in four, with which the promise is to hold on other cases. Errors of rods
/// have long tails: with nine in ten, estimates would be six times the error in the median.
const CONFIDENCE: f64 = 0.6745;

/// The factor between differences and estimates that covers a share of the errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cover {
    /// Errors over raw estimates stay below this in the share of them.
    pub scale: f64,
    /// The share.
    pub share: f64,
    /// Cases it was taken from.
    pub n_cases: usize,
}

/// The factor by which estimates of the settings `points` cover the errors of the cases `rows`; none without cases.
///
/// A quantile of `n` cases is uncertain by √(p(1−p)/n), so that the one taken lies above p = 0.9 by two thirds of that.
///
/// # Validation
/// `the_factor_is_the_quantile_that_covers`
pub fn factor_of_estimates(
    system: System,
    points: &[Point],
    rows: &[TradeoffRow],
) -> Option<Cover> {
    let n_cases = cases(rows).len();
    let spread = (PROMISED * (1.0 - PROMISED) / n_cases as f64).sqrt();
    let share = (PROMISED + CONFIDENCE * spread).min(1.0);
    let scale = scale_covering(system, points, rows, share)?;
    Some(Cover {
        scale,
        share,
        n_cases,
    })
}

fn scale_covering(
    system: System,
    points: &[Point],
    rows: &[TradeoffRow],
    share: f64,
) -> Option<f64> {
    let names = cases(rows);
    let ratios = names.iter().flat_map(|case| {
        points.iter().filter_map(|p| {
            let found = Measurement::of(system, &p.setting(), case, rows);
            Some(found.error? / p.raw_estimate(found.coarser_error)?.0)
        })
    });
    quantile(ratios, share)
}

/// One run with a goal beside its reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CheckRow {
    /// `rod` or `nematic`.
    pub system: String,
    /// Which case.
    pub case: String,
    /// The setting.
    pub setting: String,
    /// Accuracies asked for that it is picked for.
    pub asked: String,
    /// The error that the table says nine cases of ten stay below.
    pub promised: f64,
    /// The time found.
    pub result: Option<f64>,
    /// That of the reference.
    pub reference: Option<f64>,
    /// |result/reference − 1|.
    pub relative_error: Option<f64>,
    /// What was estimated.
    pub estimate: Option<f64>,
    /// Processor seconds of the run and of the coarser one.
    pub cpu_seconds: f64,
}

impl CheckRow {
    /// Whether the estimate is at least as large as the error; a run without result or reference is not.
    pub fn is_covered(&self) -> bool {
        self.estimate
            .zip(self.relative_error)
            .is_some_and(|(estimate, error)| estimate >= error)
    }

    /// Estimate over true error.
    pub fn ratio(&self) -> Option<f64> {
        Some(self.estimate? / self.relative_error?)
    }
}

/// All settings of a table on the cases `rows`, each with the accuracies that it is picked for.
///
/// # Validation
/// `every_setting_is_checked_with_what_it_is_picked_for`
pub fn check_estimates(
    system: System,
    points: &[Point],
    scale: f64,
    rows: &[TradeoffRow],
) -> Vec<CheckRow> {
    let load = Load {
        cases: 1.0,
        threads: 1,
    };
    let picked = ASKED.map(|asked| {
        let choice = choose_from(points, scale, Goal::Accuracy(asked), load);
        (asked, choice.ok().map(|c| c.point))
    });
    let mut found = Vec::new();
    for point in points {
        let of = picked.iter().filter(|p| p.1 == Some(*point));
        let asked: Vec<String> = of.map(|p| format!("{} %", 100.0 * p.0)).collect();
        for case in cases(rows) {
            let measured = Measurement::of(system, &point.setting(), case, rows);
            let estimate = point.raw_estimate(measured.coarser_error);
            found.push(CheckRow {
                system: system.name().to_owned(),
                case: case.to_owned(),
                setting: system.resolution_name(point.resolution, point.tolerance),
                asked: asked.join(", "),
                promised: point.high_error,
                result: measured.result,
                reference: measured.reference,
                relative_error: measured.error,
                estimate: estimate.map(|(error, _)| scale * error),
                cpu_seconds: measured.cpu_seconds,
            });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const COARSE: Point = Point {
        resolution: 200.0,
        tolerance: 1e-3,
        median_error: 0.01,
        high_error: 0.03,
        cpu_seconds: 1.0,
        peak_bytes: 1,
        check_resolution: 100.0,
        check_tolerance: 1e-3,
        n_cases: 20,
    };

    /// Twenty cases: errors of 1 to 20 per cent at N = 100 and half of one to ten times `share` of that at N = 200.
    fn rows(missing: bool) -> Vec<TradeoffRow> {
        let mut rows = Vec::new();
        for case in 1..=20 {
            let error = 0.004 * f64::from(case);
            for (value, result) in [
                ("N = 100, 1e-3 h", 1.0 + 4.0 * error),
                ("N = 200, 1e-3 h", 1.0 + error),
            ] {
                let lost = missing && case == 7 && value.contains("200");
                let row = |quantity: &str, result: f64| TradeoffRow {
                    system: "rod".to_owned(),
                    case: case.to_string(),
                    setting: "resolution".to_owned(),
                    value: value.to_owned(),
                    quantity: quantity.to_owned(),
                    result: (!lost).then_some(result),
                    reference: Some(1.0),
                    relative_error: (!lost).then_some(result - 1.0),
                    cpu_seconds: 1.0,
                    peak_bytes: 1,
                    pareto: false,
                };
                rows.extend([row("t50", 1.0), row("t99", result)]);
            }
        }
        rows
    }

    #[test]
    fn the_factor_is_the_quantile_that_covers() {
        // with errors of second order the difference tells the error up to 1/(1 + error): the factor is hardly above one
        let rows = rows(false);
        let scale = |share| scale_covering(System::Rod, &[COARSE], &rows, share).unwrap();
        let (all, half) = (scale(1.0), scale(0.5));
        assert!((all - 1.08).abs() < 1e-9, "{all}");
        assert!((half - 1.042).abs() < 1e-9, "{half}");
        let covered = |scale| {
            let rows = check_estimates(System::Rod, &[COARSE], scale, &rows);
            rows.iter().filter(|r| r.is_covered()).count()
        };
        assert_eq!((covered(all + 1e-9), covered(half)), (20, 10));
        // √(0.09/20) = 0.067: of twenty cases, 94.5 % are asked
        let found = factor_of_estimates(System::Rod, &[COARSE], &rows).unwrap();
        assert_eq!(found.n_cases, 20);
        assert!((found.share - 0.94525).abs() < 1e-4, "{}", found.share);
        assert_eq!(found.scale, scale(found.share));
        assert_eq!(factor_of_estimates(System::Rod, &[COARSE], &[]), None);
    }

    #[test]
    fn every_setting_is_checked_with_what_it_is_picked_for() {
        let fine = Point {
            resolution: 400.0,
            check_resolution: 200.0,
            high_error: 0.006,
            cpu_seconds: 4.0,
            ..COARSE
        };
        let found = check_estimates(System::Rod, &[COARSE, fine], 2.0, &rows(true));
        assert_eq!(found.len(), 40);
        assert_eq!(
            (found[0].asked.as_str(), found[20].asked.as_str()),
            ("10 %, 5 %, 3 %", "2 %, 1 %")
        );
        // a run without a result is not covered, and has no ratio
        assert!(!found[6].is_covered() && found[6].ratio().is_none());
        assert!(found[7].is_covered() && (found[7].ratio().unwrap() - 2.0 / 1.032).abs() < 1e-9);
        assert!(
            found[20].relative_error.is_none(),
            "this setting was not run"
        );
    }
}
