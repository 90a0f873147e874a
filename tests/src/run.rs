//! A rod with its model, and the loop that carries it through time.

use topo_core::{RosenbrockW, RunHooks, Simulation, StepControl, StopReason};
use topo_rod::{
    Accuracy, ChargeSettings, CutSite, Discharge, DischargeSettings, Ends, Guards, RodBattery,
    RodModel, RodParameters, RodState, Tube,
};

/// The simulation that most tests run.
pub type RodSimulation = Simulation<RodModel, RosenbrockW>;

/// What a rod is made of and how exactly it is followed.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Material and load.
    pub parameters: RodParameters,
    /// Contact diameter and friction range; the length is that of the state.
    pub tube: Tube,
    /// Tolerance of the steps.
    pub accuracy: Accuracy,
    /// What holds the ends.
    pub ends: Ends,
    /// First step.
    pub first_step: f64,
    /// Longest step.
    pub longest_step: f64,
}

impl Setup {
    /// A rod that bends and stretches, and nothing else.
    pub fn bare(tolerance: f64) -> Self {
        let tube = Tube {
            length: 50.0,
            contact_diameter: 2.0,
            friction_range: 2.0,
            start_length: 50.0,
        };
        Self {
            parameters: RodParameters {
                twist: None,
                contact: None,
                friction: None,
                ..Default::default()
            },
            tube,
            accuracy: Accuracy {
                tolerance,
                ..Default::default()
            },
            ends: Ends::default(),
            first_step: 1e-4,
            longest_step: 1e4,
        }
    }

    /// The same with twist modelled.
    pub fn with_twist(mut self) -> Self {
        self.parameters.twist = Some(0.0);
        self
    }

    /// The same with other ends.
    pub fn with_ends(mut self, ends: Ends) -> Self {
        self.ends = ends;
        self
    }

    /// The same with another stretch stiffness.
    pub fn with_stretch_ratio(mut self, stretch_ratio: f64) -> Self {
        self.parameters.stretch_ratio = stretch_ratio;
        self
    }

    /// The model alone.
    ///
    /// # Panics
    /// When the parameters are refused.
    pub fn model(&self, state: &RodState) -> RodModel {
        RodModel::new(
            &self.parameters,
            &self.tube,
            &self.accuracy,
            Guards::default(),
            self.ends,
            state,
        )
        .expect("a test's own parameters")
    }

    /// A simulation from `state`.
    ///
    /// # Panics
    /// When the parameters are refused or the state has no energy.
    pub fn simulation(&self, state: RodState) -> RodSimulation {
        self.simulation_of(self.model(&state), state)
    }

    /// A simulation of `model` from `state`.
    ///
    /// # Panics
    /// When the state has no energy.
    pub fn simulation_of(&self, mut model: RodModel, state: RodState) -> RodSimulation {
        model.start(&state).expect("a start state with an energy");
        let control = StepControl::new(self.accuracy.tolerance, self.first_step)
            .and_then(|c| c.with_limits(1e-12, self.longest_step))
            .expect("a test's own step lengths")
            .with_max_trials(self.accuracy.max_steps);
        Simulation::new(model, state, RosenbrockW::ros34pw2(), control)
    }
}

/// A rod on `curve` at its natural length, with a uniform twist density.
///
/// # Panics
/// When the curve cannot carry a rod.
pub fn rod(curve: &topo_core::Polyline, twist_density: f64) -> RodState {
    RodState::new(curve, curve.length(), twist_density).expect("a test's own rod")
}

/// Carries a simulation to `until` and insists that it gets there.
///
/// # Panics
/// When it stops before.
pub fn run_to(simulation: &mut RodSimulation, until: f64) {
    let stop = simulation.run(until, &mut [], &mut |_| None);
    assert_eq!(stop, StopReason::ReachedTime, "at {}", simulation.time());
}

/// As [`run_to`], past all times at which the grips of the rod change.
///
/// # Panics
/// When it stops before.
pub fn run_grips_to(simulation: &mut RodSimulation, until: f64) {
    loop {
        let change = simulation.model().next_change().filter(|t| *t < until);
        run_to(simulation, change.unwrap_or(until));
        if change.is_none() {
            return;
        }
        let time = simulation.time();
        simulation.modify(|model, state| model.change_grips(time, state));
    }
}

/// Stored energy of one term, per area.
pub fn stored(simulation: &RodSimulation, term: &str) -> f64 {
    simulation
        .model()
        .account()
        .stored_in(term)
        .unwrap_or_default()
}

/// Charges `curve` for `duration` T0, cuts it where its energy density is largest and follows the discharge for `longest` T0.
///
/// # Panics
/// When the battery cannot be built.
pub fn discharge(battery: &RodBattery, duration: f64, longest: f64) -> Discharge {
    let charge = ChargeSettings {
        duration,
        ..Default::default()
    };
    let settings = DischargeSettings {
        longest,
        ..Default::default()
    };
    battery
        .charge(&charge, &mut RunHooks::default())
        .and_then(|charged| charged.cut(CutSite::MaximumEnergyDensity))
        .and_then(|cut| cut.discharge(&settings, &mut RunHooks::default()))
        .expect("a battery of a test")
}
