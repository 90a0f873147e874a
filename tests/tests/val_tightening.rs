//! Two independent methods of tightening, and the identification of tight curves at scale.

use nalgebra::{Rotation3, Unit};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use topo_core::Polyline;
use topo_knots::{
    Chirality, Handedness, KnotTable, TightKnot, TightenSettings, V, identify, identify_open,
    second_opinion, thickness, tighten_entry,
};

fn tight(name: &str, settings: &TightenSettings) -> TightKnot {
    let table = KnotTable::builtin();
    tighten_entry(&table.get(name).unwrap(), settings).unwrap()
}

/// Settings without the search: curves that need not be the shortest.
fn quick() -> TightenSettings {
    TightenSettings {
        n_variants: 0,
        n_kicks: 0,
        n_kicks_a_start: 1,
        ..TightenSettings::draft()
    }
}

fn check_two_methods(names: &[&str]) {
    let settings = TightenSettings {
        tolerance: 2e-6,
        max_steps: 2000,
        ..TightenSettings::standard()
    };
    for name in names {
        let first = tight(name, &settings);
        let second = second_opinion(&first).unwrap();
        let apart = second.length_over_radius / first.length_over_radius - 1.0;
        println!(
            "{name}, {} vertices: {:.5} and {:.5}, {apart:+.1e}, from {:.3}",
            first.curve.n_vertices(),
            first.length_over_radius,
            second.length_over_radius,
            second.start_length_over_radius
        );
        assert!(first.certificate.converged && second.converged, "{name}");
        assert!((thickness(&second.curve).tau - 1.0).abs() < 1e-9);
        // The second method had to find the way back by itself.
        assert!(second.start_length_over_radius > 1.02 * first.length_over_radius);
        assert!(apart.abs() < 1e-4, "{name}: {apart:.1e}");
    }
}

/// Quadratic programs and the augmented Lagrangian end at the same length.
#[test]
fn val_two_methods_agree_on_tight_knots() {
    check_two_methods(&["3_1"]);
}

#[test]
#[ignore = "long: 2 minutes"]
fn long_two_methods_agree_on_tight_knots() {
    check_two_methods(&["3_1", "5_2", "7_7"]);
}

/// The curve turned, resampled, its vertices moved by a third of an edge, which ties no knot, and started elsewhere.
fn disturbed(curve: &Polyline, rng: &mut Pcg64) -> Vec<V> {
    let n = rng.random_range(curve.n_edges() / 2..3 * curve.n_edges());
    let curve = curve.resampled(n).unwrap();
    let mut random = || rng.random_range(-1.0..1.0);
    let axis = Unit::new_normalize(V::new(random(), random(), random()));
    let turn = Rotation3::from_axis_angle(&axis, std::f64::consts::PI * random());
    let amplitude = 0.2 * (curve.length() / n as f64).min(1.0);
    let mut x: Vec<V> = curve
        .vertices()
        .iter()
        .map(|x| turn * x + amplitude * V::new(random(), random(), random()))
        .collect();
    x.rotate_left(n / 3);
    x
}

/// Names turned, perturbed and resampled tight curves of the knots to a crossing number, and of their mirror images; how many,
/// and how many of them for certain.
fn check_disturbed(crossing_number: u32, n_each: usize) -> (usize, usize) {
    let table = KnotTable::builtin();
    let mut rng = Pcg64::seed_from_u64(7);
    let (mut n_named, mut n_certain) = (0, 0);
    for knot in table
        .iter()
        .filter(|k| k.crossing_number <= crossing_number)
    {
        let tight = tight(&knot.name, &quick());
        let mirror = tight
            .curve
            .vertices()
            .iter()
            .map(|x| V::new(x.x, x.y, -x.z));
        let mirror = Polyline::new(mirror.collect(), true).unwrap();
        for k in 0..n_each {
            let (curve, chiral) = match k % 2 {
                0 => (&tight.curve, Handedness::Tabulated),
                _ => (&mirror, Handedness::Mirrored),
            };
            let kind = identify(&disturbed(curve, &mut rng), &table).unwrap();
            let expected = match knot.chirality {
                Chirality::Chiral => chiral,
                Chirality::Amphichiral => Handedness::Amphichiral,
            };
            let name = match expected {
                Handedness::Mirrored => table.mirror_label(&knot.name),
                _ => knot.name.clone(),
            };
            assert_eq!(kind.label(), name);
            assert_eq!(kind.handedness, expected, "{}", knot.name);
            n_named += 1;
            n_certain += usize::from(kind.is_certain());
        }
    }
    println!("{n_named} curves named, {n_certain} of them for certain");
    (n_named, n_certain)
}

/// Disturbed tight curves are all named right, with their handedness.
#[test]
fn val_disturbed_tight_curves_are_named() {
    assert_eq!(check_disturbed(5, 50), (250, 250));
}

/// The same for the whole table.
#[test]
#[ignore = "long: 1 minute"]
fn long_a_thousand_disturbed_tight_curves_are_named() {
    assert!(check_disturbed(10, 26).0 > 1000);
}

/// A tight knot cut open is still named after its closed curve by nearly all closures, wherever the cut.
#[test]
fn val_a_knot_just_cut_keeps_its_type() {
    let table = KnotTable::builtin();
    for name in ["3_1", "4_1", "5_2", "6_3", "7_4"] {
        let tight = tight(name, &quick());
        let mut least = 1.0_f64;
        for cut in 0..8 {
            let mut chain = tight.curve.vertices().to_vec();
            let at = cut * chain.len() / 8;
            chain.rotate_left(at);
            let found = identify_open(&chain, 64, 1, &table).unwrap();
            assert_eq!(found.dominant(), name);
            least = least.min(found.probability(name));
        }
        println!("{name}: at least {:.1} % of the closures", 100.0 * least);
        assert!(least > 0.9, "{name}: {least}");
    }
}
