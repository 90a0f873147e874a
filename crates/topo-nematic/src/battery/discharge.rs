//! Discharging: the nematic relaxes in time after the switch.
//!
//! Reading order: `model` (kernel, `ramp` and `flow`, and the account of the energy), `system` (the model with
//! `crate::stabilised`, the integrator, which holds the field), `observer` (what is recorded), `run` (the loop), `resume` (what
//! a checkpoint keeps). Steps are made by [`topo_core::TimeStepping`], as those of rods; it is not a [`topo_core::Simulation`],
//! whose models give rates as flat vectors in double precision: this one computes them within the stages, and its flow sees
//! every trial.

mod flow;
mod flow_direction;
mod model;
mod observer;
mod ramp;
mod resume;
mod run;
mod system;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::{StopReason, finite, in_range, positive};

use super::hooks::RunHooks;
use super::record::FinalState;
use super::record::RunRecord;
use super::switch::SwitchedNematic;
use crate::{FlowParameters, NematicError, NematicState, Precision};

/// How far a discharge is followed and how often it is sampled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DischargeSettings {
    /// The run ends when this share of the stored energy is released: of the energy after the switch, above that of the final
    /// state.
    #[schemars(range(min = 1e-6, max = 0.999_999_999), extend("x-unit" = "1"), example = 0.99)]
    pub until_released: f64,
    /// Longest time followed, in R²/(Γ L).
    #[schemars(extend("x-unit" = "R²/(Γ L)", "exclusiveMinimum" = 0), example = 5.0)]
    pub longest: f64,
    /// First output time after the switch, in R²/(Γ L).
    #[schemars(extend("x-unit" = "R²/(Γ L)", "exclusiveMinimum" = 0), example = 1e-3)]
    pub first_output: f64,
    /// Output times per decade.
    #[schemars(range(min = 1e-3, max = 1e6), extend("x-unit" = "1"), example = 16.0)]
    pub outputs_per_decade: f64,
    /// Order below which a cell belongs to the defect ring.
    #[schemars(extend("x-unit" = "1"), example = 0.3)]
    pub ring_threshold: f64,
    /// The flow; leave it out and none is modelled.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(skip)]
    pub flow: Option<FlowParameters>,
}

impl Default for DischargeSettings {
    fn default() -> Self {
        Self {
            until_released: 0.9995,
            longest: 10.0,
            first_output: 1e-4,
            outputs_per_decade: 8.0,
            ring_threshold: 0.35,
            flow: None,
        }
    }
}

impl DischargeSettings {
    /// Checks every number but those of the flow.
    ///
    /// # Errors
    /// Names the first value out of range and what would be right.
    pub fn check(&self) -> Result<(), NematicError> {
        in_range(
            "discharge.until_released",
            self.until_released,
            1e-6,
            1.0 - 1e-9,
        )?;
        positive("discharge.longest", self.longest)?;
        positive("discharge.first_output", self.first_output)?;
        in_range(
            "discharge.outputs_per_decade",
            self.outputs_per_decade,
            1e-3,
            1e6,
        )?;
        finite("discharge.ring_threshold", self.ring_threshold)?;
        Ok(())
    }
}

/// A discharge: what the switch removed, and how the rest was released.
#[derive(Debug, Clone)]
pub struct Discharge {
    /// Energy that the switch itself removed, in L ξ_N.
    pub removed: f64,
    /// Energy just after the switch, in L ξ_N.
    pub start: f64,
    /// The state of equilibrium after the switch: released shares count from `start` to its energy.
    pub final_state: FinalState,
    /// Energy that can be released, `start` minus the final energy, in L ξ_N; none where nothing is stored.
    pub stored: Option<f64>,
    /// The run.
    pub record: RunRecord,
    /// The last state.
    pub state: NematicState,
}

impl Discharge {
    /// Whether the requested share was released.
    pub fn is_finished(&self) -> bool {
        matches!(self.record.report.stop, StopReason::Condition(_))
    }
}

impl SwitchedNematic {
    /// Follows the nematic after the switch.
    ///
    /// The run ends when the requested share of the energy above the [final state](Self::final_state) is released. With moving
    /// plates or body forces, and with nothing stored, it ends at its longest time.
    ///
    /// # Errors
    /// A setting out of range, a flow that cannot be found at the start, or a checkpoint that cannot be used.
    pub fn discharge(
        &self,
        settings: &DischargeSettings,
        hooks: &mut RunHooks<'_>,
    ) -> Result<Discharge, NematicError> {
        settings.check()?;
        let end = self.final_state(hooks)?;
        match self.charged.battery.accuracy.precision {
            Precision::Double => self.discharge_in::<f64>(settings, end, hooks),
            Precision::Single => self.discharge_in::<f32>(settings, end, hooks),
        }
    }
}

#[cfg(test)]
mod tests;
