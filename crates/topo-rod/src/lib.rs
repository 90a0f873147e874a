//! Kirchhoff rods with twist, stretch, contact and contact friction, and the elastic battery made of them: charge, cut, discharge.
//!
//! Reading order: [`RodParameters`] (what a scene names) → [`RodState`] (degrees of freedom) → the energy terms
//! ([`energy`]) and the mobility ([`viscosity`], [`friction`]) → [`RodModel`] (what an integrator of `topo-core` advances)
//! → [`RodBattery`] (the protocol).
//!
//! Units are reduced: rod radius h = 1, bending modulus E_b = 1, viscosity η = 1, so times are in η/E_b.
//! Energies are *per cross section area*, e = E/A with A = π h², so E/E_0 = π e h/L for E_0 = E_b h² L.
//! [`RodUnits`](topo_core::RodUnits) leads to SI.

mod battery;
mod breaking;
mod circle;
pub mod contact;
mod density;
mod drag;
mod ends;
pub mod energy;
mod error;
pub mod friction;
mod geometry;
mod guard;
mod layout;
mod load;
mod model;
mod newton;
mod parameters;
mod relaxation;
mod state;
pub mod viscosity;

pub use battery::RodBattery;
pub use battery::charge::{ChargeSettings, ChargedRod, Twisting};
pub use battery::cut::{CutCandidate, CutRod, CutSite, cut_candidates};
pub use battery::discharge::{Discharge, DischargeSettings};
pub use battery::hooks::RunHooks;
pub use battery::links::Linking;
pub use battery::protocol::Protocol;
pub use battery::pull::PullSettings;
pub use battery::record::{LoadReport, PhaseReport, RodPhase, RodSample, RunRecord};
pub use breaking::{Breaking, Broken, Criterion};
pub use circle::{cut_circle_energy, cut_circle_time};
pub use density::smoothed_density;
pub use ends::{EndCondition, EndMotion, Ends, Grip, Ramp, RodEnds, TimeCourse};
pub use error::RodError;
pub use geometry::Geometry;
pub use guard::Guards;
pub use layout::{Chain, Layout, Tips};
pub use load::{EndLoad, LoadPlace};
pub use model::{GripForce, RodModel, WorkAccount};
pub use nalgebra::{Matrix3, Vector3};
pub use parameters::{
    Accuracy, ContactParameters, FrictionParameters, FrictionRange, IntegratorKind, Reading,
    RodParameters, Tube,
};
pub use state::{RestShape, RodState};
