//! What integrators need from a model, and what they return.

mod fire;
mod rkc2;
mod rosenbrock;
#[cfg(test)]
pub(crate) mod testing;

pub use fire::{Fire, FireStep, FireSums};
pub use rkc2::{Rkc2, Rkc2Stage, Rkc2Stages};
pub use rosenbrock::{GAMMA_L_STABLE_LARGE, GAMMA_L_STABLE_SMALL, RosenbrockW};

use serde::{Deserialize, Serialize};

use crate::control::Rejection;
use crate::ledger::Ledger;

/// A system u' = F(u) that integrators can advance.
///
/// Rates, steps and errors are flat vectors of [`n_dof`](Self::n_dof) numbers in the tangent space; the model decides how a
/// step changes the state, so that an update can be an exact retraction where adding numbers is not.
pub trait Model {
    /// Degrees of freedom with their invariants.
    type State: Clone;

    /// Length of rates and steps; constant over a run.
    fn n_dof(&self) -> usize;

    /// Writes F(`state`) to `rate`; F does not depend on time.
    ///
    /// # Errors
    /// A [`Rejection`] when there is no rate at this state.
    fn rate(&mut self, state: &Self::State, rate: &mut [f64]) -> Result<(), Rejection>;

    /// Writes to `to` the state reached from `from` by the finite `step`. Before, `to` holds an unrelated earlier state.
    ///
    /// # Errors
    /// A [`Rejection`] when the step leads out of the domain.
    fn advance(
        &self,
        from: &Self::State,
        step: &[f64],
        to: &mut Self::State,
    ) -> Result<(), Rejection>;

    /// Size of an error vector, in the unit of the tolerance; the largest component by default. NaN must stay NaN.
    fn error_norm(&self, error: &[f64]) -> f64 {
        max_norm(error)
    }

    /// Guards: called once for each candidate step whose error is small enough, before it is accepted.
    ///
    /// # Errors
    /// A [`Rejection`] that names what the step would violate.
    fn check(
        &mut self,
        from: &Self::State,
        to: &Self::State,
        step: &[f64],
        dt: f64,
    ) -> Result<(), Rejection> {
        let _ = (from, to, step, dt);
        Ok(())
    }

    /// Bookkeeping after a step was accepted: ledger, contact lists. It must not change what [`rate`](Self::rate) gives.
    fn accepted(&mut self, from: &Self::State, to: &Self::State, step: &[f64], dt: f64) {
        let _ = (from, to, step, dt);
    }

    /// Longest step that [`check`](Self::check) is expected to accept, estimated from the last accepted step. Longer steps are
    /// not tried.
    fn longest_step(&self) -> f64 {
        f64::INFINITY
    }

    /// The energy ledger that observers see, if the model keeps one.
    fn ledger(&self) -> Option<&Ledger> {
        None
    }
}

/// Largest absolute component; NaN if any component is NaN.
pub fn max_norm(vector: &[f64]) -> f64 {
    vector.iter().fold(0.0, |largest, x| {
        if x.abs() > largest || x.is_nan() {
            x.abs()
        } else {
            largest
        }
    })
}

/// A model with an approximate linearisation J of its rate.
pub trait LinearlyImplicit: Model {
    /// Factorises W = I - `g_dt` J at `state`; J may be any approximation of dF/du.
    ///
    /// Called after [`rate`](Model::rate) at the same `state`, except when a step is repeated with another length: then the
    /// rate is not computed again, and the last one was at another state. W must survive calls of `rate`.
    ///
    /// # Errors
    /// A [`Rejection`] when W cannot be factorised.
    fn prepare(&mut self, state: &Self::State, g_dt: f64) -> Result<(), Rejection>;

    /// Replaces `rhs` by W^-1 `rhs`, with the W of the last [`prepare`](Self::prepare).
    ///
    /// # Errors
    /// A [`Rejection`] when the solution is not usable.
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), Rejection>;
}

/// A model that can bound the stiffness of its rate.
pub trait SpectralBound: Model {
    /// An upper bound of the largest absolute eigenvalue of dF/du, which should lie near the negative real axis.
    ///
    /// # Errors
    /// A [`Rejection`] when there is no bound at this state.
    fn spectral_radius(&mut self, state: &Self::State) -> Result<f64, Rejection>;
}

/// What a trial step reports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Estimated local error, by the model's [`error_norm`](Model::error_norm).
    pub error: f64,
}

/// Work done by a stepper; the same on every machine, unlike times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Evaluations of the rate.
    pub n_rate_evaluations: u64,
    /// Factorisations of W.
    pub n_factorisations: u64,
    /// Solves with W.
    pub n_solves: u64,
    /// Trial steps, accepted or not.
    pub n_trials: u64,
}

/// What a stepper remembers between two steps.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepperMemory {
    /// Work done so far.
    pub counters: Counters,
    /// Whether it has tried a step.
    pub has_begun: bool,
    /// The rate at the present state, if it is known.
    pub rate: Option<Vec<f64>>,
    /// The spectral radius there, if it is known.
    pub radius: Option<f64>,
}

/// A one-step method with an embedded error estimate.
pub trait Stepper<M: Model> {
    /// Tries a step of length `dt` from `state` and writes where it leads to `to`.
    ///
    /// Until [`accepted`](Self::accepted) or [`reset`](Self::reset) is called, further calls must be from the same state:
    /// what does not depend on `dt` is kept.
    ///
    /// # Errors
    /// The model's [`Rejection`], or [`Rejection::NotFinite`].
    fn step(
        &mut self,
        model: &mut M,
        state: &M::State,
        dt: f64,
        to: &mut M::State,
    ) -> Result<Trial, Rejection>;

    /// The step vector of the last trial.
    fn displacement(&self) -> &[f64];

    /// Accepts the last trial as the new state.
    fn accepted(&mut self);

    /// Forgets earlier states: call it after the state was changed from outside.
    fn reset(&mut self);

    /// Longest step from `state` that the method can take at all.
    ///
    /// # Errors
    /// The model's [`Rejection`].
    fn longest_step(&mut self, model: &mut M, state: &M::State) -> Result<f64, Rejection> {
        let _ = (model, state);
        Ok(f64::INFINITY)
    }

    /// Order of convergence.
    fn order(&self) -> u32;

    /// Power of the step length with which the error estimate of one step vanishes.
    fn error_order(&self) -> u32;

    /// Work done so far.
    fn counters(&self) -> Counters;

    /// What it remembers between two steps.
    fn memory(&self) -> StepperMemory;

    /// Continues from such a memory, for a model of `n_dof` numbers.
    fn recall(&mut self, memory: StepperMemory, n_dof: usize);
}
