//! The energy of a rod as a sum of terms: one struct and one file each behind a small object-safe trait.
//!
//! ```math
//! e = E/A = ½ ∫ [ (κ² + α θ'²)/4 + γ (|x'| − 1)² ] ds + e_contact
//! ```
//!
//! A dynamic call per term is free beside the loop inside it, so a scene that leaves a term out simply has a shorter list.

mod bend;
mod contact;
mod stretch;
mod twist;

#[cfg(test)]
mod tests;

pub use bend::Bend;
pub use contact::ContactEnergy;
pub use stretch::Stretch;
pub use twist::Twist;

use nalgebra::{Matrix3, Vector3};

use crate::contact::ContactPairs;
use crate::{Geometry, RodState};

/// What a term reads.
#[derive(Clone, Copy)]
pub struct At<'a> {
    /// Degrees of freedom.
    pub state: &'a RodState,
    /// Tangents and curvatures of that state.
    pub geometry: &'a Geometry,
    /// Pairs of vertices in reach of each other.
    pub pairs: &'a ContactPairs,
}

/// Generalised force −∂e/∂(x, θ): a vector a vertex, a torque an edge.
#[derive(Debug, Clone, Default)]
pub struct Force {
    /// −∂e/∂x_i, one a vertex.
    pub vertex: Vec<Vector3<f64>>,
    /// −∂e/∂θ_j, one an edge.
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

/// Symmetric block matrix of a rod: 3 × 3 blocks on the diagonal, to the first and second neighbour, and for each pair in contact.
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

/// One term of the energy.
pub trait EnergyTerm: Send {
    /// Name used in the ledger and in tables.
    fn name(&self) -> &'static str;

    /// Energy per area at a state.
    fn energy(&self, at: At<'_>) -> f64;

    /// Adds −∂e/∂x and −∂e/∂θ, and returns the energy.
    fn add_force(&self, at: At<'_>, force: &mut Force) -> f64;

    /// Adds a positive semidefinite part of ∂²e/∂x² (Gauss–Newton). The integrator keeps its order with any matrix; a good one lets it take long steps.
    fn add_stiffness(&self, at: At<'_>, stiffness: &mut Stiffness);
}
