//! One case: charge a knot, cut it where the scene says, follow each discharge, and write a folder.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::json;
use topo_core::{CpuClock, Interrupt, StopReason, write_atomic_bytes};
use topo_knots::{KnotEntry, KnotTable, TightKnot, identify};
use topo_rod::{
    ChargedRod, CutSite, Discharge, Guards, PhaseReport, RodBattery, RodSample, energy_density,
};

use crate::AnalysisError;
use crate::imperfection::perturbed;
use crate::scene::{Cuts, ElasticCase, ElasticScene, NEAR_TIE};
use crate::sweep::make_folder;
use crate::table::{SweepRow, write_table};
use crate::timeline::Timeline;
use crate::times::{DischargeTimes, ELASTIC_SHARES};

/// Changes whenever the same scene gives other numbers than before; finished cases of another version are computed again.
pub const RESULTS_VERSION: u32 = 1;

/// Elastic parts of the energy, without contact.
pub(crate) const ELASTIC: [&str; 3] = ["bend", "twist", "stretch"];

/// What a later run needs to know of a finished case.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct CaseSummary {
    pub fingerprint: String,
    pub rows: Vec<SweepRow>,
}

/// Identity of a case: everything that its numbers depend on.
pub(crate) fn fingerprint(scene: &ElasticScene, case: &ElasticCase, entry: &KnotEntry) -> String {
    let all = json!({
        "version": RESULTS_VERSION, "case": case, "knot": entry, "tighten": scene.tighten, "imperfection": scene.imperfection,
        "seed": scene.seed, "charge": scene.charge, "cuts": scene.cuts, "discharge": scene.discharge,
        "timeline": scene.timeline, "accuracy": scene.accuracy, "guards": Guards::default(),
    });
    blake3::hash(all.to_string().as_bytes()).to_hex()[..16].to_owned()
}

/// The finished case in `folder`, if it is there and of the same identity.
pub(crate) fn finished(folder: &Path, fingerprint: &str) -> Option<Vec<SweepRow>> {
    let text = std::fs::read_to_string(folder.join("run.json")).ok()?;
    let summary: CaseSummary = match serde_json::from_str(&text) {
        Ok(summary) => summary,
        Err(error) => {
            tracing::warn!(folder = %folder.display(), %error, "run.json is not readable: the case is computed again");
            return None;
        }
    };
    if summary.fingerprint != fingerprint {
        tracing::info!(folder = %folder.display(), "the case was computed with other settings: it is computed again");
        return None;
    }
    Some(summary.rows)
}

/// Twists and relaxes the knot of a case.
pub(crate) fn charge(
    scene: &ElasticScene,
    case: &ElasticCase,
    tight: &TightKnot,
    interrupt: &Interrupt,
) -> Result<ChargedRod, AnalysisError> {
    let refuse = |source| AnalysisError::Rod {
        case: case.name(),
        source,
    };
    let start = tight.centreline(case.rod.n_edges)?;
    let tube = case.rod.tube(start.ropelength).map_err(refuse)?;
    let size = scene.imperfection * start.curve.length() / tube.start_length;
    let curve = perturbed(&start.curve, size, scene.seed).map_err(|e| refuse(e.into()))?;
    RodBattery::new(
        &case.rod,
        &scene.accuracy,
        Guards::default(),
        &curve,
        start.ropelength,
    )
    .and_then(|battery| battery.charge(&scene.charge, interrupt))
    .map_err(refuse)
}

/// One cut of a charged rod, followed to its end.
struct FollowedCut {
    discharge: Discharge,
    times: DischargeTimes,
    timeline: Timeline,
    row: SweepRow,
}

/// Runs a case and writes its folder; `None` when interrupted, and then nothing is written.
pub(crate) fn run(
    scene: &ElasticScene,
    case: &ElasticCase,
    tight: &TightKnot,
    table: &KnotTable,
    folder: &Path,
    interrupt: &Interrupt,
) -> Result<Option<Vec<SweepRow>>, AnalysisError> {
    let refuse = |source| AnalysisError::Rod {
        case: case.name(),
        source,
    };
    let clock = CpuClock::start();
    let charged = charge(scene, case, tight, interrupt)?;
    let charge_seconds = clock.seconds();
    if interrupt.is_requested() {
        return Ok(None);
    }
    let sites: Vec<f64> = match scene.cuts {
        Cuts::Argmax => vec![charged.cut_candidates(0.0)[0].at],
        Cuts::NearTies => charged
            .cut_candidates(NEAR_TIE)
            .iter()
            .map(|c| c.at)
            .collect(),
        Cuts::All(k) => (0..k).map(|i| i as f64 / k as f64).collect(),
    };
    let mut base = charged_row(case, &charged, table);
    let mut runs = Vec::new();
    if charged.record().report.stop.is_success() {
        for &at in &sites {
            let clock = CpuClock::start();
            let discharge = charged
                .cut(CutSite::At(at))
                .and_then(|c| c.discharge(&scene.discharge, interrupt))
                .map_err(refuse)?;
            if interrupt.is_requested() {
                return Ok(None);
            }
            let curves: Vec<_> = discharge
                .record
                .samples
                .iter()
                .map(|s| (s.time, s.state.vertices()))
                .collect();
            let timeline = Timeline::of(&curves, table, scene.timeline, scene.seed)?;
            let times = DischargeTimes::of(
                &discharge.record.curve,
                &ELASTIC,
                discharge.start,
                &ELASTIC_SHARES,
            );
            let row = discharge_row(
                &base,
                &discharge,
                &times,
                &timeline,
                clock.seconds() + charge_seconds / sites.len() as f64,
            );
            runs.push(FollowedCut {
                discharge,
                times,
                timeline,
                row,
            });
        }
    } else {
        base.cpu_seconds = charge_seconds;
    }
    let rows: Vec<SweepRow> = if runs.is_empty() {
        vec![base]
    } else {
        runs.iter().map(|r| r.row.clone()).collect()
    };
    let written = write_case(
        scene,
        case,
        tight,
        table,
        &charged,
        &runs,
        &rows,
        charge_seconds,
        folder,
    );
    if let Err(error) = written {
        // a folder without its run.json is of no use to anybody; what matters is the first error
        if let Err(left) = std::fs::remove_dir_all(folder) {
            tracing::debug!(folder = %folder.display(), %left, "an incomplete case stays behind");
        }
        return Err(error);
    }
    Ok(Some(rows))
}

fn push_warning(warnings: &mut String, text: &str) {
    if !warnings.is_empty() {
        warnings.push(';');
    }
    // `;` separates warnings
    warnings.push_str(&text.replace(';', ","));
}

fn phase_warnings(phase: &str, report: &PhaseReport, warnings: &mut String) {
    if !report.stop.is_success() {
        push_warning(warnings, &format!("{phase} stopped: {}", report.stop));
    }
    if report.ledger_residual > 0.01 {
        push_warning(
            warnings,
            &format!(
                "{phase}: energy account open by {:.1} %",
                100.0 * report.ledger_residual
            ),
        );
    }
    if report.min_distance_over_contact.is_some_and(|d| d < 0.75) {
        push_warning(warnings, &format!("{phase}: strands overlap deeply"));
    }
}

/// The part of a row that all cuts share.
fn charged_row(case: &ElasticCase, charged: &ChargedRod, table: &KnotTable) -> SweepRow {
    let record = charged.record();
    let report = &record.report;
    let mut row = SweepRow {
        knot: case.knot.clone(),
        twist: case.rod.twist.unwrap_or(0.0),
        reading: case.rod.reading.name().to_owned(),
        edges: case.rod.n_edges,
        link_drift: report.link_drift,
        min_distance_over_contact: report.min_distance_over_contact,
        steps: report.n_steps,
        rejected: report.rejections.total(),
        ..SweepRow::default()
    };
    if let Some(last) = record.samples.last() {
        row.energy = last.elastic();
        [row.bend, row.twist_energy, row.stretch, _] = last.stored;
        (row.writhe, row.total_twist) = (last.writhe, last.total_twist);
    }
    phase_warnings("charge", report, &mut row.warnings);
    if case.rod.contact.is_none() {
        push_warning(
            &mut row.warnings,
            "no contact: strands pass through each other",
        );
    }
    match identify(charged.state().vertices(), table) {
        Ok(kind) if kind.names.contains(&case.knot) => {}
        Ok(kind) => push_warning(
            &mut row.warnings,
            &format!("the charged rod is tied as {}", kind.label()),
        ),
        Err(error) => push_warning(
            &mut row.warnings,
            &format!("the charged rod has no knot type: {error}"),
        ),
    }
    row
}

fn discharge_row(
    base: &SweepRow,
    discharge: &Discharge,
    times: &DischargeTimes,
    timeline: &Timeline,
    cpu_seconds: f64,
) -> SweepRow {
    let report = &discharge.record.report;
    let at = |share| times.at(share).map(|t| t.value);
    let mut row = SweepRow {
        cut: discharge.at,
        t50: at(0.5),
        t90: at(0.9),
        t95: at(0.95),
        t99: at(0.99),
        t_untie: timeline.untying_time(),
        min_distance_over_contact: base
            .min_distance_over_contact
            .into_iter()
            .chain(report.min_distance_over_contact)
            .reduce(f64::min),
        steps: base.steps + report.n_steps,
        rejected: base.rejected + report.rejections.total(),
        cpu_seconds,
        ..base.clone()
    };
    if report.stop == StopReason::ReachedTime {
        push_warning(
            &mut row.warnings,
            "discharge not finished in the longest time followed",
        );
    }
    phase_warnings("discharge", report, &mut row.warnings);
    row
}

/// A vertex of the charged rod.
#[derive(Serialize)]
struct ChargedVertex {
    s: f64,
    x: f64,
    y: f64,
    z: f64,
    twist: f64,
    energy_density: f64,
}

/// A vertex of the open rod at one time.
#[derive(Serialize)]
struct SnapshotVertex {
    cut: f64,
    time: f64,
    s: f64,
    x: f64,
    y: f64,
    z: f64,
    energy_density: f64,
}

/// The open or closed rod at an output time.
#[derive(Serialize)]
struct SeriesRow<'a> {
    cut: Option<f64>,
    time: f64,
    energy: f64,
    bend: f64,
    twist_energy: f64,
    stretch: f64,
    contact_energy: f64,
    dissipated_viscosity: f64,
    dissipated_twist: f64,
    dissipated_friction: f64,
    work: f64,
    writhe: f64,
    total_twist: f64,
    n_contacts: usize,
    min_distance: Option<f64>,
    end_to_end: f64,
    knot: &'a str,
    knot_probability: Option<f64>,
}

fn series_row<'a>(
    cut: Option<f64>,
    s: &RodSample,
    timeline: Option<(&'a Timeline, usize)>,
) -> SeriesRow<'a> {
    let typed = timeline.and_then(|(t, k)| t.at(k));
    SeriesRow {
        cut,
        time: s.time,
        energy: s.elastic(),
        bend: s.stored[0],
        twist_energy: s.stored[1],
        stretch: s.stored[2],
        contact_energy: s.stored[3],
        dissipated_viscosity: s.dissipated[0],
        dissipated_twist: s.dissipated[1],
        dissipated_friction: s.dissipated[2],
        work: s.work,
        writhe: s.writhe,
        total_twist: s.total_twist,
        n_contacts: s.n_contacts,
        min_distance: s.min_distance,
        end_to_end: s.end_to_end,
        knot: typed.map_or("", |t| &t.knot),
        knot_probability: typed.map(|t| t.probability),
    }
}

/// Energies relative to the start at which the shape is kept.
const SNAPSHOT_SHARES: [f64; 11] = [1.0, 0.9, 0.75, 0.5, 0.35, 0.2, 0.1, 0.05, 0.02, 0.01, 0.002];

fn snapshot_indices(samples: &[RodSample]) -> Vec<usize> {
    let Some(first) = samples.first() else {
        return Vec::new();
    };
    let start = first.elastic();
    let mut indices: Vec<usize> = SNAPSHOT_SHARES
        .iter()
        .filter_map(|share| samples.iter().position(|s| s.elastic() <= share * start))
        .chain([samples.len() - 1])
        .collect();
    indices.dedup();
    indices
}

/// Takes away the mark of completeness of an earlier run, so that a folder never mixes two.
fn forget(folder: &Path) -> Result<(), AnalysisError> {
    match std::fs::remove_file(folder.join("run.json")) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
            Err(AnalysisError::Output {
                path: folder.to_owned(),
                source,
            })
        }
        _ => Ok(()),
    }
}

#[allow(clippy::too_many_arguments)] // one writer of one folder: everything a case has made
fn write_case(
    scene: &ElasticScene,
    case: &ElasticCase,
    tight: &TightKnot,
    table: &KnotTable,
    charged: &ChargedRod,
    runs: &[FollowedCut],
    rows: &[SweepRow],
    charge_seconds: f64,
    folder: &Path,
) -> Result<(), AnalysisError> {
    let area = std::f64::consts::PI;
    make_folder(folder)?;
    forget(folder)?;
    let state = charged.state();
    let vertices: Vec<ChargedVertex> = (0..state.n_vertices())
        .map(|i| {
            let x = state.vertices()[i];
            let (s, density) = (i as f64 * state.rest_length(), charged.density()[i] * area);
            ChargedVertex {
                s,
                x: x.x,
                y: x.y,
                z: x.z,
                twist: state.twists()[i] / state.rest_length(),
                energy_density: density,
            }
        })
        .collect();
    write_table(&folder.join("charged.csv"), &vertices)?;
    let series: Vec<_> = charged
        .record()
        .samples
        .iter()
        .map(|s| series_row(None, s, None))
        .collect();
    write_table(&folder.join("charge.csv"), &series)?;
    let mut series = Vec::new();
    let mut snapshots = Vec::new();
    for FollowedCut {
        discharge,
        timeline,
        ..
    } in runs
    {
        let samples = &discharge.record.samples;
        series.extend(
            samples
                .iter()
                .enumerate()
                .map(|(k, s)| series_row(Some(discharge.at), s, Some((timeline, k)))),
        );
        for k in snapshot_indices(samples) {
            let state = &samples[k].state;
            let density = energy_density(&case.rod, state);
            snapshots.extend(
                state
                    .vertices()
                    .iter()
                    .enumerate()
                    .map(|(i, x)| SnapshotVertex {
                        cut: discharge.at,
                        time: samples[k].time,
                        s: i as f64 * state.rest_length(),
                        x: x.x,
                        y: x.y,
                        z: x.z,
                        energy_density: density[i] * area,
                    }),
            );
        }
    }
    write_table(&folder.join("series.csv"), &series)?;
    write_table(&folder.join("snapshots.csv"), &snapshots)?;
    let entry = table.get(&case.knot)?;
    let cuts: Vec<_> = runs
        .iter()
        .map(|FollowedCut { discharge: d, times, timeline, row }| {
            json!({
                "cut": d.at, "energy_removed_by_cut": d.removed, "elastic_energy_after_cut": d.start, "tips_parted": d.parted,
                "times": times, "knot_sequence": timeline.sequence(), "t_untie": row.t_untie, "report": d.record.report,
                "warnings": row.warnings,
            })
        })
        .collect();
    let ledger_residual = runs
        .iter()
        .map(|r| r.discharge.record.report.ledger_residual)
        .fold(charged.record().report.ledger_residual, f64::max);
    let run = json!({
        "schema": "topo-elastic-case/1",
        "fingerprint": fingerprint(scene, case, entry),
        "case": case,
        "scene": scene,
        "seed": scene.seed,
        "versions": { "topo": env!("CARGO_PKG_VERSION"), "results": RESULTS_VERSION },
        "units": { "length": "h", "time": "T_0 = 2 L eta/(h E_b)", "energy": "E_0 = E_b h^2 L" },
        "tube": charged.battery().tube(),
        "start": { "length_over_radius": tight.length_over_radius, "knot": entry },
        "guards": Guards::default(),
        "ledger_residual": ledger_residual,
        "charge": charged.record().report,
        "cuts": cuts,
        "rows": rows,
        "warnings": rows.iter().map(|r| &r.warnings).filter(|w| !w.is_empty()).collect::<Vec<_>>(),
        "timings": { "charge_cpu_seconds": charge_seconds, "cpu_seconds": rows.iter().map(|r| r.cpu_seconds).sum::<f64>() },
    });
    // written last: a folder with this file is complete
    let mut text = serde_json::to_string_pretty(&run).unwrap_or_default();
    text.push('\n');
    Ok(write_atomic_bytes(
        &folder.join("run.json"),
        text.as_bytes(),
    )?)
}
