//! Types of the cut fibre, alone or in its link, while it discharges.

use topo_analysis::Timeline;
use topo_core::Vector3;
use topo_knots::LinkTable;
use topo_rod::{Discharge, RodSample, Tips};

use super::case_run::CaseInputs;
use crate::LabError;

/// Knot types of a discharge. Those of a mirror image are found on the image of its shapes, which is that of the knot itself: a
/// type is that of closures in some directions, and these would be others.
pub(super) fn timeline(
    inputs: &CaseInputs<'_>,
    discharge: &Discharge,
) -> Result<Timeline, LabError> {
    if let Some(Tips::Between(_)) = discharge.tips {
        // the halves of an open fibre are no knot
        return Ok(Timeline::default());
    }
    let (scene, seed) = (inputs.scene, inputs.case.seed);
    let samples = &discharge.record.samples;
    if inputs.case.n_components() > 1 {
        let timed: Vec<_> = samples
            .iter()
            .map(|s| (s.time, s.state.component_vertices().collect()))
            .collect();
        let (open, table) = (discharge.component, LinkTable::builtin());
        let timeline = Timeline::of_links(&timed, open, table, scene.timeline, seed)?;
        return Ok(timeline);
    }
    let is_mirror_image = inputs.case.entry(inputs.table)?.is_mirror_image();
    let seen = |s: &RodSample| -> Vec<Vector3<f64>> {
        let side = if is_mirror_image { -1.0 } else { 1.0 };
        let vertices = s.state.vertices().iter();
        vertices.map(|x| [x.x, x.y, side * x.z].into()).collect()
    };
    let curves: Vec<_> = samples.iter().map(seen).collect();
    let timed: Vec<_> = samples.iter().zip(&curves).collect();
    let timed: Vec<_> = timed.iter().map(|(s, x)| (s.time, x.as_slice())).collect();
    let timeline = Timeline::of(&timed, inputs.table, scene.timeline, seed)?;
    Ok(match is_mirror_image {
        true => timeline.mirrored(inputs.table),
        false => timeline,
    })
}
