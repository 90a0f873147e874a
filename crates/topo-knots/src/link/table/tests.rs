use std::path::Path;

use super::*;
use crate::{V, identify_link};

#[test]
fn the_table_of_links_is_complete() {
    let table = LinkTable::builtin();
    for file in BUILTIN.files() {
        let text = file.contents_utf8().expect("text");
        LinkEntry::parse(file.path(), text).unwrap_or_else(|e| panic!("{e}"));
    }
    let names: Vec<&str> = table.iter().map(|entry| entry.name.as_str()).collect();
    let expected = "L2a1 L4a1 L5a1 L6a1 L6a2 L6a3 L6a4 L6a5 L6n1 L7a1 L7a2 L7a3 L7a4 L7a5 L7a6 L7a7 L7n1 L7n2 \
        chain(3) chain(4) chain(5) T(4,4) T(5,5) T(6,6)";
    let mut expected: Vec<&str> = expected.split(' ').collect();
    // Families by their crossings: chain(5) has 8, T(4,4) has 12.
    expected.sort_by_key(|name| names.iter().position(|n| n == name));
    assert_eq!(names, expected);
    assert_eq!((table.len(), table.is_empty()), (24, false));
}

#[test]
fn links_are_found_by_name_and_alias() {
    let table = LinkTable::builtin();
    for (name, found) in [
        ("hopf", "L2a1"),
        ("T(2,2)", "L2a1"),
        ("solomon", "L4a1"),
        ("msolomon", "mL4a1"),
        ("mL4a1", "mL4a1"),
        ("whitehead", "L5a1"),
        ("borromean", "L6a4"),
        ("T(3,3)", "mL6n1"),
        ("T(2,6)", "mL6a3"),
        ("chain(3)", "chain(3)"),
        ("chain(7)", "chain(7)"),
        ("mT(4,4)", "mT(4,4)"),
        ("T(7,7)", "T(7,7)"),
    ] {
        let entry = table.get(name).expect(name);
        assert_eq!(entry.name, found, "{name}");
        assert_eq!(entry.mirror().mirror(), *entry);
        assert_eq!(entry.is_mirror_image(), found.starts_with('m'));
    }
    let error = table.get("whitehed").expect_err("unknown").to_string();
    assert!(error.contains("whitehead"), "{error}");
    for name in ["chain(1)", "chain(99)", "T(3,4)", "T(99,99)", "3_1", ""] {
        assert!(
            matches!(table.get(name), Err(KnotError::UnknownLink { .. })),
            "{name}"
        );
    }
}

/// Words against linking numbers, components and polynomials as published; each further word closes to the same link.
#[test]
fn invariants_of_the_links() {
    for entry in LinkTable::builtin().iter() {
        for word in entry.other_braids.iter().chain([&entry.braid]) {
            let curves = crate::braid_closure(word).expect("a link");
            let found = entry.verify(&curves).unwrap_or_else(|e| panic!("{e}"));
            if *word == entry.braid {
                assert_eq!(found.oriented_jones(), entry.invariants.oriented_jones());
            }
            entry.mirror().verify(&curves).map_or_else(
                |_| assert_eq!(entry.chirality, Chirality::Chiral, "{}", entry.name),
                |_| assert_eq!(entry.chirality, Chirality::Amphichiral, "{}", entry.name),
            );
        }
    }
    let length = |name: &str| {
        let entry = LinkTable::builtin().get(name).expect("known");
        entry.length_over_radius.expect("published")
    };
    for (name, exact) in [
        ("hopf", 25.132741),
        ("chain(3)", 41.699112),
        ("chain(4)", 58.265482),
        ("chain(5)", 74.831853),
    ] {
        assert!((length(name) - exact).abs() < 6e-5, "{name}");
    }
}

#[test]
fn words_and_curves_become_links() {
    let table = LinkTable::builtin();
    let hopf = LinkEntry::of_braid(&[1, 1], table).expect("a link");
    assert_eq!((hopf.name.as_str(), hopf.other_braids.len()), ("L2a1", 0));
    let turned = LinkEntry::of_braid(&[2, -1, -1, -1, -1, -2, 2], table).expect("a link");
    assert_eq!(turned.name, "mL4a1");
    assert_eq!(turned.other_braids.last().expect("a word").len(), 7);
    let own = LinkEntry::of_braid(&[1, 1, 1, 2, 2], table).expect("a link");
    assert_eq!(
        (own.name.as_str(), own.components.join(" ")),
        ("unnamed", "3_1 0_1".to_owned())
    );
    assert!(matches!(
        LinkEntry::of_braid(&[1, 1, 1], table),
        Err(KnotError::NoLink)
    ));
    let curves = crate::braid_closure(&[1, -2, 1, -2, 1, -2]).expect("a link");
    let vertices: Vec<Vec<V>> = curves.iter().map(|c| c.vertices().to_vec()).collect();
    let rings = LinkEntry::of_curves(&vertices, table).expect("a link");
    assert_eq!((rings.name.as_str(), &rings.start), ("L6a4", &Some(curves)));
    let two = vec![vertices[0].clone(), vertices[1][..2].to_vec()];
    let error = LinkEntry::of_curves(&two, table)
        .expect_err("a segment")
        .to_string();
    assert!(
        error.starts_with("component 2: ") && error.contains("at least 3"),
        "{error}"
    );
    let twice = vec![vertices[0].clone(), vertices[0].clone()];
    let error = LinkEntry::of_curves(&twice, table)
        .expect_err("twice")
        .to_string();
    assert!(
        error.contains("components 1 and 2 coincide at every vertex"),
        "{error}"
    );
}

#[test]
fn files_of_links_with_faults_are_named() {
    let sound = include_str!("../../../links/L6a4.toml");
    let parse = |text: &str| LinkEntry::parse(Path::new("L6a4.toml"), text);
    parse(sound).expect("sound");
    for (from, to, fault) in [
        ("L6a4", "L6a9", "must equal the file's name"),
        ("-2, 1, -2]", "-2, 1]", "closes to 2 components"),
        ("[0, 0, 0]", "[0, 0]", "3 components have 3 pairs"),
        ("-1, 3, -2", "-1, 3, -1", "must sum to (-2)^2"),
        ("58.006", "-58.006", "must be positive"),
        ("chirality", "handedness", "unknown field"),
        ("\"0_1\", \"0_1\"", "\"0_1\", \"99_1\"", "99_1"),
    ] {
        assert!(sound.contains(from), "{from}");
        let error = parse(&sound.replacen(from, to, 1))
            .expect_err(to)
            .to_string();
        assert!(error.contains(fault), "{error}");
    }
}

/// Every hand of every link of the table has invariants of its own, and so does every sum of at most seven crossings: a name that is
/// the only one is certain.
#[test]
fn links_to_seven_crossings_are_distinguished() {
    let table = LinkTable::builtin();
    for entry in table.iter() {
        for hand in [entry.clone(), entry.mirror()] {
            let curves = hand.start_curves().expect("curves");
            let vertices: Vec<&[V]> = curves.iter().map(|c| c.vertices()).collect();
            let found = identify_link(&vertices, table).expect(&hand.name);
            let name = match entry.chirality {
                Chirality::Chiral => &hand.name,
                Chirality::Amphichiral => &entry.name,
            };
            assert_eq!(found.label(), *name);
            assert_eq!(found.is_certain(), entry.crossing_number <= 7, "{name}");
        }
    }
    // Sums of two, as words side by side: of links with knots, and with links, at either end of the first word.
    let links: [&[i32]; 4] = [&[1, 1], &[1, 1, 1, 1], &[-1, 2, -1, 2, -1], &[1, 1, 2, 2]];
    let further: [&[i32]; 6] = [
        &[1, 1, 1],
        &[1, -2, 1, -2],
        &[1; 5],
        &[1, 1, 1, 2, -1, 2],
        &[1, 1],
        &[1; 4],
    ];
    let negated = |word: &[i32]| word.iter().map(|g| -g).collect::<Vec<_>>();
    let mut n = 0;
    for a in links {
        for b in further.iter().flat_map(|b| [b.to_vec(), negated(b)]) {
            let shift = a.iter().map(|g| g.abs()).max().unwrap_or(0);
            let beyond: Vec<i32> = b.iter().map(|g| g + shift * g.signum()).collect();
            let width = b.iter().map(|g| g.abs()).max().unwrap_or(0);
            let within: Vec<i32> = a.iter().map(|g| g + width * g.signum()).collect();
            for word in [[a, &beyond].concat(), [b.as_slice(), &within].concat()] {
                if word.len() > 9 {
                    continue;
                }
                let curves = crate::braid_closure(&word).expect("a sum");
                let vertices: Vec<&[V]> = curves.iter().map(|c| c.vertices()).collect();
                let found = identify_link(&vertices, table).expect("a sum");
                let label = found.label();
                assert!(
                    ["unknown", "chain(3)", "chain(4)"].contains(&label.as_str()),
                    "{word:?}: {label}"
                );
                n += 1;
            }
        }
    }
    println!("{n} sums");
    assert!(n > 40);
}
