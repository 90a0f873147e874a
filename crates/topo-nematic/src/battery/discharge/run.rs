//! The loop of a discharge: observe, keep a checkpoint, step.

use topo_core::{CpuClock, Phase, Progress, Sample, StepControl, StopReason, TimeStepping};

use super::flow::CoupledFlow;
use super::observer::{CurveRecorder, SampleRecorder};
use super::resume::{Start, Unfinished, save};
use super::system::System;
use super::{Discharge, DischargeSettings};
use crate::battery::final_state::nothing;
use crate::battery::hooks::RunHooks;
use crate::battery::record::{FinalState, NematicPhase, PhaseReport, RunRecord};
use crate::battery::switch::SwitchedNematic;
use crate::memory::ByteAccount;
use crate::real::Real;
use crate::stokes::Drive;
use crate::{NematicError, NematicState};

/// First step, in h²/(Γ L).
const FIRST_STEP: f64 = 1e-3;

/// A discharge in progress.
struct Run<'a, T> {
    switched: &'a SwitchedNematic,
    end: FinalState,
    /// Energy at which the run is over; none where only its time ends it.
    goal: Option<f64>,
    until: f64,
    system: System<'a, T>,
    steps: TimeStepping,
    curve: CurveRecorder,
    samples: SampleRecorder,
    /// Room for the field in the layout of states.
    state: NematicState,
    case: String,
    clock: CpuClock,
    earlier_cpu_seconds: f64,
}

impl SwitchedNematic {
    pub(super) fn discharge_in<T: Real>(
        &self,
        settings: &DischargeSettings,
        end: FinalState,
        hooks: &mut RunHooks<'_>,
    ) -> Result<Discharge, NematicError> {
        let mut run = Run::<T>::begin(self, settings, end, hooks)?;
        let stop = run.go(hooks)?;
        if stop != StopReason::Interrupted {
            hooks.finish();
        }
        Ok(run.into_discharge(stop))
    }

    /// A run that has not begun.
    fn fresh(&self, settings: &DischargeSettings) -> Result<Unfinished, NematicError> {
        let battery = &self.charged.battery;
        let (h, material) = (battery.grid().spacing(), &battery.parameters().material);
        let first = FIRST_STEP * h * h / (material.rotational_mobility * material.elastic_constant);
        let longest = settings.longest * battery.diffusion_time();
        let control = StepControl::new(battery.accuracy().tolerance, first)?
            .with_limits(1e-9 * first, longest)?
            .with_max_trials(battery.accuracy().max_steps);
        Ok(Unfinished::fresh(control, self.charged.energy()))
    }

    /// Energy at which the run is over; none where only its time ends it.
    fn goal(&self, settings: &DischargeSettings, end: &FinalState) -> Option<f64> {
        let stored = self.stored(end);
        let left = stored.map(|s| (1.0 - settings.until_released) * s.abs());
        let is_driven = settings.flow.is_some_and(|f| f.drive != Drive::default());
        match (left, is_driven) {
            (None, true) => None,
            (left, _) => Some(end.energy + left.unwrap_or_else(|| nothing(&self.charged.battery))),
        }
    }
}

impl<'a, T: Real> Run<'a, T> {
    /// A run from the switch on, or from the checkpoint of this very case.
    fn begin(
        switched: &'a SwitchedNematic,
        settings: &DischargeSettings,
        end: FinalState,
        hooks: &RunHooks<'_>,
    ) -> Result<Self, NematicError> {
        let clock = CpuClock::start();
        let battery = &switched.charged.battery;
        let case = format!(
            "{:?} {:?} {:?} {settings:?}",
            battery.parameters(),
            battery.accuracy(),
            switched.settings
        );
        let mut state = switched.state.clone();
        let until = settings.longest * battery.diffusion_time();
        let fresh = switched.fresh(settings)?;
        let Start {
            mut run,
            memory,
            is_resumed,
        } = Start::find(fresh, &case, until, &mut state, hooks)?;
        let mut system = System::new(switched, settings.flow.as_ref(), &end, &run, &state)?;
        let before = run.ledger.stored_total();
        system.begin(memory)?;
        if is_resumed {
            // The rate at a checkpoint was counted before it was written.
            system.field.counters = run.counters;
        } else {
            system.book_event("switch", 0.0, before);
        }
        let order = battery.parameters().material.order();
        let samples = SampleRecorder::new(settings, battery.diffusion_time(), order, &mut run)?;
        Ok(Self {
            goal: switched.goal(settings, &end),
            switched,
            end,
            until,
            system,
            samples,
            curve: CurveRecorder { curve: run.curve },
            steps: run.steps,
            state,
            case,
            clock,
            earlier_cpu_seconds: run.cpu_seconds,
        })
    }

    fn go(&mut self, hooks: &mut RunHooks<'_>) -> Result<StopReason, NematicError> {
        loop {
            let is_over = self.is_over();
            self.observe(is_over, hooks);
            if is_over {
                return Ok(StopReason::Condition("released".to_owned()));
            }
            if self.steps.time() >= self.until {
                return Ok(StopReason::ReachedTime);
            }
            if hooks.is_due() {
                self.save(hooks)?;
            }
            if hooks.is_interrupted() {
                return Ok(StopReason::Interrupted);
            }
            let stepped = self.steps.step_towards(self.until, &mut self.system);
            if let Err(reason) = stepped {
                return Ok(reason);
            }
            self.system.end_ramp(self.steps.time(), &mut self.state)?;
            hooks.report(&self.progress());
        }
    }

    fn is_over(&self) -> bool {
        let model = &self.system.model;
        !model.is_ramped() && self.goal.is_some_and(|goal| model.energy.total() <= goal)
    }

    /// Shows the present state to the observers.
    fn observe(&mut self, is_over: bool, hooks: &mut RunHooks<'_>) {
        let sample = Sample {
            time: self.steps.time(),
            step: self.steps.n_steps(),
            dt: self.steps.last_dt(),
            state: &self.system,
            ledger: &self.system.model.ledger,
        };
        self.curve.record(&sample);
        if !self.samples.is_due(&sample, is_over) {
            return;
        }
        self.system.gather(&mut self.state);
        let seen = self.samples.record(&sample, &self.state);
        if let Some(see) = hooks.samples() {
            let flow = self.system.model.flow.as_ref();
            see(seen, &self.state, flow.map(|flow| &flow.coupling));
        }
    }

    fn save(&mut self, hooks: &mut RunHooks<'_>) -> Result<(), NematicError> {
        self.system.gather(&mut self.state);
        let (model, field) = (&self.system.model, &self.system.field);
        let run = Unfinished {
            steps: self.steps.clone(),
            ledger: model.ledger.clone(),
            counters: field.counters,
            curve: self.curve.curve.clone(),
            samples: self.samples.samples.clone(),
            direction: self.samples.direction.clone(),
            cpu_seconds: self.cpu_seconds(),
            ramped: model.ramped,
        };
        let memory = model.flow.as_ref().map(|flow| flow.memory(field));
        save(&run, &self.state, memory, &self.case, hooks)
    }

    fn cpu_seconds(&self) -> f64 {
        self.earlier_cpu_seconds + self.clock.seconds()
    }

    fn progress(&self) -> Progress {
        let System { model, field, .. } = &self.system;
        let mean_square = field.square_of_field / model.kernel.domain.total_mass.max(1.0);
        let (start, energy) = (self.switched.start(), model.energy.total());
        let stored = self.switched.stored(&self.end);
        Progress {
            step: self.steps.n_steps(),
            time: self.steps.time(),
            until: Some(self.until),
            released: stored.map(|stored| (start - energy) / stored),
            energy: Some(energy),
            rms_field: Some(mean_square.sqrt()),
            ..Progress::at(Phase::Discharge)
        }
    }

    fn into_discharge(mut self, stop: StopReason) -> Discharge {
        self.system.gather(&mut self.state);
        let report = self.report(stop);
        Discharge {
            removed: self.switched.removed(),
            start: self.switched.start(),
            final_state: self.end,
            stored: self.switched.stored(&self.end),
            record: RunRecord {
                curve: self.curve.curve,
                samples: self.samples.samples,
                report,
            },
            state: self.state,
        }
    }

    fn report(&self, stop: StopReason) -> PhaseReport {
        let System { model, field, .. } = &self.system;
        let direction = &self.samples.direction;
        let flow_bytes = |f: &CoupledFlow| (f.n_bytes() + direction.n_bytes()) as u64;
        PhaseReport {
            stop,
            time: self.steps.time(),
            n_steps: self.steps.n_steps(),
            rejections: self.steps.rejections().clone(),
            counters: field.counters,
            ledger_residual: model.ledger.relative_residual(),
            ledger: model.ledger.clone(),
            cpu_seconds: self.cpu_seconds(),
            own: NematicPhase {
                bytes: ByteAccount {
                    fields: field.n_bytes(),
                    geometry: model.kernel.n_bytes(),
                    second: model.kernel.n_second_bytes(),
                    flow: model.flow.as_ref().map_or(0, flow_bytes),
                },
                n_second_passes: model.kernel.n_second_passes(),
                flow: model.flow.as_ref().map(CoupledFlow::report),
            },
        }
    }
}
