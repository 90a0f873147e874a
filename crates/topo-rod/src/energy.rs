//! The energy of a rod as a sum of terms: one struct and one file each behind a small object-safe trait.
//!
//! ```math
//! e = \frac{E}{A} = \frac12 \int \left[ \frac{\kappa^2 + \alpha\, \theta'^2}{4} + \gamma\, (|x'| - 1)^2 \right] ds
//!   + e_{\text{contact}}
//! ```
//!
//! One dynamic call per term costs nothing compared with the loop inside it. A scene that leaves a term out has a shorter list.

mod bend;
mod contact;
mod gradient;
mod list;
mod parts;
mod rest;
mod stretch;
mod twist;

#[cfg(test)]
mod tests;

pub use bend::Bend;
pub use contact::ContactEnergy;
pub use gradient::gradient_error;
pub use list::TermFactory;
pub(crate) use list::{checked_name, terms_of};
pub use parts::{EnergyKind, EnergyPart, RodParts, StoredEnergy};
pub use rest::{CurvedBend, CurvedTwist};
pub use stretch::Stretch;
pub use twist::Twist;

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::contact::ContactPairs;
use crate::{Geometry, RodState};

/// What a term reads.
#[derive(Clone, Copy)]
pub struct At<'a> {
    /// Degrees of freedom.
    pub state: &'a RodState,
    /// Tangents and curvatures of that state.
    pub geometry: &'a Geometry,
    /// Pairs of vertices in reach of each other, the larger of contact diameter and friction range; none without either.
    pub pairs: &'a ContactPairs,
}

impl At<'_> {
    /// Arclength l_i of vertex `i`, in h: that of an edge, half of it at a free end.
    pub fn share(&self, i: usize) -> f64 {
        self.state.chain_of(i).share(i)
    }
}

/// Generalised force −∂e/∂(x, θ): a vector per vertex, a torque per edge.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Force {
    /// −∂e/∂x_i, one per vertex, in E_b.
    pub vertex: Vec<Vector3<f64>>,
    /// −∂e/∂θ_j, one per edge, in E_b h (0 where no edge is: [`Layout`](crate::Layout)).
    pub torque: Vec<f64>,
}

impl Force {
    /// All zero, with the sizes of `state`.
    pub fn reset(&mut self, state: &RodState) {
        self.vertex.clear();
        self.vertex.resize(state.n_vertices(), Vector3::zeros());
        self.torque.clear();
        self.torque.resize(state.n_edges(), 0.0);
    }
}

/// Symmetric block matrix of a rod, in E_b/h: 3 × 3 blocks on the diagonal, to the first and second neighbour, and for each
/// pair in contact.
#[derive(Debug, Clone, Default)]
pub struct Stiffness {
    /// Block (i, i).
    pub diagonal: Vec<Matrix3<f64>>,
    /// Block (i, i+1).
    pub next: Vec<Matrix3<f64>>,
    /// Block (i, i+2).
    pub second: Vec<Matrix3<f64>>,
    /// Block (i, j) of each active pair, in the order of [`ContactPairs::active`].
    pub contact: Vec<Matrix3<f64>>,
    /// Further pairs with their block (i, j), ascending: neighbours along the rod that are too close, and pairs about to touch.
    pub further: Vec<(u32, u32, Matrix3<f64>)>,
}

impl Stiffness {
    /// All zero, for `n_vertices` and `n_active` pairs.
    pub fn reset(&mut self, n_vertices: usize, n_active: usize) {
        for (blocks, n) in [
            (&mut self.diagonal, n_vertices),
            (&mut self.next, n_vertices),
            (&mut self.second, n_vertices),
            (&mut self.contact, n_active),
        ] {
            blocks.clear();
            blocks.resize(n, Matrix3::zeros());
        }
        self.further.clear();
    }

    /// Adds a spring between vertices i and j whose second derivatives are `block`.
    pub fn add_further(&mut self, i: u32, j: u32, block: Matrix3<f64>) {
        self.diagonal[i as usize] += block;
        self.diagonal[j as usize] += block;
        self.further.push((i, j, -block));
    }
}

/// One term e(x, θ) of the energy, of this crate or of the caller.
///
/// ```math
/// e = \frac{E}{A} = \sum_{\text{terms}} e_{\text{term}}(x, \theta), \qquad
/// f_i = -\frac{\partial e}{\partial x_i}, \quad \tau_j = -\frac{\partial e}{\partial \theta_j}
/// ```
///
/// Units: lengths in h, energies per cross section area in E_b h, forces in E_b, torques in E_b h, stiffness in E_b/h,
/// densities in E_b. A term of energy w per length stores Σ_i w_i l_i, with l_i = l_0 at every vertex and l_0/2 at free ends
/// ([`At::share`]); its density is w_i.
///
/// The following is derived from the list of terms: ledger, curves, samples, tables, energy density and, for an
/// [elastic](EnergyKind::Elastic) term, the end of a discharge and its times. Released shares count down to zero energy, so the
/// lowest energy of an elastic term should be zero. The spectral bound of the stabilised integrator is measured on the forces
/// and needs nothing from a term.
///
/// Only its ends can hold a rod. The viscosity is internal, so a rod with free ends would follow a net force at once. Its
/// centroid is kept fixed instead: the mean force is subtracted, which does no work. Torques about the tangents of a free rod
/// must sum to zero.
///
/// [`RodBattery::with`](crate::RodBattery::with) and [`RodModel::with`](crate::RodModel::with) add a term of the caller.
/// [`gradient_error`] checks its force.
///
/// # Validation
/// `val_circle_in_a_trap_shrinks_as_its_closed_form`, `val_cut_circle_in_a_weak_trap` add one from outside this crate.
pub trait EnergyTerm: Send {
    /// Name used in the ledger and in tables: lower case letters, digits and `_`.
    fn name(&self) -> &'static str;

    /// Whether its energy counts as stored.
    fn kind(&self) -> EnergyKind {
        EnergyKind::Elastic
    }

    /// Energy per area at a state, in E_b h.
    fn energy(&self, at: At<'_>) -> f64;

    /// Adds −∂e/∂x and −∂e/∂θ to the force, and returns the energy per area, in E_b h. Called at every step, so it should not
    /// allocate.
    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64;

    /// Adds a positive semidefinite part of ∂²e/∂x² (Gauss–Newton). The integrator keeps its order with any matrix; a good one
    /// allows long steps.
    fn add_stiffness(&self, at: At<'_>, stiffness: &mut Stiffness);

    /// Adds the energy per area and length at each vertex, in E_b: summed with the arclengths of the vertices it gives the
    /// energy. Called for elastic terms only.
    fn add_density(&self, at: At<'_>, density: &mut [f64]);
}
