//! Charging: the nematic relaxes with a pattern on the particle.

use super::NematicBattery;
use super::charge_settings::ChargeSettings;
use super::charging::Charging;
use super::hooks::RunHooks;
use super::record::{ChargeReport, ChargeStop};
use crate::kernel::run::Kernel;
use crate::memory::ByteAccount;
use crate::order::{OrderParameter, order_parameter};
use crate::ring::{Ring, ring};
use crate::{EnergyParts, NematicError, NematicState, Particle};

/// A charged battery: the relaxed nematic, and how it got there.
#[derive(Debug, Clone)]
pub struct ChargedNematic {
    pub(crate) battery: NematicBattery,
    pub(crate) state: NematicState,
    report: ChargeReport,
}

impl NematicBattery {
    /// Relaxes the nematic with the pattern on the particle.
    ///
    /// The relaxed state is checked: from a saddle it is kicked along the unstable mode and relaxed again. A charge that is
    /// interrupted or reaches its limit of steps returns what it has, unchecked; its report says so.
    ///
    /// # Errors
    /// A setting out of range, or a checkpoint that cannot be used.
    pub fn charge(
        &self,
        settings: &ChargeSettings,
        hooks: &mut RunHooks<'_>,
    ) -> Result<ChargedNematic, NematicError> {
        self.relax(settings, None, hooks, true)
    }

    /// Relaxes the nematic from a given state; the seeds of the settings are not used.
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
        self.relax(&once, Some(start), hooks, true)
    }

    /// Takes a given state as the charged one, without relaxing it.
    ///
    /// # Errors
    /// A state of another grid.
    pub fn adopt(&self, state: &NematicState) -> Result<ChargedNematic, NematicError> {
        self.check_grid(state)?;
        let kernel = self.kernel::<f64>(&self.charged_surface(), self.accuracy.threads);
        let report = ChargeReport {
            stop: ChargeStop::Adopted,
            seed: 0.0,
            n_steps: 0,
            rms_field: kernel.rms_field_of(state),
            energy: kernel.energy_of(state),
            order: order_parameter(state, self.parameters.material.order()),
            minimum: None,
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

    /// Charges from `start`, or from each seed.
    fn relax(
        &self,
        settings: &ChargeSettings,
        from: Option<&NematicState>,
        hooks: &mut RunHooks<'_>,
        checked: bool,
    ) -> Result<ChargedNematic, NematicError> {
        settings.check()?;
        let start = |seed: f64, hooks: &RunHooks<'_>| match from {
            Some(state) => Ok(state.clone()),
            None => self.charge_start(settings, seed, hooks),
        };
        let (state, report) = Charging::new(self, settings, hooks).run(start, checked)?;
        Ok(ChargedNematic {
            battery: self.clone(),
            state,
            report,
        })
    }

    /// The start field, relaxed on a coarse grid first if requested and possible.
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
        let charged = coarse.relax(
            &coarse_settings,
            None,
            &mut RunHooks::new(hooks.interrupt()),
            false,
        )?;
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

    /// Energy by part, in L ξ_N.
    pub fn energy(&self) -> &EnergyParts {
        &self.report.energy
    }

    /// Order parameter of buckling.
    pub fn order(&self) -> &OrderParameter {
        &self.report.order
    }

    /// The defect ring: the line of lowest order around the particle, where the order is below `threshold`.
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
