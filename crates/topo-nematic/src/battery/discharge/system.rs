//! What the loop of a discharge advances: the model, and the integrator that holds its field.

use topo_core::{Advance, Rejection, StepControl};

use super::flow::CoupledMemory;
use super::model::SwitchedModel;
use super::resume::Unfinished;
use crate::battery::record::FinalState;
use crate::battery::switch::SwitchedNematic;
use crate::real::Real;
use crate::stabilised::{Drift, Stabilised};
use crate::{EnergyParts, FlowParameters, NematicError, NematicState};

/// What a discharge advances: the model, and the integrator that holds its field.
pub(super) struct System<'a, T> {
    pub model: SwitchedModel<'a, T>,
    pub field: Stabilised<T>,
    /// Longest stable step.
    longest: f64,
    /// Energy at the end of the last trial.
    next: EnergyParts,
}

impl<'a, T: Real> System<'a, T> {
    /// The system from `state` on, as far as `run` has come.
    pub fn new(
        switched: &'a SwitchedNematic,
        flow: Option<&FlowParameters>,
        end: &FinalState,
        run: &Unfinished,
        state: &NematicState,
    ) -> Result<Self, NematicError> {
        let model = SwitchedModel::<T>::new(switched, flow, end, run)?;
        let mut q = vec![T::of(0.0); model.kernel.array_length()];
        model.kernel.spread(state.q_tensor(), &mut q);
        let mut field = Stabilised::new(&model.kernel, q);
        if model.flow.is_some() {
            let material = &switched.charged.battery.parameters().material;
            field = field.with_drift(material.backflow());
        }
        Ok(Self {
            longest: field.longest_step(&model.kernel),
            next: EnergyParts::default(),
            model,
            field,
        })
    }

    /// Computes energy, velocity and rate of the field; `memory` is that of the flow in a resumed run.
    ///
    /// # Errors
    /// When no velocity is found.
    pub fn begin(&mut self, memory: Option<CoupledMemory>) -> Result<(), NematicError> {
        self.model.energy = self.model.kernel.energy(&self.field.q);
        self.find_rates(memory)
    }

    /// Finds the velocity, if there is a flow, and the rate at a field that has just changed its kernel.
    fn find_rates(&mut self, memory: Option<CoupledMemory>) -> Result<(), NematicError> {
        let kernel = &self.model.kernel;
        if let Some(flow) = &mut self.model.flow {
            // The energy weighs the molecular field by these masses, and so must the force.
            flow.coupling.set_weights(&kernel.domain.masses());
            flow.begin(kernel, &mut self.field, memory)?;
        }
        self.field.update_rate(kernel);
        Ok(())
    }

    /// Writes the field to `state`.
    pub fn gather(&self, state: &mut NematicState) {
        self.model.kernel.gather(&self.field.q, state.q_mut());
    }

    /// Records what the event `name` at `time` removed; `before` is the energy before it.
    pub fn book_event(&mut self, name: &'static str, time: f64, before: f64) {
        let now = self.model.energy;
        let model = &mut self.model;
        model.ledger.record_event(name, time, before - now.total());
        model.ledger.set_stored(&now.as_array());
    }

    /// Ends the ramp if it is over at `time`; `state` is room for the field.
    ///
    /// # Errors
    /// When no velocity is found after it.
    pub fn end_ramp(&mut self, time: f64, state: &mut NematicState) -> Result<(), NematicError> {
        let model = &mut self.model;
        let Some(ramp) = model.ramp.take_if(|ramp| ramp.is_over(time)) else {
            return Ok(());
        };
        ramp.set(&mut model.kernel, 1.0);
        let changed = model.kernel.energy(&self.field.q).total();
        model.ledger.add_work(changed - model.energy.total());
        model.kernel.gather(&self.field.q, state.q_mut());
        ramp.end(model.switched, changed, &mut model.kernel, state);
        model.kernel.spread(state.q_tensor(), &mut self.field.q);
        model.energy = model.kernel.energy(&self.field.q);
        self.book_event("end of ramp", time, changed);
        self.longest = self.field.longest_step(&self.model.kernel);
        self.field.forget_rate();
        self.find_rates(None)
    }
}

impl<T: Real> Advance for System<'_, T> {
    fn longest_step(&mut self) -> Result<f64, Rejection> {
        Ok(self.longest)
    }

    fn trial_length(&self, dt: f64, time: f64, target: f64) -> f64 {
        let dt = dt.min(target - time);
        match &self.model.ramp {
            Some(ramp) => ramp.step(dt, time),
            None => dt,
        }
    }

    /// The error is in units of the equilibrium order.
    fn try_step(&mut self, time: f64, dt: f64, control: &StepControl) -> Result<f64, Rejection> {
        let (model, field) = (&mut self.model, &mut self.field);
        // The surface changes at the middle of each step; what that takes is work.
        if model.move_surface(time + 0.5 * dt, &field.q) {
            field.forget_rate();
            if let Some(flow) = &mut model.flow {
                field.set_drift(&model.kernel, flow)?;
                flow.settle();
            }
        }
        let drift = model.flow.as_mut().map(|flow| flow as &mut dyn Drift<T>);
        let error = field.try_step(&model.kernel, dt, drift)?;
        let error = error / model.unit_of_errors();
        control.judge(error)?;
        self.next = model.kernel.energy(field.candidate());
        model.guard.check(model.energy.total(), self.next.total())?;
        Ok(error)
    }

    fn accept(&mut self, dt: f64) {
        let squares = [self.field.square_of_field, self.field.candidate_square()];
        self.field.accept();
        self.model.accepted(dt, squares, self.next);
    }

    fn error_order(&self) -> u32 {
        3
    }
}
