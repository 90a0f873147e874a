//! Settings over all cases: what they cost, how far off they are, and which of them nothing beats.

use serde::{Deserialize, Serialize};

use super::trial::{REFERENCE, TradeoffRow};
use topo_analysis::{median, quantile};

/// A setting over all cases in one quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Which setting.
    pub setting: String,
    /// Its value.
    pub value: String,
    /// In which quantity.
    pub quantity: String,
    /// Cases that came to a result.
    pub n_cases: usize,
    /// Cases that did not, though their reference did.
    pub n_failed: usize,
    /// Median of the relative errors.
    pub median_error: f64,
    /// Their 90th percentile; a case that failed counts as an error of 1.
    pub high_error: f64,
    /// Mean processor seconds of a case.
    pub cpu_seconds: f64,
    /// Most bytes of a case.
    pub peak_bytes: u64,
    /// Whether no other numerical setting is both cheaper and more accurate.
    pub pareto: bool,
}

impl Setting {
    /// Whether it is compared with converged runs of the same physics, with all of its errors.
    pub fn is_whole(&self) -> bool {
        group(&self.setting) == Some("all")
    }
}

/// Settings whose errors can be compared: those of one group have the same references. `None`: the setting changes what is
/// computed, not how accurately, or (the second method of tightening) starts from the result of another.
fn group(setting: &str) -> Option<&str> {
    match setting {
        REFERENCE
        | "grid of the reference"
        | "contact stiffness"
        | "reading"
        | "flow"
        | "buckled ring"
        | "method" => None,
        "tolerance" | "storage" => Some("time"),
        "flow solver" => Some("flow"),
        _ => Some("all"),
    }
}

/// Settings in the order of the rows, one entry a quantity.
pub fn settings_of(rows: &[TradeoffRow]) -> Vec<Setting> {
    let mut all: Vec<Setting> = Vec::new();
    for row in rows {
        let is_of = |s: &Setting| {
            (s.setting.as_str(), s.value.as_str(), s.quantity.as_str())
                == (
                    row.setting.as_str(),
                    row.value.as_str(),
                    row.quantity.as_str(),
                )
        };
        if all.iter().any(is_of) {
            continue;
        }
        let same: Vec<&TradeoffRow> = rows
            .iter()
            .filter(|r| {
                r.setting == row.setting && r.value == row.value && r.quantity == row.quantity
            })
            .collect();
        let errors: Vec<f64> = same.iter().filter_map(|r| r.relative_error).collect();
        let failed = |r: &&&TradeoffRow| r.result.is_none() && r.reference.is_some();
        let n_failed = same.iter().filter(failed).count();
        let lost = std::iter::repeat_n(1.0, n_failed);
        let all_errors = errors.iter().copied().chain(lost);
        let (Some(median_error), Some(high_error)) =
            (median(all_errors.clone()), quantile(all_errors, 0.9))
        else {
            continue;
        };
        all.push(Setting {
            setting: row.setting.clone(),
            value: row.value.clone(),
            quantity: row.quantity.clone(),
            n_cases: errors.len(),
            n_failed,
            median_error,
            high_error,
            cpu_seconds: same.iter().map(|r| r.cpu_seconds).sum::<f64>() / same.len() as f64,
            peak_bytes: same.iter().map(|r| r.peak_bytes).max().unwrap_or(0),
            pareto: false,
        });
    }
    let beaten: Vec<bool> = all
        .iter()
        .map(|a| {
            all.iter().any(|b| {
                group(&b.setting) == group(&a.setting)
                    && b.quantity == a.quantity
                    && b.cpu_seconds < a.cpu_seconds
                    && b.high_error <= a.high_error
            })
        })
        .collect();
    for (setting, beaten) in all.iter_mut().zip(beaten) {
        setting.pareto = !beaten && group(&setting.setting).is_some();
    }
    all
}

/// Marks the rows of settings on the front.
pub(super) fn mark(rows: &mut [TradeoffRow]) {
    let settings = settings_of(rows);
    for row in rows {
        row.pareto = settings.iter().any(|s| {
            s.pareto
                && s.setting == row.setting
                && s.value == row.value
                && s.quantity == row.quantity
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::run;
    use super::super::{System, compared};
    use super::*;

    #[test]
    fn the_front_has_no_dominated_setting() {
        let runs = [
            run("a", REFERENCE, 10.0, 100.0),
            run("a", "cheap", 12.0, 1.0),
            run("a", "middle", 11.0, 2.0),
            run("a", "worse than middle", 11.5, 3.0),
            run("a", "fine", 10.1, 9.0),
        ];
        let rows = compared(System::Rod, &runs);
        let front: Vec<bool> = rows.iter().map(|r| r.pareto).collect();
        assert_eq!(front, [false, true, true, false, true]);
    }

    #[test]
    fn a_model_is_no_numerical_setting_and_a_failure_is_an_error() {
        let mut model = run("a", "100", 10.0, 0.1);
        model.setting = "contact stiffness".to_owned();
        let mut lost = run("b", "cheap", 1.0, 1.0);
        lost.result = None;
        let runs = [
            run("a", REFERENCE, 10.0, 100.0),
            run("b", REFERENCE, 10.0, 100.0),
            run("a", "cheap", 10.1, 1.0),
            lost,
            model,
        ];
        let settings = settings_of(&compared(System::Rod, &runs));
        let of = |value: &str| settings.iter().find(|s| s.value == value).unwrap();
        assert!(!of("100").pareto && of("cheap").pareto);
        assert_eq!((of("cheap").n_cases, of("cheap").n_failed), (1, 1));
        assert!(of("cheap").high_error > 0.9);
    }
}
