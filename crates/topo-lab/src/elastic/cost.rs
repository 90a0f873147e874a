//! What a case of a rod costs: a model, fitted to finished runs.
//!
//! Processor seconds at N = 200 edges and tolerance 1e-3 h are means over the published knots and twists, their growth is that
//! from 100 to 560 edges and from 4e-3 to 1e-4 h. Twist makes no difference worth counting, the knot does.

use topo_rod::RodParameters;

use super::case::ElasticCase;
use super::choices::Cuts;
use super::identity::starts_from_two_images;
use super::scene::ElasticScene;
use super::tied::Entry;
use crate::cost::Cost;

/// Cost of a case of the scene; `n_cuts` is their number where it is known.
pub(super) fn cost_of(
    scene: &ElasticScene,
    case: &ElasticCase,
    entry: &Entry,
    n_cuts: Option<usize>,
) -> Cost {
    let fixed = scene.fixed_cuts.as_ref();
    let fixed = fixed.map(|cuts| cuts.get(&case.state()).map_or(0, Vec::len));
    let n_charges = if starts_from_two_images(scene, case, entry) {
        2.0
    } else {
        1.0
    };
    let work = Work {
        knot: of_crossings(entry.crossing_number()),
        n_charges,
        n_cuts: cuts(scene, n_cuts.or(fixed)),
        is_twisted: case.rod.twist.is_some(),
    };
    cost(scene, &case.rod, work)
}

/// Cost of a charge of the scene with its discharges, for a knot in the middle of the published ones.
pub(super) fn case_cost(scene: &ElasticScene, n_cuts: Option<usize>) -> Cost {
    let work = Work {
        knot: 1.0,
        n_charges: 1.0,
        n_cuts: cuts(scene, n_cuts),
        is_twisted: !scene.twists.is_empty(),
    };
    cost(scene, &scene.rod, work)
}

/// Cost of a case of a scene, over that of a charge with one discharge.
pub(super) fn weight(scene: &ElasticScene) -> f64 {
    let once = ElasticScene {
        cuts: Cuts::default(),
        ..scene.clone()
    };
    case_cost(scene, None).seconds / case_cost(&once, None).seconds
}

/// What is done in a case.
struct Work {
    /// Cost of the knot over that of one in the middle.
    knot: f64,
    n_charges: f64,
    n_cuts: f64,
    is_twisted: bool,
}

fn cuts(scene: &ElasticScene, known: Option<usize>) -> f64 {
    match (known, &scene.cuts) {
        (Some(n), _) => n as f64,
        _ if scene.charge.breaking.is_some() => 1.0,
        (None, Cuts::Largest(_) | Cuts::LetGo) => 1.0,
        (None, Cuts::NearTies(_)) => MEAN_NEAR_TIES,
        (None, Cuts::Criteria) => MEAN_CRITERIA,
        (None, Cuts::All(k)) => *k as f64,
        (None, Cuts::At(places)) => places.len() as f64,
    }
}

fn cost(scene: &ElasticScene, rod: &RodParameters, work: Work) -> Cost {
    let edges = rod.n_edges as f64 / 200.0;
    let tolerance = (1e-3 / scene.accuracy.tolerance.max(1e-9)).max(1e-3);
    let grid = FEW_EDGES + (1.0 - FEW_EDGES) * edges.powf(EDGES_POWER);
    let terms = [
        (rod.contact.is_none(), WITHOUT_CONTACT),
        (
            rod.friction.is_none_or(|f| f.ratio == 0.0),
            WITHOUT_FRICTION,
        ),
        (!work.is_twisted, WITHOUT_TWIST),
    ];
    let terms = terms.iter().filter(|(is_out, _)| *is_out);
    let terms: f64 = terms.map(|(_, factor)| factor).product();
    let runs = work.n_charges * CHARGE_SECONDS + work.n_cuts * DISCHARGE_SECONDS;
    let closures = work.n_cuts * scene.timeline.closures as f64;
    Cost {
        seconds: grid * tolerance.powf(TOLERANCE_POWER) * terms * work.knot * runs
            + edges * closures * CLOSURE_SECONDS,
        bytes: (BYTES * edges) as u64,
    }
}

/// Cost of a knot of so many crossings, over the mean of the fourteen up to seven.
fn of_crossings(n: u32) -> f64 {
    0.5 + 0.75 * (f64::from(n.min(MOST_CROSSINGS)) / 7.0).powi(4)
}

/// Processor seconds of a charge at N = 200 and tolerance 1e-3 h.
const CHARGE_SECONDS: f64 = 0.14;
/// The same of a discharge to 99.9 %.
const DISCHARGE_SECONDS: f64 = 0.54;
/// The same of a closure in each look at the knot type while a rod of 200 edges discharges.
const CLOSURE_SECONDS: f64 = 2e-3;
/// What does not shrink with the edges: coarse rods take more steps.
const FEW_EDGES: f64 = 0.6;
/// Growth of the rest with the number of edges.
const EDGES_POWER: f64 = 3.0;
/// Growth with the inverse of the tolerance.
const TOLERANCE_POWER: f64 = 0.22;
/// Cost without a term over that with it.
const WITHOUT_CONTACT: f64 = 0.3;
const WITHOUT_FRICTION: f64 = 0.55;
const WITHOUT_TWIST: f64 = 0.8;
/// Near-tied cuts of a case, on average over the published sweep.
const MEAN_NEAR_TIES: f64 = 4.5;
/// The same of the untwisted knots, with the sites of the other criteria.
const MEAN_CRITERIA: f64 = 3.8;
/// Crossings beyond those that were measured.
const MOST_CROSSINGS: u32 = 10;
/// Bytes that a case holds at N = 200.
pub(super) const BYTES: f64 = 6e7;

#[cfg(test)]
mod tests {
    use topo_knots::KnotTable;

    use super::*;
    use crate::preset::Preset;

    fn seconds(change: impl Fn(&mut ElasticScene)) -> f64 {
        let mut scene = ElasticScene::published(Preset::Draft);
        change(&mut scene);
        let table = KnotTable::builtin();
        let cost = |case: &ElasticCase| {
            let entry = case.entry(&table).unwrap();
            cost_of(&scene, case, &entry, None).seconds
        };
        scene.cases(&table).unwrap().iter().map(cost).sum()
    }

    /// Processor seconds that sweeps took (docs/performance.md), within a factor of 1.5.
    #[test]
    fn costs_are_those_of_finished_sweeps() {
        let within = |model: f64, taken: f64| {
            let ratio = model / taken;
            assert!((1.0 / 1.5..1.5).contains(&ratio), "{model} for {taken}");
        };
        // 238 cases at the draft preset, 14 untwisted ones, and 70 at five twists without types
        within(seconds(|_| {}), 180.0);
        within(seconds(|s| s.twists = vec![0.0]), 9.5);
        let last = |s: &mut ElasticScene| {
            (s.twists, s.timeline.closures) = (vec![-2.0, -1.0, 0.0, 1.0, 2.0], 0);
        };
        within(seconds(last), 62.0);
        // means of 167 cases of the trade-off of accuracy and cost, over that of 200 edges and 2e-3 h: 0.75 s
        let at = |edges: usize, tolerance: f64| {
            seconds(|s| {
                (s.rod.n_edges, s.accuracy.tolerance) = (edges, tolerance);
                s.timeline.closures = 0;
            })
        };
        for (edges, tolerance, taken) in [
            (100, 4e-3, 0.41),
            (140, 4e-3, 0.64),
            (280, 1e-3, 1.82),
            (400, 5e-4, 3.9),
            (560, 1e-4, 12.5),
        ] {
            within(at(edges, tolerance) / at(200, 2e-3), taken / 0.75);
        }
    }

    #[test]
    fn a_case_costs_what_it_does() {
        let base = seconds(|_| {});
        assert!(seconds(|s| s.rod.friction = None) < 0.8 * base);
        assert!(seconds(|s| s.twists = Vec::new()) < base / 17.0);
        assert!(seconds(|s| s.timeline.closures = 100) > 1.1 * base);
        assert!(
            seconds(|s| s.knots = vec!["4_1".to_owned()])
                > seconds(|s| s.knots = vec!["3_1".to_owned()])
        );
        let cuts = seconds(|s| s.cuts = Cuts::All(24)) / base;
        assert!(cuts > 15.0 && cuts < 24.0, "{cuts}");
        // the cuts of another run are as many as they are
        assert!(seconds(|s| s.fixed_cuts = Some(Default::default())) < 0.3 * base);
        let once = ElasticScene::published(Preset::Draft);
        assert_eq!(weight(&once), 1.0);
    }
}
