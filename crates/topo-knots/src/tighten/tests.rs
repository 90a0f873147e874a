//! Tight knots against published ropelengths and the writhe of ideal shapes.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::*;
use crate::{KnotTable, thickness_brute_force};

/// Writhe of ideal shapes, in absolute value.
const WRITHE: [(&str, f64); 8] = [
    ("3_1", 3.416),
    ("4_1", 0.0),
    ("5_1", 6.291),
    ("5_2", 4.550),
    ("6_1", 1.118),
    ("6_2", 2.787),
    ("6_3", 0.0),
    ("7_1", 9.176),
];

fn check_all(settings: &TightenSettings, excess_limit: f64, writhe_limit: f64) {
    let table = KnotTable::builtin();
    let knots: Vec<&KnotEntry> = table.primes_up_to(7).collect();
    let tight: BTreeMap<String, TightKnot> = knots
        .par_iter()
        .map(|knot| {
            (
                knot.name.clone(),
                tighten_entry(knot, settings).expect("tight"),
            )
        })
        .collect();
    for knot in knots {
        let found = &tight[&knot.name];
        let excess = found.length_over_radius / knot.length_over_radius.expect("published") - 1.0;
        assert!(
            (-0.005..excess_limit).contains(&excess),
            "{}: excess {excess}",
            knot.name
        );
        let exact = thickness_brute_force(&found.curve);
        assert!((exact.tau - 1.0).abs() < 1e-9, "{}: {exact:?}", knot.name);
        let certificate = &found.certificate;
        assert!((found.curve.length() - found.length_over_radius).abs() < 1e-6);
        assert!(certificate.thickness_windowed > 1.0 - 1e-9, "{}", knot.name);
        assert!(
            certificate.converged && certificate.residual < 0.06,
            "{}: {certificate:?}",
            knot.name
        );
        assert!(certificate.n_struts > found.curve.n_edges());
        assert_eq!(certificate.invariants, knot.invariants, "{}", knot.name);
        assert!(certificate.average_crossing_number > certificate.writhe.abs());
    }
    for (name, writhe) in WRITHE {
        let found = tight[name].certificate.writhe;
        assert!(
            (found.abs() - writhe).abs() < writhe_limit,
            "{name}: writhe {found}"
        );
    }
    // The right-handed trefoil writhes to the positive side.
    assert!(tight["3_1"].certificate.writhe > 0.0);
}

#[test]
fn all_knots_are_tight() {
    check_all(&TightenSettings::draft(), 0.006, 0.03);
}

#[test]
#[ignore = "long: 1 to 2 minutes"]
fn long_all_knots_are_tight_at_eight_vertices_a_unit() {
    check_all(&TightenSettings::standard(), 0.0025, 0.01);
}

#[test]
fn the_same_seed_gives_the_same_curve() {
    let table = KnotTable::builtin();
    let knot = table.get("4_1").expect("known");
    let quick = TightenSettings {
        n_variants: 0,
        n_kicks: 2,
        ..TightenSettings::draft()
    };
    let first = tighten_entry(knot, &quick).expect("tight");
    assert_eq!(
        first.curve,
        tighten_entry(knot, &quick).expect("tight").curve
    );
    let mirror = tighten_entry(&knot.mirror(), &quick).expect("tight");
    assert_eq!(mirror.name, "m4_1");
    assert!((mirror.length_over_radius / first.length_over_radius - 1.0).abs() < 0.005);
}

#[test]
fn centrelines_have_equal_edges_and_the_same_type() {
    let table = KnotTable::builtin();
    let knot = table.get("3_1").expect("known");
    let quick = TightenSettings {
        n_variants: 0,
        n_kicks: 0,
        ..TightenSettings::draft()
    };
    let tight = tighten_entry(knot, &quick).expect("tight");
    for n_edges in [60, 200, 800] {
        let line = tight.centreline(n_edges).expect("a centreline");
        let edges = line.curve.edge_lengths();
        let mean = line.curve.length() / n_edges as f64;
        assert!(edges.iter().all(|e| (e / mean - 1.0).abs() < 1e-6));
        assert!(
            (line.ropelength / tight.length_over_radius - 1.0).abs() < 0.03,
            "{}",
            line.ropelength
        );
        knot.verify(&line.curve).expect("a trefoil");
    }
    assert!(matches!(
        tight.centreline(7),
        Err(KnotError::Setting { name: "edges", .. })
    ));
}

#[test]
fn starts_of_another_type_are_refused() {
    let settings = TightenSettings::draft();
    let three = closed_braid(&[1, 1, 1]).expect("a knot");
    let four = closed_braid(&[1, -2, 1, -2]).expect("a knot");
    assert!(matches!(
        tighten("mixed", &[three, four], &settings),
        Err(KnotError::PassedThroughItself {
            stage: "preparing the starts",
            ..
        })
    ));
    assert!(matches!(
        tighten("none", &[], &settings),
        Err(KnotError::NotTightened { .. })
    ));
}

#[test]
fn padded_words_close_to_the_same_knot() {
    let mut rng = Pcg64::seed_from_u64(3);
    let table = KnotTable::builtin();
    for knot in table.iter() {
        let word = padded(&knot.braid, &mut rng);
        assert_eq!(word.len(), knot.braid.len() + 2 * N_PADS);
        for word in [word, stabilised(&knot.braid, &mut rng)] {
            knot.verify(&closed_braid(&word).expect("a knot"))
                .expect("the same knot");
        }
    }
}
