//! Settings of the rod: edges, tolerance, integrator; contact stiffness and reading.

use std::sync::{Arc, OnceLock};

use topo_core::{GAMMA_L_STABLE_LARGE, GAMMA_L_STABLE_SMALL, Interrupt};
use topo_knots::KnotTable;
use topo_rod::{CutSite, IntegratorKind, Reading};

use super::{Outcome, TradeoffWork, Trial};
use crate::AnalysisError;
use crate::elastic::{
    ACCURACY_CASES, CaseJob, ElasticScene, MeasuredDischarge, Preset, exact_discharge,
    measured_discharge,
};
use crate::knots::{Shapes, tight_shapes};
use crate::system::Effort;
use crate::wish::Point;

/// Cases of a draft: knots of all sizes, twisted and not, and the unknot, whose discharge is known in closed form.
const DRAFT_CASES: [(&str, f64); 9] = [
    ("3_1", 0.0),
    ("3_1", 2.0),
    ("4_1", -1.0),
    ("5_2", -2.0),
    ("6_2", 0.0),
    ("7_1", 0.5),
    ("7_4", 1.25),
    ("7_7", 2.0),
    ("0_1", 0.0),
];

/// Edges and tolerances of the numerical settings.
const EDGES: [usize; 4] = [64, 100, 140, 200];
const TOLERANCES: [f64; 5] = [1e-2, 4e-3, 2e-3, 1e-3, 5e-4];
/// Rods and tolerances too fine for a draft.
const FINE: [(usize, f64); 5] = [
    (280, 1e-3),
    (280, 5e-4),
    (400, 1e-3),
    (400, 5e-4),
    (400, 2e-4),
];

/// Edges and tolerance of the references.
const DRAFT_REFERENCE: usize = 400;
const REFERENCE: usize = 600;

/// Where integrators are compared, and models.
const MIDDLE_EDGES: usize = 140;
const MIDDLE_TOLERANCE: f64 = 1e-3;

/// Most trial steps of the stabilised explicit method, which needs many.
const EXPLICIT_STEPS: u64 = 200_000;

/// Name of a resolution.
pub(super) fn resolution(n_edges: usize, tolerance: f64) -> String {
    format!("N = {n_edges}, {tolerance:e} h")
}

/// Edges and tolerance of a resolution by its name.
pub(super) fn resolution_of(name: &str) -> Option<(f64, f64)> {
    let (edges, tolerance) = name.strip_prefix("N = ")?.split_once(", ")?;
    let tolerance = tolerance.strip_suffix(" h")?;
    Some((edges.parse().ok()?, tolerance.parse().ok()?))
}

fn base() -> ElasticScene {
    ElasticScene::published(Preset::Draft)
}

fn with(n_edges: usize, tolerance: f64, change: impl FnOnce(&mut ElasticScene)) -> ElasticScene {
    let mut scene = base();
    scene.rod.n_edges = n_edges;
    scene.accuracy.tolerance = tolerance;
    change(&mut scene);
    scene
}

/// The converged runs that all others are compared with.
fn reference(n_edges: usize) -> ElasticScene {
    with(n_edges, Preset::Reference.tolerance(), |scene| {
        scene.accuracy = Preset::Reference.accuracy();
    })
}

/// Settings with their names, the reference first.
fn settings(effort: Effort) -> Vec<(&'static str, String, ElasticScene)> {
    let n_reference = match effort {
        Effort::Draft => DRAFT_REFERENCE,
        Effort::Standard => REFERENCE,
    };
    let mut all = vec![(
        super::REFERENCE,
        resolution(n_reference, Preset::Reference.tolerance()),
        reference(n_reference),
    )];
    let mut grid: Vec<(usize, f64)> = Vec::new();
    for n_edges in EDGES {
        grid.extend(TOLERANCES.map(|tolerance| (n_edges, tolerance)));
    }
    if effort == Effort::Standard {
        grid.extend(FINE);
    }
    for (n_edges, tolerance) in grid {
        let scene = with(n_edges, tolerance, |_| {});
        all.push(("resolution", resolution(n_edges, tolerance), scene));
    }
    let (n, tolerance) = (MIDDLE_EDGES, MIDDLE_TOLERANCE);
    for (name, integrator, gamma, reuse) in [
        (
            "ROS34PW2, new matrix each step",
            IntegratorKind::Ros34pw2,
            GAMMA_L_STABLE_LARGE,
            1,
        ),
        (
            "ROS2-W, g = 1 + 1/√2, matrix for 8 steps",
            IntegratorKind::Ros2w,
            GAMMA_L_STABLE_LARGE,
            8,
        ),
        (
            "ROS2-W, g = 1 − 1/√2, matrix for 8 steps",
            IntegratorKind::Ros2w,
            GAMMA_L_STABLE_SMALL,
            8,
        ),
        (
            "ROS2-W, g = 1 − 1/√2, new matrix each step",
            IntegratorKind::Ros2w,
            GAMMA_L_STABLE_SMALL,
            1,
        ),
    ] {
        let scene = with(n, tolerance, |scene| {
            scene.accuracy.integrator = integrator;
            (scene.accuracy.gamma, scene.accuracy.reuse) = (gamma, reuse);
        });
        all.push(("integrator", name.to_owned(), scene));
    }
    let explicit = with(n, tolerance, |scene| {
        scene.accuracy.integrator = IntegratorKind::Rkc2;
        scene.accuracy.max_steps = EXPLICIT_STEPS;
    });
    all.push(("integrator", "RKC2".to_owned(), explicit));
    for stiffness in [5.0, 10.0, 40.0] {
        let scene = with(n, tolerance, |scene| {
            if let Some(contact) = &mut scene.rod.contact {
                contact.stiffness = stiffness;
            }
        });
        all.push(("contact stiffness", stiffness.to_string(), scene));
    }
    for reading in [Reading::Hard, Reading::Tight, Reading::OwnLength] {
        let scene = with(n, tolerance, |scene| scene.rod.reading = reading);
        all.push(("reading", reading.name().to_owned(), scene));
    }
    all
}

/// A case with what it starts from, and the place of its cut, found once.
struct Case {
    name: String,
    knot: String,
    twist: f64,
    site: OnceLock<Option<f64>>,
}

/// All runs, references first.
pub(super) fn trials(effort: Effort, work: &TradeoffWork<'_>) -> Result<Vec<Trial>, AnalysisError> {
    let cases = match effort {
        Effort::Draft => DRAFT_CASES.to_vec(),
        // every second one: twisted and untwisted knots of all sizes
        Effort::Standard => ACCURACY_CASES.iter().step_by(2).copied().collect(),
    };
    let chosen: Vec<(String, f64)> = cases.iter().map(|c| (c.0.to_owned(), c.1)).collect();
    let starts = Starts::of(&chosen, work)?;
    let mut trials = Vec::new();
    for (setting, value, scene) in settings(effort) {
        for k in 0..chosen.len() {
            trials.push(starts.trial(k, setting, value.clone(), scene.clone()));
        }
    }
    Ok(trials)
}

/// Cases of the published sweep that no setting was measured on, spread over knots and twists.
pub(super) fn held_back_cases() -> Result<Vec<(String, f64)>, AnalysisError> {
    let scene = base();
    let all = scene.cases(&KnotTable::builtin())?;
    let left = all.into_iter().filter_map(|case| {
        let twist = case.rod.twist?;
        let is_used = |c: &(&str, f64)| *c == (case.knot.as_str(), twist);
        (!ACCURACY_CASES.iter().any(is_used)).then_some((case.knot, twist))
    });
    Ok(left.skip(1).step_by(EVERY_HELD_BACK).collect())
}

/// Of the cases left, each so-many-th is held back; the factor of safety of the estimates was set on those before.
const EVERY_HELD_BACK: usize = 3;

/// Runs of held-back cases: the reference, and the settings of each with their coarser ones.
pub(super) fn held_back_trials(
    cases: &[(String, f64)],
    points: &[Point],
    work: &TradeoffWork<'_>,
) -> Result<Vec<Trial>, AnalysisError> {
    let starts = Starts::of(cases, work)?;
    let mut trials = Vec::new();
    for (k, p) in points.iter().enumerate() {
        let name = resolution(DRAFT_REFERENCE, Preset::Reference.tolerance());
        trials.push(starts.trial(k, super::REFERENCE, name, reference(DRAFT_REFERENCE)));
        for (edges, tolerance) in [
            (p.resolution, p.tolerance),
            (p.check_resolution, p.check_tolerance),
        ] {
            let edges = edges as usize;
            let scene = with(edges, tolerance, |_| {});
            trials.push(starts.trial(k, "resolution", resolution(edges, tolerance), scene));
        }
    }
    Ok(trials)
}

/// Name of a case.
pub(super) fn case_name((knot, twist): &(String, f64)) -> String {
    format!("{knot} {twist:+.2}")
}

/// Cases with what they start from.
struct Starts {
    cases: Vec<Arc<Case>>,
    shapes: Arc<Shapes>,
    table: Arc<KnotTable>,
}

impl Starts {
    fn of(chosen: &[(String, f64)], work: &TradeoffWork<'_>) -> Result<Self, AnalysisError> {
        let table = Arc::new(KnotTable::builtin());
        let mut names: Vec<String> = chosen.iter().map(|c| c.0.clone()).collect();
        names.sort();
        names.dedup();
        let quiet = |_: crate::progress::Event<'_>| {};
        let tighten = &base().tighten;
        let shapes = tight_shapes(&names, &table, tighten, work.out, work.interrupt, &quiet)?;
        let case = |chosen: &(String, f64)| {
            Arc::new(Case {
                name: case_name(chosen),
                knot: chosen.0.clone(),
                twist: chosen.1,
                site: OnceLock::new(),
            })
        };
        Ok(Self {
            cases: chosen.iter().map(case).collect(),
            shapes: Arc::new(shapes),
            table,
        })
    }

    fn trial(&self, k: usize, setting: &'static str, value: String, scene: ElasticScene) -> Trial {
        let (case, shapes) = (self.cases[k].clone(), self.shapes.clone());
        let table = self.table.clone();
        Trial {
            case: case.name.clone(),
            setting,
            value,
            run: Box::new(move |meter, interrupt| {
                let run = |scene: &ElasticScene, site| {
                    discharge(&case, scene, site, &shapes, &table, interrupt)
                };
                // the same cut for all: where the energy of the draft preset is densest
                let site = case.site.get_or_init(|| {
                    run(&base(), CutSite::MaximumEnergyDensity).map(|found| found.cut)
                });
                let Some(site) = *site else { return Ok(None) };
                let (found, cpu_seconds, peak_bytes) =
                    meter.measure(|| run(&scene, CutSite::At(site)));
                if interrupt.is_requested() {
                    return Ok(None);
                }
                // an exact discharge is the best reference
                let of = scene.case(&case.knot, Some(case.twist));
                let exact = table
                    .get(&case.knot)
                    .ok()
                    .filter(|_| setting == super::REFERENCE)
                    .and_then(|entry| exact_discharge(&scene, &of, entry, site));
                let found = exact.or(found.flatten());
                Ok(Some(Outcome {
                    quantities: vec![
                        ("initial energy", found.map(|f| f.energy)),
                        ("t50", found.and_then(|f| f.t50)),
                        ("t99", found.and_then(|f| f.t99)),
                    ],
                    cpu_seconds,
                    peak_bytes,
                }))
            }),
        }
    }
}

/// A discharge; a run that fails has no result.
fn discharge(
    case: &Case,
    scene: &ElasticScene,
    site: CutSite,
    shapes: &Shapes,
    table: &KnotTable,
    interrupt: &Interrupt,
) -> Option<MeasuredDischarge> {
    let of = scene.case(&case.knot, Some(case.twist));
    let job = CaseJob {
        scene,
        case: &of,
        tight: shapes.get(&case.knot)?,
        table,
    };
    measured_discharge(&job, site, interrupt).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_least_sixty_cases_are_held_back_from_the_table() {
        let held_back = held_back_cases().unwrap();
        assert!(held_back.len() >= 60, "{}", held_back.len());
        for (knot, twist) in &held_back {
            assert!(!ACCURACY_CASES.contains(&(knot.as_str(), *twist)));
        }
        let knots: std::collections::BTreeSet<_> = held_back.iter().map(|c| &c.0).collect();
        assert_eq!(knots.len(), 14);
    }

    #[test]
    fn settings_have_names_of_their_own_and_the_presets_are_among_them() {
        let all = settings(Effort::Standard);
        for (k, (setting, value, scene)) in all.iter().enumerate() {
            let same = all[..k].iter().find(|s| s.0 == *setting && s.1 == *value);
            assert!(same.is_none(), "{setting} {value} is there twice");
            scene.accuracy.checked().unwrap();
        }
        for preset in [Preset::Draft, Preset::Standard, Preset::Paper] {
            let scene = ElasticScene::published(preset);
            let found = all.iter().any(|(setting, _, s)| {
                *setting == "resolution"
                    && s.rod.n_edges == scene.rod.n_edges
                    && s.accuracy == scene.accuracy
            });
            assert!(found, "{}", preset.name());
        }
    }
}
