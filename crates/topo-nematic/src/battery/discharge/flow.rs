//! The flow of a discharge: the velocity that the director drives, as a drift of its field.

use serde::{Deserialize, Serialize};
use topo_core::Rejection;

use crate::battery::record::FlowReport;
use crate::battery::switch::SwitchedNematic;
use crate::flow::FlowCoupling;
use crate::flow::FlowMemory;
use crate::kernel::run::Kernel;
use crate::real::Real;
use crate::stabilised::{Drift, DriftMemory, Stabilised};
use crate::stokes::StokesError;
use crate::{FlowParameters, NematicError};

/// The flow of a discharge and its memory.
///
/// After a refused step the velocity is that of the refused trial: only what [`settle`](Self::settle) kept counts.
pub(super) struct CoupledFlow {
    pub coupling: FlowCoupling,
    power: f64,
    max_speed: f64,
    boundary_residual: f64,
    failure: Option<StokesError>,
}

/// What a checkpoint keeps of it.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct CoupledMemory {
    coupling: FlowMemory,
    drift: Option<DriftMemory>,
    max_speed: f64,
    boundary_residual: f64,
}

impl CoupledMemory {
    /// Whether it is one of a field of so many numbers.
    pub fn fits(&self, length: usize) -> bool {
        self.drift.iter().all(|drift| drift.fits(length))
    }
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
            power: 0.0,
            max_speed: 0.0,
            boundary_residual: 0.0,
            failure: None,
        })
    }

    pub fn memory<T: Real>(&self, field: &Stabilised<T>) -> CoupledMemory {
        CoupledMemory {
            coupling: self.coupling.memory(),
            drift: field.drift_memory(),
            max_speed: self.max_speed,
            boundary_residual: self.boundary_residual,
        }
    }

    /// Computes the velocity at the present field, or continues from a memory.
    ///
    /// # Errors
    /// Why no velocity was found.
    pub fn begin<T: Real>(
        &mut self,
        kernel: &Kernel<T>,
        field: &mut Stabilised<T>,
        memory: Option<CoupledMemory>,
    ) -> Result<(), NematicError> {
        field.forget_earlier_drift();
        let mut is_known = false;
        if let Some(memory) = memory {
            // A checkpoint of this very case fits; were it not so, the flow would start again.
            is_known = self.coupling.restore(memory.coupling);
            self.max_speed = memory.max_speed;
            self.boundary_residual = memory.boundary_residual;
            if let Some(drift) = &memory.drift {
                field.restore_drift(drift);
            }
        }
        let found = if is_known {
            field.set_drift(kernel, &mut Present(&self.coupling))
        } else {
            field.set_drift(kernel, self)
        };
        if let (Err(_), Some(failure)) = (&found, self.failure.take()) {
            return Err(failure.into());
        }
        self.settle();
        Ok(())
    }

    /// The velocity found last is that of the present field; gives the powers at the velocity before and at this one.
    pub fn settle(&mut self) -> [f64; 2] {
        let before = std::mem::replace(&mut self.power, self.coupling.power());
        self.max_speed = self.max_speed.max(self.coupling.max_speed());
        let residual = self.coupling.boundary_residual();
        self.boundary_residual = self.boundary_residual.max(residual);
        [before, self.power]
    }

    /// Bytes held.
    pub fn n_bytes(&self) -> usize {
        self.coupling.n_bytes()
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

impl<T: Real> Drift<T> for CoupledFlow {
    fn at(&mut self, q: &[T], field: &[T], drift: &mut [T]) -> Result<(), Rejection> {
        if let Err(failure) = self.coupling.update(q, field) {
            let what = match failure {
                StokesError::NotConverged { .. } => "the flow solver did not converge",
                _ => "the flow solver failed",
            };
            self.failure = Some(failure);
            return Err(Rejection::Domain { what });
        }
        Present(&self.coupling).at(q, field, drift)
    }
}

/// The drift by the velocity as it is.
struct Present<'a>(&'a FlowCoupling);

impl<T: Real> Drift<T> for Present<'_> {
    fn at(&mut self, q: &[T], _field: &[T], drift: &mut [T]) -> Result<(), Rejection> {
        drift.fill(T::of(0.0));
        self.0.add_rate(q, drift);
        Ok(())
    }
}
