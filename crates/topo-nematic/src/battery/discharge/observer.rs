//! Observers of a discharge: the energies at every step, the nematic at output times.

use topo_core::{DischargeCurve, InvalidValue, Sample, Schedule};

use super::DischargeSettings;
use super::flow_direction::FlowDirection;
use super::resume::Unfinished;
use super::system::System;
use crate::NematicState;
use crate::battery::record::NematicSample;
use crate::order::order_parameter;
use crate::real::Real;
use crate::ring::ring;

/// Observer of every step: the energy curve.
pub(super) struct CurveRecorder {
    pub curve: DischargeCurve,
}

impl CurveRecorder {
    pub fn record<T>(&mut self, sample: &Sample<'_, System<'_, T>>) {
        // a run that goes on shows its last state again
        if self
            .curve
            .time()
            .last()
            .is_some_and(|last| sample.time <= *last)
        {
            return;
        }
        let energy = sample.state.model.energy.as_array();
        if let Err(error) = self.curve.push(sample.time, &energy, &dissipated(sample)) {
            tracing::warn!(%error, "a step is missing from the energy curve");
        }
    }
}

fn dissipated<S>(sample: &Sample<'_, S>) -> [f64; 2] {
    [0, 1].map(|channel| sample.ledger.dissipated(channel))
}

/// Observer at output times: the nematic and what is measured on it.
pub(super) struct SampleRecorder {
    pub samples: Vec<NematicSample>,
    pub direction: FlowDirection,
    outputs: Schedule,
    order: f64,
    ring_threshold: f64,
}

impl SampleRecorder {
    /// A recorder that continues from `run`, for a material of order `order`; `unit` is the diffusion time.
    pub fn new(
        settings: &DischargeSettings,
        unit: f64,
        order: f64,
        run: &mut Unfinished,
    ) -> Result<Self, InvalidValue> {
        let mut outputs =
            Schedule::log_spaced(settings.first_output * unit, settings.outputs_per_decade)?;
        if let Some(last) = run.samples.last() {
            // Outputs of the run so far are done.
            outputs.due(last.time, run.steps.n_steps().saturating_sub(1));
        }
        Ok(Self {
            samples: std::mem::take(&mut run.samples),
            direction: std::mem::take(&mut run.direction),
            outputs,
            order,
            ring_threshold: settings.ring_threshold,
        })
    }

    /// Whether an output is due, as it is at the end.
    pub fn is_due<S>(&mut self, sample: &Sample<'_, S>, is_over: bool) -> bool {
        let is_due = self.outputs.due(sample.time, sample.step) || is_over;
        is_due && self.samples.last().is_none_or(|s| s.time < sample.time)
    }

    /// Adds a sample, `state` holding the field of it.
    pub fn record<T: Real>(
        &mut self,
        sample: &Sample<'_, System<'_, T>>,
        state: &NematicState,
    ) -> &NematicSample {
        let model = &sample.state.model;
        let flow = model.flow.as_ref().map(|flow| &flow.coupling);
        let direction = &mut self.direction;
        self.samples.push(NematicSample {
            time: sample.time,
            energy: model.energy,
            dissipated: dissipated(sample),
            order: order_parameter(state, self.order),
            ring: ring(state, self.ring_threshold),
            max_speed: flow.map(|flow| flow.max_speed()),
            flow_correlation: flow.and_then(|f| direction.correlation(f.velocity(), state)),
        });
        &self.samples[self.samples.len() - 1]
    }
}
