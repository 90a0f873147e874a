//! What a simulation must remember beside model and state, so that it goes on from a checkpoint to the same bits.

use serde::{Deserialize, Serialize};

use super::Simulation;
use crate::control::{RejectionCounts, StepControl};
use crate::hooks::MOST_COUNTED;
use crate::integrate::{Model, Stepper, StepperMemory};

/// Time, step control and the integrator's own memory, between two steps.
///
/// Model and state are remembered by who owns them: a simulation of the remembered model and state, [resumed](Simulation::resumed)
/// with this, takes the same steps as the one that was stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulationMemory {
    pub(super) time: f64,
    pub(super) last_dt: f64,
    pub(super) n_steps: u64,
    pub(super) n_trials: u64,
    pub(super) rejections: RejectionCounts,
    pub(super) control: StepControl,
    pub(super) stepper: StepperMemory,
}

impl SimulationMemory {
    /// Time reached.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// What does not fit a simulation of `n_dof` numbers that begins with `control` and is followed until `until`.
    pub fn flaw(&self, control: &StepControl, until: f64, n_dof: usize) -> Option<&'static str> {
        let n = &self.stepper.counters;
        let counts = [
            self.n_steps,
            self.n_trials,
            n.n_rate_evaluations,
            n.n_factorisations,
            n.n_solves,
            n.n_trials,
        ];
        let rate = self.stepper.rate.iter();
        let is_sound = rate.clone().all(|r| r.len() == n_dof)
            && rate.flatten().all(|x| x.is_finite())
            && self
                .stepper
                .radius
                .is_none_or(|r| r.is_finite() && r >= 0.0);
        if !(0.0..=until).contains(&self.time) || !self.last_dt.is_finite() {
            Some("its time is none of this run")
        } else if !control.leads_to(&self.control) {
            Some("the step control is one of another run")
        } else if !is_sound {
            Some("the integrator's memory is one of another system")
        } else if counts.iter().any(|n| *n >= MOST_COUNTED)
            || self.rejections.iter().any(|(_, n)| n >= MOST_COUNTED)
        {
            Some("a counter is out of range")
        } else {
            None
        }
    }
}

impl<M: Model, S: Stepper<M>> Simulation<M, S> {
    /// What this simulation remembers beside model and state.
    pub fn memory(&self) -> SimulationMemory {
        SimulationMemory {
            time: self.time,
            last_dt: self.last_dt,
            n_steps: self.n_steps,
            n_trials: self.n_trials,
            rejections: self.rejections.clone(),
            control: self.control.clone(),
            stepper: self.stepper.memory(),
        }
    }

    /// The same simulation gone on from what an earlier one remembered, whose model and state it was made of.
    ///
    /// # Validation
    /// `a_resumed_simulation_takes_the_same_steps`
    pub fn resumed(mut self, memory: SimulationMemory) -> Self {
        self.time = memory.time;
        self.last_dt = memory.last_dt;
        self.n_steps = memory.n_steps;
        self.n_trials = memory.n_trials;
        self.rejections = memory.rejections;
        self.control = memory.control;
        self.stepper.recall(memory.stepper, self.model.n_dof());
        self
    }
}
