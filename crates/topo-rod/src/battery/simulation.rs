//! A simulation of a rod with either integrator.

use topo_core::{
    Interrupt, Rkc2, RosenbrockW, Sample, Schedule, Scheduled, Simulation, SimulationMemory,
    StepControl, StopCondition, StopReason,
};

use crate::{Accuracy, IntegratorKind, RodError, RodModel, RodState};

/// Least length of a step, relative to the time T_0.
const LEAST_STEP: f64 = 1e-12;

/// Step control of a rod that begins.
pub(super) fn control_of(state: &RodState, accuracy: &Accuracy) -> Result<StepControl, RodError> {
    let t0 = topo_core::reference_time(state.length());
    Ok(StepControl::new(accuracy.tolerance, 1e-5 * t0)?
        .with_limits(LEAST_STEP * t0, 10.0 * t0)?
        .with_max_trials(accuracy.max_steps))
}

/// A simulation of a rod with either integrator.
pub(super) enum RodSimulation {
    Rosenbrock(Box<Simulation<RodModel, RosenbrockW>>),
    Rkc2(Box<Simulation<RodModel, Rkc2>>),
}

/// Runs an expression on either kind of simulation.
macro_rules! on_either {
    ($self:expr, $sim:ident => $body:expr) => {
        match $self {
            RodSimulation::Rosenbrock($sim) => $body,
            RodSimulation::Rkc2($sim) => $body,
        }
    };
}

impl RodSimulation {
    pub(super) fn new(
        model: RodModel,
        state: RodState,
        accuracy: &Accuracy,
        interrupt: &Interrupt,
    ) -> Result<Self, RodError> {
        let control = control_of(&state, accuracy)?;
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

    /// As [`Simulation::advance`].
    pub(super) fn advance(
        &mut self,
        until: f64,
        see: &mut dyn FnMut(&Sample<'_, RodState>),
        stop: &mut StopCondition<'_, RodState>,
    ) -> Option<StopReason> {
        let mut see = |s: &Sample<'_, RodState>| see(s);
        let mut observers = [Scheduled::new(Schedule::always(), &mut see)];
        on_either!(self, s => s.advance(until, &mut observers, stop))
    }

    pub(super) fn memory(&self) -> SimulationMemory {
        on_either!(self, s => s.memory())
    }

    pub(super) fn resumed(self, memory: SimulationMemory) -> Self {
        match self {
            Self::Rosenbrock(s) => Self::Rosenbrock(Box::new(s.resumed(memory))),
            Self::Rkc2(s) => Self::Rkc2(Box::new(s.resumed(memory))),
        }
    }

    pub(super) fn model(&self) -> &RodModel {
        on_either!(self, s => s.model())
    }

    pub(super) fn state(&self) -> &RodState {
        on_either!(self, s => s.state())
    }

    pub(super) fn modify<R>(
        &mut self,
        change: impl FnOnce(&mut RodModel, &mut RodState) -> R,
    ) -> R {
        on_either!(self, s => s.modify(change))
    }

    /// What observers would see now.
    pub(super) fn sample(&self) -> Sample<'_, RodState> {
        on_either!(self, s => s.sample())
    }

    pub(super) fn time(&self) -> f64 {
        on_either!(self, s => s.time())
    }

    pub(super) fn n_steps(&self) -> u64 {
        on_either!(self, s => s.n_steps())
    }

    pub(super) fn rejections(&self) -> &topo_core::RejectionCounts {
        on_either!(self, s => s.rejections())
    }

    pub(super) fn counters(&self) -> topo_core::Counters {
        on_either!(self, s => s.counters())
    }

    pub(super) fn into_state(self) -> RodState {
        on_either!(self, s => s.into_parts().1)
    }
}
