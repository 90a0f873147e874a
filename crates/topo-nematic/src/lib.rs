//! Charged nematic colloids: patterned anchoring, a defect ring, its release, its flow.
//!
//! Reading order: [`NematicParameters`] (what a scene names) → [`NematicState`] (the tensor field) → [`NematicBattery`] (the
//! protocol: charge, switch, discharge) → [`record`] (what it returns). What is measured on a field: [`order`], [`defects`],
//! [`ring`], [`surface`]; what it is made of: [`tensor`], [`anchoring`]; the fluid: [`flow`] on top of [`stokes`].
//!
//! Units are reduced: lengths in the nematic correlation length ξ_N, energies in L ξ_N, times in τ_N. Settings and results
//! have public fields; types with an invariant have methods.

pub mod anchoring;
mod battery;
mod boundary;
pub mod defects;
mod directors;
mod domain;
mod energy;
mod error;
pub mod flow;
mod grid;
mod hessian;
mod kernel;
mod material;
pub mod memory;
mod model;
#[cfg(test)]
mod noise;
pub mod order;
mod parameters;
mod particle;
mod real;
mod relax;
pub mod ring;
mod stabilised;
mod state;
pub mod stokes;
pub mod surface;
pub mod tensor;
mod vector;

pub use anchoring::{Anchoring, SurfacePattern};
pub use battery::NematicBattery;
pub use battery::charge::ChargedNematic;
pub use battery::charge_settings::ChargeSettings;
pub use battery::discharge::{Discharge, DischargeSettings};
pub use battery::hooks::RunHooks;
pub use battery::protocol::Protocol;
pub use battery::record;
pub use battery::switch::{SwitchSettings, SwitchTarget, SwitchedNematic};
pub use boundary::{Boundary, FreeSurface};
pub use energy::EnergyParts;
pub use error::NematicError;
pub use flow::FlowParameters;
pub use grid::{Faces, Grid, GridError};
pub use kernel::run::Threads;
pub use material::Material;
pub use parameters::{ExternalField, NematicAccuracy, NematicParameters, Sides};
pub use particle::Particle;
pub use real::Precision;
pub use state::NematicState;
