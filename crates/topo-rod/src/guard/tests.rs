//! Limits of a step: what it may gain in energy, and that no two edges pass through each other.

use std::f64::consts::TAU;

use topo_core::Polyline;

use super::*;

/// Steps that each rise by all they may, and fall back: the cycle of a bouncing strand.
fn sum_of_rises(guards: &Guards, energy: f64) -> f64 {
    let mut budget = RiseBudget::new(energy);
    let mut sum = 0.0;
    for _ in 0..10_000 {
        let rise = budget.allowed(guards, energy);
        budget.book(rise);
        budget.book(-rise);
        sum += rise;
    }
    sum / energy
}

#[test]
fn rises_cannot_add_up_beyond_their_limit() {
    let guards = Guards::default();
    let sum = sum_of_rises(&guards, 3.0);
    assert!(sum > 0.99e-3 && sum < 1.000_001e-3, "{sum:e}");
    // with the limit of single steps alone, they would
    let single = Guards {
        energy_rise_in_all: f64::INFINITY,
        ..guards
    };
    assert!(sum_of_rises(&single, 3.0) > 0.5);
}

#[test]
fn a_step_may_rise_by_its_own_limit_while_little_is_spent() {
    let guards = Guards::default();
    let mut budget = RiseBudget::new(2.0);
    assert_eq!(budget.allowed(&guards, 1.0), 1e-4);
    assert_eq!(budget.allowed(&guards, 0.1), 1e-5);
    budget.book(1e-3);
    assert!((budget.allowed(&guards, 2.0) - 1e-4).abs() < 1e-12);
    // rounding is no rise, even where nothing is left or nothing is stored
    assert!(budget.allowed(&guards, 0.0) > 0.0);
    let mut driven = RiseBudget::new(0.0);
    assert_eq!(driven.allowed(&guards, 0.0), 0.0);
    driven.widen(5.0);
    assert_eq!(driven.allowed(&guards, 1.0), 1e-4);
}

/// Distance of the two edges.
const GAP: f64 = 0.2;

/// A rod of `n` vertices on a wide circle, but for edges `i` and `j`: those cross at a right angle, far from the rest.
///
/// Its natural edges are 0.25 or 10 long: with a reach of 60 the window covers the whole of the short rod, so that all pairs are
/// neighbours along it, and a dozen edges of the long one, beyond which the list has to find them.
fn crossed(n: usize, closed: bool, i: usize, j: usize, rest: f64) -> RodState {
    let gap = GAP;
    let centre = Vector3::new(0.0, 0.0, 40.0);
    let mut vertices: Vec<_> = (0..n)
        .map(|k| {
            let u = TAU * k as f64 / n as f64;
            Vector3::new(20.0 * u.cos(), 20.0 * u.sin(), (0.7 * k as f64).sin())
        })
        .collect();
    vertices[i] = centre - Vector3::x();
    vertices[(i + 1) % n] = centre + Vector3::x();
    vertices[j] = centre + Vector3::new(0.3, -1.0, gap);
    vertices[(j + 1) % n] = centre + Vector3::new(0.3, 1.0, gap);
    // far from the origin, which is no place of its own
    vertices.iter_mut().for_each(|x| x.x += 1e3);
    let curve = Polyline::new(vertices, closed).unwrap();
    RodState::new(&curve, rest * curve.n_edges() as f64, 0.0).unwrap()
}

/// A step in which edge `j` falls by `by`.
fn fall(n: usize, j: usize, by: f64) -> Vec<f64> {
    let mut step = vec![0.0; 3 * n];
    (step[2 * n + j], step[2 * n + (j + 1) % n]) = (-by, -by);
    step
}

fn certified(state: &RodState, step: &[f64], reach: f64, cyclic: bool) -> Result<(), Rejection> {
    let mut pairs = ContactPairs::new(reach, 0.5);
    pairs.set_cyclic(cyclic);
    pairs.update(state);
    let (_, largest) = largest_displacement(step, state.n_vertices());
    certify(state, step, largest, &pairs, &mut Vec::new())
}

/// All pairs of edges without a common vertex that end points move towards each other by as much as they are apart.
fn unproved(state: &RodState, step: &[f64]) -> Vec<(usize, usize)> {
    let (x, n) = (state.vertices(), state.n_vertices());
    let moved = |i: usize| Vector3::new(step[i], step[n + i], step[2 * n + i]);
    let ends = |e: usize| [e, state.edge_end(e)];
    let mut found = Vec::new();
    for a in 0..state.n_edges() {
        for b in a + 1..state.n_edges() {
            let ([a0, a1], [b0, b1]) = (ends(a), ends(b));
            if a1 == b0 || b1 == a0 {
                continue;
            }
            let relative =
                [(a0, b0), (a0, b1), (a1, b0), (a1, b1)].map(|(i, k)| moved(i) - moved(k));
            let relative = relative.map(|v| v.norm()).into_iter().fold(0.0, f64::max);
            if relative >= segment_distance(&x[a0], &x[a1], &x[b0], &x[b1]) {
                found.push((a, b));
            }
        }
    }
    found
}

/// Checks a step in which edge `j` falls through edge `i`, and one in which it stops short; returns whether the latter passed.
fn check(state: &RodState, (i, j): (usize, usize), reach: f64, cyclic: bool) -> bool {
    let n = state.n_vertices();
    let through = fall(n, j, 1.5 * GAP);
    let pairs = unproved(state, &through);
    assert!(pairs.contains(&(i.min(j), i.max(j))));
    let Err(Rejection::Crossing { edges }) = certified(state, &through, reach, cyclic) else {
        panic!("edge {j} fell through edge {i} of {n}, reach {reach}");
    };
    assert!(pairs.contains(&edges), "{edges:?}");
    let short = fall(n, j, 0.9 * GAP);
    let passes = certified(state, &short, reach, cyclic).is_ok();
    assert_eq!(passes, unproved(state, &short).is_empty(), "{i} and {j}");
    passes
}

const REACHES: [(f64, f64); 4] = [(0.5, 0.25), (2.0, 0.25), (60.0, 0.25), (60.0, 10.0)];

/// An edge that falls through any other that it does not adjoin is refused, one that stops short is not: next but one along the
/// rod, around the seam, inside and outside of the window, in and out of the reach of the list.
#[test]
fn law_every_pair_of_edges_that_are_not_adjacent_is_certified() {
    let n = 40;
    let (mut n_passed, mut n_checked) = (0, 0);
    for (reach, rest) in REACHES {
        for i in [0, 3, 38, 39] {
            for apart in 2..=n - 2 {
                let edges = (i, (i + apart) % n);
                let state = crossed(n, true, edges.0, edges.1, rest);
                n_passed += usize::from(check(&state, edges, reach, true));
                n_checked += 1;
            }
        }
    }
    println!("{n_passed} of {n_checked} short steps passed");
    assert!(2 * n_passed > n_checked);
}

/// The same on an open rod, whose first and last edge are strands like any other, unless it has just been cut: then they adjoin.
#[test]
fn law_edges_at_the_ends_of_an_open_rod_are_certified() {
    let n = 41;
    for (reach, rest) in REACHES {
        for edges in [
            (0, 2),
            (0, 20),
            (0, 38),
            (1, 39),
            (0, 39),
            (17, 36),
            (37, 39),
        ] {
            let state = crossed(n, false, edges.0, edges.1, rest);
            assert_eq!(state.n_edges(), 40);
            check(&state, edges, reach, false);
        }
        // tips in one place, moved along together
        let ring = |k: usize| {
            let u = TAU * k as f64 / 40.0;
            Vector3::new(8.0 * u.cos(), 8.0 * u.sin(), 0.0)
        };
        let curve = Polyline::new((0..40).map(ring).collect(), true).unwrap();
        let cut = RodState::new(&curve, 50.0, 0.0).unwrap().cut_at(0).unwrap();
        let mut step = vec![0.0; 3 * 41];
        (step[0], step[40]) = (0.1, 0.1);
        assert_eq!(certified(&cut, &step, reach, true), Ok(()));
    }
}

/// Two rods of 20 vertices each on circles far apart, but for edges `i` of the first and `j` of the second, which cross at a right angle.
fn crossed_link(closed: [bool; 2], i: usize, j: usize) -> RodState {
    let n = 20;
    let centre = Vector3::new(0.0, 0.0, 40.0);
    let circle = |height: f64| {
        let at = move |k: usize| {
            let u = TAU * k as f64 / n as f64;
            Vector3::new(20.0 * u.cos(), 20.0 * u.sin(), height)
        };
        (0..n).map(at).collect::<Vec<_>>()
    };
    let (mut a, mut b) = (circle(0.0), circle(80.0));
    a[i] = centre - Vector3::x();
    a[(i + 1) % n] = centre + Vector3::x();
    b[j] = centre + Vector3::new(0.3, -1.0, GAP);
    b[(j + 1) % n] = centre + Vector3::new(0.3, 1.0, GAP);
    let rod = |vertices, closed| {
        let curve = Polyline::new(vertices, closed).unwrap();
        RodState::new(&curve, 0.25 * curve.n_edges() as f64, 0.0).unwrap()
    };
    RodState::link(&[rod(a, closed[0]), rod(b, closed[1])]).unwrap()
}

/// An edge of one component that falls through any of another is refused, one that stops short is not: first and last edges, closed
/// and open components, in and out of the reach of the list.
#[test]
fn law_edges_of_two_components_are_certified() {
    let mut n_passed = 0;
    for closed in [[true, true], [false, true], [true, false], [false, false]] {
        for (i, j) in [(0, 0), (0, 18), (18, 0), (18, 18), (7, 11), (19, 19)] {
            if (i == 19 || j == 19) && closed != [true, true] {
                continue;
            }
            for reach in [0.5, 2.0, 60.0] {
                let state = crossed_link(closed, i, j);
                let n = state.n_vertices();
                let falls = |by: f64| {
                    let mut step = vec![0.0; 3 * n];
                    for k in [j, (j + 1) % 20] {
                        step[2 * n + 20 + k] = -by;
                    }
                    step
                };
                let through = falls(1.5 * GAP);
                let pairs = unproved_of_link(&state, &through);
                assert!(pairs.contains(&(i, 20 + j)));
                let refused = certified(&state, &through, reach, true);
                let Err(Rejection::Crossing { edges }) = refused else {
                    panic!("edge {j} fell through edge {i}, reach {reach}, {closed:?}");
                };
                assert!(pairs.contains(&edges), "{edges:?}");
                let short = falls(0.9 * GAP);
                let passes = certified(&state, &short, reach, true).is_ok();
                assert_eq!(passes, unproved_of_link(&state, &short).is_empty());
                n_passed += usize::from(passes);
            }
        }
    }
    assert!(n_passed > 30, "{n_passed}");
}

/// As [`unproved`], with edges of two components never adjacent.
fn unproved_of_link(state: &RodState, step: &[f64]) -> Vec<(usize, usize)> {
    let (x, n) = (state.vertices(), state.n_vertices());
    let moved = |i: usize| Vector3::new(step[i], step[n + i], step[2 * n + i]);
    let edges = || state.components().iter().flat_map(|chain| chain.edges());
    let mut found = Vec::new();
    for (a, b) in edges().flat_map(|a| edges().filter(move |&b| b > a).map(move |b| (a, b))) {
        let (p, q) = ([a, state.edge_end(a)], [b, state.edge_end(b)]);
        if p.iter().any(|i| q.contains(i)) {
            continue;
        }
        let relative = p
            .iter()
            .flat_map(|&i| q.map(|k| (moved(i) - moved(k)).norm()));
        let relative = relative.fold(0.0, f64::max);
        if relative >= segment_distance(&x[p[0]], &x[p[1]], &x[q[0]], &x[q[1]]) {
            found.push((a, b));
        }
    }
    found
}

/// The largest displacement, and where.
#[test]
fn the_largest_displacement_is_that_of_a_vertex() {
    // component-major: vertex 1 moves by (2, 3, 6)
    let step = [1.0, 2.0, 0.0, 5.0, 3.0, 0.0, 0.0, 6.0, -4.0];
    assert_eq!(largest_displacement(&step, 3), (1, 7.0));
    assert_eq!(largest_displacement(&[0.0; 6], 2).1, 0.0);
}
