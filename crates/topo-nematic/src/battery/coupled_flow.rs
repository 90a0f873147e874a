//! The flow of a discharge: updated after its steps, adding to its rates.

use serde::{Deserialize, Serialize};

use super::record::FlowReport;
use super::switch::SwitchedNematic;
use crate::flow::FlowMemory;
use crate::kernel::run::Kernel;
use crate::real::Real;
use crate::stabilised::{ExtraRate, Stabilised};
use crate::{FlowCoupling, FlowParameters, NematicError};

/// The flow of a discharge and what is remembered of it.
pub(super) struct CoupledFlow {
    pub coupling: FlowCoupling,
    max_speed: f64,
    boundary_residual: f64,
}

/// What a checkpoint keeps of it.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct CoupledMemory {
    coupling: FlowMemory,
    max_speed: f64,
    boundary_residual: f64,
}

impl CoupledFlow {
    pub fn new(
        switched: &SwitchedNematic,
        parameters: &FlowParameters,
    ) -> Result<Self, NematicError> {
        let battery = &switched.charged.battery;
        let coupling = FlowCoupling::new(
            battery.grid(),
            battery.particle(),
            &battery.parameters().material,
            parameters,
        )?;
        Ok(Self {
            coupling,
            max_speed: 0.0,
            boundary_residual: 0.0,
        })
    }

    pub fn memory(&self) -> CoupledMemory {
        CoupledMemory {
            coupling: self.coupling.memory(),
            max_speed: self.max_speed,
            boundary_residual: self.boundary_residual,
        }
    }

    /// Goes on from a memory; whether it fits.
    pub fn restore(&mut self, memory: CoupledMemory) -> bool {
        self.max_speed = memory.max_speed;
        self.boundary_residual = memory.boundary_residual;
        self.coupling.restore(memory.coupling)
    }

    pub fn update<T: Real>(
        &mut self,
        kernel: &Kernel<T>,
        field: &mut Stabilised<T>,
    ) -> Result<(), NematicError> {
        let (q, h) = field.with_molecular_field(kernel);
        self.coupling.update(q, h)?;
        self.remember(field);
        Ok(())
    }

    pub fn after_step<T: Real>(
        &mut self,
        kernel: &Kernel<T>,
        field: &mut Stabilised<T>,
    ) -> Result<(), NematicError> {
        let (q, h) = if self.coupling.is_due() {
            field.with_molecular_field(kernel)
        } else {
            // Only the step is counted.
            (&field.q[..], &field.q[..])
        };
        if self.coupling.after_step(q, h)? {
            self.remember(field);
        }
        Ok(())
    }

    fn remember<T: Real>(&mut self, field: &mut Stabilised<T>) {
        field.forget_rate();
        self.max_speed = self.max_speed.max(self.coupling.max_speed());
        let residual = self.coupling.boundary_residual();
        self.boundary_residual = self.boundary_residual.max(residual);
    }

    pub fn report(&self) -> FlowReport {
        FlowReport {
            solver: self.coupling.solver(),
            counters: self.coupling.counters(),
            max_speed: self.max_speed,
            boundary_residual: self.boundary_residual,
        }
    }
}

impl<T: Real> ExtraRate<T> for CoupledFlow {
    fn add_rate(&self, q: &[T], rate: &mut [T]) {
        self.coupling.add_rate(q, rate);
    }
}

pub(super) fn extra<T: Real>(flow: &Option<CoupledFlow>) -> Option<&dyn ExtraRate<T>> {
    flow.as_ref().map(|f| f as &dyn ExtraRate<T>)
}
