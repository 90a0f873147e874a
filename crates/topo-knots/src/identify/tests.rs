//! Identification against the table, and faults that it must catch.

use super::*;
use crate::{Chirality, closed_braid};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

fn braid(word: &[i32]) -> Vec<V> {
    closed_braid(word).expect("a knot").into_vertices()
}

#[test]
fn names_the_table_and_its_mirrors() {
    let table = KnotTable::builtin();
    for knot in table.iter() {
        let kind = identify(&braid(&knot.braid), &table).expect("a knot");
        assert_eq!(kind.label(), knot.name);
        assert_eq!(kind.invariants, knot.invariants);
        let mirror = identify(&braid(&knot.mirror().braid), &table).expect("a knot");
        let named = match knot.chirality {
            Chirality::Amphichiral => knot.name.clone(),
            Chirality::Chiral => knot.mirror().name,
        };
        assert_eq!(mirror.label(), named);
        assert_eq!(table.mirror_label(&kind.label()), named);
        assert!(kind.fits(&knot.name) && mirror.fits(&knot.mirror().name));
        let is_chiral = knot.chirality == Chirality::Chiral;
        assert_ne!(kind.fits(&knot.mirror().name), is_chiral, "{}", knot.name);
        let expected = match knot.chirality {
            Chirality::Amphichiral => [Handedness::Amphichiral; 2],
            Chirality::Chiral => [Handedness::Tabulated, Handedness::Mirrored],
        };
        assert_eq!(
            [kind.handedness, mirror.handedness],
            expected,
            "{}",
            knot.name
        );
    }
}

/// The Jones polynomial tells these from their mirror images, and the second row from the first.
#[test]
fn jones_tells_what_the_signature_cannot() {
    let table = KnotTable::builtin();
    for name in ["6_1", "7_7", "8_1", "8_8", "8_13", "8_20"] {
        let knot = table.get(name).expect(name);
        assert_eq!(knot.invariants.signature, 0);
        let kind = identify(&braid(&knot.mirror().braid), &table).expect("a knot");
        assert_eq!(
            kind.describe(),
            format!("m{name}, the mirror image of {name} (certain)")
        );
    }
    for (one, other) in [("8_21", "3_1#4_1"), ("8_20", "3_1#m3_1")] {
        let [a, b] = [one, other].map(|name| table.get(name).expect(name));
        assert_eq!(a.invariants, b.invariants);
        for knot in [a, b] {
            let kind = identify(&braid(&knot.braid), &table).expect("a knot");
            assert_eq!(kind.label(), knot.name);
        }
    }
}

/// Without a Jones polynomial in the table, the two are not distinguished, and that is said.
#[test]
fn what_fits_several_knots_is_called_ambiguous() {
    let mut table = KnotTable::default();
    for name in ["3_1", "4_1", "8_21"] {
        let mut knot = KnotTable::builtin().get(name).expect(name).into_owned();
        knot.jones = None;
        table.insert(knot);
    }
    let word = KnotTable::builtin()
        .get("8_21")
        .expect("known")
        .braid
        .clone();
    let kind = identify(&braid(&word), &table).expect("a knot");
    assert_eq!(kind.label(), "8_21|3_1#4_1");
    assert_eq!(kind.describe(), "consistent with each of 8_21, 3_1#4_1");
    assert!(!kind.is_certain());
}

#[test]
fn unknots_are_seen_through() {
    let table = KnotTable::builtin();
    // Closed three-braids that are unknots with many crossings.
    for word in [
        vec![1, -2],
        vec![1, 2, -1, 2, -1, -2, 1, 1, -2, -1, 1, -2, -1, 2],
        vec![1, 2, 3, 4, 5],
    ] {
        if crate::n_components(&word).expect("a word") == 1 {
            let kind = identify(&braid(&word), &table).expect("a curve");
            if word.len() != 14 {
                assert!(kind.is_unknot(), "{word:?}: {}", kind.label());
            }
            assert_eq!(
                kind.invariants,
                Invariants::of(&braid(&word)).expect("a curve")
            );
        }
    }
}

#[test]
fn composite_knots_multiply() {
    let table = KnotTable::builtin();
    for (word, expected, handedness) in [
        (vec![1, 1, 1, 2, 2, 2], "3_1#3_1", Handedness::Tabulated),
        (
            vec![-1, -1, -1, -2, -2, -2],
            "m3_1#m3_1",
            Handedness::Mirrored,
        ),
        (
            vec![1, 1, 1, -2, -2, -2],
            "3_1#m3_1",
            Handedness::Amphichiral,
        ),
        (
            vec![1, 1, 1, 2, -3, 2, -3],
            "3_1#4_1",
            Handedness::Tabulated,
        ),
        (
            vec![1, 1, 1, 1, 1, -2, -2, -2],
            "m3_1#5_1",
            Handedness::Mirrored,
        ),
        (
            vec![1, -2, 1, -2, 3, -4, 3, -4],
            "4_1#4_1",
            Handedness::Amphichiral,
        ),
        (
            vec![1, 1, 1, 2, 2, 2, -3, -3, -3],
            "3_1#3_1#m3_1",
            Handedness::Tabulated,
        ),
    ] {
        let kind = identify(&braid(&word), &table).expect("a knot");
        assert_eq!(kind.label(), expected, "{word:?}");
        assert_eq!(kind.handedness, handedness, "{expected}");
        assert_eq!(kind.is_certain(), kind.n_crossings <= 10);
    }
}

#[test]
fn knots_beyond_the_table_are_unknown() {
    let table = KnotTable::builtin();
    // The torus knot T(3, 7).
    let torus = identify(&braid(&[1, 2].repeat(7)), &table).expect("a knot");
    assert!(torus.label().starts_with("unknown(1 -1 0 1"), "{torus:?}");
    assert_eq!(torus.invariants.signature, -8);
    assert!(torus.describe().contains("Jones polynomial t^6 + t^8"));
    // 9_2 shares its Alexander polynomial and signature with 7_4; its Jones polynomial tells. With the mirror image of 5_1, 10_132
    // shares the Jones polynomial too.
    let nine = [1, 1, 1, 2, -1, 2, 3, -2, 3, 4, -3, 4];
    let ten = [1, 1, 1, -2, -1, -1, -2, -3, 2, -3, -3];
    for (word, name, like) in [(&nine[..], "9_2", "7_4"), (&ten, "10_132", "5_1")] {
        let kind = identify(&braid(word), &table).expect("a knot");
        let like = table.get(like).expect("known");
        assert_eq!(kind.invariants.alexander, like.invariants.alexander);
        assert_eq!(kind.label(), name);
    }
}

/// The Kinoshita-Terasaka knot has the Alexander polynomial of the unknot.
#[test]
fn a_trivial_alexander_polynomial_is_not_enough() {
    let table = KnotTable::builtin();
    let word = [-1, -1, -1, -1, 2, 2, 1, -3, 2, 2, -3, 2, -3];
    let kind = identify(&braid(&word), &table).expect("a knot");
    assert_eq!(kind.invariants.alexander, [1]);
    assert!(!kind.is_unknot() && kind.types().is_empty(), "{kind:?}");
    assert!(kind.jones.is_some_and(|jones| jones != Jones::one()));
}

#[test]
fn a_curve_passed_through_itself_is_caught() {
    let table = KnotTable::builtin();
    let knot = table.get("5_1").expect("known");
    let curve = closed_braid(&knot.braid).expect("a knot");
    // One crossing changed: the strand above its crossing is pushed below the other one.
    let mut x = curve.vertices().to_vec();
    let top = (0..x.len())
        .max_by(|&a, &b| x[a].z.total_cmp(&x[b].z))
        .expect("vertices");
    let summit = x[top];
    for v in x
        .iter_mut()
        .filter(|v| v.z > 0.0 && (**v - summit).norm() < 2.6)
    {
        v.z *= -3.0;
    }
    let passed = topo_core::Polyline::new(x, true).expect("a curve");
    assert!(matches!(
        knot.verify(&passed),
        Err(KnotError::Mismatch {
            what: "alexander",
            ..
        })
    ));
    assert_eq!(
        identify(passed.vertices(), &table).expect("a knot").label(),
        "3_1"
    );
}

#[test]
fn an_open_knot_is_dominated_by_its_type() {
    let table = KnotTable::builtin();
    for name in ["3_1", "4_1", "5_2", "7_4"] {
        let mut chain = braid(&table.get(name).expect("known").braid);
        // A small cut: nearly all closures leave the type alone when the ends are on the rim.
        let rim = (0..chain.len())
            .max_by(|&a, &b| chain[a].norm().total_cmp(&chain[b].norm()))
            .expect("vertices");
        chain.rotate_left(rim);
        chain.truncate(chain.len() - 2);
        let found = identify_open(&chain, 32, 0, &table).expect("a chain");
        assert_eq!(found.dominant(), name);
        assert!(found.probability(name) > 0.5, "{found:?}");
        let sum: f64 = found.distribution.iter().map(|(_, share)| share).sum();
        assert!((sum - 1.0).abs() < 1e-12);
    }
}

/// A knot that has just been cut, its ends in one point, is what it was in every closure; a circle too, of which reduction leaves an edge
/// there and back.
#[test]
fn chains_whose_ends_coincide_are_closed() {
    let table = KnotTable::builtin();
    let circle = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / 60.0;
        V::new(angle.cos(), angle.sin(), 1e-5 * (7.0 * angle).sin())
    };
    let mut knots = vec![("0_1", (0..60).map(circle).collect::<Vec<V>>())];
    for name in ["3_1", "4_1", "7_4"] {
        knots.push((name, braid(&table.get(name).expect("known").braid)));
    }
    for (name, chain) in knots {
        for cut in [0, chain.len() / 3] {
            let mut chain = chain.clone();
            chain.rotate_left(cut);
            chain.push(chain[0]);
            let found = identify_open(&chain, 32, 0, &table).expect("a chain");
            assert_eq!(found.distribution, [(name.to_owned(), 1.0)]);
        }
    }
}

#[test]
fn common_reduction_changes_no_closure() {
    let table = KnotTable::builtin();
    for knot in table.iter() {
        let mut chain = braid(&knot.braid);
        // A deep cut, so that closures differ.
        chain.truncate(chain.len() * 4 / 5);
        let found = identify_open(&chain, 24, 7, &table).expect("a chain");
        let mut shares = std::collections::BTreeMap::new();
        for point in open::far_points(&chain, 24, 7).expect("closures") {
            let mut closed = chain.clone();
            closed.push(point);
            *shares
                .entry(identify(&closed, &table).expect("a knot").label())
                .or_insert(0) += 1;
        }
        assert!(
            shares.len() > 1 || knot.crossing_number < 5,
            "{}",
            knot.name
        );
        for (label, count) in shares {
            assert_eq!(
                found.probability(&label),
                f64::from(count) / 24.0,
                "{}: {label}",
                knot.name
            );
        }
    }
}

#[test]
fn ends_that_coincide_close_like_the_closed_curve() {
    let table = KnotTable::builtin();
    let mut chain = braid(&table.get("5_2").expect("known").braid);
    chain.push(chain[0]);
    let found = identify_open(&chain, 16, 0, &table).expect("a chain");
    assert_eq!(found.distribution, [("5_2".to_owned(), 1.0)]);
}

#[test]
fn bad_chains_are_refused() {
    let table = KnotTable::builtin();
    assert!(matches!(
        identify(&[V::zeros(); 2], &table),
        Err(KnotError::TooFewVertices { .. })
    ));
    let nan = vec![V::new(f64::NAN, 0.0, 0.0); 8];
    assert!(matches!(
        identify_open(&nan, 8, 0, &table),
        Err(KnotError::NotFinite { vertex: 0 })
    ));
    let rod = vec![V::zeros(), V::x()];
    assert!(matches!(
        identify_open(&rod, 0, 0, &table),
        Err(KnotError::Setting { .. })
    ));
    assert_eq!(
        identify_open(&rod, 4, 0, &table).expect("a rod").dominant(),
        "0_1"
    );
    // All vertices in one place: nothing to knot.
    assert!(
        identify(&vec![V::x(); 9], &table)
            .expect("a point")
            .is_unknot()
    );
    assert_eq!(
        identify_open(&vec![V::x(); 9], 4, 0, &table)
            .expect("a point")
            .dominant(),
        "0_1"
    );
}

proptest::proptest! {
    #[test]
    fn reduction_keeps_the_invariants_of_random_polygons(
        raw in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0_f64), 8..40),
    ) {
        let x: Vec<V> = raw.into_iter().map(V::from).collect();
        let kind = identify(&x, &KnotTable::builtin()).expect("a curve in general position");
        proptest::prop_assert_eq!(kind.invariants, Invariants::of(&x).expect("general position"));
    }
}

/// A left-handed trefoil with a million vertices, in a time that grows hardly faster than their number.
#[test]
fn a_million_vertices_are_named() {
    let table = KnotTable::builtin();
    let trefoil = |n: usize| -> Vec<V> {
        (0..n)
            .map(|k| std::f64::consts::TAU * k as f64 / n as f64)
            .map(|t| {
                let r = 2.0 + (3.0 * t).cos();
                V::new(r * (2.0 * t).cos(), r * (2.0 * t).sin(), (3.0 * t).sin())
            })
            .collect()
    };
    let mut per_vertex = Vec::new();
    for n in [10_000, 1_000_000] {
        let x = trefoil(n);
        let mut reducer = Reducer::default();
        reducer.load(&x, true);
        reducer.reduce(true, &[]);
        per_vertex.push(reducer.n_triangles as f64 / n as f64);
        let kind = identify(&x, &table).expect("a knot");
        assert_eq!((kind.label(), kind.is_certain()), ("m3_1".to_owned(), true));
        assert_eq!(
            Invariants::of(&x).expect("a knot").determinant,
            3,
            "{n} vertices"
        );
    }
    assert!(per_vertex[1] < 1.5 * per_vertex[0], "{per_vertex:?}");
}

/// Words of sixty letters: the invariants of the closure, or a refusal that counts its crossings; never a name of the table.
#[test]
fn words_of_sixty_letters_get_no_wrong_name() {
    let table = KnotTable::builtin();
    let mut n_knots = 0;
    for seed in 1..40_u64 {
        let mut rng = Pcg64::seed_from_u64(seed);
        let mut letter = || {
            // Alternating, so that nothing cancels; words on three strands, as an even number of letters closes no four to a knot.
            if rng.random() { -2 } else { 1 }
        };
        let word: Vec<i32> = (0..60).map(|_| letter()).collect();
        let Ok(curve) = closed_braid(&word) else {
            continue;
        };
        n_knots += 1;
        match identify(curve.vertices(), &table) {
            Ok(kind) => {
                assert!(kind.types().is_empty() && !kind.is_certain(), "{kind:?}");
                assert!(kind.invariants.determinant > 100);
            }
            Err(error) => assert!(matches!(error, KnotError::TooComplicated { .. }), "{error}"),
        }
    }
    assert!(n_knots > 3, "{n_knots}");
}

#[test]
fn curves_that_touch_themselves_are_refused() {
    let table = KnotTable::builtin();
    let lobe = |k: usize| std::f64::consts::TAU * (k as f64 + 0.25) / 400.0;
    // Three lobes in a plane: every crossing is a touch.
    let flat: Vec<V> = (0..400)
        .map(|k| {
            let (t, r) = (lobe(k), 2.0 + (3.0 * lobe(k)).cos());
            V::new(r * (2.0 * t).cos(), r * (2.0 * t).sin(), 0.0)
        })
        .collect();
    assert!(matches!(
        identify(&flat, &table),
        Err(KnotError::Degenerate)
    ));
    assert!(matches!(Invariants::of(&flat), Err(KnotError::Degenerate)));
}

#[test]
fn repeated_and_collinear_vertices_do_no_harm() {
    let table = KnotTable::builtin();
    let curve = braid(&[1, 1, 1]);
    let mut x = Vec::new();
    for (k, a) in curve.iter().enumerate() {
        let b = curve[(k + 1) % curve.len()];
        x.extend([*a, *a, 0.5 * (a + b), 0.25 * a + 0.75 * b]);
    }
    assert_eq!(identify(&x, &table).expect("a knot").label(), "3_1");
}

#[test]
fn size_does_not_matter() {
    let table = KnotTable::builtin();
    let trefoil = |scale: f64| -> Vec<V> {
        (0..90)
            .map(|k| {
                let u = std::f64::consts::TAU * f64::from(k) / 90.0;
                let r = 2.0 + (3.0 * u).cos();
                V::new(r * (2.0 * u).cos(), r * (2.0 * u).sin(), -(3.0 * u).sin()) * scale
            })
            .collect()
    };
    for scale in [1e-300, 1e-90, 1e-31, 1.0, 1e31, 1e90, 1e307] {
        let curve = trefoil(scale);
        let kind = identify(&curve, &table).unwrap();
        assert_eq!(kind.label(), "3_1", "{scale:e}");
        assert_eq!(crate::determinant(&curve).unwrap(), 3, "{scale:e}");
        let open = crate::identify_open(&curve[..89], 8, 1, &table).unwrap();
        assert!(open.n_closures == 8, "{scale:e}");
    }
}

/// A trefoil of six vertices with whole coordinates; the others scaled by powers of two. A positive diagonal map keeps the type.
#[test]
fn stretched_curves_keep_their_name() {
    let table = KnotTable::builtin();
    let stick = [
        [-2.0, 2.0, 1.0],
        [4.0, 0.0, 3.0],
        [-4.0, -4.0, -4.0],
        [1.0, 3.0, 3.0],
        [3.0, 0.0, 3.0],
        [0.0, 2.0, 0.0],
    ]
    .map(V::from);
    let of = |x: &[V]| identify(x, &table).expect("in general position");
    let name = of(&stick).label();
    assert_eq!(name, "3_1");
    for powers in [
        [27, 0, 0],
        [27, 0, -27],
        [27, 27, 27],
        [20, 0, -20],
        [-300, 200, 0],
        [900, -900, 0],
    ] {
        let scale = V::from(powers.map(|p| f64::from(p).exp2()));
        let x = stick.map(|x| x.component_mul(&scale));
        assert!(of(&x).is_certain(), "{powers:?}");
        assert_eq!(of(&x).label(), "3_1", "{powers:?}");
        // A shear, exact as well, and a turn that rounds.
        let sheared = stick.map(|x| V::new(x.x + x.y, x.y - x.z, x.z).component_mul(&scale));
        assert_eq!(of(&sheared).label(), "3_1", "{powers:?}");
    }
    for knot in ["8_18", "9_42", "10_123"] {
        let curve = braid(&table.get(knot).expect("known").braid);
        let scale = V::new(20_f64.exp2(), 1.0, (-20_f64).exp2());
        let x: Vec<V> = curve.iter().map(|x| x.component_mul(&scale)).collect();
        assert_eq!(of(&x).label(), knot);
    }
}

/// Strands a hair apart: the gap of the last digit decides, on either side, and no gap at all is refused.
#[test]
fn a_gap_of_the_last_digit_decides() {
    let table = KnotTable::builtin();
    let mut n_named = 0;
    for word in [[1, 1, 1], [-1, -1, -1]] {
        let curve = braid(&word);
        for power in [-20, -60, -160] {
            let flat: Vec<V> = curve
                .iter()
                .map(|x| V::new(x.x, x.y, x.z * f64::from(power).exp2()))
                .collect();
            let hand = if word[0] > 0 { "3_1" } else { "m3_1" };
            assert_eq!(identify(&flat, &table).expect("a knot").label(), hand);
            n_named += 1;
        }
        let flat: Vec<V> = curve.iter().map(|x| V::new(x.x, x.y, 0.0)).collect();
        assert!(matches!(
            identify(&flat, &table),
            Err(KnotError::Degenerate)
        ));
    }
    assert_eq!(n_named, 6);
    // One strand of a bow-tie above the other by a unit in the last place, and not at all.
    for (up, touches) in [(f64::EPSILON, false), (0.0, true)] {
        let bow = [
            V::new(0.0, 0.0, 1.0),
            V::new(2.0, 2.0, 1.0),
            V::new(2.0, 0.0, 1.0 + up),
            V::new(0.0, 2.0, 1.0 + up),
        ];
        assert_eq!(identify(&bow, &table).is_err(), touches);
    }
    // The strand into (0, 0, 0) lies in the plane of the next two edges and crosses the second.
    let crossing = [
        V::new(0.0, 0.0, 0.0),
        V::new(4.0, 0.0, 0.0),
        V::new(0.0, 4.0, 0.0),
        V::new(0.0, 5.0, 2.0),
        V::new(3.0, 6.0, 3.0),
        V::new(4.0, 5.0, 1.0),
        V::new(3.0, 3.0, 0.0),
    ];
    // That into (1, 1, 0) ends on the first edge.
    let touching = [
        V::new(0.0, 0.0, 0.0),
        V::new(2.0, 2.0, 0.0),
        V::new(3.0, 0.0, 1.0),
        V::new(1.0, 1.0, 0.0),
        V::new(0.0, 3.0, 2.0),
        V::new(-1.0, 1.0, 1.0),
    ];
    for first in 0..crossing.len() {
        let mut turned = crossing;
        turned.rotate_left(first);
        for x in [&turned[..], &touching] {
            assert!(matches!(identify(x, &table), Err(KnotError::Degenerate)));
        }
    }
}
