//! Settings of the rod: edges, tolerance, integrator; contact stiffness and reading.

use std::sync::{Arc, OnceLock};

use topo_core::{GAMMA_L_STABLE_LARGE, GAMMA_L_STABLE_SMALL, Interrupt};
use topo_knots::KnotTable;
use topo_rod::{CutSite, IntegratorKind, Reading};

use super::sets::{CaseSet, rods};
use super::trial::{Outcome, TradeoffWork, Trial};
use crate::LabError;
use crate::elastic::{
    CaseInputs, ElasticScene, MeasuredDischarge, exact_discharge, measured_discharge,
};
use crate::knots::{Shapes, tight_shapes};
use crate::preset::Preset;

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
/// What goals choose from, from coarse to fine; each has a coarser one beside it, so that the first is none of them.
///
/// The error is that of the edges: tolerances are as loose as leaves it so.
pub(super) const LADDER: [(usize, f64); 6] = [
    (70, 4e-3),
    (100, 4e-3),
    (140, 4e-3),
    (200, 2e-3),
    (280, 1e-3),
    (400, 5e-4),
];

/// Edges of the references: of a draft, and of the ladder.
const DRAFT_REFERENCE: usize = 400;
const REFERENCE: usize = 560;

/// Where integrators are compared, and models.
const MIDDLE_EDGES: usize = 140;
const MIDDLE_TOLERANCE: f64 = 1e-3;

/// Most trial steps of the stabilised explicit method, which needs many.
const EXPLICIT_STEPS: u64 = 200_000;

/// Name of a resolution.
pub(super) fn resolution(n_edges: usize, tolerance: f64) -> String {
    format!("N = {n_edges}, {tolerance:e} h")
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
fn resolutions(
    n_reference: usize,
    grid: impl IntoIterator<Item = (usize, f64)>,
) -> Vec<(&'static str, String, ElasticScene)> {
    let tolerance = Preset::Reference.tolerance();
    let mut all = vec![(
        super::REFERENCE,
        resolution(n_reference, tolerance),
        reference(n_reference),
    )];
    for (n_edges, tolerance) in grid {
        let scene = with(n_edges, tolerance, |_| {});
        all.push(("resolution", resolution(n_edges, tolerance), scene));
    }
    all
}

/// Every setting of a draft.
fn settings() -> Vec<(&'static str, String, ElasticScene)> {
    let grid = EDGES.map(|n| TOLERANCES.map(|tolerance| (n, tolerance)));
    let mut all = resolutions(DRAFT_REFERENCE, grid.concat());
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

/// All runs of a draft, references first.
pub(super) fn trials(work: &TradeoffWork<'_>) -> Result<Vec<Trial>, LabError> {
    let chosen = DRAFT_CASES.map(|c| (c.0.to_owned(), c.1));
    of_cases(&chosen, &settings(), work)
}

/// The ladder on the cases of a set, case by case.
pub(super) fn ladder_trials(set: CaseSet, work: &TradeoffWork<'_>) -> Result<Vec<Trial>, LabError> {
    let settings = resolutions(REFERENCE, LADDER);
    of_cases(&rods(set)?, &settings, work)
}

fn of_cases(
    chosen: &[(String, f64)],
    settings: &[(&'static str, String, ElasticScene)],
    work: &TradeoffWork<'_>,
) -> Result<Vec<Trial>, LabError> {
    let starts = Starts::of(chosen, work)?;
    let mut trials = Vec::new();
    for k in 0..chosen.len() {
        for (setting, value, scene) in settings {
            trials.push(starts.trial(k, setting, value.clone(), scene.clone()));
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
    fn of(chosen: &[(String, f64)], work: &TradeoffWork<'_>) -> Result<Self, LabError> {
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
                    .and_then(|entry| exact_discharge(&scene, &of, &entry, site));
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
    let job = CaseInputs {
        scene,
        case: &of,
        start: shapes.get(&case.knot)?.into(),
        table,
    };
    measured_discharge(&job, site, interrupt).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_have_names_of_their_own_and_the_presets_are_among_them() {
        let mut all = settings();
        for (k, (setting, value, _)) in all.iter().enumerate() {
            let same = all[..k].iter().find(|s| s.0 == *setting && s.1 == *value);
            assert!(same.is_none(), "{setting} {value} is there twice");
        }
        all.extend(resolutions(REFERENCE, LADDER));
        for (_, _, scene) in &all {
            scene.accuracy.checked().unwrap();
        }
        for preset in [Preset::Draft, Preset::Standard] {
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
