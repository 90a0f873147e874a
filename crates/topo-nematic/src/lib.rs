//! Charged nematic colloids: patterned anchoring, a defect ring, its release, its flow.
//!
//! Units are reduced: lengths in the nematic correlation length xi_N, energies in L xi_N, times in tau_N.

mod anchoring;
mod battery;
mod boundary;
mod defects;
mod directors;
mod domain;
mod energy;
mod error;
mod flow;
mod grid;
mod hessian;
mod kernel;
mod material;
mod memory;
mod model;
#[cfg(test)]
mod noise;
mod order;
mod parameters;
mod particle;
mod real;
mod relax;
mod ring;
mod stabilised;
mod state;
mod stokes;
mod surface;
mod tensor;
mod vector;

pub use anchoring::{Anchoring, DirectorTable, Plate, PlateDirector, SurfacePattern};
pub use battery::NematicBattery;
pub use battery::charge::ChargedNematic;
pub use battery::charge_settings::ChargeSettings;
pub use battery::discharge::{Discharge, DischargeSettings};
pub use battery::hooks::RunHooks;
pub use battery::minimum::MinimumReport;
pub use battery::protocol::Protocol;
pub use battery::record::{
    ChargeReport, ChargeStop, FinalSource, FinalState, FlowReport, NematicPhase, NematicSample,
    PhaseReport, RunRecord,
};
pub use battery::switch::{SwitchSettings, SwitchTarget, SwitchedNematic};
pub use boundary::{Boundary, FreeSurface};
pub use defects::{CrossSection, DefectLine, defect_lines, director_field, order_field};
pub use energy::EnergyParts;
pub use error::NematicError;
pub use flow::{FlowCounters, FlowCoupling, FlowParameters, FlowSolver, Stored};
pub use grid::{Faces, Grid, GridError};
pub use kernel::run::Threads;
pub use material::Material;
pub use memory::{ByteAccount, MemoryEstimate, estimate};
pub use order::{OrderParameter, order_parameter};
pub use parameters::{ExternalField, NematicAccuracy, NematicParameters, Sides};
pub use particle::Particle;
pub use real::Precision;
pub use ring::{Ring, is_near_particle, ring, ring_line};
pub use state::NematicState;
pub use stokes::{
    Drive, FaceSites, MacField, NoSlip, NoSlipReport, Sparse, SparseOptions, Spectral, StokesError,
    StokesSolver,
};
pub use surface::{TriangleMesh, VolumeSlice, isosurface, volume_slice};
pub use tensor::{
    N_COMPONENTS, Tensor5, contract, largest_eigenvalue, matrix, order_and_director,
    square_traceless, uniaxial,
};
pub use topo_core::{MinimumState, Phase, Progress};
