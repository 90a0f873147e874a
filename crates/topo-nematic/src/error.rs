//! What can be wrong with a nematic battery before a run starts.

use thiserror::Error;
use topo_core::{FileError, InvalidValue};

use crate::GridError;

/// A nematic, its grid, its particle or its protocol is invalid.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NematicError {
    /// A number is out of its range.
    #[error(transparent)]
    Value(#[from] InvalidValue),
    /// The grid is invalid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// There is no positive order at which the bulk energy is stationary.
    #[error(
        "A = {a}, B = {b}, C = {c} have no nematic phase (B^2 < 24 A C, or no positive order): change them, or give the surface order"
    )]
    NoNematicPhase {
        /// A, in L/ξ_N².
        a: f64,
        /// B, in L/ξ_N².
        b: f64,
        /// C, in L/ξ_N².
        c: f64,
    },
    /// The particle leaves no room to a wall or to its image.
    #[error(
        "a particle of radius {radius} leaves a gap of {gap} along axis {axis}, whose cell is {extent} long: use a smaller particle or a larger cell (two spacings at least)"
    )]
    ParticleTooLarge {
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// Its radius, in ξ_N.
        radius: f64,
        /// Length of the box along the axis, in ξ_N.
        extent: f64,
        /// What is left, in ξ_N.
        gap: f64,
    },
    /// The particle is smaller than the grid can show.
    #[error(
        "a particle of radius {radius} is not resolved by a spacing of {spacing}: the radius must be at least two spacings"
    )]
    ParticleTooCoarse {
        /// Its radius, in ξ_N.
        radius: f64,
        /// The spacing, in ξ_N.
        spacing: f64,
    },
    /// The spacing does not resolve the core of a defect.
    #[error(
        "a spacing of {spacing} is too coarse for defect cores of size {correlation_length}: use at most {limit}"
    )]
    SpacingTooCoarse {
        /// The spacing, in ξ_N.
        spacing: f64,
        /// Correlation length of the material, in the unit of the spacing.
        correlation_length: f64,
        /// The largest spacing accepted, in the same unit.
        limit: f64,
    },
    /// The run would need more memory than allowed.
    #[error(
        "a grid of {cells:?} cells needs about {needed} bytes, but only {limit} are allowed: use a larger spacing, single precision or a higher limit"
    )]
    TooMuchMemory {
        /// Cells along each axis.
        cells: [usize; 3],
        /// Estimate for the run, in bytes.
        needed: u64,
        /// What is allowed, in bytes.
        limit: u64,
    },
    /// Tables or fields of the wrong length.
    #[error("{what} has {found} entries instead of {expected}")]
    Length {
        /// Which one.
        what: &'static str,
        /// How many entries it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// The operation needs a particle, and there is none.
    #[error("{operation} needs a particle: give one, or leave it out")]
    NoParticle {
        /// The operation.
        operation: &'static str,
    },
    /// A field holds NaN or infinity.
    #[error("{what} is not finite at cell {cell}: check the input")]
    NotFinite {
        /// Which field.
        what: &'static str,
        /// Index of the cell.
        cell: usize,
    },
    /// Values were given for a periodic face.
    #[error("axis {axis} is periodic and has no outer faces: use walls at the sides")]
    PeriodicFace {
        /// 0, 1, 2 for x, y, z.
        axis: usize,
    },
    /// The relaxation diverged.
    #[error(
        "the field is no longer finite after {step} steps: use a smaller spacing or less extreme constants"
    )]
    Diverged {
        /// Steps taken.
        step: u64,
    },
    /// The flow could not be set up or solved.
    #[error(transparent)]
    Flow(#[from] crate::stokes::StokesError),
    /// A checkpoint could not be written or read.
    #[error(transparent)]
    File(#[from] FileError),
}
