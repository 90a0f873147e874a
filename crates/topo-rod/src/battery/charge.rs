//! Charging: the twisted rod relaxes with its ends fused.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::{Phase, Schedule, StopReason, positive};

use super::RodBattery;
use super::cut::{CutCandidate, candidates_of};
use super::hooks::RunHooks;
use super::phase::{Course, Finished, RodPhaseRun};
use super::record::{PhaseReport, Recorder, RunRecord, Scales};
use crate::model::Drive;
use crate::{Breaking, Broken, RodEnds, RodError, RodState, TimeCourse};

/// How long a rod is charged and how often it is sampled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ChargeSettings {
    /// Duration of the relaxation, in T_0: long enough to reach the buckled plateau, short enough that instabilities of that
    /// plateau which grow from rounding errors alone (rates of about 2 per T_0 at high twist) do not decide the state.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub duration: f64,
    /// First output time after the start, in T_0.
    pub first_output: f64,
    /// Output times per decade.
    pub outputs_per_decade: f64,
    /// Whether the fibre breaks by itself, which ends the charge; `None`: nothing is held against a threshold.
    #[serde(rename = "break", skip_serializing_if = "Option::is_none")]
    pub breaking: Option<Breaking>,
    /// How the twist is put in, if not at once.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub twisting: Option<Twisting>,
}

/// Twisting in time: the rods are tied without twist, relax for the duration of the charge, are twisted while the ends of each are held
/// together, are fused, and relax for that duration again.
///
/// The ends are turned against each other at a constant rate, by θ'L in all; or by a torque, however far that takes them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Twisting {
    /// Time that the twisting takes.
    #[schemars(extend("x-unit" = "T_0", "exclusiveMinimum" = 0), example = 5.0)]
    pub over: f64,
    /// Torque that turns the ends, in that which a straight rod of the twist θ' of the case carries: constant, a ramp or a table of times
    /// from the start of the twisting. They are fused at the turn that they have reached.
    #[schemars(extend("x-unit" = "(α/4) θ'h E_b A h", "x-default" = "turned at a constant rate", "examples" = [{ "to": 1.0, "over": 5.0 }]))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<TimeCourse>,
}

impl Default for ChargeSettings {
    fn default() -> Self {
        Self {
            duration: 2.0,
            first_output: 1e-2,
            outputs_per_decade: 8.0,
            breaking: None,
            twisting: None,
        }
    }
}

impl ChargeSettings {
    /// Checks every number.
    ///
    /// # Errors
    /// Names the first value out of range and what would be right.
    pub fn checked(&self) -> Result<(), RodError> {
        positive("charge.duration", self.duration)?;
        positive("charge.first_output", self.first_output)?;
        positive("charge.outputs_per_decade", self.outputs_per_decade)?;
        self.breaking.map(Breaking::checked).transpose()?;
        if let Some(twisting) = &self.twisting {
            positive("charge.twisting.over", twisting.over)?;
            if let Some(torque) = &twisting.torque {
                torque.checked("charge.twisting.torque", false)?;
            }
        }
        Ok(())
    }
}

/// A charged battery: the relaxed closed rod, and how it got there.
#[derive(Debug, Clone)]
pub struct ChargedRod {
    pub(super) battery: RodBattery,
    pub(super) state: RodState,
    pub(super) density: Vec<f64>,
    pub(super) record: RunRecord,
    /// Elastic energy when twisting in time began, in E_0.
    pub(super) tied: Option<f64>,
    pub(super) broken: Option<Broken>,
}

impl RodBattery {
    /// Relaxes the twisted closed rod.
    ///
    /// A run that cannot continue returns what it has; its report gives the reason. One that
    /// [breaks](ChargeSettings::breaking) ends with the step after which the threshold is exceeded.
    ///
    /// # Errors
    /// A setting out of range, a start curve that has no finite energy, or a checkpoint that cannot be used.
    pub fn charge(
        &self,
        settings: &ChargeSettings,
        hooks: &mut RunHooks<'_>,
    ) -> Result<ChargedRod, RodError> {
        settings.checked()?;
        let mut state = self.start.clone();
        let scales = Scales::of(&state);
        let mut until = settings.duration * scales.time;
        let mut model = self.model(&state, RodEnds::default())?;
        if let (Some(twisting), Some(density)) = (&settings.twisting, self.parameters.twist) {
            let times = [until, until + twisting.over * scales.time];
            let drive = match &twisting.torque {
                Some(torque) => Drive::Torque(torque.scaled(scales.time)),
                None => Drive::Turn,
            };
            state = state.untwisted(density);
            model = model.with_twisting(density, drive, times, &state)?;
            until += times[1];
        }
        model.start(&state)?;
        let outputs = Schedule::log_spaced(
            settings.first_output * scales.time,
            settings.outputs_per_decade,
        )?;
        let has_twist = self.parameters.twist.is_some();
        let recorder = Recorder::new(scales, self.tube, has_twist, model.parts(), outputs);
        let course = Course {
            phase: Phase::Charge,
            until,
            opened: None,
            release: None,
            breaking: settings.breaking,
        };
        let system = (model, state);
        let mut run = RodPhaseRun::begin(self, course, system, recorder, settings, hooks)?;
        let stop = run.go(hooks)?;
        let Finished {
            mut record,
            state,
            tied,
            ..
        } = run.finish(stop, hooks)?;
        self.check_links(&mut record.report);
        let breaking = settings.breaking;
        let site = breaking.and_then(|breaking| self.broken_at(breaking, &state));
        Ok(ChargedRod {
            battery: self.clone(),
            tied,
            density: self.energy_density(&state),
            state,
            broken: site.map(|site| Broken {
                time: record.report.time,
                site,
            }),
            record,
        })
    }

    /// The closed site at which `state` has exceeded what the fibre bears, if it has.
    pub(super) fn broken_at(&self, breaking: Breaking, state: &RodState) -> Option<CutCandidate> {
        let measure = state.smoothed(&self.measure(breaking.criterion, state));
        let largest = candidates_of(state, &measure, 0.0).into_iter().next()?;
        (largest.density > breaking.threshold).then_some(largest)
    }

    /// Fails a phase in which a linking number has drifted: Tw + Wr of a closed component, or that of two of them.
    pub(super) fn check_links(&self, report: &mut PhaseReport) {
        let most = self.guards.link_drift;
        let (own, pairs) = (report.own.link_drift, &report.own.linking);
        let failed = |what| StopReason::Failed {
            why: topo_core::Rejection::Fatal { what },
        };
        if let Some(drift) = own.filter(|d| *d > most) {
            tracing::error!(drift, "the linking number of a closed rod has drifted");
            report.stop = failed("Tw + Wr of the closed rod drifted: strands have crossed");
        } else if let Some(pair) = pairs.iter().find(|pair| pair.drift > most) {
            tracing::error!(
                drift = pair.drift,
                "the linking number of two rods has drifted"
            );
            report.stop = failed("the linking number of two rods drifted: strands have crossed");
        }
    }
}

impl ChargedRod {
    /// The battery it was made from.
    pub fn battery(&self) -> &RodBattery {
        &self.battery
    }

    /// The closed rod.
    pub fn state(&self) -> &RodState {
        &self.state
    }

    /// Elastic energy density at each vertex, per area, in E_b.
    pub fn density(&self) -> &[f64] {
        &self.density
    }

    /// Where and when it broke by itself; nothing where no threshold was named, or none exceeded.
    ///
    /// # Validation
    /// `val_a_swelling_ring_breaks_when_its_tension_passes_the_threshold`
    pub fn broken(&self) -> Option<Broken> {
        self.broken
    }

    /// What the charge took, in E_0: the elastic energy of the rod as it was tied, before it relaxed, and the work of twisting it.
    ///
    /// Twist that is tied in at once is put in against a centreline that does not move, so that its work is the twist energy at the
    /// start. With twist in time the rod has relaxed before, and the work is that of the drive. Of a pulled open rod it is that of
    /// the grips. None of a run without a sample.
    ///
    /// # Validation
    /// `val_price_of_a_twist_tied_in_at_once`, `val_price_of_a_slow_twist`
    pub fn energy_in(&self) -> Option<f64> {
        let samples = &self.record.samples;
        let (first, last) = (samples.first()?, samples.last()?);
        Some(self.tied.unwrap_or(first.elastic()) + last.work)
    }

    /// How it was charged.
    pub fn record(&self) -> &RunRecord {
        &self.record
    }
}
