//! Shared ground of the topological batteries: units, curve geometry, integrators, step control, ledger, observers, checkpoints.

mod check;
mod control;
mod curve;
mod discharge;
mod error;
mod integrate;
mod ledger;
mod observe;
mod simulation;
mod sparse;

pub use check::{
    InvalidValue, finite, finite_difference_gradient, in_range, non_negative, positive,
};
pub use control::{Rejection, RejectionCounts, StepControl};
pub use curve::{Polyline, average_crossing_number, writhe};
pub use discharge::{DischargeCurve, DischargeError};
pub use error::{CurveError, SparseError};
pub use integrate::{
    Counters, GAMMA_L_STABLE_LARGE, GAMMA_L_STABLE_SMALL, LinearlyImplicit, Model, Ros2w,
    SpectralBound, Stepper, Trial, max_norm,
};
pub use ledger::{CompensatedSum, EnergyEvent, Ledger};
pub use observe::{Observer, Sample, Schedule, Scheduled};
pub use simulation::{Interrupt, Simulation, StopCondition, StopReason};
pub use sparse::SparseCholesky;
