//! The folder of a case: charged state, series, snapshots, and `run.json` that marks it complete.

use serde::Serialize;
use serde_json::json;
use topo_rod::{ChargedRod, GripForce, Guards, RodBattery, RodSample, RodState};

use super::case_run::{CaseInputs, CutResults};
use super::observable::{Observable, further};
use crate::LabError;
use crate::folder::Outcome;
use crate::sweep::{About, Place, value};
use topo_analysis::{Further, SweepRow, Timeline};

/// Everything that a case has made.
#[derive(Clone, Copy)]
pub(super) struct CaseResults<'a> {
    pub inputs: &'a CaseInputs<'a>,
    pub charged: &'a ChargedRod,
    pub runs: &'a [CutResults],
    pub outcome: &'a Outcome<SweepRow>,
    pub charge_seconds: f64,
}

/// A vertex of the charged rod.
#[derive(Serialize)]
struct ChargedVertex {
    /// Of a link, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    component: Option<usize>,
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
    /// Of a link, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    component: Option<usize>,
    s: f64,
    x: f64,
    y: f64,
    z: f64,
    energy_density: f64,
    twist: f64,
}

/// A cell of a column that only some tables have.
type Cell = Option<Option<f64>>;

/// The open or closed rod at an output time.
#[derive(Default, Serialize)]
pub(super) struct SeriesRow<'a> {
    cut: Option<f64>,
    time: f64,
    energy: f64,
    bend: f64,
    twist_energy: f64,
    stretch: f64,
    contact_energy: f64,
    #[serde(skip_serializing_if = "Further::is_empty")]
    further: Further,
    dissipated_viscosity: f64,
    dissipated_twist: f64,
    dissipated_friction: f64,
    work: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    work_load: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    grip0_fx: Cell,
    #[serde(skip_serializing_if = "Option::is_none")]
    grip0_fy: Cell,
    #[serde(skip_serializing_if = "Option::is_none")]
    grip0_fz: Cell,
    #[serde(skip_serializing_if = "Option::is_none")]
    grip0_torque: Cell,
    #[serde(skip_serializing_if = "Option::is_none")]
    grip1_fx: Cell,
    #[serde(skip_serializing_if = "Option::is_none")]
    grip1_fy: Cell,
    #[serde(skip_serializing_if = "Option::is_none")]
    grip1_fz: Cell,
    #[serde(skip_serializing_if = "Option::is_none")]
    grip1_torque: Cell,
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
    observables: &[Observable],
    has_grips: bool,
) -> SeriesRow<'a> {
    let typed = timeline.and_then(|(t, k)| t.at(k));
    let grip = |end: usize, k: usize| -> Cell {
        let part = |grip: &GripForce| match k {
            3 => grip.torque,
            _ => grip.force[k],
        };
        has_grips.then(|| s.grips[end].as_ref().map(part))
    };
    SeriesRow {
        cut,
        time: s.time,
        energy: s.elastic(),
        bend: s.stored.of("bend"),
        twist_energy: s.stored.of("twist"),
        stretch: s.stored.of("stretch"),
        contact_energy: s.stored.of("contact"),
        further: further(s, observables),
        dissipated_viscosity: s.dissipated[0],
        dissipated_twist: s.dissipated[1],
        dissipated_friction: s.dissipated[2],
        work: s.work,
        work_load: s.load_work,
        grip0_fx: grip(0, 0),
        grip0_fy: grip(0, 1),
        grip0_fz: grip(0, 2),
        grip0_torque: grip(0, 3),
        grip1_fx: grip(1, 0),
        grip1_fy: grip(1, 1),
        grip1_fz: grip(1, 2),
        grip1_torque: grip(1, 3),
        writhe: s.writhe,
        total_twist: s.total_twist,
        n_contacts: s.n_contacts,
        min_distance: s.min_distance,
        end_to_end: s.end_to_end,
        knot: typed.map_or("", |t| &t.knot),
        knot_probability: typed.map(|t| t.probability),
    }
}

/// Energies relative to that before the cut at which the shape is kept.
const SNAPSHOT_SHARES: [f64; 11] = [1.0, 0.9, 0.75, 0.5, 0.35, 0.2, 0.1, 0.05, 0.02, 0.01, 0.002];

fn snapshot_indices(samples: &[RodSample], start: f64) -> Vec<usize> {
    if samples.is_empty() {
        return Vec::new();
    }
    let mut indices: Vec<usize> = SNAPSHOT_SHARES
        .iter()
        .filter_map(|share| samples.iter().position(|s| s.elastic() <= share * start))
        .chain([samples.len() - 1])
        .collect();
    indices.dedup();
    indices
}

/// Writes the folder of a case; what is there of an earlier run is replaced.
pub(super) fn write_case(made: &CaseResults<'_>, place: &Place<'_>) -> Result<(), LabError> {
    let CaseResults {
        inputs,
        charged,
        runs,
        outcome,
        charge_seconds,
    } = *made;
    let (scene, observables) = (inputs.scene, &inputs.scene.observables);
    let has_grips = !scene.discharge.ends.is_free();
    let mut folder = place.open()?;
    folder.table("charged.csv", &charged_vertices(charged))?;
    let samples = &charged.record().samples;
    let series: Vec<_> = samples
        .iter()
        .map(|s| series_row(None, s, None, observables, scene.pull.is_some()))
        .collect();
    folder.table("charge.csv", &series)?;
    let series: Vec<_> = runs
        .iter()
        .flat_map(|run| run_series(run, observables, has_grips))
        .collect();
    folder.table("series.csv", &series)?;
    let snapshots: Vec<_> = runs
        .iter()
        .flat_map(|run| run_snapshots(charged.battery(), run))
        .collect();
    folder.table("snapshots.csv", &snapshots)?;
    let mut run = folder.about(outcome, about(made)?);
    let cpu_seconds: f64 = outcome.rows.iter().map(|r| r.cpu_seconds).sum();
    run["timings"] = json!({ "charge_cpu_seconds": charge_seconds, "cpu_seconds": cpu_seconds });
    folder.finish(&run)
}

/// Area of the cross-section, in h².
const AREA: f64 = std::f64::consts::PI;

/// A vertex of a component.
struct VertexOf {
    /// Of several, from 1.
    component: Option<usize>,
    vertex: usize,
    /// Arclength along its component, in h.
    s: f64,
    rest_length: f64,
}

/// The vertices of all components, one after the other.
fn vertices_of(state: &RodState) -> impl Iterator<Item = VertexOf> + '_ {
    let chains = state.components();
    let is_link = chains.len() > 1;
    chains.iter().enumerate().flat_map(move |(c, chain)| {
        chain.vertices().map(move |vertex| VertexOf {
            component: is_link.then_some(c + 1),
            vertex,
            s: (vertex - chain.first()) as f64 * chain.rest_length(),
            rest_length: chain.rest_length(),
        })
    })
}

fn charged_vertices(charged: &ChargedRod) -> Vec<ChargedVertex> {
    let state = charged.state();
    let vertex = |at: VertexOf| {
        let x = state.vertices()[at.vertex];
        ChargedVertex {
            component: at.component,
            s: at.s,
            x: x.x,
            y: x.y,
            z: x.z,
            twist: state.twists()[at.vertex] / at.rest_length,
            energy_density: charged.density()[at.vertex] * AREA,
        }
    };
    vertices_of(state).map(vertex).collect()
}

fn run_series<'a>(
    run: &'a CutResults,
    observables: &'a [Observable],
    has_grips: bool,
) -> impl Iterator<Item = SeriesRow<'a>> {
    let (discharge, timeline) = (&run.discharge, &run.timeline);
    let samples = discharge.record.samples.iter().enumerate();
    samples.map(move |(k, s)| {
        series_row(
            Some(run.cut),
            s,
            Some((timeline, k)),
            observables,
            has_grips,
        )
    })
}

fn run_snapshots(battery: &RodBattery, run: &CutResults) -> Vec<SnapshotVertex> {
    let discharge = &run.discharge;
    let samples = &discharge.record.samples;
    let mut snapshots = Vec::new();
    for k in snapshot_indices(samples, discharge.start) {
        let state = &samples[k].state;
        let density = battery.energy_density(state);
        snapshots.extend(vertices_of(state).map(|at| {
            let x = state.vertices()[at.vertex];
            SnapshotVertex {
                cut: run.cut,
                time: samples[k].time,
                component: at.component,
                s: at.s,
                x: x.x,
                y: x.y,
                z: x.z,
                energy_density: density[at.vertex] * AREA,
                twist: state.twists()[at.vertex] / at.rest_length,
            }
        }));
    }
    snapshots
}

/// What `run.json` says of the case.
fn about(made: &CaseResults<'_>) -> Result<About, LabError> {
    let CaseResults {
        inputs,
        charged,
        runs,
        ..
    } = *made;
    let CaseInputs {
        scene,
        case,
        start,
        table,
    } = *inputs;
    let entry = case.entry(table)?;
    let cuts: Vec<_> = runs
        .iter()
        .map(|CutResults { discharge: d, cut, times, times_after_cut, timeline, row, .. }| {
            let mut about = json!({
                "cut": cut, "energy_removed_by_cut": d.removed, "elastic_energy_before_cut": d.start, "elastic_energy_after_cut": d.after_cut,
                "tips_parted": d.parted, "times": times, "times_after_cut": times_after_cut, "knot_sequence": timeline.sequence(), "t_untie": row.t_untie, "report": d.record.report,
                "warnings": row.warnings,
            });
            if case.n_components() > 1 {
                about["component"] = json!(d.component + 1);
            }
            about
        })
        .collect();
    let ledger_residual = runs
        .iter()
        .map(|r| r.discharge.record.report.ledger_residual)
        .fold(charged.record().report.ledger_residual, f64::max);
    let mut more = json!({
        "tube": charged.battery().tube(),
        "start": { "length_over_radius": start.length_over_radius(), "knot": entry },
        "guards": Guards::default(),
        "ledger_residual": ledger_residual,
        "charge": charged.record().report,
        "cuts": cuts,
    });
    if scene.charge.breaking.is_some() {
        more["broken"] = json!(charged.broken());
    }
    Ok(About {
        case: value(case),
        scene: value(scene),
        seed: Some(case.seed),
        units: ["h", "T_0 = 2 L eta/(h E_b)", "E_0 = E_b h^2 L"],
        ledger_residual,
        more,
    })
}
