//! A run beside its coarser one, and how far off that says it is.

use crate::system::System;
use crate::tradeoff::{TradeoffRow, fitted_ratio};

use super::table::Setting;

/// Order of the error in the resolution. In colloids it holds; in rods (near ties of contacts, places of cuts among the
/// vertices) a difference becomes an error of about the right size.
const ORDER: f64 = 2.0;

/// Grids nearer to each other tell nothing: small cells may have hardly another one.
const LEAST_RATIO: f64 = 1.05;

/// Relative error of a discharge that one on a grid coarser by `ratio` tells: the largest of what each of its `times`, fine and
/// coarse, says, as two runs may agree in one time by chance; none where one is lacking.
///
/// # Validation
/// `errors_of_second_order_are_told`
pub(crate) fn told(times: &[(Option<f64>, Option<f64>)], ratio: f64) -> Option<f64> {
    let of = |&(fine, coarse): &(Option<f64>, Option<f64>)| {
        let (fine, coarse) = fine.zip(coarse).filter(|_| ratio > LEAST_RATIO)?;
        Some((coarse / fine - 1.0).abs() / gain(ratio))
    };
    let all: Option<Vec<f64>> = times.iter().map(of).collect();
    all?.into_iter().reduce(f64::max)
}

/// What a time `fine` and one on a grid coarser by `ratio` tend to on finer grids.
///
/// # Validation
/// `errors_of_second_order_are_told`
pub(crate) fn extrapolated(fine: f64, coarse: f64, ratio: f64) -> f64 {
    fine + (fine - coarse) / gain(ratio)
}

/// Difference of two times, in errors of the finer one.
fn gain(ratio: f64) -> f64 {
    ratio.powf(ORDER) - 1.0
}

/// A setting of a table on one case.
pub(super) struct Measurement {
    pub result: Option<f64>,
    pub reference: Option<f64>,
    /// |result/reference − 1|.
    pub error: Option<f64>,
    /// What the coarser run tells of it.
    pub told: Option<f64>,
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
            told: told(&pairs, ratio),
            cpu_seconds: own.into_iter().chain(coarser).map(|r| r.cpu_seconds).sum(),
        }
    }
}

/// The times that are compared, that which wishes are about last. The late time of a rod hangs on ties of contacts, and two
/// resolutions may agree in it by chance.
fn times(system: System) -> &'static [&'static str] {
    match system {
        System::Rod => &["t50", "t99"],
        System::Nematic => &["t99.9"],
        System::Knots => &[],
    }
}

/// The time that wishes are about.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_second_order_are_told() {
        let time = |h: f64| 8.0 - 0.3 * h * h;
        let (fine, coarse) = (time(0.5), time(0.75));
        assert!((extrapolated(fine, coarse, 1.5) - 8.0).abs() < 1e-12);
        let error = told(&[(Some(fine), Some(coarse))], 1.5).unwrap();
        assert!((error - 0.075 / fine).abs() < 1e-12);
        // what differs most counts
        for other in [0.99, 1.01] {
            let two = [(Some(2.0), Some(2.0 * other)), (Some(fine), Some(coarse))];
            let error = told(&two, 1.5).unwrap();
            let both = [0.01, coarse / fine - 1.0].map(|d| d.abs() / 1.25);
            assert!((error - f64::max(both[0], both[1])).abs() < 1e-12);
        }
        // without a second run, or with one on the same grid, nothing is told
        for (a, b, ratio) in [
            (Some(3.0), None, 1.5),
            (None, Some(3.0), 1.5),
            (Some(3.0), Some(3.1), 1.0),
        ] {
            assert_eq!(told(&[(a, b), (Some(1.0), Some(1.0))], ratio), None);
        }
    }
}
