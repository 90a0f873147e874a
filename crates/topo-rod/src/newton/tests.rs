//! The linear algebra of the steps: forms by hand, and what every solve must satisfy.

use std::f64::consts::TAU;

use topo_core::Polyline;

use super::*;
use crate::Geometry;
use crate::energy::{At, Bend, ContactEnergy, EnergyTerm, Stretch};
use crate::friction::{Friction, friction_form};
use crate::viscosity::{CentrelineViscosity, TwistViscosity, centreline_form, twist_form};

/// A crumpled rod of 40 edges with strands in contact.
fn crumpled(closed: bool) -> RodState {
    let vertex = |k: usize| {
        let u = TAU * k as f64 / 40.0;
        let r = 2.0 + 0.5 * (3.0 * u).cos();
        Vector3::new(
            r * (2.0 * u).cos(),
            r * (2.0 * u).sin(),
            0.8 * (3.0 * u).sin(),
        )
    };
    let curve = Polyline::new((0..40).map(vertex).collect(), true).unwrap();
    let rod = RodState::new(&curve, 24.0, 0.4).unwrap();
    if closed { rod } else { rod.cut_at(7).unwrap() }
}

/// A component-major vector that is zero but at some vertices.
fn at(n: usize, entries: &[(usize, [f64; 3])]) -> Vec<f64> {
    let mut out = vec![0.0; 3 * n];
    for (i, v) in entries {
        (0..3).for_each(|k| out[k * n + i] = v[k]);
    }
    out
}

/// u·K v, w·M_θ w' and u·C v of a few entries, by hand: edges of 0.5.
#[test]
fn val_forms_of_resistance_by_hand() {
    let line = (0..=8).map(|k| Vector3::new(0.5 * f64::from(k), 0.0, 0.0));
    let line = Polyline::new(line.collect(), false).unwrap();
    let rod = RodState::new(&line, 4.0, 0.0).unwrap();
    let chain = rod.layout();
    let (u, v) = (
        at(9, &[(3, [1.0, 2.0, 3.0])]),
        at(9, &[(4, [2.0, 0.0, 1.0])]),
    );
    // two edges, |u|² = 14 each; one edge, −(1·2 + 3·1)
    assert!((centreline_form(chain, &u, &u) - 56.0).abs() < 1e-12);
    assert!((centreline_form(chain, &u, &v) + 10.0).abs() < 1e-12);
    let turn = |j: usize, w: f64| {
        (0..8)
            .map(|k| if k == j { w } else { 0.0 })
            .collect::<Vec<_>>()
    };
    let form = |u: &[f64], w: &[f64]| twist_form(chain, |_| 0.5, u, w);
    // two vertices, 2² each; one vertex, −c · 2 · 3
    assert!((form(&turn(3, 2.0), &turn(3, 2.0)) - 8.0).abs() < 1e-12);
    assert!((form(&turn(3, 2.0), &turn(4, 3.0)) + 3.0).abs() < 1e-12);
    // the first edge has a vertex at its end only
    assert!((form(&turn(0, 1.0), &turn(0, 1.0)) - 1.0).abs() < 1e-12);
    let couplings = [(0, 2, 0.5), (2, 3, 2.0)];
    let u = at(4, &[(2, [1.0, 0.0, 2.0])]);
    let v = at(4, &[(2, [3.0, 1.0, 0.0]), (0, [0.0, 1.0, 1.0])]);
    // 0.5 · (−1, 0, −2)·(−3, 0, 1) + 2 · (1, 0, 2)·(3, 1, 0)
    assert!((friction_form(&couplings, &u, &v, 4) - 6.5).abs() < 1e-12);
}

/// (M_θ + s H_θ) w = q on the edges that are free, those held turn as prescribed.
#[test]
fn law_rotations_solve_their_equations() {
    let alone = |closed| RodState::link(&[crumpled(closed)]).unwrap();
    for state in [alone(true), alone(false), link(50.0)] {
        let (layout, geometry) = (state.layout(), Geometry::new(&state));
        let n = state.n_edges();
        for held in [vec![], vec![0, 13]] {
            let stands = |j: usize| held.contains(&j) || state.unused_edges().any(|k| k == j);
            let fixed: Vec<bool> = (0..n).map(stands).collect();
            let given: Vec<f64> = (0..n).map(|j| (1.7 * j as f64).sin()).collect();
            let s = 0.8;
            // M_θ + s H_θ and M_θ alone, of the definition; s is that of edges as long as those of the first component
            let apply = |w: &[f64], s: f64| {
                let mut out = vec![0.0; n];
                for chain in state.components() {
                    let half = 0.5 / chain.rest_length();
                    let s = s * state.components()[0].rest_length() / chain.rest_length();
                    for i in chain.interior() {
                        let (a, c) = (chain.edge_before(i), geometry.cosine[i]);
                        out[a] += half * (w[a] - c * w[i]) + s * (w[a] - w[i]);
                        out[i] += half * (w[i] - c * w[a]) + s * (w[i] - w[a]);
                    }
                }
                out
            };
            let mut viscosity = TwistViscosity::new(fixed.clone());
            viscosity.prepare(layout, &geometry.cosine, s).unwrap();
            let mut w = given.clone();
            viscosity.solve(layout, &geometry.cosine, s, &mut w, &mut []);
            let mut newton = NewtonTwist::new(fixed.clone());
            newton.prepare(layout, &geometry.cosine, s).unwrap();
            let mut step = given.clone();
            newton.solve(&mut step, &mut []);
            let (found, stepped, right) = (apply(&w, s), apply(&step, s), apply(&given, 0.0));
            for j in 0..n {
                if fixed[j] {
                    assert_eq!((w[j], step[j]), (given[j], given[j]));
                } else {
                    assert!((found[j] - given[j]).abs() < 1e-8, "{j}: {}", found[j]);
                    assert!((stepped[j] - right[j]).abs() < 1e-8, "{j}: {}", stepped[j]);
                }
            }
        }
    }
}

/// The same where the turns φ of the two ends at a loose joint are unknown too: of φ, and of the edges before and behind it.
#[test]
fn law_loose_joints_solve_their_equations() {
    let alone = RodState::link(&[crumpled(true)]).unwrap();
    for state in [alone, link(50.0)] {
        let (layout, geometry) = (state.layout(), Geometry::new(&state));
        let (n, s) = (state.n_edges(), 0.8);
        let closed = state.components().iter().filter(|chain| chain.is_closed());
        let seams: Vec<usize> = closed.map(|chain| chain.first()).collect();
        let given: Vec<f64> = (0..n + seams.len())
            .map(|j| (1.7 * j as f64).sin())
            .collect();
        // M_θ + s H_θ and M_θ alone, of the definition: the edge behind a seam turns by φ more, as that joint sees it
        let apply = |w: &[f64], s: f64| {
            let mut out = vec![0.0; n + seams.len()];
            for chain in state.components() {
                let half = 0.5 / chain.rest_length();
                let s = s * state.components()[0].rest_length() / chain.rest_length();
                for i in chain.interior() {
                    let (a, c) = (chain.edge_before(i), geometry.cosine[i]);
                    let seam = seams.iter().position(|seam| *seam == i);
                    let behind = w[i] + seam.map_or(0.0, |k| w[n + k]);
                    out[a] += half * (w[a] - c * behind) + s * (w[a] - behind);
                    let own = half * (behind - c * w[a]) + s * (behind - w[a]);
                    out[i] += own;
                    seam.iter().for_each(|k| out[n + k] += own);
                }
            }
            out
        };
        let fixed: Vec<bool> = (0..n)
            .map(|j| state.unused_edges().any(|k| k == j))
            .collect();
        let mut viscosity = TwistViscosity::new(fixed.clone());
        viscosity.loosen(&seams);
        viscosity.prepare(layout, &geometry.cosine, s).unwrap();
        let mut newton = NewtonTwist::new(fixed.clone());
        newton.loosen(&seams);
        newton.prepare(layout, &geometry.cosine, s).unwrap();
        let (mut solved, mut step) = (given.clone(), given.clone());
        let (w, joints) = solved.split_at_mut(n);
        viscosity.solve(layout, &geometry.cosine, s, w, joints);
        let (w, joints) = step.split_at_mut(n);
        newton.solve(w, joints);
        let (found, stepped, right) = (apply(&solved, s), apply(&step, s), apply(&given, 0.0));
        for j in (0..n + seams.len()).filter(|j| !fixed.get(*j).is_some_and(|f| *f)) {
            assert!((found[j] - given[j]).abs() < 1e-8, "{j}: {}", found[j]);
            assert!((stepped[j] - right[j]).abs() < 1e-8, "{j}: {}", stepped[j]);
        }
    }
}

/// (M + s H) out = M r at the vertices that are free, with M = η K + η_f C and a dashpot between the ends of what is open; those held move as prescribed.
#[test]
fn law_newton_steps_solve_their_equations() {
    let alone = |closed| RodState::link(&[crumpled(closed)]).unwrap();
    for (state, held) in [
        (alone(true), vec![]),
        (alone(false), vec![]),
        (alone(false), vec![0, 1, 20]),
        (link(1.9), vec![]),
        (link(50.0), vec![]),
        (link(1.9), vec![50, 51, 52]),
    ] {
        let n = state.n_vertices();
        // the tips of the open one are still in one place
        let mut pairs = ContactPairs::new(1.7, 0.3);
        pairs.set_joined(Some(crate::Tips::Of(1)));
        pairs.update(&state);
        let geometry = Geometry::new(&state);
        let place = At {
            state: &state,
            geometry: &geometry,
            pairs: &pairs,
        };
        let mut stiffness = Stiffness::default();
        stiffness.reset(n, pairs.active().len());
        let contact = ContactEnergy {
            stiffness: 20.0,
            diameter: 1.7,
        };
        Bend.add_stiffness(place, &mut stiffness);
        Stretch { ratio: 5.0 }.add_stiffness(place, &mut stiffness);
        contact.add_stiffness(place, &mut stiffness);
        let friction = Friction {
            ratio: 0.7,
            range: 1.5,
        };
        let mut couplings = Vec::new();
        friction.couplings(pairs.active(), &mut couplings);
        assert!(couplings.len() > 10);
        let s = 0.03;
        let line = load_of(&state);
        if let Some(LoadLine {
            from: Some(a),
            to: b,
        }) = line
        {
            let spring = DAMPING * 0.3 + DAMPING / s;
            stiffness.add_further(a as u32, b as u32, spring);
            stiffness.further.sort_by_key(|p| (p.0, p.1));
        }
        let fixed: Vec<bool> = (0..n).map(|i| held.contains(&i)).collect();
        let drag = Drag::of(&state, &fixed, 3.0);
        let mut given: Vec<f64> = (0..3 * n).map(|k| (0.9 * k as f64).sin()).collect();
        if let Some(drag) = &drag {
            // the centroid of a link does not move
            drag.keep_centroid(&mut given);
        }
        let floats = |chain: &&Chain| !chain.vertices().any(|i| held.contains(&i));
        let mut newton = NewtonMatrix::new(fixed.clone()).with_drag(drag);
        if let Some(line) = line {
            newton = newton.with_load(line);
            newton.damp(DAMPING);
        }
        newton
            .prepare(&state, &pairs, &stiffness, s, &couplings)
            .unwrap();
        let mut found = given.clone();
        newton.solve(&mut found);
        let vectors = |flat: &[f64]| -> Vec<Vector3<f64>> {
            (0..n)
                .map(|i| Vector3::new(flat[i], flat[n + i], flat[2 * n + i]))
                .collect()
        };
        let (u, r) = (vectors(&found), vectors(&given));
        let resistance = |v: &[Vector3<f64>]| {
            let mut out = vec![Vector3::zeros(); n];
            let edges = state.components().iter().flat_map(|chain| {
                let viscous = 1.0 / chain.rest_length();
                chain.edges().map(move |j| (j, chain.edge_end(j), viscous))
            });
            let rubbing = couplings
                .iter()
                .map(|&(i, j, c)| (i as usize, j as usize, c));
            for (i, j, c) in edges.chain(rubbing) {
                out[i] += (v[i] - v[j]) * c;
                out[j] += (v[j] - v[i]) * c;
            }
            let chains = state
                .components()
                .iter()
                .filter(|_| state.n_components() > 1);
            for chain in chains.filter(floats) {
                let mean = v[chain.vertices()].iter().sum::<Vector3<f64>>();
                let mean = mean / chain.n_vertices() as f64;
                let each = 3.0 * chain.length() / state.length().powi(2);
                let each = mean * (each / chain.n_vertices() as f64);
                chain.vertices().for_each(|i| out[i] += each);
            }
            out
        };
        // that of the dashpot to the step itself is in the stiffness
        let (left, mut right) = (resistance(&u), resistance(&r));
        if let Some(LoadLine {
            from: Some(a),
            to: b,
        }) = line
        {
            let push = DAMPING * (r[b] - r[a]);
            right[b] += push;
            right[a] -= push;
        }
        let elastic = stiffness.product(&state, pairs.active(), &u);
        for i in 0..n {
            if held.contains(&i) {
                assert_eq!(u[i], r[i]);
            } else {
                let error = (left[i] + elastic[i] * s - right[i]).norm();
                assert!(error < 1e-9 * right[i].norm().max(1.0), "{i}: {error:.1e}");
            }
        }
        let of = |chain: &Chain| {
            let sum: Vector3<f64> = u[chain.vertices()].iter().sum();
            sum * (chain.length() / chain.n_vertices() as f64)
        };
        let mean: Vector3<f64> = state.components().iter().map(of).sum();
        assert!(!held.is_empty() || mean.norm() < 1e-9, "the rod drifts");
    }
}

/// A resistance that couples the three directions.
const DAMPING: Matrix3<f64> = Matrix3::new(0.9, 0.2, -0.3, 0.2, 0.7, 0.1, -0.3, 0.1, 1.3);

/// Between the ends of the open rod, if there is one.
fn load_of(state: &RodState) -> Option<LoadLine> {
    let open = state.components().iter().find(|chain| !chain.is_closed())?;
    Some(LoadLine {
        from: Some(open.first()),
        to: open.last(),
    })
}

/// A closed rod, an open one and a closed one of other edges, `apart` from each other.
fn link(apart: f64) -> RodState {
    let other = crumpled(true).centreline().unwrap();
    let mut parts = [
        crumpled(true),
        crumpled(false),
        RodState::new(&other, 20.0, 0.4).unwrap(),
    ];
    for (k, rod) in parts.iter_mut().enumerate() {
        let by = Vector3::new(0.9, 0.5, 1.1) * (k as f64 * apart);
        *rod = rod.with_vertices(rod.vertices().iter().map(|x| x + by).collect());
    }
    RodState::link(&parts).unwrap()
}

/// (η K + η_f C + Z + T D Tᵀ) v = f of a link with a dashpot between the ends of its open rod, rubbing and apart, without and with held vertices; net forces on components move them.
#[test]
fn law_velocities_of_a_link_solve_their_equations() {
    for (apart, held, ratio) in [
        (1.9, vec![], 1.0),
        (50.0, vec![], 1e-3),
        (1.9, vec![3, 44], 30.0),
    ] {
        let state = link(apart);
        let n = state.n_vertices();
        let mut pairs = ContactPairs::new(1.7, 0.3);
        pairs.set_joined(Some(crate::Tips::Of(1)));
        pairs.update(&state);
        let friction = Friction {
            ratio: 0.7,
            range: 1.5,
        };
        let mut couplings = Vec::new();
        friction.couplings(pairs.active(), &mut couplings);
        let fixed: Vec<bool> = (0..n).map(|i| held.contains(&i)).collect();
        let drag = Drag::of(&state, &fixed, ratio).unwrap();
        let line = load_of(&state).expect("an open rod");
        let mut mobility = CentrelineViscosity::new(fixed.clone())
            .with_drag(Some(drag.clone()))
            .with_load(line);
        mobility.damp(DAMPING);
        let mut force: Vec<f64> = (0..3 * n).map(|k| (0.9 * k as f64).sin() + 0.3).collect();
        if held.is_empty() {
            crate::viscosity::remove_mean(&mut force, n);
        }
        let mut v = force.clone();
        mobility.prepare(&state, &pairs, Some(friction)).unwrap();
        mobility.solve(&state, &couplings, &mut v);
        // the power of v against each unit motion is the force there
        for place in 0..3 * n {
            let mut unit = vec![0.0; 3 * n];
            unit[place] = 1.0;
            let resisted = centreline_form(&state, &unit, &v)
                + friction_form(&couplings, &unit, &v, n)
                + drag.form(&unit, &v)
                + line
                    .relative(&unit, n)
                    .dot(&(DAMPING * line.relative(&v, n)));
            if fixed[place % n] {
                assert_eq!(v[place], force[place]);
            } else {
                let error = (resisted - force[place]).abs();
                assert!(error < 1e-9, "{apart} {place}: {error:.1e}");
            }
        }
    }
}
