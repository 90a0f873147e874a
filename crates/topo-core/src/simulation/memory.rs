//! What a simulation must remember beside model and state, so that it continues from a checkpoint to the same bits.

use serde::{Deserialize, Serialize};

use super::Simulation;
use crate::control::StepControl;
use crate::hooks::MOST_COUNTED;
use crate::integrate::{Model, Stepper, StepperMemory};
use crate::stepping::TimeStepping;

/// Time, step control and the integrator's own memory, between two steps.
///
/// Their owner remembers model and state: a simulation of the remembered model and state, [resumed](Simulation::resumed) with
/// this, takes the same steps as the one that was stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SimulationMemory {
    pub(super) steps: TimeStepping,
    pub(super) stepper: StepperMemory,
}

impl SimulationMemory {
    /// Time reached.
    pub fn time(&self) -> f64 {
        self.steps.time()
    }

    /// What does not fit a simulation of `n_dof` numbers that begins with `control` and is followed until `until`.
    pub fn flaw(&self, control: &StepControl, until: f64, n_dof: usize) -> Option<&'static str> {
        let n = &self.stepper.counters;
        let counts = [
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
        if let Some(flaw) = self.steps.flaw(control, until) {
            Some(flaw)
        } else if !is_sound {
            Some("the integrator's memory is one of another system")
        } else if counts.iter().any(|n| *n >= MOST_COUNTED) {
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
            steps: self.steps.clone(),
            stepper: self.stepper.memory(),
        }
    }

    /// The same simulation, continued from what an earlier one with this model and state remembered.
    ///
    /// # Validation
    /// `a_resumed_simulation_takes_the_same_steps`
    pub fn resumed(mut self, memory: SimulationMemory) -> Self {
        self.steps = memory.steps;
        self.stepper.recall(memory.stepper, self.model.n_dof());
        self
    }
}
