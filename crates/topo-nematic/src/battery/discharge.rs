//! Discharging: the nematic relaxes in time after the switch.

use serde::{Deserialize, Serialize};
use topo_core::{
    CpuClock, DischargeCurve, Ledger, Rejection, RejectionCounts, Schedule, StepControl,
    StopReason, in_range, positive,
};

use super::coupled_flow::{CoupledFlow, CoupledMemory, extra};
use super::hooks::{MOST_COUNTED, Phase, Progress, RunHooks};
use super::ramp::{RAMP_STEPS, Ramp};
use super::record::{CHANNELS, NematicSample, PhaseReport, RunRecord};
use super::switch::{SwitchTarget, SwitchedNematic, blend, extend_into_cut_cells};
use crate::anchoring::Anchoring;
use crate::kernel::run::Threads;
use crate::memory::ByteAccount;
use crate::real::Real;
use crate::stabilised::Stabilised;
use crate::{
    Drive, EnergyParts, FlowParameters, NematicError, NematicState, Precision, order_parameter,
    ring,
};

/// How far a discharge is followed and how often it is looked at.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DischargeSettings {
    /// Share of the energy after the switch whose release ends the run.
    pub until_released: f64,
    /// Longest time followed, in R²/(Gamma L).
    pub longest: f64,
    /// First output time after the switch, in R²/(Gamma L).
    pub first_output: f64,
    /// Output times a decade.
    pub outputs_per_decade: f64,
    /// Order below which a cell belongs to the defect ring.
    pub ring_threshold: f64,
    /// The flow; leave it out and none is modelled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow: Option<FlowParameters>,
}

impl Default for DischargeSettings {
    fn default() -> Self {
        Self {
            until_released: 0.9995,
            longest: 10.0,
            first_output: 1e-4,
            outputs_per_decade: 8.0,
            ring_threshold: 0.35,
            flow: None,
        }
    }
}

/// A discharge: what the switch took, and how the rest was released.
#[derive(Debug, Clone)]
pub struct Discharge {
    /// Energy that the switch itself removed, in L xi_N.
    pub removed: f64,
    /// Energy just after the switch, in L xi_N: released shares count from it.
    pub start: f64,
    /// The run.
    pub record: RunRecord,
    /// The last state.
    pub state: NematicState,
}

impl Discharge {
    /// Whether the share asked for was released.
    pub fn is_finished(&self) -> bool {
        matches!(self.record.report.stop, StopReason::Condition(_))
    }
}

const SCHEMA: &str = "nematic-discharge/3";
/// First step, in h²/(Gamma L).
const FIRST_STEP: f64 = 1e-3;

/// Largest rise of the energy in a step, relative: the velocity that a step is taken with may have grown too old.
const MOST_RISE: f64 = 1e-6;

/// A discharge that is not finished.
#[derive(Clone, Serialize, Deserialize)]
struct Progressing {
    time: f64,
    control: StepControl,
    n_steps: u64,
    n_trials: u64,
    ledger: Ledger,
    rejections: RejectionCounts,
    counters: topo_core::Counters,
    curve: DischargeCurve,
    samples: Vec<NematicSample>,
    cpu_seconds: f64,
    /// Share of the ramp at which the surface stands.
    ramped: f64,
}

impl Progressing {
    /// What does not fit a discharge that begins like `fresh` and is followed until `until`.
    fn flaw(&self, fresh: &Self, until: f64) -> Option<&'static str> {
        let n = &self.counters;
        let counts = [
            self.n_steps,
            self.n_trials,
            n.n_rate_evaluations,
            n.n_factorisations,
            n.n_solves,
        ];
        let mut last = -1.0;
        let in_order = self.samples.iter().all(|s| {
            let grows = s.time > last && s.time <= self.time;
            last = s.time;
            grows && s.energy.total().is_finite() && s.dissipated.iter().all(|x| x.is_finite())
        });
        let curve = &self.curve;
        if !(0.0..=until).contains(&self.time) || !(0.0..=1.0).contains(&self.ramped) {
            Some("its time is none of this run")
        } else if !fresh.control.leads_to(&self.control) {
            Some("the step control is one of another run")
        } else if self.ledger.terms() != fresh.ledger.terms()
            || self.ledger.channels() != fresh.ledger.channels()
        {
            Some("the energy account is one of another model")
        } else if curve.parts() != fresh.curve.parts()
            || curve.channels() != fresh.curve.channels()
            || curve.time().last().is_some_and(|t| *t > self.time)
            || !in_order
        {
            Some("the samples are those of another run")
        } else if counts.iter().any(|n| *n >= MOST_COUNTED)
            || self.rejections.iter().any(|(_, n)| n >= MOST_COUNTED)
            || !self.cpu_seconds.is_finite()
        {
            Some("a counter is out of range")
        } else {
            None
        }
    }
}

impl SwitchedNematic {
    /// Lets the nematic go.
    ///
    /// # Errors
    /// A setting out of range, or a checkpoint that cannot be used.
    pub fn discharge(
        &self,
        settings: &DischargeSettings,
        hooks: &mut RunHooks<'_>,
    ) -> Result<Discharge, NematicError> {
        in_range(
            "discharge.until-released",
            settings.until_released,
            1e-6,
            1.0 - 1e-9,
        )?;
        positive("discharge.longest", settings.longest)?;
        match self.charged.battery.accuracy.precision {
            Precision::Double => self.discharge_in::<f64>(settings, hooks),
            Precision::Single => self.discharge_in::<f32>(settings, hooks),
        }
    }

    fn discharge_in<T: Real>(
        &self,
        settings: &DischargeSettings,
        hooks: &mut RunHooks<'_>,
    ) -> Result<Discharge, NematicError> {
        let clock = CpuClock::start();
        let battery = &self.charged.battery;
        let (accuracy, material) = (battery.accuracy(), &battery.parameters().material);
        let unit = battery.diffusion_time();
        let mut kernel = battery.kernel::<T>(
            &self.charged.surface_after(&self.settings),
            accuracy.threads,
        );
        let gapless = settings.flow.is_some();
        if gapless {
            kernel = kernel.without_gaps();
        }
        let mut flow = match &settings.flow {
            None => None,
            Some(parameters) => Some(CoupledFlow::new(self, parameters)?),
        };
        let case = format!(
            "{:?} {:?} {:?} {settings:?}",
            battery.parameters(),
            accuracy,
            self.settings
        );
        let mut ramp = self
            .settings
            .ramp
            .map(|duration| Ramp::new(self, duration, accuracy.threads, gapless));
        let mut state = self.state.clone();
        let h = battery.grid().spacing();
        let power_unit = material.rotational_mobility * h * h * h;
        let fresh = {
            let mut ledger = Ledger::new(&EnergyParts::NAMES, &CHANNELS);
            ledger.set_stored(&self.charged.energy().as_array());
            let first_step =
                FIRST_STEP * h * h / (material.rotational_mobility * material.elastic_constant);
            Progressing {
                time: 0.0,
                control: StepControl::new(accuracy.tolerance, first_step)?
                    .with_limits(1e-9 * first_step, settings.longest * unit)?,
                n_steps: 0,
                n_trials: 0,
                ledger,
                rejections: RejectionCounts::default(),
                counters: topo_core::Counters::default(),
                curve: DischargeCurve::new(EnergyParts::NAMES, CHANNELS),
                samples: Vec::new(),
                cpu_seconds: 0.0,
                ramped: 0.0,
            }
        };
        type Memory = Option<CoupledMemory>;
        let resumed = hooks.resume(
            SCHEMA,
            &case,
            |(run, q, _): &(Progressing, Vec<f64>, Memory)| {
                if q.len() != state.q_tensor().len() || q.iter().any(|x| !x.is_finite()) {
                    return Some("the field is one of another grid");
                }
                run.flaw(&fresh, settings.longest * unit)
            },
        )?;
        let mut remembered = None;
        let mut run = match resumed {
            Some((run, q, memory)) => {
                state.q_mut().copy_from_slice(&q);
                remembered = memory;
                run
            }
            None => fresh,
        };
        // The final kernel waits until the ramp is over.
        let mut waiting = None;
        if let Some(ramp) = ramp.take_if(|ramp| run.time < ramp.duration) {
            waiting = Some((std::mem::replace(&mut kernel, ramp.kernel), ramp.ends));
        }
        if let Some((_, ends)) = waiting.as_ref().filter(|_| run.ramped > 0.0) {
            blend(&mut kernel, &ends[0], &ends[1], run.ramped);
        }
        let mut field = {
            let mut q = vec![T::of(0.0); kernel.array_length()];
            kernel.spread(state.q_tensor(), &mut q);
            Stabilised::new(&kernel, q)
        };
        let earlier = run.cpu_seconds;
        let mut energy = kernel.energy(&field.q);
        if run.n_steps == 0 {
            let removed = run.ledger.stored_total() - energy.total();
            run.ledger.record_event("switch", 0.0, removed);
            run.ledger.set_stored(&energy.as_array());
        }
        let start = self.start();
        let goal = (1.0 - settings.until_released) * start;
        let until = settings.longest * unit;
        let mut outputs =
            Schedule::log_spaced(settings.first_output * unit, settings.outputs_per_decade)?;
        if let Some(last) = run.samples.last() {
            // Outputs up to the last one are done.
            outputs.due(last.time, run.n_steps.saturating_sub(1));
        }
        let mut longest = field.longest_step(&kernel);
        if let Some(flow) = &mut flow {
            // The energy weighs the molecular field by these masses, and so must the force.
            flow.coupling.set_weights(&kernel.domain.masses());
            // A checkpoint of this very case fits; were it not so, the flow would start anew.
            if !remembered.is_some_and(|memory| flow.restore(memory)) {
                flow.update(&kernel, &mut field)?;
            }
        }
        field.update_rate(&kernel, extra(&flow));
        if run.n_steps > 0 {
            // The rate at a checkpoint was counted before it was written.
            field.counters = run.counters;
        }
        // Plates and body forces do work on the director through the fluid.
        let is_driven = settings
            .flow
            .is_some_and(|flow| flow.drive != Drive::default());
        // Rounding of the field shows in its distortion, that of the sums in all of the bulk.
        let rounding = match accuracy.precision {
            Precision::Double => f64::EPSILON,
            Precision::Single => f64::from(f32::EPSILON),
        };
        let bulk = material.reference_density().abs() * kernel.domain.total_mass * h * h * h;
        let noise = 16.0 * (rounding * start.abs() + f64::EPSILON * bulk);
        let stop = loop {
            if run.curve.time().last().is_none_or(|last| run.time > *last) {
                let dissipated = [0, 1].map(|c| run.ledger.dissipated(c));
                if let Err(error) = run.curve.push(run.time, &energy.as_array(), &dissipated) {
                    tracing::warn!(%error, "a step is missing from the energy curve");
                }
            }
            let finished = waiting.is_none() && energy.total() <= goal;
            if (outputs.due(run.time, run.n_steps) || finished)
                && run.samples.last().is_none_or(|s| s.time < run.time)
            {
                kernel.gather(&field.q, state.q_mut());
                let sample = NematicSample {
                    time: run.time,
                    energy,
                    dissipated: [0, 1].map(|c| run.ledger.dissipated(c)),
                    order: order_parameter(&state, material.order()),
                    ring: ring(&state, settings.ring_threshold),
                    max_speed: flow.as_ref().map(|f| f.coupling.max_speed()),
                };
                if hooks.wants_samples() {
                    hooks.show(&sample, &state, flow.as_ref().map(|f| &f.coupling));
                }
                run.samples.push(sample);
            }
            if finished {
                break StopReason::Condition("released".to_owned());
            }
            if run.time >= until {
                break StopReason::ReachedTime;
            }
            if hooks.is_due() {
                kernel.gather(&field.q, state.q_mut());
                run.counters = field.counters;
                run.cpu_seconds = earlier + clock.seconds();
                let memory = flow.as_ref().map(CoupledFlow::memory);
                hooks.save(SCHEMA, &case, &(&run, state.q_tensor(), memory))?;
            }
            if hooks.is_interrupted() {
                break StopReason::Interrupted;
            }
            if run.n_trials >= accuracy.max_steps {
                break StopReason::StepLimit { n: run.n_trials };
            }
            run.n_trials += 1;
            let remaining = until - run.time;
            let mut dt = run.control.dt().min(longest).min(remaining);
            if let (Some((_, ends)), Some(duration)) = (&waiting, self.settings.ramp) {
                // The surface changes at the middle of each step; what that takes is work.
                let left = duration - run.time;
                dt = dt.min(duration / RAMP_STEPS);
                if dt > 0.99 * left {
                    dt = left;
                }
                run.ramped = (run.time + 0.5 * dt) / duration;
                blend(&mut kernel, &ends[0], &ends[1], run.ramped);
                let changed = kernel.energy(&field.q);
                run.ledger.add_work(changed.total() - energy.total());
                energy = changed;
                field.forget_rate();
            }
            let result = field.try_step(&kernel, dt, extra(&flow)).and_then(|error| {
                let error = error / material.order().max(1e-3);
                run.control.judge(error)?;
                let next = kernel.energy(field.candidate());
                let rise = next.total() - energy.total();
                if !is_driven && rise > MOST_RISE * energy.total().abs() + noise {
                    let relative = rise / energy.total().abs();
                    return Err(Rejection::EnergyRise { relative });
                }
                Ok((error, next))
            });
            match result {
                Ok((error, next)) => {
                    let dissipated = power_unit
                        * dt
                        * mean_power(field.square_of_field, field.candidate_square());
                    field.accept();
                    run.ledger.dissipate(0, dissipated);
                    if let Some(flow) = &mut flow {
                        let before = flow.coupling.power();
                        flow.after_step(&kernel, &mut field)?;
                        field.update_rate(&kernel, Some(&*flow));
                        let after = flow.coupling.power();
                        run.ledger.dissipate(1, dt * mean_power(before, after));
                    }
                    energy = next;
                    run.ledger.set_stored(&energy.as_array());
                    run.control.accept(dt, error, 3);
                    run.time = if dt < remaining { run.time + dt } else { until };
                    run.n_steps += 1;
                    let over = self
                        .settings
                        .ramp
                        .is_none_or(|d| run.time >= d * (1.0 - 1e-12));
                    if let Some((last, ends)) = waiting.take_if(|_| over) {
                        blend(&mut kernel, &ends[0], &ends[1], 1.0);
                        let changed = kernel.energy(&field.q);
                        run.ledger.add_work(changed.total() - energy.total());
                        kernel.gather(&field.q, state.q_mut());
                        if matches!(self.settings.to, SwitchTarget::Free(_)) {
                            let surface = self.charged.surface_after(&self.settings);
                            let double = battery.kernel::<f64>(&surface, Threads::One);
                            extend_into_cut_cells(
                                battery,
                                Anchoring::Free,
                                &double,
                                changed.total(),
                                &mut state,
                            );
                        }
                        kernel = last;
                        kernel.spread(state.q_tensor(), &mut field.q);
                        energy = kernel.energy(&field.q);
                        let removed = changed.total() - energy.total();
                        run.ledger.record_event("end of ramp", run.time, removed);
                        run.ledger.set_stored(&energy.as_array());
                        longest = field.longest_step(&kernel);
                        field.forget_rate();
                        if let Some(flow) = &mut flow {
                            flow.coupling.set_weights(&kernel.domain.masses());
                            flow.update(&kernel, &mut field)?;
                        }
                        field.update_rate(&kernel, extra(&flow));
                    }
                    hooks.report(&Progress {
                        phase: Phase::Discharge,
                        step: run.n_steps,
                        time: run.time,
                        energy: Some(energy.total()),
                        rms_field: (field.square_of_field / kernel.domain.total_mass.max(1.0))
                            .sqrt(),
                    });
                }
                Err(why) => {
                    run.rejections.add(&why);
                    if matches!(why, Rejection::Fatal { .. }) {
                        break StopReason::Failed { why };
                    }
                    if run.control.reject(dt, &why, 3).is_none() {
                        break StopReason::StepTooSmall { dt, last: why };
                    }
                }
            }
        };
        kernel.gather(&field.q, state.q_mut());
        if stop != StopReason::Interrupted {
            hooks.finish();
        }
        let report = PhaseReport {
            stop,
            time: run.time,
            n_steps: run.n_steps,
            rejections: run.rejections,
            counters: field.counters,
            ledger_residual: run.ledger.relative_residual(),
            ledger: run.ledger,
            bytes: ByteAccount {
                fields: field.n_bytes(),
                geometry: kernel.n_bytes(),
                second: kernel.n_second_bytes(),
                flow: flow.as_ref().map_or(0, |f| f.coupling.n_bytes() as u64),
            },
            cpu_seconds: earlier + clock.seconds(),
            n_second_passes: kernel.n_second_passes(),
            flow: flow.as_ref().map(CoupledFlow::report),
        };
        Ok(Discharge {
            removed: self.removed(),
            start,
            record: RunRecord {
                curve: run.curve,
                samples: run.samples,
                report,
            },
            state,
        })
    }
}

/// Mean of a power that decays exponentially from one value to the other.
fn mean_power(from: f64, to: f64) -> f64 {
    let ratio = (from / to).ln();
    if ratio.is_finite() && ratio.abs() > 1e-4 {
        (from - to) / ratio
    } else {
        0.5 * (from + to)
    }
}
