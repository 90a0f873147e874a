//! A phase of a rod in progress: steps, samples, checkpoints, reports.

use serde::{Deserialize, Serialize};
use topo_core::{CpuClock, Phase, Progress, Sample, SimulationMemory, StopReason, case_identity};

use super::RodBattery;
use super::hooks::RunHooks;
use super::record::{Recorder, RunRecord, Seen};
use super::simulation::{RodSimulation, control_of};
use super::tips::tips_have_parted;
use crate::model::ModelMemory;
use crate::{Breaking, RodError, RodModel, RodState, Tips};

const SCHEMA: &str = "rod-phase/3";

/// What ends a phase, and what is reported of it.
#[derive(Clone, Copy)]
pub(super) struct Course {
    pub phase: Phase,
    /// Longest time, in η/E_b.
    pub until: f64,
    /// The ends that a cut has made.
    pub opened: Option<Tips>,
    /// Elastic energy just after a cut and at which its discharge is over, per area.
    pub release: Option<[f64; 2]>,
    /// What the rod bears; the phase is over when that is exceeded.
    pub breaking: Option<Breaking>,
}

/// A phase in progress.
pub(super) struct RodPhaseRun {
    course: Course,
    /// The battery of a rod that may break.
    bearing: Option<Box<RodBattery>>,
    simulation: RodSimulation,
    recorder: Recorder,
    /// Time at which the tips were so far apart that they count as separate strands, in η/E_b.
    parted: Option<f64>,
    /// Elastic energy when the drives first changed, in E_0.
    tied: Option<f64>,
    case: String,
    clock: CpuClock,
    earlier_cpu_seconds: f64,
}

/// What the memory of a phase holds beside that of its simulation.
#[derive(Clone, Serialize, Deserialize)]
struct Beside {
    parted: Option<f64>,
    tied: Option<f64>,
    cpu_seconds: f64,
}

/// What a checkpoint holds.
type Saved = (SimulationMemory, RodState, ModelMemory, Seen, Beside);

impl RodPhaseRun {
    /// The phase that begins at `state`, or continues from its checkpoint; `of` is what its case depends on besides the
    /// battery.
    pub(super) fn begin(
        battery: &RodBattery,
        course: Course,
        (mut model, state): (RodModel, RodState),
        mut recorder: Recorder,
        of: &impl Serialize,
        hooks: &RunHooks<'_>,
    ) -> Result<Self, RodError> {
        let clock = CpuClock::start();
        let mut case = String::new();
        let mut found = None;
        if hooks.keeps_checkpoints() {
            case = battery.case(&(of, &state));
            let control = control_of(&state, &battery.accuracy)?;
            found = hooks.resume(
                SCHEMA,
                &case,
                |(simulation, reached, memory, seen, beside): &Saved| {
                    if !reached.is_sound(&state) {
                        return Some("the rod is another one");
                    }
                    let n_dof = topo_core::Model::n_dof(&model);
                    let flaw = simulation.flaw(&control, course.until, n_dof);
                    flaw.or_else(|| memory.flaw(&model, reached))
                        .or_else(|| recorder.flaw(seen, &state, simulation.time()))
                        .or_else(|| beside.flaw(simulation.time()))
                },
            )?;
        }
        let (mut parted, mut tied) = (None, None);
        let (mut earlier_cpu_seconds, mut memory, mut start) = (0.0, None, state);
        if let Some((simulation, reached, remembered, seen, beside)) = found {
            model.resume_grips(simulation.time(), &reached);
            if !model.recall(&reached, remembered).unwrap_or(false) {
                return Err(hooks.refused("the matrices do not fit each other").into());
            }
            recorder.recall(seen);
            (parted, tied) = (beside.parted, beside.tied);
            earlier_cpu_seconds = beside.cpu_seconds;
            (memory, start) = (Some(simulation), reached);
        }
        let mut simulation =
            RodSimulation::new(model, start, &battery.accuracy, hooks.interrupt())?;
        if let Some(memory) = memory {
            simulation = simulation.resumed(memory);
        }
        Ok(Self {
            course,
            bearing: course.breaking.map(|_| Box::new(battery.clone())),
            simulation,
            recorder,
            parted,
            tied,
            case,
            clock,
            earlier_cpu_seconds,
        })
    }

    /// Follows the phase to its end.
    pub(super) fn go(&mut self, hooks: &mut RunHooks<'_>) -> Result<StopReason, RodError> {
        loop {
            let n_seen = self.recorder.seen.samples.len();
            let ended = self.advance();
            self.show(n_seen, hooks);
            match ended {
                None => {}
                Some(Ended::Parted) => self.part(),
                Some(Ended::Changed) => self.change(),
                Some(Ended::Over(stop)) => {
                    if stop == StopReason::Interrupted {
                        self.save(hooks)?;
                    }
                    return Ok(stop);
                }
            }
            if hooks.wants_progress() {
                hooks.report(&self.progress());
            }
            // an interrupt ends the run in the next turn, and is saved there
            if hooks.is_due() && !hooks.is_interrupted() {
                self.save(hooks)?;
            }
        }
    }

    /// One step, unless the phase is over.
    fn advance(&mut self) -> Option<Ended> {
        let Course {
            until,
            release,
            opened,
            breaking,
            ..
        } = self.course;
        let bearing = self.bearing.as_deref().zip(breaking);
        let goal = release.map(|[_, goal]| goal);
        let recorder = &mut self.recorder;
        recorder.watch(&self.simulation);
        let (parts, diameter) = (recorder.parts.clone(), recorder.tube.contact_diameter);
        let window = self.simulation.model().pairs().window().outer();
        let is_joined = goal.is_some() && self.parted.is_none();
        let mut parts_now = false;
        let mut over = |s: &Sample<'_, RodState>| {
            if goal.is_some_and(|goal| parts.elastic_of(s.ledger) <= goal) {
                return Some("released".to_owned());
            }
            if bearing.is_some_and(|(rod, bears)| rod.broken_at(bears, s.state).is_some()) {
                return Some("broken".to_owned());
            }
            parts_now = is_joined
                && opened.is_some_and(|tips| tips_have_parted(s.state, tips, diameter, window));
            parts_now.then(|| "tips parted".to_owned())
        };
        let mut see = |s: &Sample<'_, RodState>| recorder.look(s);
        let change = self.simulation.model().next_change();
        let target = change.map_or(until, |change| change.min(until));
        let stop = self.simulation.advance(target, &mut see, &mut over)?;
        let changes = stop == StopReason::ReachedTime && self.simulation.time() < until;
        Some(if parts_now {
            Ended::Parted
        } else if changes {
            Ended::Changed
        } else {
            Ended::Over(stop)
        })
    }

    /// From now on the tips may touch each other as strands do.
    fn part(&mut self) {
        self.parted = Some(self.simulation.time());
        self.simulation.modify(|model, _| model.set_cyclic(false));
    }

    /// From now on the grips do something else.
    fn change(&mut self) {
        let (time, books) = (self.simulation.time(), self.simulation.sample().ledger);
        let elastic = self.recorder.parts.elastic_of(books) / self.recorder.scales.energy;
        self.tied.get_or_insert(elastic);
        self.simulation
            .modify(|model, state| model.change_grips(time, state));
    }

    /// Shows samples that are new.
    fn show(&self, n_seen: usize, hooks: &mut RunHooks<'_>) {
        let samples = &self.recorder.seen.samples;
        if samples.len() > n_seen
            && let Some(see) = hooks.samples()
        {
            samples[n_seen..].iter().for_each(see);
        }
    }

    fn progress(&self) -> Progress {
        let (sample, scales) = (self.simulation.sample(), self.recorder.scales);
        let elastic = self.recorder.parts.elastic_of(sample.ledger);
        let released = |[start, _]: [f64; 2]| 1.0 - elastic / start;
        Progress {
            step: sample.step,
            time: sample.time / scales.time,
            until: Some(self.course.until / scales.time),
            released: self.course.release.map(released),
            energy: Some(elastic / scales.energy),
            ..Progress::at(self.course.phase)
        }
    }

    fn save(&self, hooks: &mut RunHooks<'_>) -> Result<(), RodError> {
        if !hooks.keeps_checkpoints() {
            return Ok(());
        }
        let (simulation, state, model, beside) = self.memory();
        let saved = (simulation, state, model, &self.recorder.seen, beside);
        Ok(hooks.save(SCHEMA, &self.case, &saved)?)
    }

    fn memory(&self) -> (SimulationMemory, &RodState, ModelMemory, Beside) {
        let state = self.simulation.state();
        let beside = Beside {
            parted: self.parted,
            tied: self.tied,
            cpu_seconds: self.cpu_seconds(),
        };
        let model = self.simulation.model().memory(state);
        (self.simulation.memory(), state, model, beside)
    }

    fn cpu_seconds(&self) -> f64 {
        self.earlier_cpu_seconds + self.clock.seconds()
    }

    /// Ends the phase: its last state is sampled, and the result of a finished phase is kept.
    pub(super) fn finish(
        mut self,
        stop: StopReason,
        hooks: &mut RunHooks<'_>,
    ) -> Result<Finished, RodError> {
        if stop.is_success() && hooks.keeps_checkpoints() {
            let (simulation, state, model, beside) = self.memory();
            let saved = (simulation, state, model, &self.recorder.seen, beside);
            hooks.keep(SCHEMA, &self.case, &saved)?;
        }
        let n_seen = self.recorder.seen.samples.len();
        self.recorder.watch(&self.simulation);
        self.recorder.look_at_rod(&self.simulation.sample());
        self.show(n_seen, hooks);
        let cpu_seconds = self.cpu_seconds();
        let record = self.recorder.record(&self.simulation, stop, cpu_seconds);
        Ok(Finished {
            record,
            state: self.simulation.into_state(),
            parted: self.parted,
            tied: self.tied,
        })
    }
}

/// How a turn ended.
enum Ended {
    /// The tips have parted, and the phase continues.
    Parted,
    /// The grips do something else from now on.
    Changed,
    /// The phase is over.
    Over(StopReason),
}

/// What is left of a phase.
pub(super) struct Finished {
    pub record: RunRecord,
    pub state: RodState,
    /// When the tips had parted, in η/E_b.
    pub parted: Option<f64>,
    /// Elastic energy when the drives first changed, in E_0.
    pub tied: Option<f64>,
}

impl Beside {
    /// What does not fit a phase that has reached `time`.
    fn flaw(&self, time: f64) -> Option<&'static str> {
        let parted = self.parted.is_none_or(|t| (0.0..=time).contains(&t));
        let tied = self.tied.is_none_or(f64::is_finite);
        (!parted || !tied || !self.cpu_seconds.is_finite()).then_some("a time is out of range")
    }
}

impl RodBattery {
    /// What a run depends on; of terms supplied by the caller, their names.
    fn case(&self, of: &impl Serialize) -> String {
        let own = self
            .own_terms
            .iter()
            .map(|term| term.make(&self.start).name());
        let names: Vec<&str> = own.collect();
        let all = (&self.parameters, &self.accuracy, &self.guards, &self.tube);
        case_identity(&(all, names, of))
    }
}

#[cfg(test)]
mod tests;
