//! Verdicts on charged states.

use super::{ONSET, as_it_is, only_buckled, only_flat, row, said, verdict};
use crate::reproduction::claim::Verdict::{Confirmed, NotConfirmed, NotJudged, Partly};
use std::path::Path;
use topo_analysis::{LinePoint, NematicRow, write_table};

#[test]
fn flat_rings_below_the_buckling() {
    assert_eq!(verdict(16, as_it_is), Confirmed);
    assert_eq!(verdict(16, |r| r[2].ring_amplitude = Some(0.4)), Partly);
    let wavy = |rows: &mut Vec<NematicRow>| {
        for r in rows.iter_mut().filter(|r| r.q < ONSET) {
            r.ring_amplitude = Some(0.4);
        }
    };
    assert_eq!(verdict(16, wavy), NotConfirmed);
    assert_eq!(verdict(16, only_flat), NotJudged);
    assert_eq!(verdict(16, only_buckled), NotJudged);
}

/// Writes the charged ring of a case: its height over the equator and its angles.
fn ring(folder: &Path, row: &NematicRow, height: f64, angles: &[f64]) {
    let case = folder.join(&row.case);
    std::fs::create_dir_all(&case).unwrap();
    let point = |a: &f64| LinePoint {
        closed: true,
        z: height,
        angle: Some(*a),
        ..LinePoint::default()
    };
    let mut points: Vec<LinePoint> = angles.iter().map(point).collect();
    // a ring of the discharge has no say
    points.push(LinePoint {
        time: Some(1.0),
        z: 9.0,
        angle: Some(0.0),
        ..LinePoint::default()
    });
    write_table(&case.join("ring.csv"), &points).unwrap();
}

#[test]
fn a_ring_off_the_equator_is_not_on_it() {
    let folder = tempfile::tempdir().unwrap();
    let rows: Vec<NematicRow> = (1..=10).map(row).collect();
    let at = |q: usize, height: f64| {
        ring(folder.path(), &rows[q - 1], height, &[90.0]);
        said(16, &rows, folder.path()).1
    };
    assert_eq!(at(1, 0.01), Confirmed);
    // flat, but shifted upwards: no mode has an amplitude
    assert_eq!(at(2, 0.5), Partly);
}

#[test]
fn profiles_along_the_ring() {
    let folder = tempfile::tempdir().unwrap();
    let rows: Vec<NematicRow> = (1..=4).map(row).collect();
    let with = |angles: [&[f64]; 4]| {
        for (row, angles) in rows.iter().zip(angles) {
            ring(folder.path(), row, 0.0, angles);
        }
        said(17, &rows, folder.path()).1
    };
    // q = 1 has the same profile everywhere, and is not asked
    let (same, all, most): (&[f64], &[f64], &[f64]) =
        (&[180.0; 3], &[20.0, 90.0, 170.0], &[60.0, 90.0, 170.0]);
    assert_eq!(with([same, all, all, all]), Confirmed);
    assert_eq!(with([same, all, most, most]), Partly);
    assert_eq!(with([all, most, most, most]), NotConfirmed);
    // from one kind to the other without the twisted one between
    assert_eq!(with([same, all, all, &[20.0, 170.0]]), Partly);
}

#[test]
fn the_critical_charge() {
    let published = |rows: &mut Vec<NematicRow>| rows.iter_mut().for_each(|r| r.radius = 52.5);
    assert_eq!(verdict(18, published), Confirmed);
    assert_eq!(verdict(18, as_it_is), Partly);
    let at_eight = |rows: &mut Vec<NematicRow>| {
        published(rows);
        rows[6].order_parameter = 1e-6;
    };
    assert_eq!(verdict(18, at_eight), Partly);
    // the step from 6 to 7 was not seen
    let with_a_gap = |rows: &mut Vec<NematicRow>| {
        published(rows);
        rows.remove(5);
    };
    assert_eq!(verdict(18, with_a_gap), Partly);
    assert_eq!(verdict(18, only_flat), NotJudged);
    assert_eq!(verdict(18, only_buckled), NotJudged);
}

#[test]
fn maxima_and_minima_of_a_buckled_ring() {
    let wrong = |n: usize| {
        verdict(19, move |rows| {
            for r in rows.iter_mut().filter(|r| r.q >= ONSET).take(n) {
                r.ring_mode = Some(1);
            }
        })
    };
    assert_eq!([0, 1, 2].map(wrong), [Confirmed, Partly, NotConfirmed]);
    assert_eq!(verdict(19, only_flat), NotJudged);
}

#[test]
fn undulations_grow() {
    assert_eq!(verdict(20, as_it_is), Confirmed);
    assert_eq!(verdict(20, |r| r[8].ring_amplitude = Some(4.1)), Partly);
    assert_eq!(
        verdict(20, |r| r[9].ring_amplitude = Some(3.9)),
        NotConfirmed
    );
    assert_eq!(verdict(20, |r| r.truncate(8)), NotJudged);
}

#[test]
fn the_order_parameter_by_the_height_of_the_ring() {
    assert_eq!(verdict(21, as_it_is), Confirmed);
    assert_eq!(verdict(21, |r| r[2].order_parameter = 0.04), Partly);
    assert_eq!(verdict(21, |r| r[2].order_parameter = 0.2), NotConfirmed);
    // sorted by the order parameter itself, an undulating ring without tilt would pass for a flat one
    assert_eq!(verdict(21, |r| r[7].order_parameter = 1e-7), NotConfirmed);
    assert_eq!(verdict(21, only_flat), NotJudged);
    assert_eq!(verdict(21, only_buckled), NotJudged);
}

#[test]
fn the_energy_grows_all_the_way() {
    assert_eq!(verdict(22, as_it_is), Confirmed);
    assert_eq!(verdict(22, |r| r[4].f_charged = 700.0), NotConfirmed);
    assert_eq!(verdict(22, only_flat), NotJudged);
    let falls = |rows: &mut Vec<NematicRow>| {
        only_flat(rows);
        rows[4].f_charged = 700.0;
    };
    assert_eq!(verdict(22, falls), NotConfirmed);
}
