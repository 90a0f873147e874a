//! Charging: the twisted rod relaxes with its ends fused.

use serde::{Deserialize, Serialize};
use topo_core::{Interrupt, Schedule, Scheduled, StopReason, positive};

use super::record::{CurveRecorder, RunRecord, SampleRecorder, Scales};
use super::{RodBattery, RodSimulation};
use crate::{Ends, RodError, RodState};

/// How long a rod is charged and how often it is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ChargeSettings {
    /// Duration of the relaxation, in T_0: long enough to reach the buckled plateau, short enough that instabilities of that
    /// plateau which grow from rounding errors alone (rates of about 2 per T_0 at high twist) do not decide the state.
    pub duration: f64,
    /// First output time after the start, in T_0.
    pub first_output: f64,
    /// Output times a decade.
    pub outputs_per_decade: f64,
}

impl Default for ChargeSettings {
    fn default() -> Self {
        Self {
            duration: 2.0,
            first_output: 1e-2,
            outputs_per_decade: 8.0,
        }
    }
}

impl ChargeSettings {
    /// Checks every number.
    ///
    /// # Errors
    /// Names the first value out of range and what would be right.
    pub fn checked(self) -> Result<Self, RodError> {
        positive("charge.duration", self.duration)?;
        positive("charge.first_output", self.first_output)?;
        positive("charge.outputs_per_decade", self.outputs_per_decade)?;
        Ok(self)
    }
}

/// A charged battery: the relaxed closed rod, and how it got there.
#[derive(Debug, Clone)]
pub struct ChargedRod {
    battery: RodBattery,
    state: RodState,
    density: Vec<f64>,
    record: RunRecord,
}

impl RodBattery {
    /// Lets the twisted closed rod relax.
    ///
    /// A run that cannot go on keeps what it has and says why in the report.
    ///
    /// # Errors
    /// A setting out of range, or a start curve that has no finite energy.
    pub fn charge(
        &self,
        settings: &ChargeSettings,
        interrupt: &Interrupt,
    ) -> Result<ChargedRod, RodError> {
        settings.checked()?;
        let state = self.start.clone();
        let mut model = self.model(&state, Ends::default())?;
        model.start(&state)?;
        let scales = Scales::of(&state);
        let parts = model.parts().clone();
        let mut simulation = RodSimulation::new(model, state, &self.accuracy, interrupt)?;
        let mut curve = CurveRecorder::new(scales, &parts);
        let has_twist = self.parameters.twist.is_some();
        let mut samples = SampleRecorder::new(scales, self.tube, has_twist, &parts);
        let until = settings.duration * scales.time;
        let outputs = Schedule::log_spaced(
            settings.first_output * scales.time,
            settings.outputs_per_decade,
        )?;
        let mut stop = {
            let (mut see_step, mut see_sample) = (
                |s: &topo_core::Sample<'_, RodState>| curve.record(s),
                |s: &topo_core::Sample<'_, RodState>| samples.record(s),
            );
            let mut observers = [
                Scheduled::new(Schedule::always(), &mut see_step),
                Scheduled::new(outputs, &mut see_sample),
            ];
            simulation.run(until, &mut observers, &mut |_| None)
        };
        samples.record(&simulation.sample());
        if let Some(drift) = samples.link_drift.filter(|d| *d > self.guards.link_drift) {
            tracing::error!(drift, "the linking number of a closed rod has drifted");
            stop = StopReason::Failed {
                why: topo_core::Rejection::Fatal {
                    what: "Tw + Wr of the closed rod drifted: strands have crossed",
                },
            };
        }
        let record = RunRecord::new(&simulation, stop, curve, samples);
        let density = self.energy_density(simulation.state());
        Ok(ChargedRod {
            battery: self.clone(),
            state: simulation.into_state(),
            density,
            record,
        })
    }
}

impl ChargedRod {
    /// The battery it was made from.
    pub fn battery(&self) -> &RodBattery {
        &self.battery
    }

    /// The closed rod.
    pub fn state(&self) -> &RodState {
        &self.state
    }

    /// Elastic energy density at each vertex, per area, in E_b.
    pub fn density(&self) -> &[f64] {
        &self.density
    }

    /// How it was charged.
    pub fn record(&self) -> &RunRecord {
        &self.record
    }
}
