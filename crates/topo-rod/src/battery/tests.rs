//! The start of a battery in each reading, and the units of what it reports.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::hooks::RunHooks;
use super::record::Scales;
use super::*;
use crate::energy::StoredEnergy;
use crate::{ChargeSettings, Protocol, Reading, cut_candidates};

/// A right-handed trefoil on a torus; of tube, the thinner the torus the less.
pub(super) fn trefoil(minor: f64) -> Polyline {
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

/// Two rings that each run through the other, one of them egg-shaped so that no two of their parts are alike.
pub(super) fn hopf_link() -> [Polyline; 2] {
    let ring = |at: &dyn Fn(f64) -> Vector3<f64>| {
        let vertices = (0..200).map(|k| at(TAU * f64::from(k) / 200.0));
        Polyline::new(vertices.collect(), true).unwrap()
    };
    let flat = |u: f64| Vector3::new(2.0 * u.cos(), 2.1 * u.sin(), 0.1 * (2.0 * u).sin());
    let upright = |u: f64| Vector3::new(2.2 + 2.3 * u.cos(), 0.2 * (3.0 * u).cos(), 1.9 * u.sin());
    [ring(&flat), ring(&upright)]
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
    let charged = battery.charge(&settings, &mut RunHooks::default()).unwrap();
    let record = charged.record();
    let last = record.samples.last().unwrap();
    assert!((record.report.time - 0.02).abs() < 1e-12 && (last.time - 0.02).abs() < 1e-12);
    let names: Vec<&str> = record.report.own.parts.names().collect();
    assert_eq!(names, ["bend", "twist", "stretch", "contact"]);
    // the books are per area in E_b h
    for (part, stored) in last.stored.by_part() {
        let booked = record.report.ledger.stored_in(part.name).unwrap();
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
    let energies = vec![1.0, 2.0, 4.0, 8.0];
    sample.stored = StoredEnergy::new(record.report.own.parts.clone(), energies);
    assert_eq!(sample.elastic(), 7.0);
}

/// Two strands of edges of 0.5 that leave from a corner: the first along x so that its vertex `corner` is in the origin, the last
/// vertex `gap` above that, and a wide bow between them.
fn corner(corner: usize, gap: f64) -> RodState {
    let first = (0..20).map(|i| Vector3::new(0.5 * (i as f64 - corner as f64), 0.0, 0.0));
    let bow = [
        [30.0, -30.0, 9.0],
        [60.0, 0.0, 9.0],
        [60.0, 60.0, 9.0],
        [0.0, 60.0, 9.0],
    ];
    let last = (0..20)
        .rev()
        .map(|k| Vector3::new(0.0, gap + 0.5 * k as f64, 0.0));
    let vertices = first.chain(bow.map(Vector3::from)).chain(last).collect();
    let curve = Polyline::new(vertices, false).unwrap();
    RodState::new(&curve, 0.5 * curve.n_edges() as f64, 0.0).unwrap()
}

/// Tips have parted when all pairs that the seam kept apart by less than the window, 3 or six edges, are farther apart than d.
#[test]
fn val_tips_part_when_all_pairs_of_the_seam_are_apart() {
    let parted =
        |state: &RodState, d: f64| super::tips::tips_have_parted(state, crate::Tips::Of(0), d, 3.0);
    for vertex in [0, 3, 6] {
        let state = corner(vertex, 0.9);
        assert!(!parted(&state, 0.95) && parted(&state, 0.85), "{vertex}");
    }
    // the seventh edge from the seam is a strand of its own: what counts is the sixth, √(0.25 + 0.81) = 1.03 away
    assert!(parted(&corner(7, 0.9), 1.0) && !parted(&corner(7, 0.9), 1.05));
    let ring = |n: usize| {
        let u = |k: usize| TAU * k as f64 / n as f64;
        let ring = (0..n).map(|k| Vector3::new(u(k).cos(), u(k).sin(), 0.0));
        let curve = Polyline::new(ring.collect(), true).unwrap();
        RodState::new(&curve, 0.5 * n as f64, 0.0)
            .unwrap()
            .cut_at(0)
            .unwrap()
    };
    assert!(!parted(&ring(40), 0.1));
    // on a rod this short all pairs are neighbours along the rod
    assert!(parted(&ring(10), 0.1));
}

#[test]
fn candidates_lie_at_their_vertices() {
    let mut density = vec![1.0; 80];
    density[20] = 2.0;
    let found = cut_candidates(&density, 0.5, 0.0);
    assert_eq!(
        (found[0].vertex, found[0].at, found[0].density),
        (20, 0.25, 2.0)
    );
}

/// A protocol is its three steps, with a file a phase; interrupted it has no discharge, and goes on to the same bits.
#[test]
fn a_protocol_is_charge_cut_and_discharge() {
    let battery = battery(0.4, Reading::Shrunk);
    let mut protocol = Protocol::default();
    protocol.charge.duration = 0.05;
    protocol.discharge.longest = 0.05;
    let hooks = &mut RunHooks::default();
    let charged = battery.charge(&protocol.charge, hooks).unwrap();
    let cut = charged.cut(protocol.cut).unwrap();
    let by_hand = cut.discharge(&protocol.discharge, hooks).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rod.checkpoint");
    let interrupt = topo_core::Interrupt::new();
    interrupt.request();
    let hooks = &mut RunHooks::new(&interrupt).with_checkpoint(&path, 0.0);
    assert!(battery.run(&protocol, hooks).unwrap().1.is_none() && path.exists());
    for _ in 0..2 {
        let hooks = &mut RunHooks::default().with_checkpoint(&path, 0.0);
        let (again, run) = battery.run(&protocol, hooks).unwrap();
        assert_eq!(again.state().vertices(), charged.state().vertices());
        let [run, by_hand] =
            [&run.unwrap(), &by_hand].map(|d| (d.after_cut, d.record.curve.clone()));
        assert_eq!(run, by_hand);
    }
    assert!(folder.path().join("rod.checkpoint.discharge").exists());
}
