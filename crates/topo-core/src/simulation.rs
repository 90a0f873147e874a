//! The loop that carries a model through time.

mod memory;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use crate::control::{Rejection, RejectionCounts, StepControl};
use crate::integrate::{Counters, Model, Stepper};
use crate::ledger::Ledger;
use crate::observe::{Sample, Scheduled};

pub use memory::SimulationMemory;

/// Why a run ended: a value, not an error, since a run that stops early is still a run.
#[derive(Clone, Debug, PartialEq, Serialize, thiserror::Error)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StopReason {
    /// The requested time was reached.
    #[error("reached the requested time")]
    ReachedTime,
    /// The caller's condition was met.
    #[error("condition met: {0}")]
    Condition(String),
    /// The step would have to be shorter than allowed.
    #[error("step {dt:.3e} is too small to go on; last refusal: {last}")]
    StepTooSmall {
        /// Length of the last step tried.
        dt: f64,
        /// Why it was refused.
        last: Rejection,
    },
    /// The limit of trial steps was reached.
    #[error("limit of {n} trial steps reached")]
    StepLimit {
        /// The limit.
        n: u64,
    },
    /// An interrupt was requested.
    #[error("interrupted")]
    Interrupted,
    /// The run is broken and no smaller step helps.
    #[error("failed: {why}")]
    Failed {
        /// What is broken.
        why: Rejection,
    },
}

impl StopReason {
    /// Short name, for reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::ReachedTime => "reached-time",
            Self::Condition(_) => "condition",
            Self::StepTooSmall { .. } => "step-too-small",
            Self::StepLimit { .. } => "step-limit",
            Self::Interrupted => "interrupted",
            Self::Failed { .. } => "failed",
        }
    }

    /// Whether the run ended as asked: at its time or by its condition.
    pub fn is_success(&self) -> bool {
        matches!(self, Self::ReachedTime | Self::Condition(_))
    }
}

/// A token by which another thread (or a signal handler) asks runs to stop after their present step.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// A token that nobody has used yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks all holders of this token to stop.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether someone asked.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// A condition that ends a run: gives the reason when met.
pub type StopCondition<'a, S> = dyn FnMut(&Sample<'_, S>) -> Option<String> + 'a;

/// A model, its state and the method that advances it.
///
/// Every run ends: by its time, its condition, an interrupt, the shortest step or the limit of trial steps.
///
/// # Validation
/// `decays_as_it_should`, `every_way_to_stop`
#[derive(Clone, Debug)]
pub struct Simulation<M: Model, S> {
    model: M,
    state: M::State,
    candidate: M::State,
    stepper: S,
    control: StepControl,
    interrupt: Interrupt,
    time: f64,
    last_dt: f64,
    n_steps: u64,
    /// Trial steps of the present run.
    n_trials: u64,
    rejections: RejectionCounts,
    no_ledger: Ledger,
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
            control,
            interrupt: Interrupt::new(),
            time: 0.0,
            last_dt: 0.0,
            n_steps: 0,
            n_trials: 0,
            rejections: RejectionCounts::default(),
            no_ledger: Ledger::default(),
        }
    }

    /// The same simulation, which stops between two steps when `interrupt` asks.
    pub fn with_interrupt(mut self, interrupt: Interrupt) -> Self {
        self.interrupt = interrupt;
        self
    }

    /// Runs until `until`, `stop` or trouble; each observer sees the state whenever its schedule is due, also at the start.
    ///
    /// The last step ends at `until` to the bit. `stop` is asked at the start and after every accepted step.
    pub fn run(
        &mut self,
        until: f64,
        observers: &mut [Scheduled<'_, M::State>],
        stop: &mut StopCondition<'_, M::State>,
    ) -> StopReason {
        self.n_trials = 0;
        loop {
            if let Some(reason) = self.advance(until, observers, stop) {
                return reason;
            }
        }
    }

    /// One turn of [`run`](Self::run): shows the present state, and makes an accepted step unless the run is over; gives the reason
    /// then. What is [remembered](Self::memory) between two turns leads to the same steps.
    ///
    /// Trial steps are counted on since the start or the last [change](Self::modify).
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
        let before_the_end = self.time < until;
        if !before_the_end {
            return Some(StopReason::ReachedTime);
        }
        if self.interrupt.is_requested() {
            return Some(StopReason::Interrupted);
        }
        let exact = observers.iter().filter_map(|o| o.schedule().next_exact());
        let target = exact.filter(|t| *t > self.time).fold(until, f64::min);
        self.step_towards(target)
    }

    /// Makes one accepted step that does not pass `target`, or says why it cannot.
    fn step_towards(&mut self, target: f64) -> Option<StopReason> {
        let longest = match self.stepper.longest_step(&mut self.model, &self.state) {
            Ok(dt) => dt,
            Err(why) => return Some(StopReason::Failed { why }),
        };
        let mut dt = self
            .control
            .dt()
            .min(longest)
            .min(self.model.longest_step());
        loop {
            if self.n_trials >= self.control.max_trials() {
                return Some(StopReason::StepLimit { n: self.n_trials });
            }
            self.n_trials += 1;
            let remaining = target - self.time;
            // Two equal steps at the end are better than a long one and a sliver.
            let lands = dt >= remaining * (1.0 - 1e-9);
            let trial_dt = if lands {
                remaining
            } else {
                dt.min(0.5 * remaining)
            };
            let time = if lands { target } else { self.time + trial_dt };
            let why = match self.try_step(trial_dt) {
                Ok(_) if time <= self.time => Rejection::Domain {
                    what: "the step is lost in the rounding of the time",
                },
                Ok(error) => {
                    self.accept(time, trial_dt, error);
                    return None;
                }
                Err(why) => why,
            };
            self.rejections.add(&why);
            if matches!(why, Rejection::Fatal { .. }) {
                return Some(StopReason::Failed { why });
            }
            let error_order = self.stepper.error_order();
            match self.control.reject(trial_dt, &why, error_order) {
                Some(shorter) => dt = shorter,
                None => {
                    return Some(StopReason::StepTooSmall {
                        dt: trial_dt,
                        last: why,
                    });
                }
            }
        }
    }

    /// Tries one step and asks all guards.
    fn try_step(&mut self, dt: f64) -> Result<f64, Rejection> {
        let trial = self
            .stepper
            .step(&mut self.model, &self.state, dt, &mut self.candidate)?;
        self.control.judge(trial.error)?;
        self.model.check(
            &self.state,
            &self.candidate,
            self.stepper.displacement(),
            dt,
        )?;
        Ok(trial.error)
    }

    fn accept(&mut self, time: f64, dt: f64, error: f64) {
        self.model.accepted(
            &self.state,
            &self.candidate,
            self.stepper.displacement(),
            dt,
        );
        self.stepper.accepted();
        std::mem::swap(&mut self.state, &mut self.candidate);
        self.control.accept(dt, error, self.stepper.error_order());
        self.time = time;
        self.last_dt = dt;
        self.n_steps += 1;
    }

    /// What observers would see now.
    pub fn sample(&self) -> Sample<'_, M::State> {
        Sample {
            time: self.time,
            step: self.n_steps,
            dt: self.last_dt,
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
        self.n_trials = 0;
        result
    }

    /// Step control.
    pub fn control(&self) -> &StepControl {
        &self.control
    }

    /// Step control, to be changed between runs.
    pub fn control_mut(&mut self) -> &mut StepControl {
        &mut self.control
    }

    /// Time reached.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Accepted steps so far.
    pub fn n_steps(&self) -> u64 {
        self.n_steps
    }

    /// Refused steps so far, by name.
    pub fn rejections(&self) -> &RejectionCounts {
        &self.rejections
    }

    /// Work done by the integrator so far.
    pub fn counters(&self) -> Counters {
        self.stepper.counters()
    }

    /// Gives model and state away.
    pub fn into_parts(self) -> (M, M::State) {
        (self.model, self.state)
    }
}

#[cfg(test)]
mod tests;
