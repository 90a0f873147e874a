//! Charging: the nematic relaxes with a pattern on the particle.

use serde::{Deserialize, Serialize};
use topo_core::{CpuClock, InvalidValue, finite, positive};

use super::NematicBattery;
use super::hooks::{MOST_COUNTED, Phase, Progress, RunHooks};
use super::record::ChargeReport;
use crate::kernel::run::Kernel;
use crate::memory::ByteAccount;
use crate::relax::{Clock, Relaxation};
use crate::{
    EnergyParts, NematicError, NematicState, OrderParameter, Particle, Ring, order_parameter, ring,
};

/// How a nematic is charged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ChargeSettings {
    /// Tilts of the start fields, in radians: each is relaxed, and the state of least energy kept.
    pub seeds: Vec<f64>,
    /// Direction of the tilt, in radians from x.
    pub seed_azimuth: f64,
    /// Root mean square of the molecular field that counts as converged.
    pub tolerance: f64,
    /// Largest change of the order parameter over 25 steps that counts as converged.
    pub order_tolerance: f64,
    /// Relax on a grid of twice the spacing first. Faster, but a coarse grid may buckle where a fine one does not.
    pub coarse_start: bool,
    /// Limit of steps for each start field.
    pub max_steps: u64,
}

impl Default for ChargeSettings {
    fn default() -> Self {
        Self {
            seeds: vec![0.05],
            seed_azimuth: 0.0,
            tolerance: 1e-8,
            order_tolerance: 1e-6,
            coarse_start: false,
            max_steps: 50_000,
        }
    }
}

impl ChargeSettings {
    fn check(&self) -> Result<(), NematicError> {
        if self.seeds.is_empty() {
            return Err(InvalidValue::new("charge.seeds", 0.0, "one tilt at least").into());
        }
        for seed in &self.seeds {
            finite("charge.seeds", *seed)?;
        }
        finite("charge.seed-azimuth", self.seed_azimuth)?;
        positive("charge.tolerance", self.tolerance)?;
        positive("charge.order-tolerance", self.order_tolerance)?;
        Ok(())
    }
}

/// A charged battery: the relaxed nematic, and how it got there.
#[derive(Debug, Clone)]
pub struct ChargedNematic {
    pub(crate) battery: NematicBattery,
    pub(crate) state: NematicState,
    report: ChargeReport,
}

/// Steps between looks at the order parameter.
const CHECK_EVERY: u64 = 25;
const SCHEMA: &str = "nematic-charge/2";

/// A charge on its way; one that is done has gone through all seeds.
#[derive(Serialize, Deserialize)]
struct Unfinished {
    seed: usize,
    best: Option<(f64, NematicState, f64, f64)>,
    q: Vec<f64>,
    velocity: Vec<f64>,
    clock: Clock,
    n_steps: u64,
    last_order: Option<f64>,
    is_converged: bool,
    n_bytes: u64,
    cpu_seconds: f64,
}

impl Unfinished {
    /// What does not fit a charge with so many seeds, on arrays of this length.
    fn flaw(
        &self,
        battery: &NematicBattery,
        n_seeds: usize,
        length: usize,
    ) -> Option<&'static str> {
        let whole = |x: &[f64]| x.len() == length && x.iter().all(|x| x.is_finite());
        let kept = |(energy, state, seed, rms): &(f64, NematicState, f64, f64)| {
            let numbers = [energy, seed, rms].iter().all(|x| x.is_finite());
            numbers
                && *state.grid() == battery.grid
                && state.particle().copied() == battery.particle
        };
        if self.seed > n_seeds || (self.seed == n_seeds && self.best.is_none()) {
            Some("it has gone through other start fields")
        } else if !self.best.iter().all(kept) {
            Some("the best state is one of another battery")
        } else if self.seed < n_seeds
            && !(whole(&self.q) && whole(&self.velocity) && self.clock.is_sound())
        {
            Some("the relaxation is one of another battery")
        } else if self.n_steps >= MOST_COUNTED || !self.cpu_seconds.is_finite() {
            Some("a counter is out of range")
        } else {
            None
        }
    }
}

impl NematicBattery {
    /// Lets the nematic relax with the pattern on the particle.
    ///
    /// A charge that is interrupted or reaches its limit of steps keeps what it has and says so in its report.
    ///
    /// # Errors
    /// A setting out of range, or a checkpoint that cannot be used.
    pub fn charge(
        &self,
        settings: &ChargeSettings,
        hooks: &mut RunHooks<'_>,
    ) -> Result<ChargedNematic, NematicError> {
        self.relax(settings, None, hooks)
    }

    /// Lets the nematic relax from a given state; the seeds of the settings are not used.
    ///
    /// # Errors
    /// As [`charge`](Self::charge), and a state of another grid.
    pub fn charge_from(
        &self,
        start: &NematicState,
        settings: &ChargeSettings,
        hooks: &mut RunHooks<'_>,
    ) -> Result<ChargedNematic, NematicError> {
        self.check_grid(start)?;
        let once = ChargeSettings {
            seeds: vec![0.0],
            coarse_start: false,
            ..settings.clone()
        };
        self.relax(&once, Some(start), hooks)
    }

    /// Takes a given state as charged, as it is.
    ///
    /// # Errors
    /// A state of another grid.
    pub fn adopt(&self, state: &NematicState) -> Result<ChargedNematic, NematicError> {
        self.check_grid(state)?;
        let kernel = self.kernel::<f64>(&self.charged_surface(), self.accuracy.threads);
        let report = ChargeReport {
            stop: "adopted",
            seed: 0.0,
            n_steps: 0,
            rms_field: kernel.rms_field_of(state),
            energy: kernel.energy_of(state),
            order: order_parameter(state, self.parameters.material.order()),
            cpu_seconds: 0.0,
            bytes: ByteAccount::default(),
        };
        Ok(ChargedNematic {
            battery: self.clone(),
            state: state.clone(),
            report,
        })
    }

    fn check_grid(&self, state: &NematicState) -> Result<(), NematicError> {
        if *state.grid() == self.grid {
            return Ok(());
        }
        Err(NematicError::Length {
            what: "the state (of another grid)",
            found: state.q_tensor().len(),
            expected: 5 * self.grid.n_cells(),
        })
    }

    fn relax(
        &self,
        settings: &ChargeSettings,
        from: Option<&NematicState>,
        hooks: &mut RunHooks<'_>,
    ) -> Result<ChargedNematic, NematicError> {
        settings.check()?;
        let clock = CpuClock::start();
        let kernel = self.kernel::<f64>(&self.charged_surface(), self.accuracy.threads);
        let order_scale = self.parameters.material.order();
        let case = format!("{:?} {settings:?}", self.parameters);
        let mut unfinished = hooks.resume(SCHEMA, &case, |u: &Unfinished| {
            u.flaw(self, settings.seeds.len(), kernel.array_length())
        })?;
        let (mut first, mut best, mut n_steps, mut earlier) = (0, None, 0, 0.0);
        let (mut stop, mut n_bytes) = ("converged", 0);
        if let Some(u) = &mut unfinished {
            (first, best, n_steps, earlier) = (u.seed, u.best.take(), u.n_steps, u.cpu_seconds);
            n_bytes = u.n_bytes;
            if !u.is_converged {
                stop = "step-limit";
            }
        }
        for (index, seed) in settings.seeds.iter().enumerate().skip(first) {
            let mut relaxation = Relaxation::new(&kernel);
            let mut last_order = None;
            match unfinished.take() {
                Some(u) => {
                    relaxation.restore(u.q, u.velocity, u.clock);
                    last_order = u.last_order;
                }
                None => {
                    let start = match from {
                        Some(state) => state.clone(),
                        None => self.charge_start(settings, *seed, hooks)?,
                    };
                    relaxation.set(start.q_tensor());
                }
            }
            n_bytes = relaxation.n_bytes();
            let mut rms;
            loop {
                rms = relaxation.step();
                n_steps += 1;
                let step = relaxation.clock.n_steps;
                if !rms.is_finite() {
                    return Err(NematicError::Diverged { step });
                }
                // Without any force no step is taken and none will be.
                if step.is_multiple_of(CHECK_EVERY) || rms == 0.0 {
                    let order = kernel.tilt(&relaxation.q, order_scale);
                    let settled = last_order
                        .is_some_and(|last: f64| (order - last).abs() < settings.order_tolerance);
                    last_order = Some(order);
                    hooks.report(&Progress {
                        phase: Phase::Charge,
                        step,
                        time: 0.0,
                        energy: None,
                        rms_field: rms,
                    });
                    if settled && rms < settings.tolerance {
                        break;
                    }
                } else if step >= settings.max_steps || hooks.is_interrupted() || hooks.is_due() {
                    let ends = step >= settings.max_steps || hooks.is_interrupted();
                    if hooks.is_due() {
                        let record = Unfinished {
                            seed: index,
                            best: best.clone(),
                            q: relaxation.q.clone(),
                            velocity: relaxation.velocity.clone(),
                            clock: relaxation.clock,
                            n_steps,
                            last_order,
                            is_converged: stop == "converged",
                            n_bytes,
                            cpu_seconds: earlier + clock.seconds(),
                        };
                        hooks.save(SCHEMA, &case, &record)?;
                    }
                    if ends {
                        stop = if hooks.is_interrupted() {
                            "interrupted"
                        } else {
                            "step-limit"
                        };
                        break;
                    }
                }
            }
            let energy = kernel.energy(&relaxation.q).total();
            if best.as_ref().is_none_or(|(least, ..)| energy < *least) {
                let mut state = self.start(0.0, 0.0)?;
                kernel.gather(&relaxation.into_q(), state.q_mut());
                best = Some((energy, state, *seed, rms));
            }
            if stop == "interrupted" {
                break;
            }
        }
        let Some((energy, state, seed, rms_field)) = best else {
            return Err(NematicError::Diverged { step: 0 });
        };
        if stop != "interrupted" && first < settings.seeds.len() {
            // what comes after may be stopped: then the charge is there at once
            let record = Unfinished {
                seed: settings.seeds.len(),
                best: Some((energy, state.clone(), seed, rms_field)),
                q: Vec::new(),
                velocity: Vec::new(),
                clock: Clock::default(),
                n_steps,
                last_order: None,
                is_converged: stop == "converged",
                n_bytes,
                cpu_seconds: earlier + clock.seconds(),
            };
            hooks.save(SCHEMA, &case, &record)?;
        }
        let report = ChargeReport {
            stop,
            seed,
            n_steps,
            rms_field,
            energy: kernel.energy_of(&state),
            order: order_parameter(&state, order_scale),
            cpu_seconds: earlier + clock.seconds(),
            bytes: ByteAccount {
                fields: n_bytes,
                geometry: kernel.n_bytes(),
                second: kernel.n_second_bytes(),
                flow: 0,
            },
        };
        Ok(ChargedNematic {
            battery: self.clone(),
            state,
            report,
        })
    }

    /// The start field, relaxed on a coarse grid first if asked for and possible.
    fn charge_start(
        &self,
        settings: &ChargeSettings,
        seed: f64,
        hooks: &RunHooks<'_>,
    ) -> Result<NematicState, NematicError> {
        let fine = self.start(seed, settings.seed_azimuth)?;
        if !settings.coarse_start {
            return Ok(fine);
        }
        let spacing = 2.0 * self.grid.spacing();
        let Ok(grid) = self.parameters.grid(spacing) else {
            return Ok(fine);
        };
        let particle = match self.particle.map(|p| Particle::central(&grid, p.radius())) {
            Some(Err(_)) => return Ok(fine),
            Some(Ok(particle)) => Some(particle),
            None => None,
        };
        let coarse = NematicBattery {
            grid,
            particle,
            // Values on faces are known at the fine faces only.
            values: Default::default(),
            ..self.clone()
        };
        let coarse_settings = ChargeSettings {
            seeds: vec![seed],
            tolerance: 1e-4_f64.max(settings.tolerance),
            order_tolerance: 1e-4_f64.max(settings.order_tolerance),
            coarse_start: false,
            ..settings.clone()
        };
        let charged = coarse.charge(&coarse_settings, &mut hooks.without_files())?;
        Ok(charged.state.interpolated(&fine))
    }
}

impl ChargedNematic {
    /// The battery it was made from.
    pub fn battery(&self) -> &NematicBattery {
        &self.battery
    }

    /// The tensor field.
    pub fn state(&self) -> &NematicState {
        &self.state
    }

    /// How it was charged.
    pub fn report(&self) -> &ChargeReport {
        &self.report
    }

    /// Energy by part, in L xi_N.
    pub fn energy(&self) -> &EnergyParts {
        &self.report.energy
    }

    /// Order parameter of buckling.
    pub fn order(&self) -> &OrderParameter {
        &self.report.order
    }

    /// The defect ring: the line of lowest order around the particle, up to the order `threshold`.
    pub fn ring(&self, threshold: f64) -> Option<Ring> {
        ring(&self.state, threshold)
    }
}

impl Kernel<f64> {
    /// Energy of a state.
    pub(crate) fn energy_of(&self, state: &NematicState) -> EnergyParts {
        let mut q = vec![0.0; self.array_length()];
        self.spread(state.q_tensor(), &mut q);
        self.energy(&q)
    }

    /// Root mean square of the molecular field of a state.
    pub(super) fn rms_field_of(&self, state: &NematicState) -> f64 {
        let (mut q, mut h) = (
            vec![0.0; self.array_length()],
            vec![0.0; self.array_length()],
        );
        self.spread(state.q_tensor(), &mut q);
        self.molecular_field(&q, &mut h);
        (self.sums_of(&h, &q)[3] / self.domain.total_mass.max(1.0)).sqrt()
    }

    /// Length of the mean horizontal tilt over active cells.
    pub(super) fn tilt(&self, q: &[f64], order: f64) -> f64 {
        let mut sums = [0.0; 2];
        for (sum, c) in sums.iter_mut().zip([2, 4]) {
            let component = &q[c * self.stride..];
            for run in &self.domain.runs {
                let run = run.start as usize..(run.start + run.length) as usize;
                *sum += component[run].iter().sum::<f64>();
            }
            let special = self.domain.special.iter();
            *sum += special.map(|s| component[s.cell as usize]).sum::<f64>();
        }
        sums[0].hypot(sums[1]) / (1.5 * order.max(1e-300) * self.domain.n_active.max(1) as f64)
    }
}
