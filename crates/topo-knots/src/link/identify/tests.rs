use nalgebra::{Rotation3, Unit};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::*;

fn named(curves: &[Vec<V>]) -> Result<LinkType, KnotError> {
    let parts: Vec<&[V]> = curves.iter().map(Vec::as_slice).collect();
    identify_link(&parts, LinkTable::builtin())
}

fn of_word(word: &[i32]) -> Vec<Vec<V>> {
    let curves = braid_closure(word).expect("a link");
    curves.into_iter().map(|c| c.into_vertices()).collect()
}

fn ring(n: usize, centre: V, u: V, v: V) -> Vec<V> {
    let at = |k: usize| {
        let (s, c) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
        centre + c * u + s * v
    };
    (0..n).map(at).collect()
}

/// Turned, with uneven and moved vertices, components reversed, exchanged and begun elsewhere.
fn disturbed(curves: &[Vec<V>], rng: &mut Pcg64) -> Vec<Vec<V>> {
    let mut random = || rng.random_range(-1.0..1.0);
    let axis = Unit::new_normalize(V::new(random(), random(), random()));
    let turn = Rotation3::from_axis_angle(&axis, std::f64::consts::PI * random());
    let mut moved: Vec<Vec<V>> = Vec::new();
    for x in curves {
        let mut y: Vec<V> = x
            .iter()
            .map(|x| turn * x + 0.15 * V::new(random(), random(), random()))
            .collect();
        let n = y.len();
        y.rotate_left((n as f64 * random().abs()) as usize);
        if random() > 0.0 {
            y.reverse();
        }
        moved.push(y);
    }
    let by = (moved.len() as f64 * random().abs()) as usize;
    moved.rotate_left(by);
    moved
}

#[test]
fn links_are_named_from_braids_and_their_mirrors() {
    let mut rng = Pcg64::seed_from_u64(11);
    for entry in LinkTable::builtin().iter() {
        let mirror = entry.mirror();
        for (hand, n) in [(entry, 4), (&mirror, 4)] {
            let name = match entry.chirality {
                Chirality::Chiral => &hand.name,
                Chirality::Amphichiral => &entry.name,
            };
            for _ in 0..n {
                let found = named(&disturbed(&of_word(&hand.braid), &mut rng)).expect("a link");
                assert_eq!(found.label(), *name);
                assert_eq!(found.name(), Some(name.as_str()));
                assert!(!found.is_split());
            }
        }
    }
}

#[test]
fn split_links_are_seen() {
    let far = |x: Vec<V>| -> Vec<V> { x.into_iter().map(|x| x + V::x() * 200.0).collect() };
    let rings = [
        ring(40, V::zeros(), V::x(), V::y()),
        ring(3, V::z() * 9.0, V::x(), V::z()),
    ];
    let found = named(&rings).expect("two rings");
    assert!(found.is_split() && found.is_certain());
    assert_eq!((found.label().as_str(), found.name()), ("0_1+0_1", None));
    assert_eq!(
        found.describe(),
        "a split link of 2 components; component 1: 0_1 (certain); component 2: 0_1 (certain)"
    );
    // A Hopf link whose rings are not neighbours in the file, and a trefoil apart.
    let mut parts = of_word(&[1, 1]);
    parts.insert(1, far(of_word(&[1, 1, 1]).swap_remove(0)));
    let found = named(&parts).expect("three curves");
    assert_eq!(found.label(), "L2a1+3_1");
    assert_eq!(found.parts[0].components, [0, 2]);
    assert!(found.is_certain());
    // Through each other and back.
    let found = named(&of_word(&[1, -1])).expect("two rings");
    assert_eq!(found.label(), "0_1+0_1");
    // A ring around two strands of another that does not hold on to it.
    let found = named(&of_word(&[1, 2, 2, -1, 1, -2, -2, 1])).expect("three rings");
    assert_eq!(found.label(), "L2a1+0_1");
}

#[test]
fn links_are_described() {
    let text = |word: &[i32]| named(&of_word(word)).expect("a link").describe();
    assert_eq!(
        text(&[1, -2, 1, -2, 1, -2]),
        "L6a4 (certain), a link of 3 components"
    );
    let chain = text(&[1, 1, 2, 2, 3, 3, 4, 4]);
    assert_eq!(chain, "consistent with chain(5), a link of 5 components");
    let other = text(&[1, 1, 1, 2, 2]);
    assert!(
        other.starts_with("unknown: no link of the table") && other.contains("linking"),
        "{other}"
    );
}

/// Rings of three and four vertices, at any scale.
#[test]
fn small_polygons_are_linked() {
    for (n, m) in [(3, 3), (3, 4), (5, 60)] {
        for size in [1e-200, 1.0, 1e200] {
            let a = ring(n, V::zeros(), V::x() * size, V::y() * size);
            let b = ring(m, V::x() * size, V::x() * size, V::z() * size);
            let found = named(&[a, b]).expect("two rings");
            assert_eq!(found.label(), "L2a1", "{n} {m} {size}");
        }
    }
}

#[test]
fn what_is_no_link_is_refused() {
    let [a, b] =
        [0.0, 1.0].map(|x| ring(24, V::x() * x, V::x(), V::y() + V::z() * (2.0 * x - 1.0)));
    let refused = |curves: &[Vec<V>]| match named(curves) {
        Ok(found) => found.describe(),
        Err(error) => error.to_string(),
    };
    named(&[a.clone(), b.clone()]).expect("a link");
    assert!(refused(std::slice::from_ref(&a)).contains("a single component"));
    assert!(refused(&[]).contains("a single component"));
    let mut bad = b.clone();
    bad[7].y = f64::NAN;
    assert_eq!(
        refused(&[a.clone(), bad]),
        "component 2: vertex 7 is not finite"
    );
    let short = refused(&[a.clone(), b[..2].to_vec()]);
    assert!(
        short.starts_with("component 2: a closed curve needs at least 3"),
        "{short}"
    );
    let twice = refused(&[a.clone(), a.clone()]);
    assert!(
        twice.starts_with("components 1 and 2 coincide at every vertex"),
        "{twice}"
    );
    // One that runs along the other for a while, and one that touches it at a point.
    let mut along = a.clone();
    along.iter_mut().skip(6).for_each(|x| x.z += 3.0);
    let along = refused(&[a.clone(), along]);
    assert!(
        along.starts_with("components 1 and 2 coincide at 25.000 %"),
        "{along}"
    );
    let mut touch = ring(24, V::x() * 2.0, V::x(), V::z());
    // Whatever little they are apart counts: 1e-16 is not touching.
    assert_eq!(
        refused(&[a.clone(), touch.clone()]),
        "a split link of 2 components; component 1: 0_1 (certain); component 2: 0_1 (certain)"
    );
    touch[12] = a[0];
    let touch = refused(&[a.clone(), touch]);
    assert!(
        touch.starts_with("components 1 and 2 coincide at 4.167 %"),
        "{touch}"
    );
    let crossing = ring(4, V::x() * 2.0, V::x(), V::y());
    let through = ring(4, V::x() * 3.5, V::x() * 2.0, V::y());
    let meet = refused(&[crossing, through]);
    assert!(
        meet.contains("components 1 and 2 meet: they come within"),
        "{meet}"
    );
    // All vertices in one place.
    let point = refused(&[a.clone(), vec![V::z(); 5]]);
    assert!(point.starts_with("component 2"), "{point}");
    let eight: Vec<V> = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]
        .map(|(x, y)| V::new(x, y, 9.0))
        .to_vec();
    let crossed = refused(&[a, eight]);
    assert!(crossed.starts_with("component 2"), "{crossed}");
}
