//! The loop of a discharge: look, step, keep the books.

use topo_core::{CpuClock, Phase, Progress, Rejection, Schedule, StepControl, StopReason};

use super::super::coupled_flow::{CoupledFlow, CoupledMemory};
use super::super::final_state::nothing;
use super::super::hooks::RunHooks;
use super::super::ramp::Ramp;
use super::super::record::FinalState;
use super::super::record::{NematicPhase, NematicSample, PhaseReport, RunRecord};
use super::super::switch::SwitchedNematic;
use super::progressing::Progressing;
use super::{Discharge, DischargeSettings};
use crate::kernel::run::Kernel;
use crate::memory::ByteAccount;
use crate::real::Real;
use crate::stabilised::{Drift, Stabilised};
use crate::{Drive, EnergyParts, NematicError, NematicState, Precision, order_parameter, ring};

const SCHEMA: &str = "nematic-discharge/5";
/// First step, in h²/(Gamma L).
const FIRST_STEP: f64 = 1e-3;
/// Largest rise of the energy in a step, relative to what is left above the final state.
const MOST_RISE: f64 = 1e-6;

/// A discharge in progress.
struct Advance<'a, T> {
    switched: &'a SwitchedNematic,
    settings: &'a DischargeSettings,
    end: FinalState,
    /// As [`SwitchedNematic::goal`].
    goal: Option<f64>,
    until: f64,
    /// Changes of the energy that may be rounding.
    noise: f64,
    /// Plates and body forces do work on the director through the fluid.
    is_driven: bool,
    kernel: Kernel<T>,
    field: Stabilised<T>,
    energy: EnergyParts,
    flow: Option<CoupledFlow>,
    ramp: Option<Ramp<T>>,
    /// Longest stable step.
    longest: f64,
    outputs: Schedule,
    run: Progressing,
    state: NematicState,
    case: String,
    clock: CpuClock,
    earlier_cpu_seconds: f64,
}

/// What a checkpoint holds.
type Saved = (Progressing, Vec<f64>, Option<CoupledMemory>);

impl SwitchedNematic {
    pub(super) fn discharge_in<T: Real>(
        &self,
        settings: &DischargeSettings,
        end: FinalState,
        hooks: &mut RunHooks<'_>,
    ) -> Result<Discharge, NematicError> {
        let mut advance = Advance::<T>::new(self, settings, end, hooks)?;
        let stop = advance.go(hooks)?;
        if stop != StopReason::Interrupted {
            hooks.finish();
        }
        Ok(advance.into_discharge(stop))
    }

    /// A run that has not begun.
    fn fresh(&self, settings: &DischargeSettings) -> Result<Progressing, NematicError> {
        let battery = &self.charged.battery;
        let (h, material) = (battery.grid().spacing(), &battery.parameters().material);
        let first = FIRST_STEP * h * h / (material.rotational_mobility * material.elastic_constant);
        let longest = settings.longest * battery.diffusion_time();
        let control = StepControl::new(battery.accuracy().tolerance, first)?
            .with_limits(1e-9 * first, longest)?;
        Ok(Progressing::fresh(control, self.charged.energy()))
    }

    /// Energy at which the run is over; none where only its time ends it.
    fn goal(&self, settings: &DischargeSettings, end: &FinalState, is_driven: bool) -> Option<f64> {
        let stored = self.stored(end);
        let left = stored.map(|s| (1.0 - settings.until_released) * s.abs());
        match (left, is_driven) {
            (None, true) => None,
            (left, _) => Some(end.energy + left.unwrap_or_else(|| nothing(&self.charged.battery))),
        }
    }

    /// Changes of the energy that may be rounding: that of the field shows in its distortion, that of the sums in all of the bulk.
    fn noise(&self, scale: f64, total_mass: f64) -> f64 {
        let battery = &self.charged.battery;
        let rounding = match battery.accuracy().precision {
            Precision::Double => f64::EPSILON,
            Precision::Single => f64::from(f32::EPSILON),
        };
        let volume = total_mass * battery.grid().spacing().powi(3);
        let bulk = battery.parameters().material.reference_density().abs() * volume;
        16.0 * (rounding * scale.abs() + f64::EPSILON * bulk)
    }
}

/// The run of a checkpoint, whose field `state` takes over, or a fresh one.
fn begin(
    fresh: Progressing,
    case: &str,
    until: f64,
    state: &mut NematicState,
    hooks: &RunHooks<'_>,
) -> Result<(Progressing, Option<CoupledMemory>), NematicError> {
    let resumed = hooks.resume(SCHEMA, case, |(run, q, memory): &Saved| {
        let is_sound = q.len() == state.q_tensor().len()
            && q.iter().all(|x| x.is_finite())
            && memory.iter().all(|memory| memory.fits(q.len()));
        if !is_sound {
            return Some("the field is one of another grid");
        }
        run.flaw(&fresh, until)
    })?;
    Ok(match resumed {
        Some((run, q, memory)) => {
            state.q_mut().copy_from_slice(&q);
            (run, memory)
        }
        None => (fresh, None),
    })
}

/// Times of outputs, those of the run so far done; `unit` is the diffusion time.
fn outputs(
    settings: &DischargeSettings,
    unit: f64,
    run: &Progressing,
) -> Result<Schedule, NematicError> {
    let mut outputs =
        Schedule::log_spaced(settings.first_output * unit, settings.outputs_per_decade)?;
    if let Some(last) = run.samples.last() {
        outputs.due(last.time, run.n_steps.saturating_sub(1));
    }
    Ok(outputs)
}

impl<'a, T: Real> Advance<'a, T> {
    fn new(
        switched: &'a SwitchedNematic,
        settings: &'a DischargeSettings,
        end: FinalState,
        hooks: &RunHooks<'_>,
    ) -> Result<Self, NematicError> {
        let clock = CpuClock::start();
        let battery = &switched.charged.battery;
        let surface = switched.charged.surface_after(&switched.settings);
        let mut kernel = battery.kernel::<T>(&surface, battery.accuracy().threads);
        let flow = settings.flow.as_ref();
        if flow.is_some() {
            kernel = kernel.without_gaps();
        }
        let mut flow = flow.map(|f| CoupledFlow::new(switched, f)).transpose()?;
        let case = format!(
            "{:?} {:?} {:?} {settings:?}",
            battery.parameters(),
            battery.accuracy(),
            switched.settings
        );
        let mut state = switched.state.clone();
        let until = settings.longest * battery.diffusion_time();
        let fresh = switched.fresh(settings)?;
        let (mut run, memory) = begin(fresh, &case, until, &mut state, hooks)?;
        let duration = switched.settings.ramp.filter(|d| run.time < *d);
        let ramp = duration.map(|d| Ramp::begin(switched, d, flow.is_some(), &mut kernel));
        if let Some(ramp) = ramp.as_ref().filter(|_| run.ramped > 0.0) {
            ramp.set(&mut kernel, run.ramped);
        }
        let mut q = vec![T::of(0.0); kernel.array_length()];
        kernel.spread(state.q_tensor(), &mut q);
        let mut field = Stabilised::new(&kernel, q);
        if flow.is_some() {
            field = field.with_drift(battery.parameters().material.backflow());
        }
        let energy = kernel.energy(&field.q);
        if run.n_steps == 0 {
            let removed = run.ledger.stored_total() - energy.total();
            run.ledger.record_event("switch", 0.0, removed);
            run.ledger.set_stored(&energy.as_array());
        }
        let outputs = outputs(settings, battery.diffusion_time(), &run)?;
        if let Some(flow) = &mut flow {
            // The energy weighs the molecular field by these masses, and so must the force.
            flow.coupling.set_weights(&kernel.domain.masses());
            flow.begin(&kernel, &mut field, memory)?;
        }
        field.update_rate(&kernel);
        if run.n_steps > 0 {
            // The rate at a checkpoint was counted before it was written.
            field.counters = run.counters;
        }
        let is_driven = settings.flow.is_some_and(|f| f.drive != Drive::default());
        Ok(Self {
            noise: switched.noise(switched.start(), kernel.domain.total_mass),
            longest: field.longest_step(&kernel),
            earlier_cpu_seconds: run.cpu_seconds,
            goal: switched.goal(settings, &end, is_driven),
            switched,
            settings,
            end,
            until,
            is_driven,
            kernel,
            field,
            energy,
            flow,
            ramp,
            outputs,
            run,
            state,
            case,
            clock,
        })
    }

    fn go(&mut self, hooks: &mut RunHooks<'_>) -> Result<StopReason, NematicError> {
        let max_steps = self.switched.charged.battery.accuracy().max_steps;
        // A refused step leaves the velocity of its trial behind: nothing ends or is saved there.
        let mut settled = true;
        loop {
            if settled {
                let is_over = self.ramp.is_none()
                    && self.goal.is_some_and(|goal| self.energy.total() <= goal);
                self.look(is_over, hooks);
                if is_over {
                    return Ok(StopReason::Condition("released".to_owned()));
                }
                if self.run.time >= self.until {
                    return Ok(StopReason::ReachedTime);
                }
                if hooks.is_due() {
                    self.save(hooks)?;
                }
                if hooks.is_interrupted() {
                    return Ok(StopReason::Interrupted);
                }
            }
            if self.run.n_trials >= max_steps {
                return Ok(StopReason::StepLimit {
                    n: self.run.n_trials,
                });
            }
            self.run.n_trials += 1;
            let dt = self.next_step();
            settled = match self.try_step(dt) {
                Ok((error, energy)) => {
                    self.accept(dt, error, energy)?;
                    hooks.report(&self.progress());
                    true
                }
                Err(why) => {
                    self.run.rejections.add(&why);
                    if matches!(why, Rejection::Fatal { .. }) {
                        return Ok(StopReason::Failed { why });
                    }
                    if self.run.control.reject(dt, &why, 3).is_none() {
                        return Ok(StopReason::StepTooSmall { dt, last: why });
                    }
                    false
                }
            };
        }
    }

    /// Writes the energies down, and a sample where one is due.
    fn look(&mut self, is_over: bool, hooks: &mut RunHooks<'_>) {
        let run = &mut self.run;
        let dissipated = [0, 1].map(|c| run.ledger.dissipated(c));
        if run.curve.time().last().is_none_or(|last| run.time > *last)
            && let Err(error) = run
                .curve
                .push(run.time, &self.energy.as_array(), &dissipated)
        {
            tracing::warn!(%error, "a step is missing from the energy curve");
        }
        let is_new = run.samples.last().is_none_or(|s| s.time < run.time);
        if !(self.outputs.due(run.time, run.n_steps) || is_over) || !is_new {
            return;
        }
        self.kernel.gather(&self.field.q, self.state.q_mut());
        let order = self.switched.charged.battery.parameters().material.order();
        let flow_correlation = self.flow.as_mut().and_then(|f| f.direction(&self.state));
        let flow = self.flow.as_ref().map(|f| &f.coupling);
        let sample = NematicSample {
            time: run.time,
            energy: self.energy,
            dissipated,
            order: order_parameter(&self.state, order),
            ring: ring(&self.state, self.settings.ring_threshold),
            max_speed: flow.map(|f| f.max_speed()),
            flow_correlation,
        };
        if let Some(see) = hooks.samples() {
            see(&sample, &self.state, flow);
        }
        run.samples.push(sample);
    }

    fn save(&mut self, hooks: &mut RunHooks<'_>) -> Result<(), NematicError> {
        self.kernel.gather(&self.field.q, self.state.q_mut());
        self.run.counters = self.field.counters;
        self.run.cpu_seconds = self.earlier_cpu_seconds + self.clock.seconds();
        let memory = self.flow.as_ref().map(|flow| flow.memory(&self.field));
        let saved = (&self.run, self.state.q_tensor(), memory);
        Ok(hooks.save(SCHEMA, &self.case, &saved)?)
    }

    fn next_step(&self) -> f64 {
        let remaining = self.until - self.run.time;
        let dt = self.run.control.dt().min(self.longest).min(remaining);
        match &self.ramp {
            Some(ramp) => ramp.step(dt, self.run.time),
            None => dt,
        }
    }

    /// Tries a step; gives its local error, in orders of equilibrium, and the energy at its end.
    fn try_step(&mut self, dt: f64) -> Result<(f64, EnergyParts), Rejection> {
        if let Some(ramp) = &self.ramp {
            // The surface changes at the middle of each step; what that takes is work.
            self.run.ramped = (self.run.time + 0.5 * dt) / ramp.duration;
            ramp.set(&mut self.kernel, self.run.ramped);
            let changed = self.kernel.energy(&self.field.q);
            let work = changed.total() - self.energy.total();
            self.run.ledger.add_work(work);
            self.energy = changed;
            self.field.forget_rate();
            if let Some(flow) = &mut self.flow {
                self.field.set_drift(&self.kernel, flow)?;
                flow.settle();
            }
        }
        let drift = self.flow.as_mut().map(|flow| flow as &mut dyn Drift<T>);
        let error = self.field.try_step(&self.kernel, dt, drift)?;
        let order = self.switched.charged.battery.parameters().material.order();
        let error = error / order.max(1e-3);
        self.run.control.judge(error)?;
        let next = self.kernel.energy(self.field.candidate());
        let rise = next.total() - self.energy.total();
        let above = (self.energy.total() - self.end.energy).abs();
        if !self.is_driven && rise > MOST_RISE * above + self.noise {
            let relative = rise / self.energy.total().abs();
            return Err(Rejection::EnergyRise { relative });
        }
        Ok((error, next))
    }

    fn accept(&mut self, dt: f64, error: f64, next: EnergyParts) -> Result<(), NematicError> {
        let mobility = self
            .switched
            .charged
            .battery
            .parameters()
            .material
            .rotational_mobility;
        let cell = self.kernel.domain.grid.spacing().powi(3);
        let power = mean_power(self.field.square_of_field, self.field.candidate_square());
        self.field.accept();
        let run = &mut self.run;
        run.ledger.dissipate(0, mobility * cell * dt * power);
        if let Some(flow) = &mut self.flow {
            let [before, after] = flow.settle();
            run.ledger.dissipate(1, dt * mean_power(before, after));
        }
        self.energy = next;
        run.ledger.set_stored(&next.as_array());
        run.control.accept(dt, error, 3);
        run.time = if dt < self.until - run.time {
            run.time + dt
        } else {
            self.until
        };
        run.n_steps += 1;
        let time = run.time;
        match self.ramp.take_if(|ramp| ramp.is_over(time)) {
            Some(ramp) => self.end_ramp(ramp),
            None => Ok(()),
        }
    }

    fn end_ramp(&mut self, ramp: Ramp<T>) -> Result<(), NematicError> {
        ramp.set(&mut self.kernel, 1.0);
        let changed = self.kernel.energy(&self.field.q).total();
        self.run.ledger.add_work(changed - self.energy.total());
        self.kernel.gather(&self.field.q, self.state.q_mut());
        ramp.end(self.switched, changed, &mut self.kernel, &mut self.state);
        self.kernel.spread(self.state.q_tensor(), &mut self.field.q);
        self.energy = self.kernel.energy(&self.field.q);
        let removed = changed - self.energy.total();
        let run = &mut self.run;
        run.ledger.record_event("end of ramp", run.time, removed);
        run.ledger.set_stored(&self.energy.as_array());
        self.longest = self.field.longest_step(&self.kernel);
        self.field.forget_rate();
        if let Some(flow) = &mut self.flow {
            flow.coupling.set_weights(&self.kernel.domain.masses());
            flow.begin(&self.kernel, &mut self.field, None)?;
        }
        self.field.update_rate(&self.kernel);
        Ok(())
    }

    fn progress(&self) -> Progress {
        let mean_square = self.field.square_of_field / self.kernel.domain.total_mass.max(1.0);
        let start = self.switched.start();
        let stored = self.switched.stored(&self.end);
        Progress {
            step: self.run.n_steps,
            time: self.run.time,
            until: Some(self.until),
            released: stored.map(|stored| (start - self.energy.total()) / stored),
            energy: Some(self.energy.total()),
            rms_field: Some(mean_square.sqrt()),
            ..Progress::at(Phase::Discharge)
        }
    }

    fn into_discharge(mut self, stop: StopReason) -> Discharge {
        self.kernel.gather(&self.field.q, self.state.q_mut());
        let flow = self.flow.as_ref();
        let report = PhaseReport {
            stop,
            time: self.run.time,
            n_steps: self.run.n_steps,
            rejections: self.run.rejections,
            counters: self.field.counters,
            ledger_residual: self.run.ledger.relative_residual(),
            ledger: self.run.ledger,
            cpu_seconds: self.earlier_cpu_seconds + self.clock.seconds(),
            own: NematicPhase {
                bytes: ByteAccount {
                    fields: self.field.n_bytes(),
                    geometry: self.kernel.n_bytes(),
                    second: self.kernel.n_second_bytes(),
                    flow: flow.map_or(0, |f| f.n_bytes() as u64),
                },
                n_second_passes: self.kernel.n_second_passes(),
                flow: flow.map(CoupledFlow::report),
            },
        };
        Discharge {
            removed: self.switched.removed(),
            start: self.switched.start(),
            final_state: self.end,
            stored: self.switched.stored(&self.end),
            record: RunRecord {
                curve: self.run.curve,
                samples: self.run.samples,
                report,
            },
            state: self.state,
        }
    }
}

/// Mean of a power that decays exponentially from one value to the other.
pub(super) fn mean_power(from: f64, to: f64) -> f64 {
    let ratio = (from / to).ln();
    if ratio.is_finite() && ratio.abs() > 1e-4 {
        (from - to) / ratio
    } else {
        0.5 * (from + to)
    }
}
