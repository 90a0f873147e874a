//! What a run says of its own error: a coarser run beside it, and the measured table.

use serde::{Deserialize, Serialize};

use super::Grant;
use crate::nematic::NematicRow;
use crate::table::SweepRow;

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

impl ErrorRow {
    fn new(
        grant: &Grant,
        case: String,
        cut: Option<f64>,
        quantity: &str,
        result: Option<f64>,
        coarser: Option<f64>,
    ) -> Self {
        let difference = result.zip(coarser).map(|(a, b)| b / a - 1.0);
        Self {
            case,
            cut,
            quantity: quantity.to_owned(),
            result,
            coarser,
            relative_error: result.map(|_| grant.point.estimate(difference)),
        }
    }
}

/// Errors of the discharges `rows`, beside coarser ones of the same cuts.
///
/// Cuts are matched by their order: a coarser rod has its vertices elsewhere.
///
/// # Validation
/// `cuts_are_matched_by_their_order`
pub fn errors_of_rods(grant: &Grant, rows: &[SweepRow], coarser: &[SweepRow]) -> Vec<ErrorRow> {
    let place = |k: usize, rows: &[SweepRow]| {
        let same = |r: &&SweepRow| r.knot == rows[k].knot && r.twist == rows[k].twist;
        rows[..k].iter().filter(same).count()
    };
    let of = |(k, row): (usize, &SweepRow)| {
        let beside = coarser
            .iter()
            .filter(|r| r.knot == row.knot && r.twist == row.twist)
            .nth(place(k, rows));
        ErrorRow::new(
            grant,
            format!("{} {:+.2}", row.knot, row.twist),
            Some(row.cut),
            "t99",
            row.t99,
            beside.and_then(|r| r.t99),
        )
    };
    rows.iter().enumerate().map(of).collect()
}

/// Errors of the colloids `rows`, beside coarser ones.
pub fn errors_of_colloids(
    grant: &Grant,
    rows: &[NematicRow],
    coarser: &[NematicRow],
) -> Vec<ErrorRow> {
    let of = |row: &NematicRow| {
        let beside = coarser.iter().find(|r| r.q == row.q && r.flow == row.flow);
        ErrorRow::new(
            grant,
            row.case_name(),
            None,
            "t99.9",
            row.t999,
            beside.and_then(|r| r.t999),
        )
    };
    rows.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Point, Wish};
    use super::*;

    #[test]
    fn cuts_are_matched_by_their_order() {
        let row = |knot: &str, cut: f64, t99: Option<f64>| SweepRow {
            knot: knot.to_owned(),
            cut,
            t99,
            ..SweepRow::default()
        };
        let rows = [
            row("3_1", 0.10, Some(10.0)),
            row("3_1", 0.43, Some(20.0)),
            row("4_1", 0.20, Some(5.0)),
            row("5_1", 0.20, None),
        ];
        let coarser = [
            row("3_1", 0.11, Some(10.1)),
            row("3_1", 0.44, Some(21.0)),
            row("5_1", 0.2, Some(3.0)),
        ];
        let grant = Grant {
            wish: Wish::Accuracy(0.1),
            point: Point {
                resolution: 100.0,
                tolerance: 1e-3,
                median_error: 0.02,
                high_error: 0.1,
                cpu_seconds: 1.0,
                peak_bytes: 1,
                check_resolution: 60.0,
                check_tolerance: 2e-3,
                scale: 2.0,
                n_cases: 8,
            },
            cpu_seconds: 1.0,
        };
        let found = errors_of_rods(&grant, &rows, &coarser);
        let errors: Vec<_> = found.iter().map(|r| r.relative_error).collect();
        // a difference below the median error counts as that
        assert!((errors[0].unwrap() - 0.04).abs() < 1e-12);
        assert!((errors[1].unwrap() - 0.10).abs() < 1e-12);
        // without a coarser run nothing is known
        assert!((errors[2].unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(errors[3], None);
    }
}
