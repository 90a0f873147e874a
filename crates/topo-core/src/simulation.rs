//! The loop that carries a model through time.

mod memory;

use crate::control::{Rejection, RejectionCounts, StepControl};
use crate::integrate::{Counters, Model, Stepper};
use crate::ledger::Ledger;
use crate::observe::{Sample, Scheduled};
use crate::stepping::{Advance, TimeStepping};
use crate::stop::{Interrupt, StopReason};

pub use memory::SimulationMemory;

/// A condition that ends a run: gives the reason when met.
pub type StopCondition<'a, S> = dyn FnMut(&Sample<'_, S>) -> Option<String> + 'a;

/// A model, its state and the method that advances it.
///
/// Every run ends: at its time, by its condition, by an interrupt, at the shortest step or at the limit of trial steps.
///
/// # Validation
/// `decays_as_it_should`, `every_way_to_stop`
#[derive(Clone, Debug)]
pub struct Simulation<M: Model, S> {
    model: M,
    state: M::State,
    candidate: M::State,
    stepper: S,
    steps: TimeStepping,
    interrupt: Interrupt,
    no_ledger: Ledger,
}

/// What a simulation advances.
struct System<'a, M: Model, S> {
    model: &'a mut M,
    state: &'a mut M::State,
    candidate: &'a mut M::State,
    stepper: &'a mut S,
}

impl<M: Model, S: Stepper<M>> Advance for System<'_, M, S> {
    fn longest_step(&mut self) -> Result<f64, Rejection> {
        let longest = self.stepper.longest_step(self.model, self.state)?;
        Ok(longest.min(self.model.longest_step()))
    }

    fn try_step(&mut self, _: f64, dt: f64, control: &StepControl) -> Result<f64, Rejection> {
        let trial = self
            .stepper
            .step(self.model, self.state, dt, self.candidate)?;
        control.judge(trial.error)?;
        let step = self.stepper.displacement();
        self.model.check(self.state, self.candidate, step, dt)?;
        Ok(trial.error)
    }

    fn accept(&mut self, dt: f64) {
        let step = self.stepper.displacement();
        self.model.accepted(self.state, self.candidate, step, dt);
        self.stepper.accepted();
        std::mem::swap(self.state, self.candidate);
    }

    fn error_order(&self) -> u32 {
        self.stepper.error_order()
    }
}

impl<M: Model, S: Stepper<M>> Simulation<M, S> {
    /// A simulation of `model` from `state` at time 0.
    pub fn new(model: M, state: M::State, stepper: S, control: StepControl) -> Self {
        let candidate = state.clone();
        Self {
            model,
            state,
            candidate,
            stepper,
            steps: TimeStepping::new(control),
            interrupt: Interrupt::new(),
            no_ledger: Ledger::default(),
        }
    }

    /// The same simulation, which stops between two steps when `interrupt` requests it.
    pub fn with_interrupt(mut self, interrupt: Interrupt) -> Self {
        self.interrupt = interrupt;
        self
    }

    /// Runs until the time `until`, until `stop` returns a reason, or until no step is accepted any more. Each observer sees
    /// the state whenever its schedule is due, also at the start.
    ///
    /// The last step ends at `until` to the bit. `stop` is called at the start and after every accepted step.
    pub fn run(
        &mut self,
        until: f64,
        observers: &mut [Scheduled<'_, M::State>],
        stop: &mut StopCondition<'_, M::State>,
    ) -> StopReason {
        self.steps.restart_trials();
        loop {
            if let Some(reason) = self.advance(until, observers, stop) {
                return reason;
            }
        }
    }

    /// One turn of [`run`](Self::run): shows the present state, and makes an accepted step unless the run is over; gives the reason
    /// then. What is [remembered](Self::memory) between two turns leads to the same steps.
    ///
    /// Trial steps are counted since the start or the last [change](Self::modify).
    pub fn advance(
        &mut self,
        until: f64,
        observers: &mut [Scheduled<'_, M::State>],
        stop: &mut StopCondition<'_, M::State>,
    ) -> Option<StopReason> {
        let sample = self.sample();
        for observer in observers.iter_mut() {
            observer.offer(&sample);
        }
        if let Some(reason) = stop(&sample) {
            return Some(StopReason::Condition(reason));
        }
        // A NaN ends the run as well.
        let before_the_end = self.time() < until;
        if !before_the_end {
            return Some(StopReason::ReachedTime);
        }
        if self.interrupt.is_requested() {
            return Some(StopReason::Interrupted);
        }
        let exact = observers.iter().filter_map(|o| o.schedule().next_exact());
        let target = exact.filter(|t| *t > self.time()).fold(until, f64::min);
        self.step_towards(target).err()
    }

    /// Makes one accepted step that does not pass `target`.
    fn step_towards(&mut self, target: f64) -> Result<(), StopReason> {
        let mut system = System {
            model: &mut self.model,
            state: &mut self.state,
            candidate: &mut self.candidate,
            stepper: &mut self.stepper,
        };
        self.steps.step_towards(target, &mut system)
    }

    /// What observers would see now.
    pub fn sample(&self) -> Sample<'_, M::State> {
        Sample {
            time: self.steps.time(),
            step: self.steps.n_steps(),
            dt: self.steps.last_dt(),
            state: &self.state,
            ledger: self.model.ledger().unwrap_or(&self.no_ledger),
        }
    }

    /// The model.
    pub fn model(&self) -> &M {
        &self.model
    }

    /// The state.
    pub fn state(&self) -> &M::State {
        &self.state
    }

    /// Lets `change` alter model and state together, as a cut does; the integrator then forgets what it knew of the old state.
    pub fn modify<R>(&mut self, change: impl FnOnce(&mut M, &mut M::State) -> R) -> R {
        let result = change(&mut self.model, &mut self.state);
        self.candidate = self.state.clone();
        self.stepper.reset();
        self.steps.restart_trials();
        result
    }

    /// Step control.
    pub fn control(&self) -> &StepControl {
        self.steps.control()
    }

    /// Step control, to be changed between runs.
    pub fn control_mut(&mut self) -> &mut StepControl {
        self.steps.control_mut()
    }

    /// Time reached, in the model's unit.
    pub fn time(&self) -> f64 {
        self.steps.time()
    }

    /// Accepted steps so far.
    pub fn n_steps(&self) -> u64 {
        self.steps.n_steps()
    }

    /// Refused steps so far, by name.
    pub fn rejections(&self) -> &RejectionCounts {
        self.steps.rejections()
    }

    /// Work done by the integrator so far.
    pub fn counters(&self) -> Counters {
        self.stepper.counters()
    }

    /// Returns model and state.
    pub fn into_parts(self) -> (M, M::State) {
        (self.model, self.state)
    }
}

#[cfg(test)]
mod tests;
