//! A discharge in progress, as its checkpoint keeps it.

use serde::{Deserialize, Serialize};
use topo_core::{Counters, DischargeCurve, Ledger, MOST_COUNTED, StepControl, TimeStepping};

use super::flow::CoupledMemory;
use super::flow_direction::FlowDirection;
use crate::battery::hooks::RunHooks;
use crate::battery::record::{CHANNELS, NematicSample};
use crate::{EnergyParts, NematicError, NematicState};

const SCHEMA: &str = "nematic-discharge/6";

/// A discharge that is not finished, without its field and its flow.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Unfinished {
    pub steps: TimeStepping,
    pub ledger: Ledger,
    pub counters: Counters,
    pub curve: DischargeCurve,
    pub samples: Vec<NematicSample>,
    pub direction: FlowDirection,
    pub cpu_seconds: f64,
    /// Share of the ramp that the surface has reached.
    pub ramped: f64,
}

/// What a checkpoint holds, its field in the layout of states.
type Saved = (Unfinished, Vec<f64>, Option<CoupledMemory>);

/// The state from which a discharge continues.
pub(super) struct Start {
    pub run: Unfinished,
    pub memory: Option<CoupledMemory>,
    /// It comes from a checkpoint.
    pub is_resumed: bool,
}

impl Start {
    /// The checkpoint of the case, whose field `state` takes over, or `fresh`.
    pub fn find(
        fresh: Unfinished,
        case: &str,
        until: f64,
        state: &mut NematicState,
        hooks: &RunHooks<'_>,
    ) -> Result<Self, NematicError> {
        let length = state.q_tensor().len();
        let resumed = hooks.resume(SCHEMA, case, |(run, q, memory): &Saved| {
            let is_sound = q.len() == length
                && q.iter().all(|x| x.is_finite())
                && run.direction.fits(length / 5)
                && memory.iter().all(|memory| memory.fits(length));
            if !is_sound {
                return Some("the field is one of another grid");
            }
            run.flaw(&fresh, until)
        })?;
        let Some((run, q, memory)) = resumed else {
            return Ok(Self {
                run: fresh,
                memory: None,
                is_resumed: false,
            });
        };
        state.q_mut().copy_from_slice(&q);
        Ok(Self {
            run,
            memory,
            is_resumed: true,
        })
    }
}

/// Writes the checkpoint of the case.
pub(super) fn save(
    run: &Unfinished,
    state: &NematicState,
    memory: Option<CoupledMemory>,
    case: &str,
    hooks: &mut RunHooks<'_>,
) -> Result<(), NematicError> {
    Ok(hooks.save(SCHEMA, case, &(run, state.q_tensor(), memory))?)
}

impl Unfinished {
    /// A discharge that has not begun, with `energy` stored.
    pub fn fresh(control: StepControl, energy: &EnergyParts) -> Self {
        let mut ledger = Ledger::new(&EnergyParts::NAMES, &CHANNELS);
        ledger.set_stored(&energy.as_array());
        Self {
            steps: TimeStepping::new(control),
            ledger,
            counters: Counters::default(),
            curve: DischargeCurve::new(EnergyParts::NAMES, CHANNELS),
            samples: Vec::new(),
            direction: FlowDirection::default(),
            cpu_seconds: 0.0,
            ramped: 0.0,
        }
    }

    /// What does not fit a discharge that begins like `fresh` and is followed until `until`.
    fn flaw(&self, fresh: &Self, until: f64) -> Option<&'static str> {
        let n = &self.counters;
        let counts = [n.n_rate_evaluations, n.n_factorisations, n.n_solves];
        let time = self.steps.time();
        let mut last = -1.0;
        let in_order = self.samples.iter().all(|s| {
            let grows = s.time > last && s.time <= time;
            last = s.time;
            grows && s.energy.total().is_finite() && s.dissipated.iter().all(|x| x.is_finite())
        });
        let curve = &self.curve;
        if !(0.0..=1.0).contains(&self.ramped) {
            Some("its time is none of this run")
        } else if let Some(flaw) = self.steps.flaw(fresh.steps.control(), until) {
            Some(flaw)
        } else if self.ledger.terms() != fresh.ledger.terms()
            || self.ledger.channels() != fresh.ledger.channels()
        {
            Some("the energy account is one of another model")
        } else if curve.parts() != fresh.curve.parts()
            || curve.channels() != fresh.curve.channels()
            || curve.time().last().is_some_and(|t| *t > time)
            || !in_order
        {
            Some("the samples are those of another run")
        } else if counts.iter().any(|n| *n >= MOST_COUNTED) || !self.cpu_seconds.is_finite() {
            Some("a counter is out of range")
        } else {
            None
        }
    }
}
