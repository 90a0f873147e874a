//! A run beside its coarser one, and how far off that says it is.

use crate::system::System;
use crate::tradeoff::{TradeoffRow, fitted_ratio};

use super::difference::difference_error;
use super::setting::Setting;

/// A setting of a table on one case.
pub(super) struct Measurement {
    pub result: Option<f64>,
    pub reference: Option<f64>,
    /// |result/reference − 1|.
    pub error: Option<f64>,
    /// Relative error by the difference to a coarser run.
    pub coarser_error: Option<f64>,
    /// Processor seconds of both runs.
    pub cpu_seconds: f64,
}

impl Measurement {
    /// What the rows of a trade-off say of a case at a setting.
    pub(super) fn of(system: System, setting: &Setting, case: &str, rows: &[TradeoffRow]) -> Self {
        let at = |(resolution, tolerance): (f64, f64), quantity: &str| {
            let value = system.resolution_name(resolution, tolerance);
            rows.iter().find(|r| {
                r.case == case
                    && r.setting == "resolution"
                    && r.value == value
                    && r.quantity == quantity
            })
        };
        let last = quantity(system).unwrap_or_default();
        let (own, coarser) = (at(setting.fine, last), at(setting.coarse, last));
        let ratio = fitted_ratio(system, case, setting.coarse.0, setting.fine.0)
            .unwrap_or_else(|| setting.ratio());
        let time = |at: Option<&TradeoffRow>| at.and_then(|r| r.result);
        let pair = |name: &&str| (time(at(setting.fine, name)), time(at(setting.coarse, name)));
        let pairs: Vec<_> = times(system).iter().map(pair).collect();
        Self {
            result: time(own),
            reference: own.and_then(|r| r.reference),
            error: own.and_then(|r| r.relative_error),
            coarser_error: difference_error(&pairs, ratio),
            cpu_seconds: own.into_iter().chain(coarser).map(|r| r.cpu_seconds).sum(),
        }
    }
}

/// The times that are compared, that which goals are about last. The late time of a rod depends on ties of contacts, and two
/// resolutions may agree in it by chance.
fn times(system: System) -> &'static [&'static str] {
    match system {
        System::Rod => &["t50", "t99"],
        System::Nematic => &["t99.9"],
        System::Knots => &[],
    }
}

/// The time that goals are about.
pub(super) fn quantity(system: System) -> Option<&'static str> {
    times(system).last().copied()
}

/// Names of the cases of rows.
pub(super) fn cases(rows: &[TradeoffRow]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for row in rows {
        if !names.contains(&row.case.as_str()) {
            names.push(&row.case);
        }
    }
    names
}
