//! Errors of the flow solvers.

use thiserror::Error;
use topo_core::InvalidValue;
use topo_sparse::SparseError;

/// Why a flow could not be set up or solved.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum StokesError {
    /// The spectral solver needs periodic x and y.
    #[error(
        "the spectral flow solver needs periodic sides, but axis {axis} has walls: choose the sparse solver"
    )]
    Walls {
        /// 0 or 1 for x, y.
        axis: usize,
    },
    /// A body force, but no wall or particle that could balance it.
    #[error(
        "a body force accelerates a fully periodic fluid without end: prescribe mean_velocity instead, or use walls"
    )]
    Unbalanced,
    /// A mean velocity where walls already determine it.
    #[error(
        "mean_velocity is free only where all sides are periodic: use body_force or moving walls"
    )]
    MeanVelocity,
    /// A wall that moves along its normal, or where there is none.
    #[error(
        "the velocity of the {side} wall along axis {axis} must be tangential, and zero where the sides are periodic"
    )]
    WallVelocity {
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// `lower` or `upper`.
        side: &'static str,
    },
    /// Too much memory.
    #[error(
        "the flow needs about {estimate} bytes of memory, more than the limit of {limit}: use a coarser grid or raise the limit"
    )]
    Memory {
        /// Bytes it would take.
        estimate: u64,
        /// Bytes it may take.
        limit: u64,
    },
    /// An iteration that did not reach its tolerance.
    #[error(
        "{what} stopped at residual {residual:.1e} above the tolerance {tolerance:.1e} after {n_iterations} iterations: relax the tolerance"
    )]
    NotConverged {
        /// Which iteration.
        what: &'static str,
        /// Relative residual reached.
        residual: f64,
        /// Relative residual requested.
        tolerance: f64,
        /// Iterations done.
        n_iterations: usize,
    },
    /// A force is NaN or infinite.
    #[error(
        "the force on the fluid is not finite: the order parameter field that made it is broken"
    )]
    NotFinite,
    /// The particle covers no face.
    #[error(
        "a particle of radius {radius} covers no cell face at spacing {spacing}: refine the grid"
    )]
    ParticleTooSmall {
        /// Hydrodynamic radius, in ξ_N.
        radius: f64,
        /// Grid spacing, in ξ_N.
        spacing: f64,
    },
    /// A parameter outside its domain.
    #[error(transparent)]
    Value(#[from] InvalidValue),
    /// The coarsest level could not be factorised.
    #[error(transparent)]
    Sparse(#[from] SparseError),
}
