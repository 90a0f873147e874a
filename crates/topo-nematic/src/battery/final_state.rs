//! The state that a switched nematic relaxes to: released energy counts from there.

use topo_core::{Phase, Progress};

use super::NematicBattery;
use super::hooks::RunHooks;
use super::record::{FinalSource, FinalState};
use super::switch::{SwitchTarget, SwitchedNematic, extend_into_cut_cells};
use crate::kernel::run::Kernel;
use crate::relax::Relaxation;
use crate::tensor::uniaxial;
use crate::{NematicError, NematicState};

/// Root mean square of the molecular field below which a state is in equilibrium.
const EQUILIBRIUM: f64 = 1e-8;
/// Largest change of the mean tilt between two looks in equilibrium.
const STEADY_TILT: f64 = 1e-6;
/// Steps between two looks.
const CHECK_EVERY: u64 = 25;
/// Limit of steps.
const MAX_STEPS: u64 = 50_000;
/// Share of the energy of order of the whole cell below which nothing counts as stored: what a converged charge leaves.
const NOTHING: f64 = 1e-9;

impl SwitchedNematic {
    /// The state that the nematic relaxes to without flow.
    ///
    /// Without a field, and where plates and particle agree, it is uniform and its energy 0. Otherwise the switched state is
    /// relaxed; a discharge that starts on a symmetric saddle stays there, and so does this.
    ///
    /// # Errors
    /// [`NematicError::Diverged`] when the relaxation breaks down.
    ///
    /// # Validation
    /// `val_final_state_in_a_field_is_that_of_the_bulk`, `law_ramps_to_another_pattern_end_in_its_charged_state`
    pub fn final_state(&self, hooks: &mut RunHooks<'_>) -> Result<FinalState, NematicError> {
        if let Some(known) = self.final_state.get() {
            return Ok(*known);
        }
        let battery = &self.charged.battery;
        let surface = self.charged.surface_after(&self.settings);
        let kernel = battery.kernel::<f64>(&surface, battery.accuracy().threads);
        let found = if self.is_uniform(&kernel)? {
            FinalState {
                energy: 0.0,
                source: FinalSource::Uniform,
            }
        } else {
            self.relaxed(&kernel, hooks)?
        };
        if hooks.is_interrupted() {
            return Ok(found);
        }
        Ok(*self.final_state.get_or_init(|| found))
    }

    /// Energy that can be released on the way to `end`, in L ξ_N; none if it is not above what a converged charge leaves.
    ///
    /// Negative if the energy of the final state is above the present one, as can happen with a ramp of the anchoring.
    pub fn stored(&self, end: &FinalState) -> Option<f64> {
        Some(self.start() - end.energy)
            .filter(|stored| stored.abs() > nothing(&self.charged.battery))
    }

    fn is_uniform(&self, kernel: &Kernel<f64>) -> Result<bool, NematicError> {
        let battery = &self.charged.battery;
        let parameters = battery.parameters();
        if parameters.field.is_some() {
            return Ok(false);
        }
        let director = parameters.plates.director_along(2);
        let q = uniaxial(parameters.material.order(), director);
        let state = NematicState::from_fn(battery.grid, battery.particle, |_| q)?;
        let rms = kernel.rms_field_of(&state);
        Ok(rms < EQUILIBRIUM && kernel.energy_of(&state).total().abs() <= nothing(battery))
    }

    fn relaxed(
        &self,
        kernel: &Kernel<f64>,
        hooks: &mut RunHooks<'_>,
    ) -> Result<FinalState, NematicError> {
        let battery = &self.charged.battery;
        let mut start = self.state.clone();
        if self.settings.ramp.is_some() && matches!(self.settings.to, SwitchTarget::Free(_)) {
            let anchoring = battery.parameters().anchoring;
            extend_into_cut_cells(battery, anchoring, kernel, self.start(), &mut start);
        }
        let order = battery.parameters().material.order();
        let mut relaxation = Relaxation::new(kernel);
        relaxation.set(start.q_tensor());
        let mut last_tilt: Option<f64> = None;
        let mut source = FinalSource::Unconverged;
        while relaxation.fire.n_steps() < MAX_STEPS && !hooks.is_interrupted() {
            let rms_field = relaxation.step();
            let step = relaxation.fire.n_steps();
            if !rms_field.is_finite() {
                return Err(NematicError::Diverged { step });
            }
            if !step.is_multiple_of(CHECK_EVERY) && rms_field > 0.0 {
                continue;
            }
            let tilt = kernel.tilt(&relaxation.q, order);
            let steady = last_tilt.is_some_and(|last| (tilt - last).abs() < STEADY_TILT);
            last_tilt = Some(tilt);
            hooks.report(&Progress {
                step,
                rms_field: Some(rms_field),
                ..Progress::at(Phase::FinalState)
            });
            if rms_field < EQUILIBRIUM && steady {
                source = FinalSource::Relaxed;
                break;
            }
        }
        Ok(FinalState {
            energy: kernel.energy(&relaxation.q).total(),
            source,
        })
    }
}

/// Energy that counts as none in a cell, in L ξ_N.
pub(super) fn nothing(battery: &NematicBattery) -> f64 {
    let volume = battery.grid.extent().iter().product::<f64>();
    NOTHING * battery.parameters().material.reference_density().abs() * volume
}
