//! The check of forces that every term must pass.

use topo_core::{finite_difference_gradient, max_norm};

use super::{At, EnergyTerm, Force};
use crate::contact::ContactPairs;
use crate::{Geometry, RodState};

/// Largest error of a term's force and torque against fourth-order central differences of its energy with steps of `probe`, over the
/// largest component of the gradient.
///
/// About 1e-11 to 1e-9 for a smooth term at a `probe` of 2e-3 h; `pairs` are those in reach at `state` and are updated as it is
/// moved.
///
/// # Validation
/// `bend_force_is_the_gradient` and its neighbours hold the terms of this crate to 1e-7.
pub fn gradient_error(
    term: &dyn EnergyTerm,
    state: &RodState,
    pairs: &mut ContactPairs,
    probe: f64,
) -> f64 {
    let (n, n_edges) = (state.n_vertices(), state.n_edges());
    let mut moved = state.clone();
    let energy = |step: &[f64]| {
        state.moved_by(step, true, state.stamp() + 1, &mut moved);
        pairs.update(&moved);
        term.energy(At {
            state: &moved,
            geometry: &Geometry::new(&moved),
            pairs,
        })
    };
    let gradient = finite_difference_gradient(energy, &vec![0.0; 3 * n + n_edges], probe);
    pairs.update(state);
    let at = At {
        state,
        geometry: &Geometry::new(state),
        pairs,
    };
    let mut force = Force::default();
    force.reset(state);
    term.add_force(at, &mut force);
    let components = (0..3).flat_map(|k| force.vertex.iter().map(move |f| f[k]));
    let forces = components.chain(force.torque.iter().copied());
    let errors: Vec<f64> = gradient.iter().zip(forces).map(|(g, f)| g + f).collect();
    max_norm(&errors) / max_norm(&gradient)
}
