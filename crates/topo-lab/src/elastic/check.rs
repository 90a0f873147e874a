//! What is refused of a scene of rods before anything runs.

use std::collections::HashSet;

use topo_core::InvalidValue;
use topo_knots::KnotTable;
use topo_rod::{IntegratorKind, Reading, RodError};

use super::case::ElasticCase;
use super::choices::Cuts;
use super::cost::BYTES;
use super::keys::{EDGES, ROD_KEYS};
use super::rest::{RestKeys, TWIST};
use super::scene::{BREAKS, ElasticScene};
use crate::LabError;
use crate::scene::{AxisValue, Document, check_count, product};

/// Prime knots of up to seven crossings, which "all" stands for.
const ALL: usize = 14;
/// Most closures of a sample: types are as good as certain with far fewer.
pub(super) const MOST_CLOSURES: usize = 100_000;
/// Most memory of a case, in bytes.
const MOST_BYTES: f64 = 16e9;

/// What is refused of a scene; `poisson_ratio` is the one written, or the first of several.
pub(super) fn faults(
    scene: &ElasticScene,
    poisson_ratio: f64,
    document: &Document<'_>,
) -> Vec<LabError> {
    let mut faults = Vec::new();
    let mut see = |checked: Result<(), LabError>| faults.extend(checked.err());
    see(check_knots(scene, document));
    let n_knots = scene.knots.iter().map(|k| if k == "all" { ALL } else { 1 });
    let n_knots: usize = n_knots.sum();
    let outer = [
        (
            "rod.knot",
            scene.tie.as_ref().map_or(n_knots, |tie| tie.n(n_knots)),
        ),
        ("rod.twist", scene.twists.len().max(1)),
    ];
    if let Err(too_many) = check_count(document, &outer, &scene.axes) {
        see(Err(too_many));
        return faults;
    }
    let ratios = values(scene, "rod.poisson_ratio").unwrap_or(vec![poisson_ratio]);
    if let Some(nu) = ratios.iter().find(|nu| !(**nu > -1.0 && **nu <= 0.5)) {
        let remedy = "a number above -1 and up to 0.5 is needed";
        see(Err(document.wrong("rod.poisson_ratio", nu, remedy)));
    }
    let cases = inner_cases(scene);
    for check in [
        check_imperfection,
        check_rod,
        check_memory,
        check_cuts,
        check_load,
    ] {
        see(cases
            .iter()
            .try_for_each(|case| check(scene, case, document)));
    }
    let refuse = |e| refused(document, e);
    see(scene.accuracy.checked().map(drop).map_err(refuse));
    see(scene.charge.checked().map_err(refuse));
    if let Some(si) = scene.si {
        let wrong = |e: InvalidValue| {
            let key = format!("si.{}", e.name);
            document.wrong(&key, e.value, format!("expected {}", e.expected))
        };
        see(si.checked().map(drop).map_err(wrong));
    }
    let has_twist = !scene.twists.is_empty();
    if let Some(pull) = &scene.pull {
        see(pull
            .checked(has_twist)
            .map_err(|e| refused_pull(document, e)));
    }
    see(scene.discharge.checked(has_twist).map(drop).map_err(refuse));
    if let Some(rest) = scene.rest.as_ref().filter(|rest| !rest.has_files()) {
        see(rest.made().map(drop).map_err(|e| e.placed(document)));
    }
    let closures = scene.timeline.closures;
    if closures > MOST_CLOSURES {
        let remedy = format!("at most {MOST_CLOSURES} closures of each sample are looked at");
        see(Err(document.wrong("discharge.closures", closures, remedy)));
    }
    for (key, reason) in idle(scene) {
        see(document.idle(key, reason));
    }
    faults
}

/// The cases of one knot at one twist.
fn inner_cases(scene: &ElasticScene) -> Vec<ElasticCase> {
    product(&ROD_KEYS, &scene.axes, scene.case("", None))
}

/// The numbers of an axis, if there is one of that key.
fn values(scene: &ElasticScene, key: &str) -> Option<Vec<f64>> {
    let axis = scene.axes.iter().find(|axis| axis.key() == key)?;
    let number = |value: &AxisValue| match value {
        AxisValue::Number(x) => Some(*x),
        _ => None,
    };
    Some(axis.values().iter().filter_map(number).collect())
}

fn check_knots(scene: &ElasticScene, document: &Document<'_>) -> Result<(), LabError> {
    let key = "rod.knot";
    if scene.tie.as_ref().is_some_and(|tie| !tie.is_of_knots()) {
        return Ok(());
    }
    if scene.knots.is_empty() {
        return Err(document.wrong(key, "[]", "name at least one knot, or write \"all\""));
    }
    if scene.knots.len() == 1 {
        return Ok(());
    }
    let twice = |name: &str, knot: &str| {
        document.wrong(
            key,
            name,
            format!("{knot} is there already: name each knot once"),
        )
    };
    let mut seen = HashSet::new();
    if let Some(name) = scene.knots.iter().find(|name| !seen.insert(*name)) {
        return Err(twice(name, name));
    }
    // what a folder of knots may call otherwise is looked at when the cases are made
    if scene.own_knots.is_some() {
        return Ok(());
    }
    let table = KnotTable::builtin();
    let mut seen = HashSet::new();
    for name in &scene.knots {
        let meant: Vec<String> = match (name.as_str(), table.get(name)) {
            ("all", _) => table.primes_up_to(7).map(|k| k.name.clone()).collect(),
            (_, Ok(knot)) => vec![knot.name.clone()],
            (_, Err(_)) => continue,
        };
        if let Some(knot) = meant.iter().find(|knot| !seen.insert((*knot).clone())) {
            return Err(twice(name, knot));
        }
    }
    Ok(())
}

fn check_imperfection(
    _: &ElasticScene,
    case: &ElasticCase,
    document: &Document<'_>,
) -> Result<(), LabError> {
    if (0.0..=0.5).contains(&case.imperfection) {
        return Ok(());
    }
    let remedy = "a number from 0 to 0.5 (in h) is needed";
    Err(document.wrong("rod.imperfection", case.imperfection, remedy))
}

fn check_rod(
    _: &ElasticScene,
    case: &ElasticCase,
    document: &Document<'_>,
) -> Result<(), LabError> {
    let checked = case.rod.clone().checked();
    checked.map(drop).map_err(|e| refused(document, e))
}

fn check_memory(
    _: &ElasticScene,
    case: &ElasticCase,
    document: &Document<'_>,
) -> Result<(), LabError> {
    let n_edges = case.rod.n_edges;
    let bytes_of_edge = BYTES / 200.0;
    if n_edges as f64 * bytes_of_edge <= MOST_BYTES {
        return Ok(());
    }
    Err(document.wrong(
        EDGES,
        n_edges,
        format!(
            "a case would take about {:.3e} GB of memory, and {} GB are the most: use at most {} edges",
            n_edges as f64 * bytes_of_edge / 1e9,
            MOST_BYTES / 1e9,
            (MOST_BYTES / bytes_of_edge) as usize,
        ),
    ))
}

fn check_cuts(
    scene: &ElasticScene,
    case: &ElasticCase,
    document: &Document<'_>,
) -> Result<(), LabError> {
    let wrong = |remedy: String| {
        let cuts = String::from(scene.cuts.clone());
        Err(document.wrong("discharge.cuts", cuts, remedy))
    };
    if scene.cuts == Cuts::LetGo && scene.pull.is_none() {
        return wrong(
            "only an open fibre that is pulled can be let go: say where to cut".to_owned(),
        );
    }
    if let (Cuts::At(places), Some(_)) = (&scene.cuts, &scene.pull) {
        let (edges, least) = (case.rod.n_edges as f64, 2.0);
        let inside = |at: &f64| (least..=edges - least).contains(&(at * edges).round());
        if let Some(at) = places.iter().find(|at| !inside(at)) {
            let [from, to] = [least / edges, 1.0 - least / edges];
            return wrong(format!(
                "{at} is at an end of the open fibre: places from {from} to {to} are on it"
            ));
        }
    }
    scene.cuts.clash(case.rod.n_edges).map_or(Ok(()), wrong)
}

fn check_load(
    scene: &ElasticScene,
    case: &ElasticCase,
    document: &Document<'_>,
) -> Result<(), LabError> {
    if case.load.is_some() && scene.pull.is_some() && scene.cuts != Cuts::LetGo {
        let key = "discharge.load";
        let remedy =
            "an open fibre that is cut has four ends: leave the load or `discharge.cuts` out";
        return Err(document.wrong(key, document.written(key), remedy));
    }
    let checked = case.load.map(|load| load.checked(&scene.discharge.ends));
    checked.map_or(Ok(()), |checked| {
        checked.map(drop).map_err(|e| refused(document, e))
    })
}

/// Knots of the scene that its table does not have.
pub(super) fn unknown_knots(scene: &ElasticScene, document: &Document<'_>) -> Vec<LabError> {
    let table = match scene.knot_table() {
        Ok(table) => table,
        Err(e) => return vec![document.wrong("knots", document.written("knots"), e.to_string())],
    };
    let named = scene.knots.iter().filter(|name| *name != "all");
    let unknown = named.filter_map(|name| Some((name, table.get(name).err()?)));
    unknown
        .map(|(name, e)| document.wrong("rod.knot", format!("\"{name}\""), e.to_string()))
        .collect()
}

/// Why what is tied besides tight knots by name cannot be.
pub(super) fn untied(scene: &ElasticScene, document: &Document<'_>) -> Option<LabError> {
    scene.tie.as_ref()?;
    let cases = scene.knot_table().and_then(|table| scene.cases(&table));
    cases.err().map(|e| e.placed(document))
}

/// Why the natural shape of a file cannot be; where something is tied [`untied`] says so.
pub(super) fn unrested(scene: &ElasticScene, document: &Document<'_>) -> Option<LabError> {
    let rest = scene.rest.as_ref().filter(|rest| rest.has_files());
    let made = rest.filter(|_| scene.tie.is_none())?.made();
    made.err().map(|e| e.placed(document))
}

/// What the rod refuses, with the key of the scene.
fn refused(document: &Document<'_>, error: RodError) -> LabError {
    match error {
        RodError::Value(wrong) => {
            let tables = ["accuracy.", "charge.", "discharge.", "pull."];
            let key = match tables.iter().any(|table| wrong.name.starts_with(table)) {
                true => wrong.name,
                false => format!("rod.{}", wrong.name),
            };
            document.wrong(&key, wrong.value, format!("expected {}", wrong.expected))
        }
        RodError::TooFewEdges { n_edges, least } => {
            document.wrong(EDGES, n_edges, format!("use at least {least} edges"))
        }
        RodError::Ends { reason } => {
            let key = "discharge.ends";
            document.wrong(key, document.written(key), reason)
        }
        RodError::Course { key, reason } => document.wrong(key, document.written(key), reason),
        RodError::Load { key, reason } => {
            let key = if document.has(key) {
                key
            } else {
                "discharge.load"
            };
            document.wrong(key, document.written(key), reason)
        }
        source => LabError::Rod {
            case: document.path().display().to_string(),
            source,
        },
    }
}

/// What the rod refuses of its pulling, with the key of the scene.
fn refused_pull(document: &Document<'_>, error: RodError) -> LabError {
    let grips = "pull.grips";
    let wrong = |key: &str, reason: &str| document.wrong(key, document.written(key), reason);
    match error {
        RodError::Course { key, reason } => wrong(grips, &format!("`{key}`: {reason}")),
        RodError::Ends { reason } => wrong(grips, reason),
        RodError::Value(value) if value.name == "released" => wrong(
            grips,
            &format!("`released` = {}: expected {}", value.value, value.expected),
        ),
        error => refused(document, error),
    }
}

/// Keys that change nothing in this scene, with the reason and the remedy.
pub(super) fn idle(scene: &ElasticScene) -> Vec<(&'static str, &'static str)> {
    let cases = inner_cases(scene);
    let swept = |key: &str| scene.axes.iter().any(|axis| axis.key().starts_with(key));
    // a key with one value must act in some case, one with several in all
    let acts = |key: &str, of: &dyn Fn(&ElasticCase) -> bool| match swept(key) {
        true => cases.iter().all(of),
        false => cases.iter().any(of),
    };
    let mut idle = Vec::new();
    let mut unless = |acts: bool, key: &'static str, reason: &'static str| {
        if !acts {
            idle.push((key, reason));
        }
    };
    unless(scene.charge.breaking.is_none(), "discharge.cuts", BREAKS);
    let key = "rod.slenderness";
    unless(
        acts(key, &|c| c.rod.reading != Reading::OwnLength),
        key,
        "it changes nothing: with the reading `own-length` a rod has its knot's own length; leave it out",
    );
    unless(
        !scene.twists.is_empty(),
        "rod.poisson_ratio",
        "it changes nothing: no twist is modelled; give `twist`, or leave it out",
    );
    unless(
        !scene.twists.is_empty(),
        TWIST,
        "it changes nothing: no twist is modelled; give `twist`, or leave it out",
    );
    unless(
        !scene.rest.as_ref().is_some_and(RestKeys::is_empty),
        "rod.rest",
        "it says nothing: give `curvature` or `twist`, or leave the table out",
    );
    unless(
        scene.charge.twisting.is_none() || !scene.twists.is_empty(),
        "charge.twisting",
        "it changes nothing: no twist is modelled; give `twist`, or leave it out",
    );
    for key in ["charge.duration", "charge.twisting", "charge.break"] {
        unless(
            scene.pull.is_none(),
            key,
            "it changes nothing: the fibre is open and pulled, not charged; leave it out",
        );
    }
    let key = "rod.seed";
    unless(
        scene.timeline.closures > 0 || acts(key, &|c| c.imperfection > 0.0),
        key,
        "it changes nothing: there are no closures and no imperfection; leave it out",
    );
    let key = "rod.friction.range";
    unless(
        acts(key, &|c| c.rod.friction.is_none_or(|f| f.ratio > 0.0)),
        key,
        "it changes nothing where the friction has the ratio 0; leave it out",
    );
    let integrator = scene.accuracy.integrator;
    unless(
        integrator == IntegratorKind::Ros2w,
        "accuracy.gamma",
        "it changes nothing: it belongs to `integrator = \"ros2w\"`; leave it out",
    );
    unless(
        integrator != IntegratorKind::Rkc2,
        "accuracy.reuse",
        "it changes nothing: the explicit integrator has no Newton matrix; leave it out",
    );
    idle
}
