//! The start of a battery in each reading, and the units of what it reports.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use topo_core::Interrupt;

use super::record::{PARTS, Scales};
use super::*;
use crate::{ChargeSettings, Reading};

/// A right-handed trefoil on a torus; of tube, the thinner the torus the less.
fn trefoil(minor: f64) -> Polyline {
    let vertex = |k: usize| {
        let u = TAU * k as f64 / 200.0;
        let r = 2.0 + minor * (3.0 * u).cos();
        Vector3::new(
            r * (2.0 * u).cos(),
            r * (2.0 * u).sin(),
            -1.2 * minor * (3.0 * u).sin(),
        )
    };
    Polyline::new((0..200).map(vertex).collect(), true).unwrap()
}

fn battery(minor: f64, reading: Reading) -> RodBattery {
    let parameters = RodParameters {
        n_edges: 80,
        reading,
        twist: Some(2.0),
        ..Default::default()
    };
    let accuracy = Accuracy::default();
    RodBattery::new(&parameters, &accuracy, Guards::default(), &trefoil(minor)).unwrap()
}

/// The strain a rod starts with: none but in `hard`, where a knot whose ropelength is beyond 50 is stretched to it.
#[test]
fn val_only_hard_rods_start_stretched() {
    for minor in [1.0, 0.4] {
        let rope = battery(minor, Reading::Shrunk).ropelength();
        for (reading, length, strain) in [
            (Reading::Shrunk, 50.0, 1.0),
            (Reading::Hard, 50.0, (rope / 50.0).max(1.0)),
            (Reading::Tight, 50.0, 1.0),
            (Reading::OwnLength, rope, 1.0),
        ] {
            let battery = battery(minor, reading);
            let start = battery.start();
            let curve = start.centreline().unwrap();
            assert!((start.length() / length - 1.0).abs() < 1e-12);
            assert!((curve.length() / (strain * length) - 1.0).abs() < 1e-9);
            // tied in right-handed on the natural length, and the curve is the right-handed trefoil
            let turns = 2.0 * length / TAU;
            assert!((start.total_twist() / turns - 1.0).abs() < 1e-12);
            assert!(start.writhe() > 2.0);
        }
    }
    let rope = |minor| battery(minor, Reading::Shrunk).ropelength();
    assert!(rope(1.0) < 50.0 && rope(0.4) > 60.0, "nothing is stretched");
}

/// T_0 = 2 L η/(h E_b) = 100, E_0 = E_b h² L: per area 50/π; and times of a run are in T_0.
#[test]
fn val_reported_units_of_fifty_radii() {
    let battery = battery(0.4, Reading::Hard);
    let scales = Scales::of(battery.start());
    assert!((scales.time - 100.0).abs() < 1e-12);
    assert!((scales.energy - 50.0 / PI).abs() < 1e-12);
    let settings = ChargeSettings {
        duration: 0.02,
        ..Default::default()
    };
    let charged = battery.charge(&settings, &Interrupt::new()).unwrap();
    let record = charged.record();
    let last = record.samples.last().unwrap();
    assert!((record.report.time - 0.02).abs() < 1e-12 && (last.time - 0.02).abs() < 1e-12);
    assert_eq!(PARTS, ["bend", "twist", "stretch", "contact"]);
    // the books are per area in E_b h
    for (part, stored) in PARTS.iter().zip(last.stored) {
        let booked = record.report.ledger.stored_in(part).unwrap();
        assert!((stored * 50.0 / PI - booked).abs() <= 1e-12 * booked);
    }
    // α θ'²/8 a length at the start, most of it still there
    let twist = last.stored[1] * 50.0 / PI;
    assert!(
        (twist / (4.0 / 8.0 / 1.3 * 50.0) - 1.0).abs() < 0.25,
        "{twist}"
    );
    // released shares count what bend, twist and stretch hold, not what strands in contact do
    let mut sample = last.clone();
    sample.stored = [1.0, 2.0, 4.0, 8.0];
    assert_eq!(sample.elastic(), 7.0);
}
