//! What charges and discharges leave behind: reports, samples, the final state.

use std::fmt;

use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize};
use topo_core::PhaseExtension;

pub use super::minimum::MinimumReport;
pub use topo_core::MinimumState;

use crate::EnergyParts;
use crate::flow::FlowCounters;
use crate::memory::ByteAccount;
use crate::order::OrderParameter;
use crate::ring::Ring;

/// Channels by which energy is dissipated, as tables name them.
pub(crate) const CHANNELS: [&str; 2] = ["rotation", "viscous"];

/// Why a charge ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ChargeStop {
    /// The molecular field is below the tolerance.
    Converged,
    /// The limit of steps was reached.
    StepLimit,
    /// It was interrupted.
    Interrupted,
    /// It was not relaxed: the state was given by the caller.
    Adopted,
}

impl fmt::Display for ChargeStop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Converged => "converged",
            Self::StepLimit => "step-limit",
            Self::Interrupted => "interrupted",
            Self::Adopted => "adopted",
        })
    }
}

/// How a charge went.
#[derive(Debug, Clone, Serialize)]
pub struct ChargeReport {
    /// Why it ended.
    pub stop: ChargeStop,
    /// Tilt of the start field that led to the state kept, in radians.
    pub seed: f64,
    /// Steps of the relaxation, over all start fields.
    pub n_steps: u64,
    /// Root mean square of the molecular field at the end, in L/ξ_N².
    pub rms_field: f64,
    /// Energy by part, in L ξ_N.
    pub energy: EnergyParts,
    /// Order parameter of buckling.
    pub order: OrderParameter,
    /// Whether the state is a minimum, which files keep separately; none when the relaxation was not finished, or when the
    /// lowest mode was not found.
    #[serde(skip)]
    pub minimum: Option<MinimumReport>,
    /// Processor time of the calling thread, in seconds.
    pub cpu_seconds: f64,
    /// Bytes by component.
    pub bytes: ByteAccount,
}

impl ChargeReport {
    /// Whether it converged.
    pub fn is_converged(&self) -> bool {
        self.stop == ChargeStop::Converged
    }
}

/// How the final state was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FinalSource {
    /// The uniform nematic along the plates' director is in equilibrium: F = 0.
    Uniform,
    /// The switched state, relaxed under the anchoring and field after the switch.
    Relaxed,
    /// As `Relaxed`, but the relaxation did not converge: the energy is an upper bound.
    Unconverged,
}

impl FinalSource {
    /// As tables name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Relaxed => "relaxed",
            Self::Unconverged => "unconverged",
        }
    }
}

/// The state of equilibrium under the anchoring and field after a switch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FinalState {
    /// Its energy, in L ξ_N.
    pub energy: f64,
    /// How it was found.
    pub source: FinalSource,
}

/// The nematic at one output time of a discharge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NematicSample {
    /// Time since the switch, in τ_N.
    pub time: f64,
    /// Energy by part, in L ξ_N.
    pub energy: EnergyParts,
    /// Dissipated so far by rotation and by viscosity, in L ξ_N.
    pub dissipated: [f64; 2],
    /// Order parameter.
    pub order: OrderParameter,
    /// The defect ring, while there is one.
    pub ring: Option<Ring>,
    /// Largest speed, in ξ_N/τ_N; none without flow.
    pub max_speed: Option<f64>,
    /// Correlation of the velocity with the first one sampled, ⟨u(t)·u(t_1)⟩/(‖u(t)‖ ‖u(t_1)‖) over the fluid: below zero the
    /// flow has reversed; none without flow.
    pub flow_correlation: Option<f64>,
}

/// The work of the flow of a discharge.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FlowReport {
    /// Name of the solver.
    pub solver: &'static str,
    /// Its counters.
    pub counters: FlowCounters,
    /// Largest speed at any update, in ξ_N/τ_N.
    pub max_speed: f64,
    /// Largest velocity left on the particle's boundary at any update, relative to that without the particle.
    pub boundary_residual: f64,
}

/// What only a nematic reports of a discharge.
#[derive(Debug, Clone)]
pub struct NematicPhase {
    /// Bytes by component.
    pub bytes: ByteAccount,
    /// Passes over the field for the second elastic constant, since the run began or was resumed.
    pub n_second_passes: u64,
    /// The flow; none if none was modelled.
    pub flow: Option<FlowReport>,
}

impl PhaseExtension for NematicPhase {
    fn n_bytes(&self) -> u64 {
        self.bytes.total()
    }

    fn write_after<M: SerializeMap>(&self, cpu_seconds: f64, map: &mut M) -> Result<(), M::Error> {
        map.serialize_entry("bytes", &self.bytes)?;
        map.serialize_entry("n_second_passes", &self.n_second_passes)?;
        map.serialize_entry("cpu_seconds", &cpu_seconds)?;
        match &self.flow {
            Some(flow) => map.serialize_entry("flow", flow),
            None => Ok(()),
        }
    }
}

/// Counters and guards of a discharge: times in τ_N, energies in L ξ_N.
pub type PhaseReport = topo_core::PhaseReport<NematicPhase>;

/// What a discharge leaves behind: times in τ_N, energies in L ξ_N.
pub type RunRecord = topo_core::RunRecord<NematicSample, NematicPhase>;
