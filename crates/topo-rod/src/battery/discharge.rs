//! Discharging: the cut rod opens until its elastic energy is released.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::{Phase, Schedule, StopReason, in_range, positive};

use super::cut::CutRod;
use super::hooks::RunHooks;
use super::phase::{Course, Finished, RodPhaseRun};
use super::record::{Recorder, RunRecord, Scales};
use crate::{EndLoad, Ends, RodEnds, RodError, Tips};

/// How far a discharge is followed and how often it is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DischargeSettings {
    /// The run ends when this share of the elastic energy left by the cut is released. At least the same share of the energy
    /// before the cut is then released.
    #[schemars(range(min = 1e-6, max = 0.999_999_999))]
    pub until_released: f64,
    /// Longest time followed, in T_0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub longest: f64,
    /// First output time after the cut, in T_0.
    pub first_output: f64,
    /// Output times per decade.
    pub outputs_per_decade: f64,
    /// How the ends of the open rod are held and loaded; of a link, those of the component that was cut.
    pub ends: Ends,
    /// What takes up the work of the ends; nothing by default.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<EndLoad>,
}

impl Default for DischargeSettings {
    fn default() -> Self {
        Self {
            until_released: 0.999,
            longest: 500.0,
            first_output: 1e-3,
            outputs_per_decade: 16.0,
            ends: Ends::default(),
            load: None,
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
        if let Some(load) = self.load {
            load.checked(&self.ends)?;
        }
        Ok(self)
    }
}

/// A discharge: where the rod was cut, what the cut removed, and how the rest was released.
#[derive(Debug, Clone)]
pub struct Discharge {
    /// Place of the cut, s/L along its component.
    pub at: f64,
    /// The component that was cut, from 0.
    pub component: usize,
    /// The ends that the cut made; none where an open rod was let go.
    pub tips: Option<Tips>,
    /// Energy per part that the cut itself removed (contact included), in E_0.
    pub removed: f64,
    /// Elastic energy just before the cut, in E_0: released shares count from it, and what the cut removes counts as released
    /// at once.
    pub start: f64,
    /// Elastic energy just after the cut, in E_0.
    pub after_cut: f64,
    /// Time at which the tips were so far apart that they count as separate strands, in T_0.
    pub parted: Option<f64>,
    /// The run.
    pub record: RunRecord,
}

impl Discharge {
    /// Heat by the end, in E_0: what internal viscosity, twist viscosity and friction dissipated; none of a run without a sample.
    pub fn heat(&self) -> Option<f64> {
        let last = self.record.samples.last()?;
        Some(last.dissipated.iter().sum())
    }

    /// Whether the requested share was released.
    pub fn is_finished(&self) -> bool {
        matches!(self.record.report.stop, StopReason::Condition(_))
    }
}

impl CutRod {
    /// The ends of a discharge on the open components that have them: of an open rod that was cut, the outer end of each half.
    fn placed(&self, ends: Ends) -> RodEnds {
        let one = |end: usize| {
            let mut one = Ends::default();
            (one.conditions[end], one.motions[end]) = (ends.conditions[end], ends.motions[end]);
            one
        };
        RodEnds::Each(match self.tips {
            Some(Tips::Between(c)) => vec![(c, one(0)), (c + 1, one(1))],
            _ => vec![(self.component, ends)],
        })
    }

    /// Releases the open rod and follows it.
    ///
    /// # Errors
    /// A setting out of range, end conditions that contradict each other, or a checkpoint that cannot be used.
    pub fn discharge(
        &self,
        settings: &DischargeSettings,
        hooks: &mut RunHooks<'_>,
    ) -> Result<Discharge, RodError> {
        let battery = self.charged.battery();
        let has_twist = battery.parameters().twist.is_some();
        settings.checked(has_twist)?;
        let state = self.state.clone();
        let mut model = battery.model(&state, self.placed(settings.ends))?;
        if let Some(load) = settings.load {
            if let Some(Tips::Between(_)) = self.tips {
                return Err(RodError::Load {
                    key: "discharge.load",
                    reason: "a fibre that was open has four ends when it is cut: leave the load or the cut out",
                });
            }
            model = model.with_load(load, self.component, &state)?;
        }
        if self.tips.is_some() {
            model.set_joined(self.tips);
            model.set_cyclic(true);
        }
        let parts = model.parts().clone();
        let before = &self.charged.record().report.ledger;
        let (closed, start) = (before.stored_total(), parts.elastic_of(before));
        model.start(&state)?;
        let scales = Scales::of(&state);
        let opened = model.account().stored_total();
        let after_cut = parts.elastic_of(model.account());
        let removed = self.tips.map_or(0.0, |_| closed - opened);
        if self.tips.is_some() {
            model.record_cut(closed, removed);
        }
        let outputs = Schedule::log_spaced(
            settings.first_output * scales.time,
            settings.outputs_per_decade,
        )?;
        let recorder = Recorder::new(scales, battery.tube(), has_twist, &parts, outputs);
        let recorder = recorder.of_cut(self.tips);
        let course = Course {
            phase: Phase::Discharge,
            until: settings.longest * scales.time,
            opened: self.tips,
            release: Some([after_cut, (1.0 - settings.until_released) * after_cut]),
            breaking: None,
        };
        let of = (settings, before);
        let system = (model, state);
        let mut run = RodPhaseRun::begin(battery, course, system, recorder, &of, hooks)?;
        let stop = run.go(hooks)?;
        let Finished {
            mut record, parted, ..
        } = run.finish(stop, hooks)?;
        battery.check_links(&mut record.report);
        Ok(Discharge {
            at: self.at,
            component: self.component,
            tips: self.tips,
            removed: removed / scales.energy,
            start: start / scales.energy,
            after_cut: after_cut / scales.energy,
            parted: parted.map(|time| time / scales.time),
            record,
        })
    }
}
