//! The knot type of a cut rod while it discharges.

use topo_knots::{
    KnotTable, LinkTable, TightenSettings, V, identify_open, identify_open_link, tighten_entry,
};
use topo_rod::{Accuracy, Guards, RodBattery, RodParameters};
use topo_tests::run::discharge;

/// Closures of an open curve.
const N_CLOSURES: usize = 400;
/// Time followed after the cut, in T_0.
const LONGEST: f64 = 0.15;

/// Least distance of either tip from strands further along the rod than `window` vertices.
fn room_of_the_tips(x: &[V], window: usize) -> f64 {
    let others = &x[window..x.len() - window];
    let room = |tip: &V| {
        others
            .iter()
            .map(|x| (x - tip).norm())
            .fold(f64::INFINITY, f64::min)
    };
    room(&x[0]).min(room(&x[x.len() - 1]))
}

/// Charges, cuts and discharges each knot, and compares the types of the open rod with the closed one.
fn check_discharges(names: &[&str], n_edges: usize) {
    let table = KnotTable::builtin();
    let quick = TightenSettings {
        n_variants: 0,
        n_kicks: 0,
        n_kicks_a_start: 1,
        ..TightenSettings::draft()
    };
    for name in names {
        let tight = tighten_entry(&table.get(name).unwrap(), &quick).unwrap();
        let line = tight.centreline().unwrap();
        let parameters = RodParameters {
            n_edges,
            twist: Some(1.0),
            ..Default::default()
        };
        let (accuracy, guards) = (Accuracy::default(), Guards::default());
        let battery = RodBattery::new(&parameters, &accuracy, guards, &line);
        let battery = battery.unwrap();
        let diameter = battery.tube().contact_diameter;
        let run = discharge(&battery, 1.0, LONGEST);
        let (mut n_near, mut n_free) = (0, 0);
        let (mut least_near, mut least_free) = (1.0_f64, 1.0_f64);
        for sample in &run.record.samples {
            let x = sample.state.vertices();
            let found = identify_open(x, N_CLOSURES, 1, &table).unwrap();
            assert_eq!(found.dominant(), *name, "at {}", sample.time);
            let share = found.probability(name);
            // just cut: the tips are still within a tube radius of each other
            if sample.end_to_end < 0.5 * diameter {
                n_near += 1;
                least_near = least_near.min(share);
            }
            // later, as long as nothing is near the tips
            if room_of_the_tips(x, n_edges / 10) > 1.5 * diameter {
                n_free += 1;
                least_free = least_free.min(share);
            }
        }
        println!(
            "{name}: at least {:.1} % of the closures in {n_near} samples with the tips together, {:.1} % in {n_free} with free tips",
            100.0 * least_near,
            100.0 * least_free
        );
        assert!(n_near > 3, "{name}: {n_near} samples");
        assert!(least_near > 0.9, "{name}: {least_near}");
        assert!(least_free > 0.9, "{name}: {least_free}");
    }
}

/// The type of most closures is the closed one: nine in ten while the tips are together, and as long as no strand is near them.
#[test]
fn val_a_discharge_begins_with_the_closed_type() {
    check_discharges(&["3_1", "5_2", "7_4"], 120);
}

/// The same for all of seven crossings, at the edges of the default preset.
#[test]
#[ignore = "long: 1 minute"]
fn long_discharges_begin_with_the_closed_type() {
    let table = KnotTable::builtin();
    let names: Vec<&str> = table.primes_up_to(7).map(|k| k.name.as_str()).collect();
    check_discharges(&names, 200);
}

/// A straight rod along the axis of a ring, from −a to a, closed far away in the direction d: the ring lies around the rod, and once more, the other way
/// round, around the way from one of its ends where that passes within the ring, which is where tan θ < R/a. So it is linked for the share
/// a/√(a² + R²) of all directions.
#[test]
fn val_share_of_the_closures_of_a_rod_that_link_its_ring() {
    let n_closures = 1000;
    let ring: Vec<V> = (0..60)
        .map(|k| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 60.0).sin_cos();
            V::new(cos, sin, 0.0)
        })
        .collect();
    for a in [0.25, 1.0, 3.0] {
        let rod = [V::new(0.01, 0.02, -a), V::new(0.01, 0.02, a)];
        let rod: Vec<V> = (0..=8)
            .map(|k| rod[0].lerp(&rod[1], f64::from(k) / 8.0))
            .collect();
        let link = [&ring[..], &rod[..]];
        let found =
            identify_open_link(&link, 1, n_closures, 1, LinkTable::builtin()).expect("a link");
        let linked = found.iter().filter(|(kind, _)| !kind.is_free(1));
        let linked: f64 = linked.map(|(_, share)| share).sum();
        let share = a / a.hypot(1.0);
        println!("a/R = {a}: {linked:.4} of closures linked, {share:.4} expected");
        assert!((linked - share).abs() < 0.02);
        let labels: Vec<String> = found.iter().map(|(kind, _)| kind.label()).collect();
        assert!(
            labels.iter().all(|l| l == "L2a1" || l == "0_1+0_1"),
            "{labels:?}"
        );
    }
    let refused = |n, open| identify_open_link(&[&ring, &ring], open, n, 0, LinkTable::builtin());
    assert!(refused(0, 1).is_err() && refused(4, 2).is_err());
}
