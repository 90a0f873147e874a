//! The interface of the flow solvers.

use crate::stokes::{FaceSites, MacField, StokesError};

/// Solves the discrete Stokes equations between walls at rest.
///
/// ```math
/// \eta \nabla_h^2 u - \nabla_h p + f = 0, \qquad \nabla_h \cdot u = 0
/// ```
///
/// On the staggered grid with the 7-point Laplacian: the normal component vanishes on a wall, and the tangential ones are
/// reflected by it (ghost value -u), so that the velocity is second order. The map from f to u is linear, symmetric and positive
/// semi-definite, and moving walls are forces too (see [`Drive`](crate::stokes::Drive)). In a fully periodic box the mean velocity is
/// zero, and the mean force is balanced by a mean pressure gradient.
pub trait StokesSolver: Send + Sync {
    /// Writes the velocity (ξ_N/τ_N) that `force` (per volume, on faces, L/ξ_N³) drives.
    ///
    /// # Errors
    /// [`StokesError::NotConverged`] of an iterative solver.
    fn solve(&mut self, force: &MacField, velocity: &mut MacField) -> Result<(), StokesError>;

    /// Writes the velocities at `sites` that `forces` at these `sites` alone drive: cheaper than a whole field.
    ///
    /// # Errors
    /// As [`solve`](Self::solve).
    fn solve_at(
        &mut self,
        sites: &FaceSites,
        forces: &[f64],
        velocities: &mut [f64],
    ) -> Result<(), StokesError>;

    /// Viscosity η, in 1/Γ.
    fn viscosity(&self) -> f64;

    /// Solves so far: of whole fields, and at sites.
    fn n_solves(&self) -> [u64; 2];

    /// Iterations so far; none in a direct solver.
    fn n_iterations(&self) -> u64 {
        0
    }

    /// Continues counting from what an earlier run had reached.
    fn set_counts(&mut self, n_solves: [u64; 2], n_iterations: u64);

    /// Bytes held.
    fn n_bytes(&self) -> usize;

    /// Name for reports.
    fn name(&self) -> &'static str;
}
