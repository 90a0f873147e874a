//! Pulling: an open fibre that is held, moved and loaded at its ends in time, and then let go.

use serde::{Deserialize, Serialize};
use topo_core::{Phase, Schedule, in_range, positive};

use super::RodBattery;
use super::charge::ChargedRod;
use super::cut::CutRod;
use super::hooks::RunHooks;
use super::phase::{Course, Finished, RodPhaseRun};
use super::record::{Recorder, Scales};
use crate::{Grip, RodEnds, RodError};

/// How the ends of an open fibre are pulled, for how long, and how often it is sampled.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PullSettings {
    /// How the first and the last end are held, moved and loaded; times are in T_0.
    pub grips: [Grip; 2],
    /// Duration, in T_0.
    pub duration: f64,
    /// Output times, evenly spaced.
    pub outputs: usize,
}

impl PullSettings {
    /// Checks every number, and the grips of a rod whose twist is modelled or not.
    ///
    /// # Errors
    /// Names the first value out of range or order and what would be right.
    pub fn checked(&self, has_twist: bool) -> Result<(), RodError> {
        positive("pull.duration", self.duration)?;
        in_range("pull.outputs", self.outputs as f64, 1.0, 1e5)?;
        crate::ends::GripSchedule::new(&self.grips, 1.0, has_twist).map(drop)
    }
}

impl RodBattery {
    /// Pulls the [open](Self::open) fibre. What it then stores, and what its grips did, is as of a charge.
    ///
    /// A run that cannot continue returns what it has; its report gives the reason.
    ///
    /// # Errors
    /// A setting out of range, a closed fibre, a start curve that has no finite energy, or a checkpoint that cannot be used.
    ///
    /// # Validation
    /// `law_work_of_ends_in_time`, `law_pulled_knots_jam_and_come_loose_without_crossing`
    pub fn pull(
        &self,
        settings: &PullSettings,
        hooks: &mut RunHooks<'_>,
    ) -> Result<ChargedRod, RodError> {
        let has_twist = self.parameters.twist.is_some();
        settings.checked(has_twist)?;
        let state = self.start.clone();
        let scales = Scales::of(&state);
        let model = self.model(&state, RodEnds::default())?;
        let mut model = model.with_grips(&settings.grips, scales.time, &state)?;
        model.start(&state)?;
        let interval = settings.duration / settings.outputs as f64;
        let outputs = Schedule::every(interval * scales.time)?;
        let recorder = Recorder::new(scales, self.tube, has_twist, model.parts(), outputs);
        let course = Course {
            phase: Phase::Charge,
            until: settings.duration * scales.time,
            opened: None,
            release: None,
            breaking: None,
        };
        let system = (model, state);
        let mut run = RodPhaseRun::begin(self, course, system, recorder, settings, hooks)?;
        let stop = run.go(hooks)?;
        let Finished { record, state, .. } = run.finish(stop, hooks)?;
        Ok(ChargedRod {
            battery: self.clone(),
            density: self.energy_density(&state),
            state,
            record,
            tied: None,
            broken: None,
        })
    }
}

impl ChargedRod {
    /// The pulled open fibre, let go: what a discharge starts from, as after a cut that removes nothing.
    ///
    /// # Errors
    /// A fibre whose ends are fused.
    pub fn let_go(&self) -> Result<CutRod, RodError> {
        if self.state.is_closed() {
            return Err(RodError::WrongTopology {
                operation: "letting go",
                needed: "an open",
            });
        }
        let mut state = self.state.clone();
        state.set_clock(0.0);
        Ok(CutRod {
            charged: self.clone(),
            state,
            vertex: 0,
            at: 0.0,
            component: 0,
            tips: None,
        })
    }
}
