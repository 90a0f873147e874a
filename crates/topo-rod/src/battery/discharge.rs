//! Discharging: the cut rod opens until its elastic energy is released.

use serde::{Deserialize, Serialize};
use topo_core::{Interrupt, Ledger, Sample, Schedule, Scheduled, StopReason, in_range, positive};

use super::RodSimulation;
use super::cut::CutRod;
use super::record::{CurveRecorder, RunRecord, SampleRecorder, Scales};
use super::tips::tips_have_parted;
use crate::{Ends, RodError, RodState};

/// How far a discharge is followed and how often it is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DischargeSettings {
    /// Share of the elastic energy whose release ends the run: of that which the cut left, so that the share of what was stored
    /// before the cut is released too.
    pub until_released: f64,
    /// Longest time followed, in T_0.
    pub longest: f64,
    /// First output time after the cut, in T_0.
    pub first_output: f64,
    /// Output times a decade.
    pub outputs_per_decade: f64,
    /// What holds or loads the ends of the open rod.
    pub ends: Ends,
}

impl Default for DischargeSettings {
    fn default() -> Self {
        Self {
            until_released: 0.999,
            longest: 500.0,
            first_output: 1e-3,
            outputs_per_decade: 16.0,
            ends: Ends::default(),
        }
    }
}

impl DischargeSettings {
    /// Checks every number, and the ends of a rod whose twist is modelled or not.
    ///
    /// # Errors
    /// Names the first value out of range and what would be right.
    pub fn checked(self, has_twist: bool) -> Result<Self, RodError> {
        in_range(
            "discharge.until_released",
            self.until_released,
            1e-6,
            1.0 - 1e-9,
        )?;
        positive("discharge.longest", self.longest)?;
        positive("discharge.first_output", self.first_output)?;
        positive("discharge.outputs_per_decade", self.outputs_per_decade)?;
        self.ends.checked(has_twist)?;
        Ok(self)
    }
}

/// A discharge: where it was cut, what the cut took, and how the rest was released.
#[derive(Debug, Clone)]
pub struct Discharge {
    /// Place of the cut, s/L.
    pub at: f64,
    /// Energy per part that the cut itself removed (contact included), in E_0.
    pub removed: f64,
    /// Elastic energy just before the cut, in E_0: released shares count from it, and what the cut removes is released at once.
    pub start: f64,
    /// Elastic energy just after the cut, in E_0.
    pub after_cut: f64,
    /// When the tips had parted so far that they count as separate strands, in T_0.
    pub parted: Option<f64>,
    /// The run.
    pub record: RunRecord,
}

impl Discharge {
    /// Whether the share asked for was released.
    pub fn is_finished(&self) -> bool {
        matches!(self.record.report.stop, StopReason::Condition(_))
    }
}

impl CutRod {
    /// Lets the open rod go.
    ///
    /// # Errors
    /// A setting out of range, or end conditions that contradict each other.
    pub fn discharge(
        &self,
        settings: &DischargeSettings,
        interrupt: &Interrupt,
    ) -> Result<Discharge, RodError> {
        let battery = self.charged.battery();
        let (parameters, tube) = (battery.parameters(), battery.tube());
        settings.checked(parameters.twist.is_some())?;
        let state = self.state.clone();
        let mut model = battery.model(&state, settings.ends)?;
        model.set_cyclic(true);
        let parts = model.parts().clone();
        let elastic_of = |books: &Ledger| parts.elastic_of(books);
        let before = &self.charged.record().report.ledger;
        let (closed, start) = (before.stored_total(), elastic_of(before));
        model.start(&state)?;
        let scales = Scales::of(&state);
        let elastic = |s: &Sample<'_, RodState>| elastic_of(s.ledger);
        let opened = model.account().stored_total();
        let after_cut = elastic_of(model.account());
        model.record_cut(closed, closed - opened);
        let window = model.pairs().window().outer();
        let mut simulation = RodSimulation::new(model, state, battery.accuracy(), interrupt)?;
        let mut curve = CurveRecorder::new(scales, &parts);
        let has_twist = parameters.twist.is_some();
        let mut samples = SampleRecorder::new(scales, tube, has_twist, &parts);
        let outputs = Schedule::log_spaced(
            settings.first_output * scales.time,
            settings.outputs_per_decade,
        )?;
        let (until, goal) = (
            settings.longest * scales.time,
            (1.0 - settings.until_released) * after_cut,
        );
        let mut parted = None;
        let stop = {
            let mut see_step = |s: &Sample<'_, RodState>| curve.record(s);
            let mut see_sample = |s: &Sample<'_, RodState>| samples.record(s);
            let mut observers = [
                Scheduled::new(Schedule::always(), &mut see_step),
                Scheduled::new(outputs, &mut see_sample),
            ];
            let mut has_parted = false;
            let mut stop = simulation.run(until, &mut observers, &mut |s| {
                if elastic(s) <= goal {
                    return Some("released".to_owned());
                }
                has_parted = tips_have_parted(s.state, tube.contact_diameter, window);
                has_parted.then(|| "tips parted".to_owned())
            });
            if has_parted {
                parted = Some(simulation.time() / scales.time);
                simulation.modify(|model, _| model.set_cyclic(false));
                stop = simulation.run(until, &mut observers, &mut |s| {
                    (elastic(s) <= goal).then(|| "released".to_owned())
                });
            }
            stop
        };
        samples.record(&simulation.sample());
        let record = RunRecord::new(&simulation, stop, curve, samples);
        Ok(Discharge {
            at: self.at,
            removed: (closed - opened) / scales.energy,
            start: start / scales.energy,
            after_cut: after_cut / scales.energy,
            parted,
            record,
        })
    }
}
