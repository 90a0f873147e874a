//! Forces against finite differences of the energy.

use nalgebra::Vector3;
use topo_core::{Polyline, finite_difference_gradient};

use super::*;

mod values;

/// A crumpled curve with strands in contact, stretched and twisted unevenly.
fn crumpled(closed: bool) -> RodState {
    let n = 40;
    let vertices: Vec<_> = (0..n)
        .map(|k| {
            let u = std::f64::consts::TAU * k as f64 / n as f64;
            Vector3::new(
                (2.0 + 0.5 * (3.0 * u).cos()) * (2.0 * u).cos(),
                (2.1 + 0.4 * (3.0 * u).cos()) * (2.0 * u).sin(),
                0.8 * (3.0 * u).sin(),
            )
        })
        .collect();
    let rod = RodState::new(&Polyline::new(vertices, true).unwrap(), 24.0, 0.7).unwrap();
    let rod = if closed { rod } else { rod.cut_at(7).unwrap() };
    let mut twisted = rod.clone();
    let n = rod.n_vertices();
    let step: Vec<f64> = (0..3 * n + rod.n_edges())
        .map(|k| 0.05 * (k as f64 * 1.7).sin())
        .collect();
    rod.moved_by(&step, true, 1, &mut twisted);
    twisted
}

/// An open rod between two closed ones, all three in contact with each other.
fn link() -> RodState {
    let parts = [true, false, true].map(crumpled);
    let mut link = RodState::link(&parts).unwrap();
    let n = link.n_vertices();
    let mut step = vec![0.0; 3 * n + link.n_edges()];
    for (c, chain) in link.components().iter().enumerate() {
        let by = Vector3::new(0.9, 0.4, 1.1) * c as f64;
        for i in chain.vertices() {
            (0..3).for_each(|k| step[k * n + i] = by[k]);
        }
    }
    link.clone().moved_by(&step, true, 2, &mut link);
    link
}

fn check(term: &dyn EnergyTerm, reach: f64, probe: f64) {
    for (rod, closed) in [
        (crumpled(true), true),
        (crumpled(false), false),
        (link(), true),
    ] {
        let mut pairs = ContactPairs::new(reach, 0.3);
        pairs.set_cyclic(closed);
        let error = gradient_error(term, &rod, &mut pairs, probe);
        assert!(error < 1e-7, "{}: off by {error:.2e}", term.name());
        let mut force = Force::default();
        force.reset(&rod);
        let at = At {
            state: &rod,
            geometry: &Geometry::new(&rod),
            pairs: &pairs,
        };
        let stored = term.add_force(at, &mut force);
        assert!(
            (stored - term.energy(at)).abs() <= 1e-13 * stored,
            "energy and force disagree on the energy"
        );
        assert!(stored > 1e-3, "{} is not at work", term.name());
    }
}

#[test]
fn bend_force_is_the_gradient() {
    check(&Bend, 0.0, 2e-3);
}

/// A rod with a natural shape that varies along each component, in no plane.
fn curved(rod: RodState) -> RodState {
    let curvature = |c: usize, s: f64| {
        let phase = 0.7 * s + c as f64;
        [0.6 + 0.3 * phase.sin(), 0.4 * phase.cos()]
    };
    rod.with_rest(curvature, |c, s| 0.5 + 0.2 * (s + c as f64).sin())
        .unwrap()
}

fn check_curved(term: &dyn EnergyTerm) {
    for rod in [crumpled(true), crumpled(false), link()] {
        let rod = curved(rod);
        let mut pairs = ContactPairs::new(0.0, 0.3);
        let error = gradient_error(term, &rod, &mut pairs, 2e-3);
        assert!(error < 1e-7, "{}: off by {error:.2e}", term.name());
        let mut force = Force::default();
        force.reset(&rod);
        let at = At {
            state: &rod,
            geometry: &Geometry::new(&rod),
            pairs: &pairs,
        };
        let stored = term.add_force(at, &mut force);
        assert!((stored - term.energy(at)).abs() <= 1e-13 * stored);
        let torque = force.torque.iter().map(|t| t.abs()).fold(0.0, f64::max);
        assert!(
            stored > 1e-3 && torque > 1e-3,
            "{} is not at work",
            term.name()
        );
        let mut density = vec![0.0; rod.n_vertices()];
        term.add_density(at, &mut density);
        let sum: f64 = density
            .iter()
            .enumerate()
            .map(|(i, w)| w * at.share(i))
            .sum();
        assert!((sum - stored).abs() < 1e-12 * stored);
    }
}

#[test]
fn bend_about_a_natural_curvature_has_its_gradient() {
    check_curved(&CurvedBend);
}

#[test]
fn twist_about_a_natural_twist_has_its_gradient() {
    check_curved(&CurvedTwist(Twist { ratio: 0.77 }));
}

/// The present shape as the natural one stores nothing and pulls at nothing, and a cut does not change that.
#[test]
fn law_a_rod_at_rest_in_its_shape_is_free_of_stress() {
    for rod in [crumpled(true), crumpled(false), link()] {
        let rod = rod.at_rest().unwrap();
        let cut = rod.components()[0]
            .is_closed()
            .then(|| rod.cut_at(17).unwrap());
        for rod in [Some(rod), cut].into_iter().flatten() {
            let (geometry, mut force) = (Geometry::new(&rod), Force::default());
            let pairs = ContactPairs::new(0.0, 0.3);
            let at = At {
                state: &rod,
                geometry: &geometry,
                pairs: &pairs,
            };
            force.reset(&rod);
            let bend = CurvedBend.add_force(at, &mut force);
            let twist = CurvedTwist(Twist { ratio: 0.77 }).add_force(at, &mut force);
            assert!(bend + twist < 1e-24, "{bend:e} {twist:e}");
            let largest = force.vertex.iter().map(|f| f.norm()).fold(0.0, f64::max);
            assert!(largest < 1e-12, "{largest:e}");
            assert!(force.torque.iter().all(|t| t.abs() < 1e-12));
        }
    }
}

#[test]
fn twist_force_is_the_gradient() {
    check(&Twist { ratio: 0.77 }, 0.0, 2e-3);
}

#[test]
fn stretch_force_is_the_gradient() {
    check(&Stretch { ratio: 5.0 }, 0.0, 2e-3);
}

#[test]
fn contact_force_is_the_gradient() {
    // the second derivative jumps where strands part: a short probe, so that no pair parts within it
    check(
        &ContactEnergy {
            stiffness: 20.0,
            diameter: 1.7,
        },
        1.7,
        2e-5,
    );
}

/// What strands of two components do to each other sums to zero, without and with a window that would keep near numbers apart.
#[test]
fn law_components_push_each_other_alike() {
    let link = link();
    let term = ContactEnergy {
        stiffness: 20.0,
        diameter: 1.7,
    };
    let mut pairs = ContactPairs::new(1.7, 0.3);
    pairs.update(&link);
    let between = |p: &&crate::contact::ActivePair| {
        link.component_of(p.i as usize) != link.component_of(p.j as usize)
    };
    let crossing: Vec<_> = pairs.active().iter().filter(between).collect();
    assert!(crossing.len() > 30 && crossing.iter().all(|p| p.strands));
    let share = |i: u32| link.chain_of(i as usize).share(i as usize);
    assert!(crossing.iter().all(|p| p.weight == share(p.i) * share(p.j)));
    let mut force = Force::default();
    force.reset(&link);
    term.add_force(
        At {
            state: &link,
            geometry: &Geometry::new(&link),
            pairs: &pairs,
        },
        &mut force,
    );
    let chains = link.components().iter();
    let net: Vec<Vector3<f64>> = chains
        .map(|chain| force.vertex[chain.vertices()].iter().sum())
        .collect();
    assert!(net.iter().all(|f| f.norm() > 1.0), "{net:?}");
    assert!((net[0] + net[1] + net[2]).norm() < 1e-12 * net[0].norm());
}

/// A rod pressed together along itself until its neighbours repel.
#[test]
fn force_of_a_collapsing_rod_is_the_gradient() {
    let n = 40;
    let ring: Vec<_> = (0..n)
        .map(|k| {
            let u = std::f64::consts::TAU * k as f64 / n as f64;
            let r = 0.35 * (1.0 + 0.1 * (3.0 * u).cos());
            Vector3::new(r * u.cos(), r * u.sin(), 0.05 * (2.0 * u).sin())
        })
        .collect();
    let rod = RodState::new(&Polyline::new(ring, true).unwrap(), 6.5, 0.0).unwrap();
    let term = ContactEnergy {
        stiffness: 20.0,
        diameter: 2.0,
    };
    let at = |state: &RodState, force: &mut Force| {
        let mut pairs = ContactPairs::new(2.0, 0.3).with_core();
        pairs.update(state);
        let geometry = Geometry::new(state);
        let at = At {
            state,
            geometry: &geometry,
            pairs: &pairs,
        };
        force.reset(state);
        assert_eq!(term.energy(at), term.add_force(at, force));
        let core = |p: &crate::contact::CorePair| p.j - p.i < 20;
        assert!(pairs.core().iter().any(core), "the core is not at work");
        term.energy(at)
    };
    let mut force = Force::default();
    at(&rod, &mut force);
    let mut energy = |step: &[f64]| {
        let mut moved = rod.clone();
        rod.moved_by(step, false, 2, &mut moved);
        at(&moved, &mut Force::default())
    };
    let gradient = finite_difference_gradient(&mut energy, &vec![0.0; 3 * n], 2e-5);
    let size = gradient.iter().fold(0.0f64, |a, b| a.max(b.abs()));
    for i in 0..n {
        for k in 0..3 {
            let error = (gradient[k * n + i] + force.vertex[i][k]).abs();
            assert!(error < 1e-7 * size, "vertex {i}: {error:.2e} of {size:.2e}");
        }
    }
}
