//! What a phase of a run leaves behind: energies at every step, states at output times, and a report.

use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize};
use topo_core::{DischargeCurve, Ledger, PhaseExtension, Sample, Schedule, StopReason};
use topo_core::{reference_energy, reference_time};

use super::links::{Linking, Links};
use super::simulation::RodSimulation;
use super::tips::tips_have_parted;
use crate::contact::ContactPairs;
use crate::energy::{RodParts, StoredEnergy};
use crate::model::{CHANNELS, LOAD, WorkAccount};
use crate::{GripForce, RodState, Tips, Tube};

/// The rod at one output time.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RodSample {
    /// Time since the start of the phase, in T_0.
    pub time: f64,
    /// Bend, twist, stretch and contact energy, and those of further terms, in E_0.
    pub stored: StoredEnergy,
    /// Dissipated so far by internal viscosity, twist viscosity and friction, in E_0.
    pub dissipated: [f64; 3],
    /// Work done on the rod so far, in E_0.
    pub work: f64,
    /// Work done on the load so far, in E_0; none without a load.
    pub load_work: Option<f64>,
    /// What holds or draws the two ends, per area, in E_b and E_b h; none where nothing does.
    pub grips: [Option<GripForce>; 2],
    /// Writhe of the centreline.
    pub writhe: f64,
    /// Total twist, in turns.
    pub total_twist: f64,
    /// Vertex pairs of different strands closer than the contact diameter.
    pub n_contacts: usize,
    /// Least distance of vertices of different strands, in h; none if no strands are in reach.
    pub min_distance: Option<f64>,
    /// Distance between the ends, in h.
    pub end_to_end: f64,
    /// Positions and twists.
    pub state: RodState,
}

impl RodSample {
    /// Elastic energy, contact left out, in E_0.
    pub fn elastic(&self) -> f64 {
        self.stored.elastic()
    }
}

/// What only a rod reports of a phase.
#[derive(Debug, Clone)]
pub struct RodPhase {
    /// Parts of the stored energy, in the order of curve and samples.
    pub parts: RodParts,
    /// Computational work of the model by component.
    pub work: WorkAccount,
    /// Least distance of vertices of different strands over the contact diameter; none if none came in reach.
    pub min_distance_over_contact: Option<f64>,
    /// Largest |Δ(Tw + Wr)| seen while closed, in turns; none for an open rod or one without twist. Of several components, that
    /// of the closed one with the largest.
    pub link_drift: Option<f64>,
    /// Linking numbers of each two closed components of several.
    pub linking: Vec<Linking>,
    /// What a load took up, if there was one.
    pub load: Option<LoadReport>,
}

/// What a load took up.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LoadReport {
    /// Work done on it, in E_0.
    pub work: f64,
    /// Largest power, in the mean over a step, in E_0/T_0.
    pub peak_power: f64,
}

impl PhaseExtension for RodPhase {
    fn n_bytes(&self) -> u64 {
        self.work.n_bytes()
    }

    fn write_before<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        map.serialize_entry("work", &self.work)
    }

    fn write_after<M: SerializeMap>(&self, _: f64, map: &mut M) -> Result<(), M::Error> {
        map.serialize_entry("min_distance_over_contact", &self.min_distance_over_contact)?;
        map.serialize_entry("link_drift", &self.link_drift)?;
        if let Some(load) = &self.load {
            map.serialize_entry("load", load)?;
        }
        if self.linking.is_empty() {
            return Ok(());
        }
        map.serialize_entry("linking", &self.linking)
    }
}

/// Counters and guards of a phase: times in T_0, the energy account per area in E_b h.
pub type PhaseReport = topo_core::PhaseReport<RodPhase>;

/// What a phase leaves behind: times in T_0, energies in E_0.
pub type RunRecord = topo_core::RunRecord<RodSample, RodPhase>;

/// The units in which times and energies are reported, T_0 and E_0 per cross section.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scales {
    pub time: f64,
    pub energy: f64,
}

impl Scales {
    pub(crate) fn of(state: &RodState) -> Self {
        Self {
            time: reference_time(state.length()),
            energy: reference_energy(state.length()),
        }
    }
}

/// What was seen of a phase so far.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Seen {
    pub curve: DischargeCurve,
    pub samples: Vec<RodSample>,
    link_start: Option<f64>,
    pub link_drift: Option<f64>,
    outputs: Schedule,
    /// Work on a load at the last step, and its largest power.
    load: Option<[f64; 2]>,
}

/// Observer of a phase: the energy curve at every step, the rod and what is measured on it at output times.
pub(super) struct Recorder {
    pub seen: Seen,
    pub scales: Scales,
    pub tube: Tube,
    has_twist: bool,
    pub parts: RodParts,
    /// Values of the current step, kept so that no step allocates.
    stored: Vec<f64>,
    /// The ends that a cut has made.
    opened: Option<Tips>,
    /// Linking numbers of several components.
    links: Links,
    /// Those of the present step.
    grips: [Option<GripForce>; 2],
}

impl Recorder {
    pub(super) fn new(
        scales: Scales,
        tube: Tube,
        has_twist: bool,
        parts: &RodParts,
        outputs: Schedule,
    ) -> Self {
        Self {
            seen: Seen {
                curve: DischargeCurve::new(parts.names(), CHANNELS),
                samples: Vec::new(),
                link_start: None,
                link_drift: None,
                outputs,
                load: None,
            },
            scales,
            tube,
            has_twist,
            parts: parts.clone(),
            stored: Vec::with_capacity(parts.len()),
            opened: None,
            links: Links::default(),
            grips: [None; 2],
        }
    }

    /// The same for a discharge after a cut.
    pub(super) fn of_cut(mut self, tips: Option<Tips>) -> Self {
        self.opened = tips;
        self
    }

    /// What does not fit a phase that begins like this one, of a run from `fresh`, at `time`.
    pub(super) fn flaw(&self, seen: &Seen, fresh: &RodState, time: f64) -> Option<&'static str> {
        let (begun, now) = (&self.seen, time / self.scales.time);
        let mut last = -1.0;
        let in_order = seen.samples.iter().all(|s| {
            let grows = s.time > last && s.time <= now;
            last = s.time;
            grows
                && s.state.is_sound(fresh)
                && s.stored.len() == self.parts.len()
                && s.stored.iter().chain(&s.dissipated).all(|x| x.is_finite())
        });
        let loads = seen.load.iter().flatten().all(|x| x.is_finite());
        let fits = loads
            && seen.curve.parts() == begun.curve.parts()
            && seen.curve.channels() == begun.curve.channels()
            && seen.curve.time().last().is_none_or(|t| *t <= now)
            && begun.outputs.leads_to(&seen.outputs);
        (!in_order || !fits).then_some("the samples are those of another run")
    }

    /// Continues from what was seen before.
    pub(super) fn recall(&mut self, mut seen: Seen) {
        for sample in &mut seen.samples {
            sample.stored = StoredEnergy::new(self.parts.clone(), sample.stored.to_vec());
            self.links.look(&sample.state, self.has_twist);
        }
        self.seen = seen;
    }

    /// Takes the forces of the grips at the present step.
    pub(super) fn watch(&mut self, simulation: &RodSimulation) {
        if simulation.model().has_grips() {
            self.grips = simulation.model().grip_forces(simulation.state());
        }
    }

    /// Records the present step.
    pub(super) fn look(&mut self, sample: &Sample<'_, RodState>) {
        self.look_at_energy(sample);
        if self.seen.outputs.due(sample.time, sample.step) {
            self.look_at_rod(sample);
        }
    }

    fn look_at_energy(&mut self, sample: &Sample<'_, RodState>) {
        let (time, curve) = (sample.time / self.scales.time, &mut self.seen.curve);
        // a run continued after a pause shows its last state again
        if curve.time().last().is_none_or(|last| time > *last) {
            let (books, scale) = (sample.ledger, self.scales.energy);
            if let Some(work) = load_work(books, scale) {
                let before = curve.time().last().zip(self.seen.load);
                let peak = before.map_or(0.0, |(last, [w, peak])| {
                    peak.max((work - w) / (time - last))
                });
                self.seen.load = Some([work, peak]);
            }
            self.stored.clear();
            self.stored.extend(stored(&self.parts, books, scale));
            let dissipated = dissipated(books, scale);
            if let Err(error) = curve.push(time, &self.stored, &dissipated) {
                tracing::warn!(%error, "a step is missing from the energy curve");
            }
        }
    }

    /// Samples the rod, unless that was done at this time.
    pub(super) fn look_at_rod(&mut self, sample: &Sample<'_, RodState>) {
        let (state, time, seen) = (sample.state, sample.time / self.scales.time, &mut self.seen);
        if seen.samples.last().is_some_and(|last| last.time >= time) {
            return;
        }
        let (books, scale) = (sample.ledger, self.scales.energy);
        let energies = stored(&self.parts, books, scale).collect();
        let (writhe, total_twist) = (state.writhe(), state.total_twist());
        if state.n_components() > 1 {
            self.links.look(state, self.has_twist);
            seen.link_drift = self.links.own_drift();
        } else if state.is_closed() && self.has_twist {
            let link = writhe + (total_twist - state.turned_by(0) / std::f64::consts::TAU);
            let start = *seen.link_start.get_or_insert(link);
            seen.link_drift = Some(seen.link_drift.unwrap_or(0.0).max((link - start).abs()));
        }
        let mut pairs = ContactPairs::new(
            self.tube.contact_diameter.max(self.tube.friction_range),
            0.01,
        );
        let parted = self.opened.is_some_and(|tips| {
            let window = pairs.window().outer();
            tips_have_parted(state, tips, self.tube.contact_diameter, window)
        });
        pairs.set_joined(self.opened);
        pairs.set_cyclic(!parted);
        pairs.update(state);
        let touching =
            |p: &&crate::contact::ActivePair| p.strands && p.distance < self.tube.contact_diameter;
        seen.samples.push(RodSample {
            time,
            stored: StoredEnergy::new(self.parts.clone(), energies),
            dissipated: dissipated(books, scale),
            work: books.work() / scale,
            load_work: load_work(books, scale),
            grips: self.grips,
            writhe,
            total_twist,
            n_contacts: pairs.active().iter().filter(touching).count(),
            min_distance: pairs.least_distance(),
            end_to_end: state.end_to_end(),
            state: state.clone(),
        });
    }

    /// What the phase leaves behind.
    pub(super) fn record(
        self,
        simulation: &RodSimulation,
        stop: StopReason,
        cpu_seconds: f64,
    ) -> RunRecord {
        let model = simulation.model();
        let ledger = model.account().clone();
        let distance = model.least_distance() / self.tube.contact_diameter;
        let report = PhaseReport {
            stop,
            time: simulation.time() / self.scales.time,
            n_steps: simulation.n_steps(),
            rejections: simulation.rejections().clone(),
            counters: simulation.counters(),
            ledger_residual: ledger.relative_residual(),
            ledger,
            cpu_seconds,
            own: RodPhase {
                parts: self.parts,
                work: model.work(),
                min_distance_over_contact: Some(distance).filter(|d| d.is_finite()),
                link_drift: self.seen.link_drift,
                linking: self.links.linking(),
                load: (self.seen.load).map(|[work, peak_power]| LoadReport { work, peak_power }),
            },
        };
        RunRecord {
            curve: self.seen.curve,
            samples: self.seen.samples,
            report,
        }
    }
}

fn stored<'a>(
    parts: &'a RodParts,
    books: &'a Ledger,
    scale: f64,
) -> impl Iterator<Item = f64> + 'a {
    let names = parts.names();
    names.map(move |name| books.stored_in(name).unwrap_or(0.0) / scale)
}

fn load_work(books: &Ledger, scale: f64) -> Option<f64> {
    Some(books.dissipated_by(LOAD)? / scale)
}

fn dissipated(books: &Ledger, scale: f64) -> [f64; 3] {
    CHANNELS.map(|name| books.dissipated_by(name).unwrap_or(0.0) / scale)
}
