//! What is refused of a scene of colloids before anything runs.

use topo_nematic::flow::FlowSolver;
use topo_nematic::stokes::StokesError;
use topo_nematic::{Anchoring, NematicBattery, NematicError, Sides, SwitchTarget};

use super::case::NematicCase;
use super::scene::NematicScene;
use crate::LabError;
use crate::scene::{Document, check_count, repeated, repeated_number};

/// Most memory of a case where the scene sets no limit, in bytes.
const MOST_BYTES: u64 = 64_000_000_000;

/// What is refused of a scene.
pub(super) fn faults(scene: &NematicScene, document: &Document<'_>) -> Vec<LabError> {
    let refuse = |e| refused(document, e);
    let mut faults = Vec::new();
    let mut see = |checked: Result<(), LabError>| faults.extend(checked.err());
    see(check_windings(scene, document));
    let flows = match (&scene.flow, &scene.flowing) {
        (Some(_), Some(_)) => 2,
        _ => 1,
    };
    let outer = [("nematic.q", scene.charges.len().max(1)), ("flow.q", flows)];
    if let Err(too_many) = check_count(document, &outer, &scene.axes) {
        see(Err(too_many));
        return faults;
    }
    see(scene.accuracy.checked().map(drop).map_err(refuse));
    see(scene.charge.check().map_err(refuse));
    if let Some(x) = repeated_number(&scene.charge.seeds) {
        see(Err(repeated(document, "charge.seeds", x)));
    }
    see(check_switch(scene, document));
    see(scene.discharge.check().map_err(refuse));
    let cases = scene.cases();
    see(cases
        .iter()
        .try_for_each(|case| check_case(scene, case, document)));
    for (key, reason) in idle(scene) {
        see(document.idle(key, reason));
    }
    faults
}

fn check_switch(scene: &NematicScene, document: &Document<'_>) -> Result<(), LabError> {
    let has_particle = scene.nematic.particle;
    if has_particle || scene.switch.to == SwitchTarget::Keep {
        let checked = scene.switch.check(has_particle);
        return checked.map_err(|e| refused(document, e));
    }
    let remedy =
        "without a particle there is no anchoring to switch: write `to = \"keep\"` in [switch]";
    let key = match document.has("switch.to") {
        true => "switch.to",
        false => "nematic.particle",
    };
    Err(document.wrong(key, document.written(key), remedy))
}

fn check_windings(scene: &NematicScene, document: &Document<'_>) -> Result<(), LabError> {
    let Some(flowing) = &scene.flowing else {
        return Ok(());
    };
    if scene.charges.is_empty() {
        let reason = "it chooses among the windings of nematic.q, and there are none: leave it out";
        return document.idle("flow.q", reason);
    }
    match flowing.iter().find(|q| !scene.charges.contains(q)) {
        Some(q) => Err(document.wrong(
            "flow.q",
            q,
            format!(
                "nematic.q has no such winding: add it there, or name one of {:?}",
                scene.charges
            ),
        )),
        None => Ok(()),
    }
}

fn check_case(
    scene: &NematicScene,
    case: &NematicCase,
    document: &Document<'_>,
) -> Result<(), LabError> {
    let refuse = |e| refused(document, e);
    let has_goal = scene.goal.is_some();
    let battery = match NematicBattery::new(&case.nematic, &scene.accuracy) {
        // the grid of a goal is not known yet
        Err(_) if has_goal => {
            case.nematic.clone().checked().map_err(refuse)?;
            return Ok(());
        }
        battery => battery.map_err(refuse)?,
    };
    let needed = battery.memory().total();
    if !has_goal && scene.accuracy.memory_limit.is_none() && needed > MOST_BYTES {
        let grid = battery.grid().cells();
        let key = key_of_grid(document);
        return Err(document.wrong(
            key,
            document.written(key),
            format!(
                "a grid of {grid:?} cells takes about {:.3e} GB of memory, and {} GB are the most without accuracy.memory_limit: use fewer cells, or a larger spacing",
                needed as f64 / 1e9,
                MOST_BYTES / 1_000_000_000,
            ),
        ));
    }
    if let Some(flow) = &case.flow {
        match flow.check(battery.grid(), case.nematic.particle) {
            Err(StokesError::Memory { .. }) if has_goal => {}
            checked => checked.map_err(|e| refuse(e.into()))?,
        }
    }
    Ok(())
}

/// The key that decides how large the grid is.
fn key_of_grid(document: &Document<'_>) -> &'static str {
    let keys = ["nematic.cells", "nematic.cell", "nematic.spacing"];
    let written = keys.into_iter().find(|key| document.has(key));
    written.unwrap_or("nematic.radius")
}

/// What the nematic refuses, with the key of the scene.
fn refused(document: &Document<'_>, error: NematicError) -> LabError {
    let message = error.to_string();
    let (key, value) = match &error {
        NematicError::Value(wrong) | NematicError::Flow(StokesError::Value(wrong)) => {
            let is_flag = document
                .find(&wrong.name)
                .is_some_and(|f| f.parsed.is_bool());
            let value = match is_flag {
                true => document.written(&wrong.name),
                false => wrong.value.to_string(),
            };
            return document.wrong(&wrong.name, value, format!("expected {}", wrong.expected));
        }
        NematicError::SpacingTooCoarse { spacing, .. } => ("nematic.spacing", spacing.to_string()),
        NematicError::ParticleTooLarge { radius, .. }
        | NematicError::ParticleTooCoarse { radius, .. } => ("nematic.radius", radius.to_string()),
        NematicError::NoNematicPhase { .. } => {
            let keys = ["material.b", "material.a"];
            let written = keys.into_iter().find(|key| document.has(key));
            let key = written.unwrap_or("material.c");
            (key, document.written(key))
        }
        NematicError::TooMuchMemory { limit, .. } => ("accuracy.memory_limit", limit.to_string()),
        NematicError::Grid(_) => {
            let key = key_of_grid(document);
            (key, document.written(key))
        }
        NematicError::Length { .. } => {
            let key = match document.has("nematic.pattern.table") {
                true => "nematic.pattern.table",
                false => "switch.to",
            };
            (key, document.written(key))
        }
        NematicError::Flow(StokesError::Walls { .. }) => {
            ("flow.solver", document.written("flow.solver"))
        }
        NematicError::Flow(StokesError::Memory { limit, .. }) => {
            ("flow.memory_limit", limit.to_string())
        }
        NematicError::Flow(_) => ("flow.drive", document.written("flow.drive")),
        _ => {
            return LabError::Nematic {
                case: document.path().display().to_string(),
                source: error,
            };
        }
    };
    document.wrong(key, value, message)
}

const NO_PARTICLE: &str = "it changes nothing: there is no particle; leave it out";
const NO_FLOW: &str =
    "it changes nothing: no flow is modelled; write the table [flow], or leave it out";
const NOT_ALL_FLOW: &str = "it changes nothing in the cases without flow, which would be computed again for each value: leave flow.q out, or give one value";

/// Keys that change nothing in this scene, with the reason and the remedy.
pub(super) fn idle(scene: &NematicScene) -> Vec<(&'static str, &'static str)> {
    let nematic = &scene.nematic;
    let mut idle = Vec::new();
    let mut when = |is_idle: bool, keys: &[&'static str], reason: &'static str| {
        if is_idle {
            idle.extend(keys.iter().map(|key| (*key, reason)));
        }
    };
    when(
        !nematic.particle,
        &[
            "nematic.q",
            "nematic.pattern",
            "nematic.anchoring",
            "nematic.boundary",
            "flow.boundary_residual",
            "discharge.ring_threshold",
        ],
        NO_PARTICLE,
    );
    let swept = |key: &str| scene.axes.iter().any(|axis| axis.key().starts_with(key));
    let is_free = nematic.anchoring == Anchoring::Free && !swept("nematic.anchoring");
    when(
        nematic.particle && is_free,
        &["nematic.q", "nematic.pattern"],
        "it changes nothing: the anchoring is free; leave it out, or the anchoring",
    );
    when(
        nematic.cells.is_some(),
        &["nematic.cell"],
        "it changes nothing: nematic.cells says how large the cell is; keep one of the two",
    );
    when(
        scene.goal.is_some() && nematic.cells.is_none(),
        &["nematic.spacing"],
        "accuracy and budget pick the spacing: keep one of the two",
    );
    idle.extend(idle_in_runs(scene));
    idle
}

/// Keys of flow, switch, charge and field that change nothing in this scene.
fn idle_in_runs(scene: &NematicScene) -> Vec<(&'static str, &'static str)> {
    let nematic = &scene.nematic;
    let swept = |key: &str| scene.axes.iter().any(|axis| axis.key().starts_with(key));
    let mut idle = Vec::new();
    let mut when = |is_idle: bool, keys: &[&'static str], reason: &'static str| {
        if is_idle {
            idle.extend(keys.iter().map(|key| (*key, reason)));
        }
    };
    let flow_only = ["material.viscosity", "material.flow_alignment"];
    when(scene.flow.is_none(), &flow_only, NO_FLOW);
    for key in flow_only {
        when(scene.flowing.is_some() && swept(key), &[key], NOT_ALL_FLOW);
    }
    let is_spectral = |solver| match solver {
        FlowSolver::Auto => nematic.sides == Sides::Periodic,
        FlowSolver::Spectral => true,
        FlowSolver::Sparse => false,
    };
    when(
        scene.flow.is_some_and(|flow| is_spectral(flow.solver)),
        &["flow.solver_tolerance"],
        "it changes nothing: the spectral solver is direct; leave it out",
    );
    when(
        scene.switch.to == SwitchTarget::Keep,
        &["switch.ramp"],
        "it changes nothing: the anchoring is kept; leave it out",
    );
    when(
        scene.charge.seeds.iter().all(|seed| *seed == 0.0),
        &["charge.seed_azimuth"],
        "it changes nothing: no start field is tilted; leave it out",
    );
    when(
        nematic.field.is_some_and(|field| field.vector == [0.0; 3])
            && swept("nematic.field.anisotropy"),
        &["nematic.field.anisotropy"],
        "it changes nothing: the field is zero; give one value",
    );
    when(
        true,
        &["accuracy.threads"],
        "it changes nothing: the sweep shares out the threads, as many as `--jobs` says; leave it out",
    );
    idle
}
