//! How far the discharge times of a preset are from those of a much finer run.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use topo_core::{CpuClock, Interrupt, RunHooks};
use topo_knots::{KnotEntry, KnotTable};
use topo_rod::{Accuracy, CutSite, Ends, Reading, cut_circle_time};

use super::case::ElasticCase;
use super::case_run::CaseInputs;
use super::run::charge;
use super::scene::ElasticScene;
use crate::LabError;
use crate::knots::Shapes;
use crate::preset::Preset;
use crate::progress::Event;
use topo_analysis::{DischargeTimes, ELASTIC_SHARES};

/// Knots and twists on which accuracy is measured: every knot of the published sweep untwisted, twenty others spread over
/// knots and twists, and the unknot, whose discharge is known in closed form. The list is fixed so that numbers of different versions can be compared.
pub const ACCURACY_CASES: [(&str, f64); 35] = [
    ("3_1", 0.0),
    ("4_1", 0.0),
    ("5_1", 0.0),
    ("5_2", 0.0),
    ("6_1", 0.0),
    ("6_2", 0.0),
    ("6_3", 0.0),
    ("7_1", 0.0),
    ("7_2", 0.0),
    ("7_3", 0.0),
    ("7_4", 0.0),
    ("7_5", 0.0),
    ("7_6", 0.0),
    ("7_7", 0.0),
    ("3_1", 2.0),
    ("3_1", -2.0),
    ("3_1", 1.0),
    ("4_1", 2.0),
    ("4_1", -1.0),
    ("5_1", 1.5),
    ("5_1", -0.5),
    ("5_2", -2.0),
    ("5_2", 0.75),
    ("6_1", 1.0),
    ("6_1", -1.75),
    ("6_2", 2.0),
    ("6_3", -1.25),
    ("7_1", 0.5),
    ("7_1", -2.0),
    ("7_2", 1.75),
    ("7_3", -1.0),
    ("7_4", 1.25),
    ("7_5", -1.5),
    ("7_7", 2.0),
    ("0_1", 0.0),
];

/// One comparison; times in T_0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AccuracyRow {
    /// Knot type.
    pub knot: String,
    /// θ'h.
    pub twist: f64,
    /// Place of the cut, s/L, the same in both runs.
    pub cut: f64,
    /// t50 of the preset.
    pub t50: Option<f64>,
    /// t99 of the preset.
    pub t99: Option<f64>,
    /// t50 of the reference.
    pub t50_reference: Option<f64>,
    /// t99 of the reference.
    pub t99_reference: Option<f64>,
    /// Relative error of t50, in per cent.
    pub t50_error_percent: Option<f64>,
    /// Relative error of t99, in per cent.
    pub t99_error_percent: Option<f64>,
    /// Elastic energy after charging over that of the reference.
    pub energy_ratio: f64,
    /// Processor seconds of the preset.
    pub cpu_seconds: f64,
    /// Processor seconds of the reference.
    pub cpu_seconds_reference: f64,
}

/// The reference: twice the edges, tolerance 1e-4 h, a fresh Newton matrix every step.
pub fn reference_scene(scene: &ElasticScene) -> ElasticScene {
    let mut fine = scene.clone();
    fine.rod.n_edges = 2 * scene.rod.n_edges;
    fine.accuracy = Accuracy {
        max_steps: scene.accuracy.max_steps,
        ..Preset::Reference.accuracy()
    };
    fine
}

/// What one charge and one discharge say; times in T_0, the energy in E_0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MeasuredDischarge {
    /// Place of the cut, s/L.
    pub cut: f64,
    /// Elastic energy after charging.
    pub energy: f64,
    pub t50: Option<f64>,
    pub t99: Option<f64>,
}

/// Charges a case, cuts it and follows the discharge, writing nothing.
pub(crate) fn measured_discharge(
    inputs: &CaseInputs<'_>,
    site: CutSite,
    interrupt: &Interrupt,
) -> Result<MeasuredDischarge, LabError> {
    let mut hooks = RunHooks::new(interrupt);
    let charged = charge(inputs, &mut hooks, None)?.rod;
    let last = charged.record().samples.last();
    let energy = last.map_or(f64::NAN, |s| s.elastic());
    let run = inputs.discharge(&charged, site, &inputs.scene.discharge, &mut hooks)?;
    let parts = run.record.report.own.parts.elastic();
    let times = DischargeTimes::of(&run.record.curve, &parts, run.start, &ELASTIC_SHARES);
    let at = |share| times.at(share).map(|t| t.value);
    Ok(MeasuredDischarge {
        cut: run.at,
        energy,
        t50: at(0.5),
        t99: at(0.99),
    })
}

/// The exact discharge of a case, where it is known: an untwisted unknot is a circle, and cut with free ends it unbends as
/// [`cut_circle_energy`](topo_rod::cut_circle_energy) says.
///
/// # Validation
/// `the_circle_is_known_exactly`
pub(crate) fn exact_discharge(
    scene: &ElasticScene,
    case: &ElasticCase,
    entry: &KnotEntry,
    cut: f64,
) -> Option<MeasuredDischarge> {
    let is_twisted = case.rod.twist.is_some_and(|twist| twist != 0.0);
    let has_more = !scene.own_terms.is_empty() || scene.discharge.ends != Ends::default();
    if !entry.is_unknot() || is_twisted || has_more {
        return None;
    }
    let length = match case.rod.reading {
        Reading::OwnLength => TAU,
        _ => case.rod.slenderness,
    };
    // T_b/T_0 = L/(π² h)
    let time = |share| Some(cut_circle_time(share).ok()? * length / (PI * PI));
    Some(MeasuredDischarge {
        cut,
        energy: 0.125 * PI * (TAU / length).powi(2),
        t50: time(0.5),
        t99: time(0.99),
    })
}

/// The row of a discharge and its reference; `seconds` are those of both.
fn compared(
    knot: String,
    twist: f64,
    found: &MeasuredDischarge,
    reference: &MeasuredDischarge,
    seconds: [f64; 2],
) -> AccuracyRow {
    let error = |a: Option<f64>, b: Option<f64>| a.zip(b).map(|(a, b)| 100.0 * (a / b - 1.0));
    AccuracyRow {
        knot,
        twist,
        cut: found.cut,
        t50: found.t50,
        t99: found.t99,
        t50_reference: reference.t50,
        t99_reference: reference.t99,
        t50_error_percent: error(found.t50, reference.t50),
        t99_error_percent: error(found.t99, reference.t99),
        energy_ratio: found.energy / reference.energy,
        cpu_seconds: seconds[0],
        cpu_seconds_reference: seconds[1],
    }
}

/// Compares the discharges of `scene` with those of [`reference_scene`] on the given knots and twists, cut at the same place, or with the
/// exact one where that is known.
///
/// # Errors
/// As [`run_sweep`](crate::run_sweep).
pub fn measure_accuracy(
    scene: &ElasticScene,
    cases: &[(&str, f64)],
    table: &KnotTable,
    shapes: &Shapes,
    interrupt: &Interrupt,
    progress: &(dyn Fn(Event<'_>) + Sync),
) -> Result<Vec<AccuracyRow>, LabError> {
    let fine = reference_scene(scene);
    let n_done = std::sync::atomic::AtomicUsize::new(0);
    let rows: Vec<Option<AccuracyRow>> = cases
        .par_iter()
        .with_max_len(1)
        .map(|&(knot, twist)| {
            let name = table.get(knot)?.name.clone();
            let Some(tight) = shapes.get(&name) else {
                return Ok(None);
            };
            let case = scene.case(&name, Some(twist));
            let run = |scene: &ElasticScene, site: CutSite| {
                let clock = CpuClock::start();
                let case = scene.case(&name, Some(twist));
                let inputs = CaseInputs {
                    scene,
                    case: &case,
                    start: tight.into(),
                    table,
                };
                measured_discharge(&inputs, site, interrupt).map(|found| (found, clock.seconds()))
            };
            let (coarse, cpu_seconds) = run(scene, CutSite::MaximumEnergyDensity)?;
            let exact = exact_discharge(scene, &case, &*table.get(&name)?, coarse.cut);
            let (reference, cpu_seconds_reference) = match exact {
                Some(exact) => (exact, 0.0),
                None => run(&fine, CutSite::At(coarse.cut))?,
            };
            if interrupt.is_requested() {
                return Ok(None);
            }
            let n_done = n_done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
            progress(Event::Case {
                name: &format!("{name} {twist:+.2}"),
                n_done,
                expected: 0.0,
                warnings: "",
            });
            let seconds = [cpu_seconds, cpu_seconds_reference];
            Ok(Some(compared(name, twist, &coarse, &reference, seconds)))
        })
        .collect::<Result<_, LabError>>()?;
    Ok(rows.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_circle_is_known_exactly() {
        let table = KnotTable::builtin();
        let scene = ElasticScene::published(Preset::Draft);
        let exact = |knot: &str, twist: f64| {
            let case = scene.case(knot, Some(twist));
            exact_discharge(&scene, &case, &table.get(knot).unwrap(), 0.0)
        };
        let circle = exact("0_1", 0.0).unwrap();
        assert!((circle.t50.unwrap() - 2.459134).abs() < 5e-6);
        assert!((circle.t99.unwrap() - 22.266100).abs() < 5e-6);
        // π B/R over E_b h² L, B = π/4, R = 50/2π
        assert!((circle.energy - 0.0062013).abs() < 1e-6);
        assert!(exact("0_1", 0.5).is_none() && exact("3_1", 0.0).is_none());
    }

    #[test]
    fn the_list_has_every_published_knot_untwisted_and_no_case_twice() {
        let table = KnotTable::builtin();
        for name in table.primes_up_to(7).map(|knot| knot.name.as_str()) {
            assert!(ACCURACY_CASES.contains(&(name, 0.0)), "{name}");
        }
        let twisted = ACCURACY_CASES.iter().filter(|c| c.1 != 0.0).count();
        assert_eq!(twisted, 20);
        for (k, case) in ACCURACY_CASES.iter().enumerate() {
            assert!(
                !ACCURACY_CASES[k + 1..].contains(case),
                "{case:?} is listed twice"
            );
            assert!((case.1 * 4.0).fract() == 0.0 && case.1.abs() <= 2.0);
        }
    }
}
