//! Energies and forces at hand-computed places, and the matrix of the Newton step where it is exact.

use super::*;
use crate::Layout;
use crate::contact::ActivePair;
use crate::friction::Friction;

/// A wide ring of 40 vertices whose vertices 5 and 25 are `r` apart along x and far from all others, each standing for an arc of 1.2.
fn touching(r: f64) -> RodState {
    let vertices = (0..40).map(|k| {
        let u = std::f64::consts::TAU * f64::from(k) / 40.0;
        match k {
            5 => Vector3::new(0.5 * r, 0.0, 30.0),
            25 => Vector3::new(-0.5 * r, 0.0, 30.0),
            _ => Vector3::new(20.0 * u.cos(), 20.0 * u.sin(), 0.0),
        }
    });
    let curve = Polyline::new(vertices.collect(), true).unwrap();
    RodState::new(&curve, 48.0, 0.0).unwrap()
}

fn pairs_of(state: &RodState, reach: f64) -> ContactPairs {
    let mut pairs = ContactPairs::new(reach, 0.3);
    pairs.update(state);
    pairs
}

/// V(r) = (k_c/2)(d_c − r)²(d_c/r)⁴ with k_c = 20, d_c = 2 at r = 1.6: 10 · 0.16 · 2.44140625 = 3.90625, and
/// −dV/dr = 20 · 0.4 · 2.44140625 + 4 · 3.90625/1.6 = 29.296875; d_c and beyond: nothing.
#[test]
fn val_contact_law_at_given_distances() {
    let term = ContactEnergy {
        stiffness: 20.0,
        diameter: 2.0,
    };
    let arcs = 1.2 * 1.2;
    // at r = 1 the factor is 16: 10 · 16 = 160, and 20 · 16 + 4 · 160 = 960
    for (r, energy, push) in [
        (1.6, 3.90625, 29.296875),
        (1.0, 160.0, 960.0),
        (2.0, 0.0, 0.0),
        (2.1, 0.0, 0.0),
    ] {
        let state = touching(r);
        let (geometry, pairs) = (Geometry::new(&state), pairs_of(&state, 2.2));
        let at = At {
            state: &state,
            geometry: &geometry,
            pairs: &pairs,
        };
        let mut force = Force::default();
        force.reset(&state);
        let stored = term.add_force(at, &mut force);
        assert!((stored - arcs * energy).abs() < 1e-12 * 160.0, "{r}");
        assert!((term.energy(at) - stored).abs() < 1e-12 * 160.0);
        // pushed apart
        let along = Vector3::new(arcs * push, 0.0, 0.0);
        assert!((force.vertex[5] - along).norm() < 1e-11, "{r}");
        assert!((force.vertex[25] + along).norm() < 1e-11, "{r}");
    }
}

/// The end of an open rod stands for half an edge, as do both of a cut one: 1.2 · 0.6 between an end and any other vertex.
#[test]
fn val_free_ends_count_half() {
    let term = ContactEnergy {
        stiffness: 20.0,
        diameter: 2.0,
    };
    for (cut, weight) in [(5, 0.72), (25, 0.72), (15, 1.44)] {
        let state = touching(1.6).cut_at(cut).unwrap();
        let mut pairs = ContactPairs::new(1.7, 0.3);
        pairs.set_cyclic(true);
        pairs.update(&state);
        let at = At {
            state: &state,
            geometry: &Geometry::new(&state),
            pairs: &pairs,
        };
        // a vertex that was doubled touches twice
        let twice = if weight < 1.0 { 2.0 } else { 1.0 };
        let exact = twice * weight * 3.90625;
        assert!((term.energy(at) / exact - 1.0).abs() < 1e-12);
    }
}

/// η_f/η w w'/r³ below the range and nothing from there on: 0.1 · 1.44/1.6³ = 0.03515625.
#[test]
fn val_friction_at_given_distances() {
    for (r, coefficient) in [(1.6, 0.03515625), (2.05, 0.0)] {
        let (friction, state) = (
            Friction {
                ratio: 0.1,
                range: 2.0,
            },
            touching(r),
        );
        let mut couplings = Vec::new();
        friction.couplings(pairs_of(&state, 2.2).active(), &mut couplings);
        assert_eq!(couplings.len(), usize::from(coefficient > 0.0));
        for (i, j, c) in couplings {
            assert_eq!((i, j), (5, 25));
            assert!((c - coefficient).abs() < 1e-15);
        }
    }
}

/// A ring of radius 4 and 100 edges, a turn of θ' = 0.3, a quarter longer than it is at rest: bend is tan²(φ/2)/(2 l₀) a vertex,
/// twist α (θ' l₀)²/(8 l₀), stretch (γ/2) l₀/16.
#[test]
fn val_energies_of_a_ring() {
    let ring = (0..100).map(|k| {
        let u = std::f64::consts::TAU * f64::from(k) / 100.0;
        Vector3::new(4.0 * u.cos(), 4.0 * u.sin(), 0.0)
    });
    let curve = Polyline::new(ring.collect(), true).unwrap();
    let state = RodState::new(&curve, 0.8 * curve.length(), 0.3).unwrap();
    let l0 = 0.8 * 8.0 * (std::f64::consts::PI / 100.0).sin();
    let (geometry, pairs) = (Geometry::new(&state), ContactPairs::new(0.0, 0.3));
    let at = At {
        state: &state,
        geometry: &geometry,
        pairs: &pairs,
    };
    let tangent = (std::f64::consts::PI / 100.0).tan();
    let twist = Twist { ratio: 1.0 / 1.3 };
    let stretch = Stretch { ratio: 5.0 };
    let exact: [(&dyn EnergyTerm, f64); 3] = [
        (&Bend, 100.0 * tangent * tangent / (2.0 * l0)),
        (&twist, 100.0 * 0.3 * 0.3 * l0 / (8.0 * 1.3)),
        (&stretch, 100.0 * 2.5 * l0 / 16.0),
    ];
    for (term, exact) in exact {
        let found = term.energy(at);
        assert!((found / exact - 1.0).abs() < 1e-12, "{}", term.name());
    }
    // the moment that the twist carries, α θ'/4 per area
    assert!((twist.torque(0.3 * l0, l0) - 0.3 / (4.0 * 1.3)).abs() < 1e-15);
}

impl Stiffness {
    /// H u, vertex-major.
    pub(crate) fn product(
        &self,
        layout: &Layout,
        active: &[ActivePair],
        u: &[Vector3<f64>],
    ) -> Vec<Vector3<f64>> {
        let n = u.len();
        let mut out: Vec<_> = (0..n).map(|i| self.diagonal[i] * u[i]).collect();
        let mut couple = |i: usize, j: usize, block: &Matrix3<f64>| {
            out[i] += block * u[j];
            out[j] += block.transpose() * u[i];
        };
        for chain in layout.components() {
            let (first, n) = (chain.first(), chain.n_vertices());
            for k in 0..n {
                couple(first + k, first + (k + 1) % n, &self.next[first + k]);
                couple(first + k, first + (k + 2) % n, &self.second[first + k]);
            }
        }
        for (pair, block) in active.iter().zip(&self.contact) {
            couple(pair.i as usize, pair.j as usize, block);
        }
        for (i, j, block) in &self.further {
            couple(*i as usize, *j as usize, block);
        }
        out
    }
}

/// Largest difference of H u and minus the change of the force along u, relative.
fn error_of_stiffness(
    term: &dyn EnergyTerm,
    state: &RodState,
    reach: f64,
    along: impl Fn(usize) -> Vector3<f64>,
) -> f64 {
    let n = state.n_vertices();
    let u: Vec<_> = (0..n).map(along).collect();
    let force = |by: f64| {
        let mut moved = state.clone();
        let step: Vec<f64> = (0..3 * n).map(|k| by * u[k % n][k / n]).collect();
        state.moved_by(&step, false, 1, &mut moved);
        let mut force = Force::default();
        force.reset(&moved);
        let at = At {
            state: &moved,
            geometry: &Geometry::new(&moved),
            pairs: &pairs_of(&moved, reach),
        };
        term.add_force(at, &mut force);
        force.vertex
    };
    let by = 1e-5;
    let (ahead, behind) = (force(by), force(-by));
    let (geometry, pairs) = (Geometry::new(state), pairs_of(state, reach));
    let mut stiffness = Stiffness::default();
    stiffness.reset(n, pairs.active().len());
    let at = At {
        state,
        geometry: &geometry,
        pairs: &pairs,
    };
    term.add_stiffness(at, &mut stiffness);
    let found = stiffness.product(state, pairs.active(), &u);
    let size = found.iter().map(|v| v.norm()).fold(0.0, f64::max);
    assert!(size > 1e-3, "{} has no stiffness", term.name());
    let error = |i: usize| (found[i] + (ahead[i] - behind[i]) / (2.0 * by)).norm();
    (0..n).map(error).fold(0.0, f64::max) / size
}

fn wave(i: usize) -> Vector3<f64> {
    let i = i as f64;
    Vector3::new((1.3 * i).sin(), (0.7 * i + 1.0).cos(), (2.1 * i).sin())
}

/// Where every edge is strained, H of the stretch is the second derivative of its energy.
#[test]
fn stiffness_of_a_strained_rod_is_the_second_derivative() {
    let rod = crumpled(true);
    let edges = rod.centreline().unwrap().edge_lengths();
    let shortest = edges.iter().copied().fold(f64::INFINITY, f64::min);
    let rod = RodState::new(&rod.centreline().unwrap(), 0.9 * shortest * 40.0, 0.0).unwrap();
    let error = error_of_stiffness(&Stretch { ratio: 5.0 }, &rod, 0.0, wave);
    assert!(error < 1e-7, "off by {error:.1e}");
}

/// Across the plane of a flat rod κ is of second order, so that there Gauss–Newton misses the bend by the strain of a straight rod
/// only: on a wide ring by its curvature, to second order.
#[test]
fn stiffness_of_a_nearly_straight_rod_is_the_second_derivative() {
    let ring = |n: usize| {
        let ring = (0..n).map(|k| {
            let u = std::f64::consts::TAU * k as f64 / n as f64;
            Vector3::new(u.cos(), u.sin(), 0.0) * (n as f64 / std::f64::consts::TAU)
        });
        let curve = Polyline::new(ring.collect(), true).unwrap();
        RodState::new(&curve, curve.length(), 0.0).unwrap()
    };
    let error = |n: usize| error_of_stiffness(&Bend, &ring(n), 0.0, wave);
    let (coarse, fine) = (error(60), error(240));
    println!("off by {coarse:.2e}, {fine:.2e}");
    assert!(
        fine < 2e-2 && fine < 0.3 * coarse,
        "{coarse:.2e} {fine:.2e}"
    );
}

/// V'' of a pair that moves along its normal, at any depth.
#[test]
fn stiffness_of_a_contact_is_the_second_derivative() {
    let term = ContactEnergy {
        stiffness: 20.0,
        diameter: 2.0,
    };
    for r in [1.9, 1.6, 1.0] {
        let along = |i: usize| match i {
            5 => Vector3::new(0.3, 0.0, 0.0),
            25 => Vector3::new(-0.4, 0.0, 0.0),
            _ => Vector3::zeros(),
        };
        let error = error_of_stiffness(&term, &touching(r), 2.2, along);
        assert!(error < 1e-6, "off by {error:.1e} at {r}");
    }
    // about to touch: V''(d_c) = k_c, as if they touched already
    let state = touching(2.05);
    let pairs = pairs_of(&state, 2.2);
    let mut stiffness = Stiffness::default();
    stiffness.reset(40, pairs.active().len());
    term.add_expected(pairs.active(), &mut stiffness);
    assert_eq!(stiffness.further.len(), 1);
    let (i, j, block) = &stiffness.further[0];
    assert_eq!((*i, *j), (5, 25));
    let exact = 20.0 * 1.2 * 1.2;
    assert!((block[(0, 0)] + exact).abs() < 1e-10 && block[(1, 1)].abs() < 1e-12);
    assert!((stiffness.diagonal[5][(0, 0)] - exact).abs() < 1e-10);
}
