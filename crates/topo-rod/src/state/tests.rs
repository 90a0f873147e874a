//! Hand and amount of the twist, areas on the sphere, and what a cut leaves.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use super::*;

fn ring(n: usize, length: f64, twist: f64) -> RodState {
    let vertex = |k: usize| {
        let u = TAU * k as f64 / n as f64;
        Vector3::new(u.cos(), u.sin(), 0.0) * (length / TAU)
    };
    let curve = Polyline::new((0..n).map(vertex).collect(), true).unwrap();
    RodState::new(&curve, length, twist).unwrap()
}

/// θ'h = 2 on 50 h is 15.9 turns (100/2π), positive where the tied-in twist is right-handed.
#[test]
fn val_two_radians_a_radius_are_sixteen_turns() {
    for (twist, turns) in [(2.0, 15.9155), (-2.0, -15.9155), (0.0, 0.0)] {
        let rod = ring(200, 50.0, twist);
        assert!((rod.total_twist() - turns).abs() < 1e-4);
        assert!(rod.twists().iter().all(|m| *m == twist * 0.25));
        // a planar ring has no writhe: the link is that of the twist
        assert!(rod.writhe().abs() < 1e-12);
        // the two ends of a cut rod carry none
        let open = rod.cut_at(30).unwrap();
        assert_eq!((open.twists()[0], open.twists()[200]), (0.0, 0.0));
        assert!((open.total_twist() - turns * 199.0 / 200.0).abs() < 1e-4);
    }
    let line = (0..=10).map(|k| Vector3::new(f64::from(k), 0.0, 0.0));
    let line = Polyline::new(line.collect(), false).unwrap();
    let rod = RodState::new(&line, 10.0, 0.3).unwrap();
    assert!((rod.total_twist() * TAU - 9.0 * 0.3).abs() < 1e-12);
}

/// An edge that turns by the right-hand rule about its tangent twists the rod before it right-handedly and the rod behind it
/// left-handedly; a turn of all edges alike twists nothing.
#[test]
fn val_twist_follows_the_right_hand_rule() {
    for rod in [ring(20, 10.0, 0.0), ring(20, 10.0, 0.0).cut_at(0).unwrap()] {
        let (n, n_edges) = (rod.n_vertices(), rod.n_edges());
        let mut step = vec![0.0; 3 * n + n_edges];
        step[3 * n + 7] = 0.4;
        let mut moved = rod.clone();
        rod.moved_by(&step, true, 1, &mut moved);
        let expected = |i: usize| match i {
            7 => 0.4,
            8 => -0.4,
            _ => 0.0,
        };
        let twists = moved.twists().iter().enumerate();
        assert!(twists.clone().all(|(i, m)| (m - expected(i)).abs() < 1e-15));
        step[3 * n..].fill(0.3);
        rod.moved_by(&step, true, 2, &mut moved);
        assert!(moved.twists().iter().all(|m| m.abs() < 1e-15));
        // without twist, rotations do not count
        rod.moved_by(&step, false, 3, &mut moved);
        assert_eq!(moved.twists(), rod.twists());
    }
}

/// An octant of the sphere has the area π/2, half of it π/4, positive counterclockwise; a great circle has none.
#[test]
fn val_areas_of_spherical_triangles() {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let middle = (x + y).normalize();
    for (corners, area) in [
        ([x, y, z], FRAC_PI_2),
        ([y, x, z], -FRAC_PI_2),
        ([x, middle, z], FRAC_PI_4),
        ([z, x, middle], FRAC_PI_4),
        ([x, middle, y], 0.0),
        // four triangles cover the sphere: this one is a third of what the octant leaves
        ([x, y, (-x - y - z).normalize()], -7.0 * PI / 6.0),
    ] {
        let found = spherical_area(&corners[0], &corners[1], &corners[2]);
        assert!((found - area).abs() < 1e-14, "{found} of {area}");
    }
}

/// A loop pulled out of a right-handed helix: what the writhe gains, the twist loses.
#[test]
fn law_twist_and_writhe_add_up_over_a_finite_step() {
    let rod = ring(60, 30.0, 0.5);
    let n = rod.n_vertices();
    let step: Vec<f64> = (0..4 * n)
        .map(|k| match k / n {
            2 => 0.8 * (3.0 * TAU * (k % n) as f64 / n as f64).sin(),
            0 => 0.6 * (2.0 * TAU * (k % n) as f64 / n as f64 + 0.4).cos(),
            _ => 0.0,
        })
        .collect();
    let mut moved = rod.clone();
    rod.moved_by(&step, true, 1, &mut moved);
    let gained = moved.writhe() - rod.writhe();
    let lost = rod.total_twist() - moved.total_twist();
    assert!(gained.abs() > 1e-3, "{gained:.1e}");
    assert!((gained - lost).abs() < 1e-13, "{gained} and {lost}");
}

#[test]
fn a_cut_doubles_its_vertex_and_starts_there() {
    let rod = ring(12, 6.0, 0.7);
    let open = rod.cut_at(5).unwrap();
    assert_eq!((open.n_vertices(), open.n_edges()), (13, 12));
    assert_eq!((open.rest_length(), open.length()), (0.5, 6.0));
    for k in 0..13 {
        assert_eq!(open.vertices()[k], rod.vertices()[(5 + k) % 12]);
    }
    let interior = [&open, &rod].map(|state| state.components()[0].interior());
    assert_eq!(interior, [1..12, 0..12]);
    assert_eq!((rod.edge_before(0), rod.edge_end(11)), (11, 0));
    assert_eq!((open.edge_before(4), open.edge_end(11)), (3, 12));
    assert_eq!((open.end_to_end(), rod.end_to_end()), (0.0, 0.0));
    assert_ne!(open.stamp(), rod.stamp());
    assert!(rod.cut_at(12).is_err() && open.cut_at(1).is_err() && open.cut_at(11).is_err());
    let mut apart = open.clone();
    apart.vertices[12] += Vector3::new(0.0, 3.0, 4.0);
    assert!((apart.end_to_end() - 5.0).abs() < 1e-12);
}

/// An open rod becomes two where it is cut, each as it was: their twists, directors and natural shape too; what lies behind moves up by one.
#[test]
fn an_open_rod_is_cut_into_two() {
    let curved = |rod: RodState| {
        rod.with_rest(|_, s| [0.3, 0.1 * s], |_, s| 0.2 * s)
            .unwrap()
    };
    let open = curved(ring(12, 6.0, 0.7).cut_at(5).unwrap());
    let link = RodState::link([&open, &curved(ring(9, 4.0, -0.3))]).unwrap();
    let halves = link.cut_at(7).unwrap();
    let chains = halves.components();
    assert_eq!(
        chains.iter().map(Chain::n_edges).collect::<Vec<_>>(),
        [7, 5, 9]
    );
    assert_eq!(halves.vertices()[7], halves.vertices()[8]);
    let (before, after) = (Geometry::new(&link), Geometry::new(&halves));
    for (k, place) in (0..=7).chain(7..link.n_vertices()).enumerate() {
        assert_eq!(halves.vertices()[k], link.vertices()[place]);
        let is_end = k == 7 || k == 8;
        let (twist, rest) = (halves.twists()[k], halves.rest().unwrap());
        let kept = link.rest().unwrap();
        assert_eq!(twist, if is_end { 0.0 } else { link.twists()[place] });
        assert_eq!(rest.twist[k], if is_end { 0.0 } else { kept.twist[place] });
        let curvature = if is_end {
            [0.0; 2]
        } else {
            kept.curvature[place]
        };
        assert_eq!(rest.curvature[k], curvature);
        if halves.chain_of(k).edges().contains(&k) {
            assert!(
                (after.director[k] - before.director[place]).norm() < 1e-12,
                "{k}"
            );
        }
    }
}

/// A link keeps its rods as they are; a cut opens one of them and moves those behind it up; each can be taken out again.
#[test]
fn a_link_is_its_rods_one_after_the_other() {
    let (a, b, c) = (ring(12, 6.0, 0.7), ring(20, 12.0, 0.1), ring(9, 4.0, -0.3));
    let link = RodState::link([&a, &b, &c]).unwrap();
    let firsts: Vec<usize> = link.components().iter().map(Chain::first).collect();
    assert_eq!(
        (firsts, link.n_vertices(), link.n_edges()),
        (vec![0, 12, 32], 41, 41)
    );
    assert!(
        (link.length() - 22.0).abs() < 1e-12 && (link.rest_length() - 22.0 / 41.0).abs() < 1e-12
    );
    assert_eq!((link.edge_before(12), link.edge_end(31)), (31, 12));
    assert_eq!(
        [0, 11, 12, 31, 32, 40].map(|i| link.component_of(i)),
        [0, 0, 1, 1, 2, 2]
    );
    let open = link.cut_at(15).unwrap();
    let chains = open.components();
    assert_eq!((chains[1].n_vertices(), chains[1].n_edges()), (21, 20));
    assert_eq!(
        (chains[2].first(), open.n_vertices(), open.n_edges()),
        (33, 42, 42)
    );
    assert_eq!(open.unused_edges().collect::<Vec<_>>(), [32]);
    assert!(!open.is_interior(12) && !open.is_interior(32) && open.is_interior(33));
    let alone = b.cut_at(3).unwrap();
    let taken = open.component(1).unwrap();
    assert_eq!(taken.vertices(), alone.vertices());
    assert_eq!(
        (taken.twists(), taken.layout()),
        (alone.twists(), alone.layout())
    );
    for (k, rod) in [(0, &a), (2, &c)] {
        let kept = open.component(k).unwrap();
        assert_eq!(
            (kept.vertices(), kept.twists()),
            (rod.vertices(), rod.twists())
        );
        assert_eq!(open.writhe_of(k).unwrap(), rod.writhe());
        assert_eq!(open.total_twist_of(k).unwrap(), rod.total_twist());
    }
    assert!(open.component(3).is_err() && open.linking(1, 1).is_err() && open.cut_at(13).is_err());
    assert!(RodState::link([]).is_err() && link.centreline().is_err());
    assert_eq!(link.centrelines().unwrap().len(), 3);
    // one rod is no link
    assert_eq!(RodState::link([&a]).unwrap().layout(), a.layout());
}

#[test]
fn folded_short_and_endless_rods_are_refused() {
    let mut vertices: Vec<_> = (0..12)
        .map(|k| Vector3::new(f64::from(k), 0.0, 0.0))
        .collect();
    let open = |v: &[Vector3<f64>]| Polyline::new(v.to_vec(), false).unwrap();
    assert!(RodState::new(&open(&vertices), 11.0, 0.0).is_ok());
    assert!(RodState::new(&open(&vertices[..8]), 7.0, 0.0).is_err());
    assert!(RodState::new(&open(&vertices[..9]), 8.0, 0.0).is_ok());
    for (length, twist) in [(0.0, 0.0), (f64::NAN, 0.0), (11.0, f64::INFINITY)] {
        assert!(RodState::new(&open(&vertices), length, twist).is_err());
    }
    vertices[6].x = 4.5;
    let folded = RodState::new(&open(&vertices), 11.0, 0.0).unwrap_err();
    assert!(matches!(folded, RodError::Folded { vertex: 5 }), "{folded}");
}
