//! The table against its own coordinates, and faults in knot files.

use super::*;
use crate::{V, closed_braid, thickness, thickness_brute_force, windowed_half_distance};

#[test]
fn builtin_table_is_complete() {
    let table = KnotTable::builtin();
    let names: Vec<&str> = table.names().collect();
    let mut expected = vec!["0_1".to_owned()];
    for (crossings, n) in [(3, 1), (4, 1), (5, 2), (6, 3), (7, 7), (8, 21)] {
        expected.extend((1..=n).map(|k| format!("{crossings}_{k}")));
    }
    expected.extend(["10_124", "3_1#3_1", "3_1#m3_1", "3_1#4_1"].map(str::to_owned));
    assert_eq!(names, expected);
    assert_eq!(
        BUILTIN.files().filter(|f| is_toml(f.path())).count(),
        table.len()
    );
    for knot in table.iter() {
        assert_eq!(knot.length_over_radius.is_none(), knot.is_composite());
        assert_eq!(knot.source.is_some(), knot.length_over_radius.is_some());
        let crossings = |factor: &str| -> u32 {
            let (n, _) = factor.trim_start_matches('m').split_once('_').expect("n_k");
            n.parse().expect("a number")
        };
        assert_eq!(
            knot.name.split('#').map(crossings).sum::<u32>(),
            knot.crossing_number
        );
    }
    assert_eq!(table.primes_up_to(7).count(), 14);
    assert!(table.primes_up_to(99).all(|knot| knot.name != "0_1"));
    assert_eq!(table.complete_up_to(), 10);
    assert_eq!(KnotTable::default().complete_up_to(), 2);
}

#[test]
fn aliases_and_mirrors_are_found() {
    let table = KnotTable::builtin();
    for (alias, name) in [
        ("granny", "3_1#3_1"),
        ("square", "3_1#m3_1"),
        ("T(3,4)", "8_19"),
        ("T(3,5)", "10_124"),
        ("m3_1#m4_1", "m3_1#4_1"),
        ("4_1#m3_1", "m3_1#4_1"),
        ("trefoil#mgranny", "3_1#m3_1#m3_1"),
        ("mgranny", "m3_1#m3_1"),
    ] {
        assert_eq!(table.get(alias).expect(alias).name, name);
    }
    // A torus knot is the closure of (1 2 .. p-1)^q.
    for (name, p, q) in [("T(3,4)", 3, 4), ("T(3,5)", 3, 5), ("T(2,7)", 2, 7)] {
        let word = (1..p).collect::<Vec<i32>>().repeat(q);
        let curve = closed_braid(&word).expect("a knot");
        table.get(name).expect(name).verify(&curve).expect(name);
    }
}

#[test]
fn jones_polynomials_of_the_table() {
    for knot in KnotTable::builtin().iter() {
        for knot in [knot.clone(), knot.mirror()] {
            let curve = closed_braid(&knot.braid).expect("a knot");
            let found = crate::jones_polynomial(curve.vertices()).expect("a knot");
            assert_eq!(found, knot.jones, "{}", knot.name);
        }
        let jones = knot.jones.as_ref().expect("narrow");
        assert_eq!(
            *jones == jones.mirror(),
            knot.chirality == Chirality::Amphichiral,
            "{}",
            knot.name
        );
    }
}

#[test]
fn labels_of_mirror_images() {
    let table = KnotTable::builtin();
    for (label, mirror) in [
        ("3_1", "m3_1"),
        ("m3_1", "3_1"),
        ("0_1", "0_1"),
        ("4_1", "4_1"),
        ("3_1#m3_1", "3_1#m3_1"),
        ("4_1#4_1", "4_1#4_1"),
        ("3_1#3_1", "m3_1#m3_1"),
        ("6_1|m6_1", "6_1|m6_1"),
        ("3_1#4_1", "m3_1#4_1"),
        ("m3_1#5_2", "3_1#m5_2"),
        ("8_21|5_1", "m8_21|m5_1"),
        ("unknown(1 -1 1)", "unknown(1 -1 1)"),
        ("", ""),
    ] {
        assert_eq!(table.mirror_label(label), mirror);
    }
}

#[test]
fn invariants_of_the_table() {
    for knot in KnotTable::builtin().iter() {
        for knot in [knot.clone(), knot.mirror()] {
            let curve = closed_braid(&knot.braid).expect("a knot");
            let found = knot.verify(&curve).expect("the invariants of the table");
            assert_eq!(found, knot.invariants);
        }
    }
}

#[test]
fn braids_of_the_table_are_legal_tubes() {
    for knot in KnotTable::builtin().iter() {
        let curve = closed_braid(&knot.braid).expect("a knot");
        let exact = thickness_brute_force(&curve);
        assert!(exact.tau > 1.0, "{}: {exact:?}", knot.name);
        assert_eq!(thickness(&curve), exact);
        assert!(windowed_half_distance(&curve, 1.0) > 1.0);
    }
}

#[test]
fn positive_trefoil_is_right_handed() {
    let table = KnotTable::builtin();
    let writhe = |name: &str| {
        closed_braid(&table.get(name).expect("known").braid)
            .expect("a knot")
            .writhe()
    };
    assert!(writhe("3_1") > 2.0);
    assert!((writhe("3_1") + writhe("m3_1")).abs() < 1e-9);
    assert_eq!(table.get("3_1").expect("known").invariants.signature, -2);
}

#[test]
fn unknown_names_bring_near_ones() {
    let error = KnotTable::builtin().get("3-1").expect_err("unknown");
    let KnotError::UnknownKnot { near, .. } = &error else {
        panic!("{error}")
    };
    assert!(near.contains(&"3_1".to_owned()));
    assert!(error.to_string().contains("did you mean"));
}

/// What has no file: primes from the published table, sums from their factors; what cannot be made is refused with the reason.
#[test]
fn any_sum_and_any_prime_to_ten_crossings_is_found() {
    let table = KnotTable::builtin();
    for (name, canonical, word) in [
        ("m3_1#m3_1", "m3_1#m3_1", vec![-1, -1, -1, -2, -2, -2]),
        ("5_1#m3_1", "m3_1#5_1", vec![-1, -1, -1, 2, 2, 2, 2, 2]),
        ("m3_1#0_1", "m3_1", vec![-1, -1, -1]),
    ] {
        let entry = table.get(name).expect(name);
        assert_eq!((entry.name.as_str(), &entry.braid), (canonical, &word));
        entry
            .verify(&entry.start_curve().expect("a curve"))
            .expect("its own invariants");
    }
    let square = table.get("m5_1#5_1").expect("known");
    assert_eq!(square.chirality, Chirality::Amphichiral);
    let (nine, mirror) = (table.get("9_12"), table.get("m9_12"));
    let (nine, mirror) = (nine.expect("known"), mirror.expect("known"));
    assert_eq!(
        (nine.crossing_number, nine.mirror()),
        (9, mirror.into_owned())
    );
    assert_eq!(
        table.get("10_123").expect("known").chirality,
        Chirality::Amphichiral
    );
    assert!(KnotTable::default().get("9_12").is_err());
    for name in ["10_166", "3_1#x", "m", "#", "3_1#", ""] {
        assert!(
            matches!(table.get(name), Err(KnotError::UnknownKnot { .. })),
            "{name}"
        );
    }
    let long = vec!["3_1"; 70].join("#");
    assert!(matches!(
        table.get(&long),
        Err(KnotError::GeneratorTooLarge { .. })
    ));
    // a determinant of 3^25 fits into 64 bits, 121^10 does not
    assert!(table.get(&["3_1"; 25].join("#")).is_ok());
    assert!(matches!(
        table.get(&["10_123"; 10].join("#")),
        Err(KnotError::TooComplicated { n_crossings: 100 })
    ));
    let mut table = table;
    let mut curve = table.get("3_1").expect("known").into_owned();
    (curve.name, curve.braid) = ("curve".to_owned(), Vec::new());
    table.insert(curve);
    let error = table.get("4_1#curve").expect_err("no word").to_string();
    assert!(error.contains("`curve` has no braid word"), "{error}");
}

fn parse(text: &str) -> Result<KnotEntry, KnotError> {
    KnotEntry::parse(Path::new("x_1.toml"), text, &|_| {
        Ok("x,y,z\n0,0,0\n1,0,0\n0,1,oops\n".into())
    })
}

#[test]
fn files_with_faults_are_named() {
    let good = "name = \"x_1\"\ncrossing_number = 3\nchirality = \"chiral\"\nbraid = [1, 1, 1]\n\
        [invariants]\nalexander = [1, -1, 1]\ndeterminant = 3\nsignature = -2\n";
    assert!(parse(good).is_ok());
    for (from, to, key) in [
        ("\"x_1\"", "\"y_1\"", "name"),
        ("\"x_1\"", "\"mx_1\"", "leading `m`"),
        ("\"x_1\"", "\"x_1#3_1\"", "`3_1#x_1` would do"),
        ("determinant = 3", "determinant = 5", "determinant"),
        ("[1, -1, 1]", "[1, -1, 2]", "alexander"),
        (
            "crossing_number = 3",
            "crossing_number = 0",
            "crossing_number",
        ),
        ("signature = -2", "signature = 1", "signature"),
        (
            "signature = -2",
            "signature = -2\njones = { lowest = 1, coefficients = [1, 1, -1] }",
            "jones",
        ),
        ("[1, 1, 1]", "[1, 1]", "braid"),
        ("[1, 1, 1]", "[]", "braid"),
        ("\"chiral\"", "\"amphichiral\"", "chirality"),
        ("\"chiral\"", "\"both\"", "chirality"),
        ("crossing_number", "crossings", "crossings"),
        (
            "braid =",
            "other_braids = [[1, 1]]\nbraid =",
            "other_braids",
        ),
        ("braid =", "polygon = \"p.csv\"\nbraid =", "line 4"),
    ] {
        let error = parse(&good.replacen(from, to, 1))
            .expect_err(key)
            .to_string();
        assert!(error.contains(key), "{key}: {error}");
    }
}

#[test]
fn a_folder_adds_knots_and_names_bad_files() {
    let folder = std::env::temp_dir().join(format!("topo-knots-folder-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("folder");
    let text = "name = \"tre\"\ncrossing_number = 3\nchirality = \"chiral\"\npolygon = \"tre.csv\"\n\
        [invariants]\nalexander = [1, -1, 1]\ndeterminant = 3\nsignature = -2\n";
    std::fs::write(folder.join("tre.toml"), text).expect("written");
    let missing = KnotTable::builtin()
        .with_folder(&folder)
        .expect_err("no polygon yet")
        .to_string();
    assert!(missing.contains("tre.csv"), "{missing}");
    let mut rows = "x,y,z\n".to_owned();
    for x in closed_braid(&[1, 1, 1]).expect("a knot").vertices() {
        rows += &format!("{},{},{}\n", x.x, x.y, x.z);
    }
    std::fs::write(folder.join("tre.csv"), rows).expect("written");
    let table = KnotTable::builtin().with_folder(&folder).expect("a table");
    let entry = table.get("tre").expect("added");
    entry
        .verify(&entry.start_curve().expect("a curve"))
        .expect("a trefoil");
    std::fs::remove_dir_all(&folder).expect("removed");
    assert!(matches!(
        table.with_folder(&folder),
        Err(KnotError::Io { .. })
    ));
}

#[test]
fn words_and_curves_become_entries() {
    let table = KnotTable::builtin();
    let of = |word: &[i32]| KnotEntry::of_braid(word, &table).expect("a knot");
    // The figure-eight knot with a detour, a left-handed trefoil, an unknot, the torus knot T(3, 7).
    let four = of(&[1, -2, 1, -2, 3, -3, 3]);
    assert_eq!(four.name, "4_1");
    assert_eq!(four.other_braids, [vec![1, -2, 1, -2, 3, -3, 3]]);
    assert_eq!(of(&[-1, -1, -1]).name, "m3_1");
    assert_eq!(of(&[1]).name, "0_1");
    let torus = of(&[1, 2].repeat(7));
    assert_eq!(torus.name, "unnamed");
    assert_eq!(torus.braid.len(), 14);
    torus
        .verify(&torus.start_curve().expect("a curve"))
        .expect("itself");
    let dense = closed_braid(&[-1, -1, -1]).expect("a knot");
    let dense = dense.resampled(9000).expect("resampled");
    let three = KnotEntry::of_curve(dense.vertices(), &table).expect("a knot");
    assert_eq!(three.name, "m3_1");
    assert_eq!(three.start_curve().expect("a curve").n_vertices(), 4000);
    assert!(matches!(
        KnotEntry::of_braid(&[1, 1], &table),
        Err(KnotError::Link { .. })
    ));
    let twice = [V::zeros(), V::x(), V::x(), V::y()];
    assert!(matches!(
        KnotEntry::of_curve(&twice, &table),
        Err(KnotError::Curve(_))
    ));
}
