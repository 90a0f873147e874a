//! What a phase of a run leaves behind: energies at every step, states at output times, and a report.

use topo_core::{reference_energy, reference_time};

use serde::Serialize;
use topo_core::{Counters, DischargeCurve, Ledger, RejectionCounts, Sample, StopReason};

use crate::contact::ContactPairs;
use crate::energy::{RodParts, StoredEnergy};
use crate::model::{CHANNELS, WorkAccount};
use crate::{RodState, Tube};

/// The rod at one output time.
#[derive(Debug, Clone, Serialize)]
pub struct RodSample {
    /// Time since the start of the phase, in T_0.
    pub time: f64,
    /// Bend, twist, stretch and contact energy, and those of further terms, in E_0.
    pub stored: StoredEnergy,
    /// Dissipated so far by internal viscosity, twist viscosity and friction, in E_0.
    pub dissipated: [f64; 3],
    /// Work done on the rod so far, in E_0.
    pub work: f64,
    /// Writhe of the centreline.
    pub writhe: f64,
    /// Total twist, in turns.
    pub total_twist: f64,
    /// Vertex pairs of different strands closer than the contact diameter.
    pub n_contacts: usize,
    /// Least distance of vertices of different strands, in h; none if no strands are in reach.
    pub min_distance: Option<f64>,
    /// Distance of the ends, in h.
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

/// Counters and guards of a phase.
#[derive(Debug, Clone, Serialize)]
pub struct PhaseReport {
    /// Why it ended.
    pub stop: StopReason,
    /// Time it covered, in T_0.
    pub time: f64,
    /// Accepted steps.
    pub n_steps: u64,
    /// Refused steps by name.
    pub rejections: RejectionCounts,
    /// Work of the integrator.
    pub counters: Counters,
    /// Work of the model by component.
    pub work: WorkAccount,
    /// Relative residual of the energy account.
    pub ledger_residual: f64,
    /// The energy account, per area in E_b h.
    pub ledger: Ledger,
    /// Least distance of vertices of different strands over the contact diameter; none if none came in reach.
    pub min_distance_over_contact: Option<f64>,
    /// Largest |Δ(Tw + Wr)| seen while closed, in turns; none for an open rod or one without twist.
    pub link_drift: Option<f64>,
}

/// What a phase leaves behind.
#[derive(Debug, Clone, Serialize)]
pub struct RunRecord {
    /// Parts of the stored energy, in the order of curve and samples.
    pub parts: RodParts,
    /// Energies at every accepted step: times in T_0, energies in E_0.
    pub curve: DischargeCurve,
    /// The rod at output times.
    pub samples: Vec<RodSample>,
    /// Counters and guards.
    pub report: PhaseReport,
}

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

/// Observer of every step: the energy curve.
pub(crate) struct CurveRecorder {
    pub curve: DischargeCurve,
    scales: Scales,
    parts: RodParts,
    /// Of the step in hand, so that none allocates.
    stored: Vec<f64>,
}

impl CurveRecorder {
    pub(crate) fn new(scales: Scales, parts: &RodParts) -> Self {
        Self {
            curve: DischargeCurve::new(parts.names(), CHANNELS),
            scales,
            parts: parts.clone(),
            stored: Vec::with_capacity(parts.len()),
        }
    }

    pub(crate) fn record(&mut self, sample: &Sample<'_, RodState>) {
        let time = sample.time / self.scales.time;
        // a run continued after a pause shows its last state again
        if self.curve.time().last().is_none_or(|last| time > *last) {
            let (books, scale) = (sample.ledger, self.scales.energy);
            self.stored.clear();
            self.stored.extend(stored(&self.parts, books, scale));
            let dissipated = dissipated(books, scale);
            if let Err(error) = self.curve.push(time, &self.stored, &dissipated) {
                tracing::warn!(%error, "a step is missing from the energy curve");
            }
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

fn dissipated(books: &Ledger, scale: f64) -> [f64; 3] {
    CHANNELS.map(|name| books.dissipated_by(name).unwrap_or(0.0) / scale)
}

/// Observer at output times: the rod and what is measured on it.
pub(crate) struct SampleRecorder {
    pub samples: Vec<RodSample>,
    pub link_drift: Option<f64>,
    link_start: Option<f64>,
    scales: Scales,
    tube: Tube,
    has_twist: bool,
    parts: RodParts,
}

impl SampleRecorder {
    pub(crate) fn new(scales: Scales, tube: Tube, has_twist: bool, parts: &RodParts) -> Self {
        Self {
            samples: Vec::new(),
            link_drift: None,
            link_start: None,
            scales,
            tube,
            has_twist,
            parts: parts.clone(),
        }
    }

    pub(crate) fn record(&mut self, sample: &Sample<'_, RodState>) {
        let (state, time) = (sample.state, sample.time / self.scales.time);
        if self.samples.last().is_some_and(|last| last.time >= time) {
            return;
        }
        let (books, scale) = (sample.ledger, self.scales.energy);
        let energies = stored(&self.parts, books, scale).collect();
        let (writhe, total_twist) = (state.writhe(), state.total_twist());
        if state.is_closed() && self.has_twist {
            let link = writhe + total_twist;
            let start = *self.link_start.get_or_insert(link);
            self.link_drift = Some(self.link_drift.unwrap_or(0.0).max((link - start).abs()));
        }
        let mut pairs = ContactPairs::new(
            self.tube.contact_diameter.max(self.tube.friction_range),
            0.01,
        );
        let parted = !state.is_closed()
            && super::tips::tips_have_parted(
                state,
                self.tube.contact_diameter,
                pairs.window().outer(),
            );
        pairs.set_cyclic(!parted);
        pairs.update(state);
        let touching =
            |p: &&crate::contact::ActivePair| p.strands && p.distance < self.tube.contact_diameter;
        self.samples.push(RodSample {
            time,
            stored: StoredEnergy::new(self.parts.clone(), energies),
            dissipated: dissipated(books, scale),
            work: books.work() / scale,
            writhe,
            total_twist,
            n_contacts: pairs.active().iter().filter(touching).count(),
            min_distance: pairs.least_distance(),
            end_to_end: state.end_to_end(),
            state: state.clone(),
        });
    }
}

impl RunRecord {
    pub(crate) fn new(
        simulation: &super::RodSimulation,
        stop: StopReason,
        curve: CurveRecorder,
        samples: SampleRecorder,
    ) -> Self {
        let model = simulation.model();
        let ledger = model.account().clone();
        let distance = model.least_distance() / samples.tube.contact_diameter;
        let report = PhaseReport {
            stop,
            time: simulation.time() / curve.scales.time,
            n_steps: simulation.n_steps(),
            rejections: simulation.rejections().clone(),
            counters: simulation.counters(),
            work: model.work(),
            ledger_residual: ledger.relative_residual(),
            ledger,
            min_distance_over_contact: Some(distance).filter(|d| d.is_finite()),
            link_drift: samples.link_drift,
        };
        Self {
            parts: curve.parts,
            curve: curve.curve,
            samples: samples.samples,
            report,
        }
    }
}
