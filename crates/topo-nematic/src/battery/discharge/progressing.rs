//! A discharge on its way, as its checkpoint keeps it.

use serde::{Deserialize, Serialize};
use topo_core::{DischargeCurve, Ledger, MOST_COUNTED, RejectionCounts, StepControl};

use super::super::record::{CHANNELS, NematicSample};
use crate::EnergyParts;

/// A discharge that is not finished.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Progressing {
    pub time: f64,
    pub control: StepControl,
    pub n_steps: u64,
    pub n_trials: u64,
    pub ledger: Ledger,
    pub rejections: RejectionCounts,
    pub counters: topo_core::Counters,
    pub curve: DischargeCurve,
    pub samples: Vec<NematicSample>,
    pub cpu_seconds: f64,
    /// Share of the ramp at which the surface stands.
    pub ramped: f64,
}

impl Progressing {
    /// A discharge that has not begun, with `energy` stored.
    pub(super) fn fresh(control: StepControl, energy: &EnergyParts) -> Self {
        let mut ledger = Ledger::new(&EnergyParts::NAMES, &CHANNELS);
        ledger.set_stored(&energy.as_array());
        Self {
            time: 0.0,
            control,
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
    }

    /// What does not fit a discharge that begins like `fresh` and is followed until `until`.
    pub(super) fn flaw(&self, fresh: &Self, until: f64) -> Option<&'static str> {
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
