//! A run beside its coarser one: the best value that both tell, and how far off it may be.

use serde::{Deserialize, Serialize};

use super::table::Setting;
use crate::system::System;
use crate::tradeoff::{TradeoffRow, fitted_ratio};

/// Order of the error in the resolution. In colloids it holds, and the value is extrapolated; in rods (near ties of contacts,
/// places of cuts among the vertices) hardly, so that it only turns a difference into an error of about the right size.
const ORDER: f64 = 2.0;

/// Grids nearer to each other tell nothing: small cells may have hardly another one.
const LEAST_RATIO: f64 = 1.05;

/// What a run and a coarser one say of the last time listed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pair {
    /// The time of the run, of a colloid extrapolated with the coarser one.
    pub value: Option<f64>,
    /// Relative error of the run itself as the difference to the coarser one tells it.
    pub told: Option<f64>,
}

impl Pair {
    /// A run with time `fine` and one with time `coarse` on a grid coarser by `ratio`.
    ///
    /// # Validation
    /// `times_are_extrapolated_at_second_order`
    pub(crate) fn of(system: System, fine: Option<f64>, coarse: Option<f64>, ratio: f64) -> Self {
        let gain = ratio.powf(ORDER) - 1.0;
        let both = fine.zip(coarse).filter(|_| ratio > LEAST_RATIO);
        let value = match both {
            Some((fine, coarse)) if system == System::Nematic => {
                Some(fine + (fine - coarse) / gain)
            }
            _ => fine,
        };
        Self {
            value,
            told: both.map(|(fine, coarse)| (coarse / fine - 1.0).abs() / gain),
        }
    }
}

/// A setting of a table on one case.
pub(super) struct Measurement {
    pub pair: Pair,
    pub reference: Option<f64>,
    /// |value/reference − 1|.
    pub error: Option<f64>,
    /// Processor seconds of both runs.
    pub cpu_seconds: f64,
}

impl Measurement {
    /// What the rows of a trade-off say of a case at a setting.
    pub(super) fn of(system: System, setting: &Setting, case: &str, rows: &[TradeoffRow]) -> Self {
        let at = |(resolution, tolerance): (f64, f64)| {
            let value = system.resolution_name(resolution, tolerance);
            rows.iter().find(|r| {
                r.case == case
                    && r.setting == "resolution"
                    && r.value == value
                    && quantity(system) == Some(r.quantity.as_str())
            })
        };
        let (own, coarser) = (at(setting.fine), at(setting.coarse));
        let ratio = fitted_ratio(system, case, setting.coarse.0, setting.fine.0)
            .unwrap_or_else(|| setting.ratio());
        let result = |row: Option<&TradeoffRow>| row.and_then(|r| r.result);
        let pair = Pair::of(system, result(own), result(coarser), ratio);
        let reference = own.and_then(|r| r.reference);
        Self {
            pair,
            reference,
            error: pair.value.zip(reference).map(|(a, b)| (a / b - 1.0).abs()),
            cpu_seconds: own.into_iter().chain(coarser).map(|r| r.cpu_seconds).sum(),
        }
    }
}

/// The time that wishes are about.
pub(super) fn quantity(system: System) -> Option<&'static str> {
    match system {
        System::Rod => Some("t99"),
        System::Nematic => Some("t99.9"),
        System::Knots => None,
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_extrapolated_at_second_order() {
        let time = |h: f64| 8.0 - 0.3 * h * h;
        let of = |system| Pair::of(system, Some(time(0.5)), Some(time(0.75)), 1.5);
        let colloid = of(System::Nematic);
        assert!((colloid.value.unwrap() - 8.0).abs() < 1e-12);
        // the error of the finer run, over its time
        assert!((colloid.told.unwrap() - 0.075 / time(0.5)).abs() < 1e-12);
        let rod = of(System::Rod);
        assert_eq!((rod.value, rod.told), (Some(time(0.5)), colloid.told));
        let alone = Pair::of(System::Nematic, Some(3.0), None, 1.5);
        assert_eq!((alone.value, alone.told), (Some(3.0), None));
        // two runs on one grid tell nothing
        let same = Pair::of(System::Nematic, Some(3.0), Some(3.1), 1.0);
        assert_eq!((same.value, same.told), (Some(3.0), None));
        assert_eq!(Pair::of(System::Rod, None, Some(3.0), 1.5).value, None);
    }
}
