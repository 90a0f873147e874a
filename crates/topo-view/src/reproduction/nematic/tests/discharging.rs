//! Verdicts on discharges.

use super::{CLAIMS, MODE, RADIUS, as_it_is, only_buckled, only_flat, row, said, tables, verdict};
use crate::reproduction::claim::Verdict::{Confirmed, NotConfirmed, NotJudged, Partly};
use std::path::Path;
use topo_analysis::Flow;
use topo_analysis::{NematicRow, NematicSample, write_table};

/// Writes the time series of a case: radius of the ring over that of the particle, and correlation of the flow.
fn series(folder: &Path, row: &NematicRow, samples: &[(Option<f64>, Option<f64>)]) {
    let case = folder.join(&row.case);
    std::fs::create_dir_all(&case).unwrap();
    let sample = |(k, (ring, flow)): (usize, &(Option<f64>, Option<f64>))| NematicSample {
        time: k as f64,
        ring_radius: ring.map(|r| r * RADIUS),
        flow_correlation: *flow,
        ..NematicSample::default()
    };
    let samples: Vec<NematicSample> = samples.iter().enumerate().map(sample).collect();
    write_table(&case.join("series.csv"), &samples).unwrap();
}

#[test]
fn rings_shrink_and_vanish_on_the_particle() {
    let folder = tempfile::tempdir().unwrap();
    let rows: Vec<NematicRow> = (1..=2).map(row).collect();
    let with = |both: [&[Option<f64>]; 2]| {
        for (row, radii) in rows.iter().zip(both) {
            let samples: Vec<_> = radii.iter().map(|r| (*r, None)).collect();
            series(folder.path(), row, &samples);
        }
        said(23, &rows, folder.path()).1
    };
    let gone: &[_] = &[Some(1.14), Some(1.03), None, None];
    let there: &[_] = &[Some(1.14), Some(1.1), Some(1.03)];
    let grown: &[_] = &[Some(1.04), Some(1.06), None];
    let away: &[_] = &[Some(1.4), Some(1.2), None];
    assert_eq!(with([gone, gone]), Confirmed);
    for other in [there, grown, away] {
        assert_eq!(with([gone, other]), Partly);
        assert_eq!(with([other, other]), NotConfirmed);
    }
}

#[test]
fn the_flow_changes_direction() {
    let folder = tempfile::tempdir().unwrap();
    let rows: Vec<NematicRow> = (1..=2)
        .map(|q| NematicRow {
            flow: Flow::On,
            ..row(q)
        })
        .collect();
    let with = |both: [&[f64]; 2]| {
        for (row, values) in rows.iter().zip(both) {
            let samples: Vec<_> = values.iter().map(|c| (None, Some(*c))).collect();
            series(folder.path(), row, &samples);
        }
        said(24, &rows, folder.path())
    };
    let (turns, keeps): (&[f64], &[f64]) = (&[1.0, 0.2, -0.91, -0.4], &[1.0, 0.02, 0.5]);
    let (found, verdict) = with([turns, turns]);
    assert_eq!(verdict, Confirmed);
    assert!(found.contains("−0.91 (q = 1)"), "{found}");
    assert_eq!(with([turns, keeps]).1, Partly);
    assert_eq!(with([keeps, keeps]).1, NotConfirmed);
    // series without the column say nothing
    assert_eq!(said(24, &rows, Path::new("no files")).1, NotJudged);
}

#[test]
fn orders_of_magnitude_within_the_relaxation_time() {
    assert_eq!(verdict(25, as_it_is), Confirmed);
    assert_eq!(verdict(25, |r| r[0].t999 = Some(401.0)), Partly);
    let slow = |rows: &mut Vec<NematicRow>| rows.iter_mut().for_each(|r| r.t999 = Some(401.0));
    assert_eq!(verdict(25, slow), NotConfirmed);
    assert_eq!(verdict(25, only_buckled), NotJudged);
}

#[test]
fn the_first_half_goes_faster_with_q() {
    assert_eq!(verdict(26, as_it_is), Confirmed);
    assert_eq!(verdict(26, |r| r[4].t50 = Some(9.0)), Partly);
    let slower = |rows: &mut Vec<NematicRow>| {
        rows.iter_mut().for_each(|r| r.t50 = Some(f64::from(r.q)));
    };
    assert_eq!(verdict(26, slower), NotConfirmed);
    assert_eq!(verdict(26, only_flat), NotJudged);
}

#[test]
fn late_rates_peak_at_the_buckling() {
    assert_eq!(verdict(27, as_it_is), Confirmed);
    assert_eq!(verdict(27, |r| r[2].t99 = Some(1.0)), Partly);
    // two away is half of all charges run
    let both = |k: usize| {
        move |rows: &mut Vec<NematicRow>| {
            (rows[k].t99, rows[k].t999) = (Some(1.0), Some(2.0));
        }
    };
    assert_eq!(verdict(27, both(4)), NotConfirmed);
    assert_eq!(verdict(27, both(7)), Confirmed);
    // fastest at the end of the range: faster ones may lie beyond
    let at_the_end = |rows: &mut Vec<NematicRow>| {
        both(7)(rows);
        rows.truncate(8);
    };
    assert_eq!(verdict(27, at_the_end), NotJudged);
    assert_eq!(verdict(27, only_flat), NotJudged);
}

#[test]
fn far_above_the_discharge_is_slow_again() {
    assert_eq!(verdict(28, as_it_is), Confirmed);
    let fast = |rows: &mut Vec<NematicRow>| rows[9].t999 = Some(80.0);
    let other_mode = |rows: &mut Vec<NematicRow>| {
        rows.iter_mut().for_each(|r| r.late_rate = Some(1.2 * MODE));
    };
    let not_seen = |rows: &mut Vec<NematicRow>| rows.iter_mut().for_each(|r| r.late_rate = None);
    assert_eq!(verdict(28, fast), Partly);
    assert_eq!(verdict(28, other_mode), Partly);
    assert_eq!(verdict(28, not_seen), Partly);
    let neither = |rows: &mut Vec<NematicRow>| {
        fast(rows);
        other_mode(rows);
    };
    assert_eq!(verdict(28, neither), NotConfirmed);
    assert_eq!(verdict(28, |r| r.truncate(8)), NotJudged);
    assert_eq!(verdict(28, only_flat), NotJudged);
}

#[test]
fn with_flow_the_slow_mode_is_faster_by_the_closed_form() {
    let mut rows: Vec<NematicRow> = (1..=10).map(row).collect();
    for r in &mut rows {
        r.flow = Flow::On;
        r.late_rate = r.late_rate.map(|l| 1.105_707 * l);
    }
    // a sweep that has runs with flow only is judged by these
    let tables = tables(Path::new("no files"), rows.clone(), rows);
    let (found, verdict) = (CLAIMS[28 - 16].look)(&tables).unwrap();
    assert_eq!(verdict, Confirmed);
    assert!(found.contains("at 1.04 times"), "{found}");
}
