//! A charge in progress: relaxations from all start fields, the check of the best state, kicks out of saddles.

mod unfinished;

use topo_core::{CpuClock, Phase, Progress};

use self::unfinished::{MOST_KICKS, Moving, Progressed, Unfinished};
use super::NematicBattery;
use super::charge_settings::ChargeSettings;
use super::hooks::RunHooks;
use super::minimum::Check;
use super::record::{ChargeReport, ChargeStop};
use crate::battery::record::MinimumState;
use crate::kernel::run::Kernel;
use crate::memory::ByteAccount;
use crate::order::order_parameter;
use crate::relax::Relaxation;
use crate::{NematicError, NematicState};

/// Steps between looks at the order parameter.
const CHECK_EVERY: u64 = 25;
const SCHEMA: &str = "nematic-charge/3";

/// How a relaxation ended.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    Converged,
    AtLimit,
    Interrupted,
}

/// A charge of one battery.
pub(super) struct Charging<'a, 'h> {
    battery: &'a NematicBattery,
    settings: &'a ChargeSettings,
    kernel: Kernel<f64>,
    hooks: &'a mut RunHooks<'h>,
    case: String,
    clock: CpuClock,
    earlier: f64,
    at: Progressed,
}

impl<'a, 'h> Charging<'a, 'h> {
    pub fn new(
        battery: &'a NematicBattery,
        settings: &'a ChargeSettings,
        hooks: &'a mut RunHooks<'h>,
    ) -> Self {
        Self {
            kernel: battery.kernel::<f64>(&battery.charged_surface(), battery.accuracy.threads),
            case: format!("{:?} {settings:?}", battery.parameters),
            battery,
            settings,
            hooks,
            clock: CpuClock::start(),
            earlier: 0.0,
            at: Progressed::default(),
        }
    }

    /// Charges from `start` of each seed; checks the state that is left if `checked`.
    pub fn run(
        mut self,
        start: impl Fn(f64, &RunHooks<'_>) -> Result<NematicState, NematicError>,
        checked: bool,
    ) -> Result<(NematicState, ChargeReport), NematicError> {
        let (length, n_seeds) = (self.kernel.array_length(), self.settings.seeds.len());
        let earlier = self.hooks.resume(SCHEMA, &self.case, |u: &Unfinished| {
            u.flaw(self.battery, n_seeds, length)
        })?;
        let mut moving = None;
        if let Some(u) = earlier {
            (self.at, moving) = (u.progressed, u.moving);
            self.earlier = self.at.cpu_seconds;
        }
        let settings = self.settings;
        let was_through = self.at.seed == n_seeds;
        let mut end = End::Converged;
        while let Some(&seed) = settings.seeds.get(self.at.seed) {
            let from = match moving.take() {
                Some(moving) => moving,
                None => self.at_rest(start(seed, self.hooks)?.q_tensor()),
            };
            end = self.relax(from, seed)?;
            if end == End::Interrupted {
                break;
            }
            self.at.seed += 1;
        }
        if end != End::Interrupted {
            if !was_through {
                // what comes after may be stopped: then the relaxed state is there at once
                self.save(None)?;
            }
            if checked {
                end = self.leave_saddles(moving)?;
            }
        }
        self.finish(end)
    }

    /// Looks whether the best state is a minimum, and kicks it while it is none.
    fn leave_saddles(&mut self, mut moving: Option<Moving>) -> Result<End, NematicError> {
        loop {
            if let Some(from) = moving.take() {
                let seed = self.at.best.as_ref().map_or(0.0, |best| best.seed);
                if self.relax(from, seed)? == End::Interrupted {
                    return Ok(End::Interrupted);
                }
                self.save(None)?;
            }
            let Some(best) = self.at.best.as_ref().filter(|_| self.needs_check()) else {
                return Ok(End::Converged);
            };
            let mut q = vec![0.0; self.kernel.array_length()];
            self.kernel.spread(best.state.q_tensor(), &mut q);
            let hooks = &*self.hooks;
            let can_kick = self.at.n_kicks < MOST_KICKS;
            let (particle, mut n_products) = (self.battery.particle.as_ref(), self.at.n_products);
            let check = Check::new(
                &self.kernel,
                particle,
                &q,
                can_kick,
                &mut n_products,
                || hooks.is_interrupted(),
            );
            if hooks.is_interrupted() {
                // done again from its beginning by who goes on
                return Ok(End::Interrupted);
            }
            let kick = match &check {
                Some(check) if check.state == MinimumState::Saddle && can_kick => {
                    check.kicked(&mut n_products)
                }
                _ => None,
            };
            self.at.n_products = n_products;
            let report = check.map(|check| check.report(self.at.n_kicks, n_products));
            let n_arrays = if kick.is_some() { 6 } else { 5 };
            let n_bytes = n_arrays * size_of_val(&q[..]) as u64;
            self.at.n_bytes = self.at.n_bytes.max(n_bytes);
            let Some(kicked) = kick else {
                self.at.minimum = report;
                self.save(None)?;
                return Ok(End::Converged);
            };
            drop(q);
            self.at.n_kicks += 1;
            let mut from = self.at_rest(&[]);
            from.q = kicked;
            moving = Some(from);
        }
    }

    /// Whether the best state has converged and was not looked at.
    fn needs_check(&self) -> bool {
        !self.at.has_reached_limit && self.at.minimum.is_none()
    }

    fn at_rest(&self, flat: &[f64]) -> Moving {
        let mut relaxation = Relaxation::new(&self.kernel);
        if !flat.is_empty() {
            relaxation.set(flat);
        }
        Moving {
            fire: relaxation.fire,
            velocity: std::mem::take(&mut relaxation.velocity),
            q: relaxation.into_q(),
            last_order: None,
        }
    }

    /// Relaxes until converged or stopped; what is reached replaces the best state if its energy is lower.
    fn relax(&mut self, from: Moving, seed: f64) -> Result<End, NematicError> {
        let kernel = &self.kernel;
        let settings = self.settings;
        let order_scale = self.battery.parameters.material.order();
        let mut relaxation = Relaxation::new(kernel);
        let mut last_order = from.last_order;
        relaxation.restore(from.q, from.velocity, from.fire);
        self.at.n_bytes = self.at.n_bytes.max(relaxation.n_bytes());
        let mut rms;
        let end = loop {
            rms = relaxation.step();
            self.at.n_steps += 1;
            let step = relaxation.fire.n_steps();
            if !rms.is_finite() {
                return Err(NematicError::Diverged { step });
            }
            // Without any force no step is taken and none will be.
            if step.is_multiple_of(CHECK_EVERY) || rms == 0.0 {
                let order = kernel.tilt(&relaxation.q, order_scale);
                let settled = last_order
                    .is_some_and(|last: f64| (order - last).abs() < settings.order_tolerance);
                last_order = Some(order);
                self.hooks.report(&Progress {
                    step,
                    rms_field: Some(rms),
                    ..Progress::at(Phase::Charge)
                });
                if settled && rms < settings.tolerance {
                    break End::Converged;
                }
                continue;
            }
            if self.hooks.is_due() {
                let record = Unfinished {
                    progressed: self.at_present(),
                    moving: Some(Moving::of(&relaxation, last_order)),
                };
                self.hooks.save(SCHEMA, &self.case, &record)?;
            }
            if self.hooks.is_interrupted() {
                break End::Interrupted;
            }
            if step >= settings.max_steps {
                self.at.has_reached_limit = true;
                break End::AtLimit;
            }
        };
        let energy = kernel.energy(&relaxation.q).total();
        self.at.offer(energy, seed, rms, || {
            let mut state = self.battery.start(0.0, 0.0)?;
            kernel.gather(&relaxation.into_q(), state.q_mut());
            Ok(state)
        })?;
        Ok(end)
    }

    fn at_present(&self) -> Progressed {
        Progressed {
            cpu_seconds: self.earlier + self.clock.seconds(),
            ..self.at.clone()
        }
    }

    fn save(&mut self, moving: Option<Moving>) -> Result<(), NematicError> {
        if !self.hooks.keeps_checkpoints() {
            return Ok(());
        }
        let progressed = self.at_present();
        let record = Unfinished { progressed, moving };
        Ok(self.hooks.save(SCHEMA, &self.case, &record)?)
    }

    fn finish(self, end: End) -> Result<(NematicState, ChargeReport), NematicError> {
        let seconds = self.earlier + self.clock.seconds();
        let (kernel, at) = (self.kernel, self.at);
        let Some(best) = at.best else {
            return Err(NematicError::Diverged { step: 0 });
        };
        let stop = match end {
            End::Interrupted => ChargeStop::Interrupted,
            _ if at.has_reached_limit => ChargeStop::StepLimit,
            _ => ChargeStop::Converged,
        };
        let report = ChargeReport {
            stop,
            seed: best.seed,
            n_steps: at.n_steps,
            rms_field: best.rms_field,
            energy: kernel.energy_of(&best.state),
            order: order_parameter(&best.state, self.battery.parameters.material.order()),
            minimum: at.minimum,
            cpu_seconds: seconds,
            bytes: ByteAccount {
                fields: at.n_bytes,
                geometry: kernel.n_bytes(),
                second: kernel.n_second_bytes(),
                flow: 0,
            },
        };
        Ok((best.state, report))
    }
}
