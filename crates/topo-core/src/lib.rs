//! Shared ground of the topological batteries: units, curve geometry, integrators, step control, ledger, observers, checkpoints.
//!
//! Reading order: `curve` (what is deformed), `integrate` (what a model offers and how it is advanced), `control`, `stepping`
//! and `simulation` (the loop, which always ends), `ledger` and `observe` (what is recorded of a run), `hooks` (what a caller
//! attaches to it), `discharge` and `phase` (what a battery produces), `file`, `checkpoint` and `snapshot` (what stays on
//! disk), `check` (validators, and the finite differences that every energy is tested with).
//!
//! Only `units` knows units: inside, a rod's radius, bending modulus and viscosity are 1, and SI values enter and leave through
//! [`RodUnits`]. Points are nalgebra's vectors, re-exported as [`Vector3`]: a caller does not need the same version of
//! nalgebra.

/// The vectors that everything here takes and gives.
pub use nalgebra;

mod check;
mod checkpoint;
mod control;
mod cpu;
mod curve;
mod discharge;
mod error;
mod file;
mod hooks;
mod integrate;
mod ledger;
mod minimum;
mod observe;
mod phase;
mod simulation;
mod snapshot;
mod stepping;
mod stop;
mod units;

pub use check::{
    InvalidValue, finite, finite_difference_gradient, in_range, non_negative, positive,
};
pub use checkpoint::{
    case_identity, checkpoint_bytes, load_checkpoint, parse_checkpoint, save_checkpoint,
};
pub use control::{Rejection, RejectionCounts, StepControl};
pub use cpu::CpuClock;
pub use curve::{
    Polyline, Thickness, average_crossing_number, closest_points, distance_between, linking,
    thickness, thickness_brute_force, thickness_of_all, thickness_of_all_brute_force,
    vertex_radius, windowed_half_distance, writhe,
};
pub use discharge::{DischargeCurve, DischargeError};
pub use error::CurveError;
pub use file::{FileError, write_atomic, write_atomic_bytes};
pub use hooks::{MOST_COUNTED, Phase, Progress, RunHooks};
pub use integrate::{
    Counters, Fire, FireStep, FireSums, GAMMA_L_STABLE_LARGE, GAMMA_L_STABLE_SMALL,
    LinearlyImplicit, Model, Rkc2, Rkc2Stage, Rkc2Stages, RosenbrockW, SpectralBound, Stepper,
    StepperMemory, Trial, max_norm,
};
pub use ledger::{CompensatedSum, EnergyEvent, Ledger};
pub use minimum::MinimumState;
pub use nalgebra::Vector3;
pub use observe::{Observer, Sample, Schedule, Scheduled};
pub use phase::{PhaseExtension, PhaseReport, RunRecord};
pub use simulation::{Simulation, SimulationMemory, StopCondition};
pub use snapshot::Snapshot;
pub use stepping::{Advance, TimeStepping};
pub use stop::{Interrupt, StopReason};
pub use units::{
    RodMaterial, RodUnits, SILICONE, bending_time, energy_over_reference, energy_per_mass,
    reference_energy, reference_time, twist_time,
};
