//! The model of a discharge: the switched nematic, its ramp and its flow if there are any, and the account of its energy.

use topo_core::{Ledger, Rejection};

use super::flow::CoupledFlow;
use super::ramp::Ramp;
use super::resume::Unfinished;
use crate::battery::record::FinalState;
use crate::battery::switch::SwitchedNematic;
use crate::kernel::run::Kernel;
use crate::real::Real;
use crate::stokes::Drive;
use crate::{EnergyParts, FlowParameters, NematicError, Precision};

/// Largest rise of the energy in a step, relative to what is left above the final state.
const MOST_RISE: f64 = 1e-6;
/// Channels of dissipation, as the account numbers them.
const ROTATION: usize = 0;
const VISCOUS: usize = 1;

/// A switched nematic with the present state of its surface.
pub(super) struct SwitchedModel<'a, T> {
    pub switched: &'a SwitchedNematic,
    pub kernel: Kernel<T>,
    pub ramp: Option<Ramp<T>>,
    /// Share of the ramp that the surface has reached.
    pub ramped: f64,
    pub flow: Option<CoupledFlow>,
    /// Energy of the present field.
    pub energy: EnergyParts,
    pub ledger: Ledger,
    pub guard: RiseGuard,
}

impl<'a, T: Real> SwitchedModel<'a, T> {
    /// The model at `time`; its energy is known once the run has begun.
    pub fn new(
        switched: &'a SwitchedNematic,
        flow: Option<&FlowParameters>,
        end: &FinalState,
        run: &Unfinished,
    ) -> Result<Self, NematicError> {
        let battery = &switched.charged.battery;
        let surface = switched.charged.surface_after(&switched.settings);
        let mut kernel = battery.kernel::<T>(&surface, battery.accuracy().threads);
        if flow.is_some() {
            kernel = kernel.without_gaps();
        }
        let duration = switched.settings.ramp.filter(|d| run.steps.time() < *d);
        let ramp = duration.map(|d| Ramp::begin(switched, d, flow.is_some(), &mut kernel));
        if let Some(ramp) = ramp.as_ref().filter(|_| run.ramped > 0.0) {
            ramp.set(&mut kernel, run.ramped);
        }
        Ok(Self {
            flow: flow.map(|f| CoupledFlow::new(switched, f)).transpose()?,
            guard: RiseGuard {
                end: end.energy,
                noise: switched.noise(kernel.domain.total_mass),
                is_driven: flow.is_some_and(|f| f.drive != Drive::default()),
            },
            energy: EnergyParts::default(),
            ledger: run.ledger.clone(),
            ramped: run.ramped,
            ramp,
            kernel,
            switched,
        })
    }

    /// Order at equilibrium, but not 0: the unit of errors.
    pub fn unit_of_errors(&self) -> f64 {
        let material = &self.switched.charged.battery.parameters().material;
        material.order().max(1e-3)
    }

    /// Sets the surface to its state at `time` of the ramp and records the work of that; false without a ramp.
    pub fn move_surface(&mut self, time: f64, q: &[T]) -> bool {
        let Some(ramp) = &self.ramp else {
            return false;
        };
        self.ramped = time / ramp.duration;
        ramp.set(&mut self.kernel, self.ramped);
        let changed = self.kernel.energy(q);
        let work = changed.total() - self.energy.total();
        self.ledger.add_work(work);
        self.energy = changed;
        true
    }

    /// Updates the energy account after a step of length `dt` to energy `next`, from the sums of H:H at both its ends.
    pub fn accepted(&mut self, dt: f64, squares: [f64; 2], next: EnergyParts) {
        let material = &self.switched.charged.battery.parameters().material;
        let cell = self.kernel.domain.grid.spacing().powi(3);
        let power = mean_power(squares[0], squares[1]);
        self.ledger
            .dissipate(ROTATION, material.rotational_mobility * cell * dt * power);
        if let Some(flow) = &mut self.flow {
            let [before, after] = flow.settle();
            self.ledger
                .dissipate(VISCOUS, dt * mean_power(before, after));
        }
        self.energy = next;
        self.ledger.set_stored(&next.as_array());
    }

    /// Whether the anchoring is still being ramped.
    pub fn is_ramped(&self) -> bool {
        self.ramp.is_some()
    }
}

impl SwitchedNematic {
    /// Changes of the energy that may be rounding: that of the field shows in its distortion, that of the sums in all of the bulk.
    fn noise(&self, total_mass: f64) -> f64 {
        let battery = &self.charged.battery;
        let rounding = match battery.accuracy().precision {
            Precision::Double => f64::EPSILON,
            Precision::Single => f64::from(f32::EPSILON),
        };
        let volume = total_mass * battery.grid().spacing().powi(3);
        let bulk = battery.parameters().material.reference_density().abs() * volume;
        16.0 * (rounding * self.start().abs() + f64::EPSILON * bulk)
    }
}

/// The guard of a step: the energy falls, unless plates or body forces do work on the director through the fluid.
pub(super) struct RiseGuard {
    /// Energy of the final state.
    end: f64,
    /// Changes of the energy that may be rounding.
    noise: f64,
    is_driven: bool,
}

impl RiseGuard {
    pub fn check(&self, from: f64, to: f64) -> Result<(), Rejection> {
        let rise = to - from;
        let above = (from - self.end).abs();
        if !self.is_driven && rise > MOST_RISE * above + self.noise {
            let relative = rise / from.abs();
            return Err(Rejection::EnergyRise { relative });
        }
        Ok(())
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
