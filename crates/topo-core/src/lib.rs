//! Shared ground of the topological batteries: units, curve geometry, integrators, step control, ledger, observers, checkpoints.

mod check;
mod control;
mod curve;
mod error;
mod integrate;
mod ledger;
mod sparse;

pub use check::{
    InvalidValue, finite, finite_difference_gradient, in_range, non_negative, positive,
};
pub use control::Rejection;
pub use curve::{Polyline, average_crossing_number, writhe};
pub use error::{CurveError, SparseError};
pub use integrate::{Counters, LinearlyImplicit, Model, SpectralBound, Stepper, Trial, max_norm};
pub use ledger::{CompensatedSum, EnergyEvent, Ledger};
pub use sparse::SparseCholesky;
