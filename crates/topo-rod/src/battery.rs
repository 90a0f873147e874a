//! The elastic battery: charge (twist, relax closed) → release (cut) → discharge.

pub(crate) mod charge;
pub(crate) mod cut;
pub(crate) mod discharge;
pub(crate) mod record;

use topo_core::{
    Polyline, Rkc2, RosenbrockW, Sample, Scheduled, Simulation, StepControl, StopReason,
};

use crate::{Accuracy, Guards, IntegratorKind, RodError, RodModel, RodParameters, RodState, Tube};

/// A tied fibre, ready to be twisted, fused and charged.
#[derive(Debug, Clone)]
pub struct RodBattery {
    parameters: RodParameters,
    accuracy: Accuracy,
    guards: Guards,
    tube: Tube,
    start: RodState,
}

impl RodBattery {
    /// Least length of a step, relative to the time T_0.
    const LEAST_STEP: f64 = 1e-12;

    /// A battery on a closed centreline (any scale) whose ropelength, length over thickness radius, is `ropelength`.
    ///
    /// The curve is resampled to the number of edges asked for and scaled as the reading says.
    ///
    /// # Errors
    /// A parameter out of range, or a curve that is open or unusable.
    pub fn new(
        parameters: &RodParameters,
        accuracy: &Accuracy,
        guards: Guards,
        centreline: &Polyline,
        ropelength: f64,
    ) -> Result<Self, RodError> {
        let parameters = parameters.clone().checked()?;
        let accuracy = accuracy.checked()?;
        if !centreline.is_closed() {
            return Err(RodError::WrongTopology {
                operation: "a battery",
                needed: "a closed",
            });
        }
        let tube = parameters.tube(ropelength)?;
        let curve = if centreline.n_edges() == parameters.n_edges {
            centreline.clone()
        } else {
            centreline.resampled(parameters.n_edges)?
        };
        let curve = curve.scaled(tube.start_length / curve.length())?;
        let start = RodState::new(&curve, tube.length, parameters.twist.unwrap_or(0.0))?;
        Ok(Self {
            parameters,
            accuracy,
            guards,
            tube,
            start,
        })
    }

    /// The state before charging: the twist is tied in, nothing has relaxed.
    pub fn start(&self) -> &RodState {
        &self.start
    }

    /// Lengths after the reading was applied.
    pub fn tube(&self) -> Tube {
        self.tube
    }

    /// Parameters of the rod.
    pub fn parameters(&self) -> &RodParameters {
        &self.parameters
    }

    /// Accuracy asked for.
    pub fn accuracy(&self) -> &Accuracy {
        &self.accuracy
    }
}

/// A simulation of a rod with either integrator.
pub(crate) enum RodSimulation {
    Rosenbrock(Box<Simulation<RodModel, RosenbrockW>>),
    Rkc2(Box<Simulation<RodModel, Rkc2>>),
}

/// Runs an expression on whichever simulation it is.
macro_rules! on_either {
    ($self:expr, $sim:ident => $body:expr) => {
        match $self {
            RodSimulation::Rosenbrock($sim) => $body,
            RodSimulation::Rkc2($sim) => $body,
        }
    };
}

impl RodSimulation {
    pub(crate) fn new(
        model: RodModel,
        state: RodState,
        accuracy: &Accuracy,
        interrupt: &topo_core::Interrupt,
    ) -> Result<Self, RodError> {
        let t0 = 2.0 * state.length();
        let control = StepControl::new(accuracy.tolerance, 1e-5 * t0)?
            .with_limits(RodBattery::LEAST_STEP * t0, 10.0 * t0)?
            .with_max_trials(accuracy.max_steps);
        let interrupt = interrupt.clone();
        let rosenbrock = match accuracy.integrator {
            IntegratorKind::Ros34pw2 => RosenbrockW::ros34pw2(),
            IntegratorKind::Ros2w => RosenbrockW::ros2w(accuracy.gamma)?,
            IntegratorKind::Rkc2 => {
                let simulation = Simulation::new(model, state, Rkc2::default(), control);
                return Ok(Self::Rkc2(Box::new(simulation.with_interrupt(interrupt))));
            }
        };
        let simulation = Simulation::new(model, state, rosenbrock, control);
        Ok(Self::Rosenbrock(Box::new(
            simulation.with_interrupt(interrupt),
        )))
    }

    pub(crate) fn run(
        &mut self,
        until: f64,
        observers: &mut [Scheduled<'_, RodState>],
        stop: &mut dyn FnMut(&Sample<'_, RodState>) -> Option<String>,
    ) -> StopReason {
        on_either!(self, s => s.run(until, observers, stop))
    }

    pub(crate) fn model(&self) -> &RodModel {
        on_either!(self, s => s.model())
    }

    pub(crate) fn state(&self) -> &RodState {
        on_either!(self, s => s.state())
    }

    pub(crate) fn modify<R>(
        &mut self,
        change: impl FnOnce(&mut RodModel, &mut RodState) -> R,
    ) -> R {
        on_either!(self, s => s.modify(change))
    }

    pub(crate) fn sample(&self) -> Sample<'_, RodState> {
        on_either!(self, s => s.sample())
    }

    pub(crate) fn time(&self) -> f64 {
        on_either!(self, s => s.time())
    }

    pub(crate) fn n_steps(&self) -> u64 {
        on_either!(self, s => s.n_steps())
    }

    pub(crate) fn rejections(&self) -> &topo_core::RejectionCounts {
        on_either!(self, s => s.rejections())
    }

    pub(crate) fn counters(&self) -> topo_core::Counters {
        on_either!(self, s => s.counters())
    }

    pub(crate) fn into_state(self) -> RodState {
        on_either!(self, s => s.into_parts().1)
    }
}
