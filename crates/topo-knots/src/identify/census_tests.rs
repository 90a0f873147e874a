//! All types of at most ten crossings: from braid words, from published planar diagrams, and whether their invariants differ.

use super::known::Candidate;
use super::*;
use crate::invariant::Visit;
use crate::name::{self, KnotName, is_amphichiral};
use crate::rings::Rings;
use crate::{KnotEntry, closed_braid};

static PLANAR_DIAGRAMS: &str = include_str!("../../data/pd.csv");

/// The diagram of a line `name,a-b-c-d ...`: at each crossing the edges counterclockwise from the one that comes in below.
fn planar_diagram(cell: &str) -> Diagram {
    let crossings: Vec<Vec<usize>> = cell
        .split(' ')
        .map(|c| c.split('-').map(|e| e.parse().expect("an edge")).collect())
        .collect();
    let n_edges = 2 * crossings.len();
    let blank = Visit {
        crossing: 0,
        over: false,
    };
    let mut visits = vec![blank; n_edges];
    let mut signs = Vec::new();
    for (crossing, c) in crossings.iter().enumerate() {
        let crossing = crossing as u32;
        // Edge k runs from visit k - 1 to visit k.
        visits[c[0] - 1] = Visit {
            crossing,
            over: false,
        };
        let is_rightward = c[1] == c[3] % n_edges + 1;
        let over = if is_rightward { c[3] } else { c[1] };
        visits[over - 1] = Visit {
            crossing,
            over: true,
        };
        signs.push(if is_rightward { 1 } else { -1 });
    }
    let rings = Rings::one(visits.len());
    Diagram {
        visits,
        signs,
        rings,
    }
}

fn mirrored(mut diagram: Diagram) -> Diagram {
    diagram.visits.iter_mut().for_each(|v| v.over = !v.over);
    diagram.signs.iter_mut().for_each(|s| *s = -*s);
    diagram
}

/// All 249 prime knots to ten crossings, each hand from its planar diagram and from its braid word.
#[test]
fn all_primes_from_words_and_planar_diagrams() {
    let table = KnotTable::builtin();
    let (mut n_primes, mut n_certain) = (0, 0);
    for line in PLANAR_DIAGRAMS.lines().skip(1) {
        let (name, cell) = line.split_once(',').expect("two cells");
        let mirror = KnotName::parse(name).mirror().to_string();
        let entry = table.get(name).expect(name);
        n_primes += 1;
        let own = planar_diagram(cell);
        assert_eq!(own.n_crossings(), entry.crossing_number as usize);
        for (diagram, word, expected) in [
            (own.clone(), entry.braid.clone(), name),
            (mirrored(own), entry.mirror().braid, &mirror),
        ] {
            let drawn = classify_diagram(&diagram, &table, Care::Handed).expect("a diagram");
            let curve = closed_braid(&word).expect("a knot");
            let braided = identify(curve.vertices(), &table).expect("a knot");
            assert!(drawn.is_certain() && drawn.fits(expected), "{expected}");
            let label = if name == "10_71" {
                "10_71|m10_71"
            } else {
                expected
            };
            assert_eq!(drawn.label(), label, "{expected} from its diagram");
            assert_eq!(braided.label(), label, "{expected} from its word");
            assert_eq!(drawn.invariants, braided.invariants);
            let is_undecided = drawn.handedness == Handedness::Undecided;
            assert_eq!(is_undecided, name == "10_71");
            n_certain += usize::from(braided.is_certain());
            if !braided.is_certain() {
                println!("{expected}: {} crossings", braided.n_crossings);
            }
        }
        assert_eq!(name == mirror, is_amphichiral(name));
    }
    assert_eq!(n_primes, 249);
    println!("{n_certain} of 498 certain from their words");
    assert_eq!(n_certain, 498);
}

/// All types of at most ten crossings but the unknot: primes and sums, each hand by itself, with an entry.
fn all_types(table: &KnotTable) -> Vec<(KnotName, KnotEntry)> {
    let mut hands: Vec<(String, u32)> = Vec::new();
    for line in PLANAR_DIAGRAMS.lines().skip(1) {
        let name = line.split(',').next().expect("a name");
        let crossings = name::rolfsen(name).expect("of Rolfsen's table").0;
        hands.push((name.to_owned(), crossings));
        if !is_amphichiral(name) {
            hands.push((format!("m{name}"), crossings));
        }
    }
    let mut sums: Vec<(String, u32, usize)> = Vec::new();
    for (k, (name, crossings)) in hands.iter().enumerate() {
        sums.push((name.clone(), *crossings, k));
    }
    let mut first = 0;
    while first < sums.len() {
        let (sum, crossings, k) = sums[first].clone();
        for (j, (name, more)) in hands.iter().enumerate().skip(k) {
            if crossings + more <= 10 {
                sums.push((format!("{sum}#{name}"), crossings + more, j));
            }
        }
        first += 1;
    }
    let entry = |name: &str| table.get(name).expect(name).into_owned();
    sums.iter()
        .map(|(name, ..)| (KnotName::parse(name), entry(name)))
        .collect()
}

/// 556 types. Without the Kauffman polynomial, fourteen sets of them look alike; with it, only the two hands of 10_71.
#[test]
fn all_types_to_ten_crossings_are_distinguished() {
    let table = KnotTable::builtin();
    let mut blind: Vec<Vec<String>> = Vec::new();
    let all = all_types(&table);
    for (name, entry) in &all {
        let found = Found {
            invariants: &entry.invariants,
            jones: entry.jones.as_ref(),
            n_crossings: 10,
        };
        let list = candidates(&found, &table);
        assert!(list.iter().any(|c| c.name == *name), "{name}");
        if list.len() == 1 {
            continue;
        }
        let mut names: Vec<String> = list.iter().map(|c| c.name.to_string()).collect();
        let of_diagram = {
            let curve = closed_braid(&entry.braid).expect("a knot");
            let diagram = least_crossing(curve.vertices(), 8, 0).expect("a view");
            kauffman(&diagram).expect("few crossings")
        };
        let own = |c: &&Candidate| kauffman_of_name(&c.name).expect("published") == of_diagram;
        let left: Vec<String> = list
            .iter()
            .filter(own)
            .map(|c| c.name.to_string())
            .collect();
        if name.unsided().to_string() == "10_71" {
            assert_eq!(left, ["10_71", "m10_71"]);
        } else {
            assert_eq!(left, [name.to_string()]);
        }
        names.sort();
        if !blind.contains(&names) {
            blind.push(names);
        }
    }
    blind.sort();
    println!("{} types, {} sets alike: {blind:?}", all.len(), blind.len());
    assert_eq!((all.len(), blind.len()), (556, 14));
}
