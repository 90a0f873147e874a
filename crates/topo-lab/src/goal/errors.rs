//! What a run says of its own error: a coarser run beside it, and the measured table.

use super::choice::{Choice, ErrorRow};
use super::difference::difference_error;
use topo_analysis::NematicRow;
use topo_analysis::SweepRow;

/// Errors of the discharges `rows`, beside coarser ones of the same cuts.
///
/// Cuts are matched by their order: a coarser rod has its vertices elsewhere.
///
/// # Validation
/// `cuts_are_matched_by_their_order`
pub fn errors_of_rods(choice: &Choice, rows: &[SweepRow], coarser: &[SweepRow]) -> Vec<ErrorRow> {
    let place = |k: usize, rows: &[SweepRow]| {
        let same = |r: &&SweepRow| r.is_same_state(&rows[k]);
        rows[..k].iter().filter(same).count()
    };
    let of = |(k, row): (usize, &SweepRow)| {
        let beside = coarser
            .iter()
            .filter(|r| r.is_same_state(row))
            .nth(place(k, rows));
        let coarser = beside.and_then(|r| r.t99);
        let early = (row.t50, beside.and_then(|r| r.t50));
        let (estimate, kind) = choice.estimate(difference_error(
            &[early, (row.t99, coarser)],
            choice.point.ratio(),
        ));
        ErrorRow {
            case: row.case.clone(),
            cut: Some(row.cut),
            quantity: "t99".to_owned(),
            result: row.t99,
            coarser,
            relative_error: row.t99.map(|_| estimate),
            kind: kind.filter(|_| row.t99.is_some()),
        }
    };
    rows.iter().enumerate().map(of).collect()
}

/// Errors of the colloids `rows`, beside coarser ones.
pub fn errors_of_colloids(
    choice: &Choice,
    rows: &[NematicRow],
    coarser: &[NematicRow],
) -> Vec<ErrorRow> {
    let of = |row: &NematicRow| {
        let beside = coarser.iter().find(|r| r.is_same_discharge(row));
        let coarser = beside.and_then(|r| r.t999);
        // grids are fitted to the cell
        let ratio = beside.map_or(choice.point.ratio(), |r| r.spacing / row.spacing);
        let (estimate, kind) = choice.estimate(difference_error(&[(row.t999, coarser)], ratio));
        ErrorRow {
            case: row.case.clone(),
            cut: None,
            quantity: "t99.9".to_owned(),
            result: row.t999,
            coarser,
            relative_error: row.t999.map(|_| estimate),
            kind: kind.filter(|_| row.t999.is_some()),
        }
    };
    rows.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{ErrorKind, Goal, Point};
    use super::*;

    fn choice() -> Choice {
        Choice {
            goal: Goal::Accuracy(0.1),
            point: Point {
                resolution: 100.0,
                tolerance: 1e-3,
                median_error: 0.02,
                high_error: 0.04,
                cpu_seconds: 1.0,
                peak_bytes: 1,
                check_resolution: 50.0,
                check_tolerance: 2e-3,
                n_cases: 8,
            },
            unit: "edges",
            scale: 2.0,
            stale: None,
            cpu_seconds: 1.0,
        }
    }

    #[test]
    fn cuts_are_matched_by_their_order() {
        let row = |knot: &str, cut: f64, t99: Option<f64>| SweepRow {
            knot: knot.to_owned(),
            cut,
            t50: Some(1.0),
            t99,
            ..SweepRow::default()
        };
        let rows = [
            row("3_1", 0.10, Some(10.0)),
            row("3_1", 0.43, Some(20.0)),
            row("4_1", 0.20, Some(5.0)),
            row("5_1", 0.20, None),
            row("5_2", 0.20, Some(2.0)),
        ];
        let coarser = [
            row("3_1", 0.11, Some(10.1)),
            row("3_1", 0.44, Some(23.0)),
            row("5_1", 0.2, Some(3.0)),
            SweepRow {
                t50: Some(1.09),
                ..row("5_2", 0.2, Some(2.0))
            },
        ];
        let found = errors_of_rods(&choice(), &rows, &coarser);
        let errors: Vec<_> = found.iter().map(|r| r.relative_error).collect();
        // a difference that tells less than a quarter of the 90th percentile counts as that
        assert!((errors[0].unwrap() - 0.02).abs() < 1e-12);
        // at twice the edges a difference of 15 % tells an error of 5 %
        assert!((errors[1].unwrap() - 0.10).abs() < 1e-12);
        // without a coarser run nothing is known
        assert_eq!((errors[2], errors[3]), (Some(1.0), None));
        // where t99 agrees but t50 does not, this tells
        assert!((errors[4].unwrap() - 0.06).abs() < 1e-12);
        let kinds: Vec<_> = found.iter().map(|r| r.kind).collect();
        let (own, floor) = (Some(ErrorKind::Own), Some(ErrorKind::Floor));
        assert_eq!(kinds, [floor, own, None, None, own]);
    }

    #[test]
    fn errors_of_colloids_follow_from_the_grids_they_had() {
        let row = |q: u32, spacing: f64, t999: Option<f64>| NematicRow {
            q,
            spacing,
            t999,
            flow: topo_analysis::Flow::Off,
            ..NematicRow::default()
        };
        // second order in the spacing, on grids fitted to the cell
        let time = |h: f64| Some(8.0 - 0.3 * h * h);
        let rows = [
            row(2, 0.95, time(0.95)),
            row(3, 0.95, Some(4.0)),
            row(4, 0.95, None),
        ];
        let coarser = [row(2, 1.19, time(1.19)), row(4, 1.19, Some(2.0))];
        let found = errors_of_colloids(&choice(), &rows, &coarser);
        let error = 0.3 * 0.95 * 0.95 / time(0.95).unwrap();
        assert!((found[0].relative_error.unwrap() - 2.0 * error).abs() < 1e-12);
    }
}
