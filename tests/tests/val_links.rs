//! Tight links against exact and published lengths, by two methods, and their names from coordinates.

use nalgebra::{Rotation3, Unit};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use topo_core::{Polyline, thickness_of_all, thickness_of_all_brute_force};
use topo_knots::{
    Chirality, LinkEntry, LinkTable, TightLink, TightenSettings, V, identify_link,
    second_opinion_of_link, tighten_link,
};

fn entry(name: &str) -> LinkEntry {
    LinkTable::builtin().get(name).unwrap().into_owned()
}

/// The finest levels without a search: enough where every start leads into the one basin.
fn fine() -> TightenSettings {
    TightenSettings {
        n_variants: 0,
        n_kicks: 0,
        n_kicks_a_start: 1,
        ..TightenSettings::fine()
    }
}

fn tight(name: &str, settings: &TightenSettings) -> TightLink {
    tighten_link(&entry(name), settings).unwrap()
}

/// What must hold of any tight link.
fn check(name: &str, link: &TightLink) {
    let exact = thickness_of_all_brute_force(&link.curves);
    assert_eq!(exact, thickness_of_all(&link.curves));
    assert!((exact.tau - 1.0).abs() < 1e-9, "{name}: {exact:?}");
    let length: f64 = link.curves.iter().map(Polyline::length).sum();
    assert!((length / exact.tau - link.length_over_radius).abs() < 1e-9);
    let certificate = &link.certificate;
    assert!(certificate.thickness_windowed > 1.0 - 1e-9, "{name}");
    assert!(
        certificate.converged && certificate.residual < 0.05,
        "{name}: {certificate:?}"
    );
    entry(name).verify(&link.curves).unwrap();
}

fn check_lengths(lengths: &[(&str, f64)]) {
    for (name, exact) in lengths {
        let link = tight(name, &fine());
        let excess = link.length_over_radius / exact - 1.0;
        println!(
            "{name}: {:.5}, {:+.4} % of {exact}, residual {:.3}, {:.1} s",
            link.length_over_radius,
            100.0 * excess,
            link.certificate.residual,
            link.cpu_seconds
        );
        check(name, &link);
        assert!((-1e-5..2e-4).contains(&excess), "{name}: {excess:.2e}");
    }
}

/// Hopf link 8 pi; each ring between the ends of a straight chain adds 4 pi + 4 (Cantarella, Kusner and Sullivan 2002, exact minima);
/// the Borromean rings' critical configuration (Cantarella, Fu, Kusner, Sullivan and Wrinkle 2006), not proved to be the minimum.
#[test]
fn val_tight_links_have_their_exact_lengths() {
    check_lengths(&[
        ("hopf", 25.132741),
        ("chain(3)", 41.699112),
        ("borromean", 58.0060),
    ]);
}

#[test]
#[ignore = "long: 1 minute"]
fn long_straight_chains_have_their_exact_lengths() {
    check_lengths(&[("chain(4)", 58.265482), ("chain(5)", 74.831853)]);
}

/// T(Q,Q) against the best published polygons and the lower bounds (Klotz 2026): within half a percent or below, and what is below is
/// found by the second method too.
fn check_torus(published: &[(usize, f64, f64)], settings: &TightenSettings) {
    for &(q, polygon, bound) in published {
        let name = format!("T({q},{q})");
        let link = tight(&name, settings);
        let length = link.length_over_radius;
        let second = second_opinion_of_link(&link).unwrap();
        println!(
            "{name}: {length:.4}, {:+.3} % of {polygon}, second method {:.4} from {:.3}, {:.1} s and {:.1} s",
            100.0 * (length / polygon - 1.0),
            second.length_over_radius,
            second.start_length_over_radius,
            link.cpu_seconds,
            second.cpu_seconds
        );
        check(&name, &link);
        assert!(
            length > bound && length < 1.005 * polygon,
            "{name}: {length}"
        );
        assert!(second.start_length_over_radius > 1.01 * length);
        assert!((thickness_of_all_brute_force(&second.curve).tau - 1.0).abs() < 1e-9);
        // A shorter one counts when both methods find it.
        let both = second.length_over_radius < polygon;
        assert!(length > polygon || both, "{name}");
        assert!(second.length_over_radius > bound);
    }
}

#[test]
fn val_torus_links_are_as_short_as_published() {
    check_torus(&[(4, 77.47, 74.265)], &TightenSettings::standard());
}

#[test]
#[ignore = "long: 10 minutes"]
fn long_torus_links_are_as_short_as_published() {
    let published = [
        (3, 50.35, 49.699),
        (4, 77.47, 74.265),
        (5, 109.00, 102.832),
        (6, 144.21, 135.398),
    ];
    // The resolution that the second method comes to rest at in minutes, with the search of the finest.
    let settings = TightenSettings {
        n_variants: 3,
        n_kicks: 12,
        ..TightenSettings::standard()
    };
    check_torus(&published, &settings);
}

/// Quadratic programs and the augmented Lagrangian end at the same length, to what the resolution leaves open, of links with components of unequal lengths too.
fn check_two_methods(names: &[&str]) {
    let settings = TightenSettings {
        tolerance: 2e-6,
        max_steps: 2000,
        ..TightenSettings::standard()
    };
    for name in names {
        let first = tight(name, &settings);
        let second = second_opinion_of_link(&first).unwrap();
        let apart = second.length_over_radius / first.length_over_radius - 1.0;
        println!(
            "{name}: {:.5} and {:.5}, {apart:+.1e}, from {:.3}",
            first.length_over_radius, second.length_over_radius, second.start_length_over_radius
        );
        assert!(first.certificate.converged && second.converged, "{name}");
        assert!(second.start_length_over_radius > 1.01 * first.length_over_radius);
        // Round components may slide along themselves, so that polygons of one shape differ: by less than half of what the
        // resolution costs, 4.6e-4.
        assert!(apart.abs() < 2e-4, "{name}: {apart:.1e}");
    }
}

#[test]
fn val_two_methods_agree_on_tight_links() {
    check_two_methods(&["hopf", "chain(3)"]);
}

#[test]
#[ignore = "long: 2 minutes"]
fn long_two_methods_agree_on_tight_links() {
    check_two_methods(&["L4a1", "borromean", "L7n1"]);
}

/// Turned, resampled, vertices moved by up to a fifth of a radius, components reversed, exchanged and begun elsewhere.
fn disturbed(curves: &[Polyline], rng: &mut Pcg64) -> Vec<Vec<V>> {
    let mut random = || rng.random_range(-1.0..1.0);
    let axis = Unit::new_normalize(V::new(random(), random(), random()));
    let turn = Rotation3::from_axis_angle(&axis, std::f64::consts::PI * random());
    let mut moved = Vec::new();
    for curve in curves {
        let n = (curve.n_edges() as f64 * (1.0 + 0.5 * random())) as usize;
        let curve = curve.resampled(n).unwrap();
        let amplitude = 0.2 * (curve.length() / n as f64).min(1.0);
        let shifted = |x: &V| turn * x + amplitude * V::new(random(), random(), random());
        let mut x: Vec<V> = curve.vertices().iter().map(shifted).collect();
        x.rotate_left(n / 3);
        if random() > 0.0 {
            x.reverse();
        }
        moved.push(x);
    }
    let by = (moved.len() as f64 * random().abs()) as usize;
    moved.rotate_left(by);
    moved
}

/// Names disturbed tight links and their mirror images; how many.
fn check_disturbed(most_crossings: u32, n_each: usize) -> usize {
    let table = LinkTable::builtin();
    let quick = TightenSettings {
        n_variants: 0,
        n_kicks: 0,
        n_kicks_a_start: 0,
        ..TightenSettings::draft()
    };
    let mut rng = Pcg64::seed_from_u64(5);
    let mut n_named = 0;
    for link in table.iter().filter(|l| l.crossing_number <= most_crossings) {
        let tight = tighten_link(link, &quick).unwrap();
        let mirror = tight.mirror();
        for k in 0..n_each {
            let shape = if k % 2 == 0 { &tight } else { &mirror };
            let name = match link.chirality {
                Chirality::Chiral => &shape.name,
                Chirality::Amphichiral => &link.name,
            };
            let parts = disturbed(&shape.curves, &mut rng);
            let parts: Vec<&[V]> = parts.iter().map(Vec::as_slice).collect();
            let found = identify_link(&parts, table).unwrap();
            assert_eq!(found.label(), *name);
            assert_eq!(found.is_certain(), link.crossing_number <= 7, "{name}");
            n_named += 1;
        }
    }
    println!("{n_named} links named");
    n_named
}

#[test]
fn val_tight_links_are_named() {
    assert_eq!(check_disturbed(5, 20), 80);
}

#[test]
#[ignore = "long: 2 minutes"]
fn long_all_tight_links_are_named() {
    assert_eq!(check_disturbed(30, 40), 960);
}

/// Mirror images are tightened as the link itself, to the bit, and the same seed gives the same curves.
#[test]
fn law_a_tight_link_is_its_mirror_image_turned() {
    let quick = TightenSettings {
        n_variants: 0,
        n_kicks: 1,
        ..TightenSettings::draft()
    };
    let (link, mirror) = (tight("solomon", &quick), tight("msolomon", &quick));
    assert_eq!(mirror.name, "mL4a1");
    assert_eq!(mirror.length_over_radius, link.length_over_radius);
    assert_eq!(mirror.curves, link.mirror().curves);
    entry("mL4a1").verify(&mirror.curves).unwrap();
    assert!(entry("L4a1").verify(&mirror.curves).is_err());
    assert_eq!(tight("solomon", &quick).curves, link.curves);
    let lines = link.centrelines().unwrap();
    entry("L4a1").verify(&lines).unwrap();
}
