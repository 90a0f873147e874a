//! The shapes of one discharge at many times, for moving pictures.

use topo_core::Vector3;
use topo_core::{Interrupt, RunHooks};
use topo_knots::KnotTable;
use topo_rod::{CutSite, DischargeSettings};

use super::case_run::CaseInputs;
use super::run::charge;
use super::scene::ElasticScene;
use crate::LabError;
use crate::knots::Shapes;

/// The rod at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeFrame {
    /// Time since the cut, in T_0; `None`: charged, still closed.
    pub time: Option<f64>,
    /// Vertices, in h.
    pub vertices: Vec<Vector3<f64>>,
    /// Energy density at the vertices, in E_b h².
    pub density: Vec<f64>,
    /// Elastic energy, in E_0.
    pub energy: f64,
}

/// Charges a knot, cuts it where its energy density is largest, and keeps the shape `per_decade` times a decade of time.
///
/// # Errors
/// As [`run_sweep`](crate::run_sweep).
pub fn discharge_frames(
    scene: &ElasticScene,
    knot: &str,
    twist: f64,
    per_decade: f64,
    shapes: &Shapes,
    table: &KnotTable,
    interrupt: &Interrupt,
) -> Result<Vec<ShapeFrame>, LabError> {
    let case = scene.case(&table.get(knot)?.name, Some(twist));
    let Some(tight) = shapes.get(&case.knot) else {
        return Ok(Vec::new());
    };
    let inputs = CaseInputs {
        scene,
        case: &case,
        start: tight.into(),
        table,
    };
    let area = std::f64::consts::PI;
    let mut hooks = RunHooks::new(interrupt);
    let charged = charge(&inputs, &mut hooks, None)?.rod;
    let mut frames = vec![ShapeFrame {
        time: None,
        vertices: charged.state().vertices().to_vec(),
        density: charged.density().iter().map(|w| w * area).collect(),
        energy: charged.record().samples.last().map_or(0.0, |s| s.elastic()),
    }];
    let settings = DischargeSettings {
        outputs_per_decade: per_decade,
        ..scene.discharge
    };
    let site = CutSite::MaximumEnergyDensity;
    let run = inputs.discharge(&charged, site, &settings, &mut hooks)?;
    frames.extend(run.record.samples.iter().map(|s| {
        let density = charged.battery().energy_density(&s.state);
        ShapeFrame {
            time: Some(s.time),
            vertices: s.state.vertices().to_vec(),
            density: density.iter().map(|w| w * area).collect(),
            energy: s.elastic(),
        }
    }));
    Ok(frames)
}
