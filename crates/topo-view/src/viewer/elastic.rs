//! Charged knots by knot and twist, with the shapes of their discharge.

use super::Data;
use super::bytes::{coordinates, reach, shades, shorts};
use crate::data::{Case, Curve, Sweep, snapshots};
use crate::error::ViewError;
use crate::plot::camera;
use crate::plot::color::Scale;
use crate::plot::text;
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::path::Path;

/// Points kept of each shape.
const N_POINTS: usize = 100;

/// What the viewer needs, a file a knot, if there is an elastic sweep.
pub fn data(results: &Path) -> Result<Option<Data>, ViewError> {
    let sweep = match Sweep::read(results) {
        Err(ViewError::Missing { .. }) => return Ok(None),
        other => other?,
    };
    let (knots, twists) = (sweep.knots(), sweep.twists());
    let energies = sweep.cases.iter().map(|c| c.first().energy);
    let top = energies.fold(1e-9, f64::max);
    let (mut cases, mut files) = (Vec::new(), Vec::new());
    let mut first = None;
    for (i, knot) in knots.iter().enumerate() {
        let (mut row, mut states) = (Vec::new(), Vec::new());
        for (j, twist) in twists.iter().enumerate() {
            let Some(case) = sweep.at(knot, *twist) else {
                row.push(Value::Null);
                states.push(Value::Null);
                continue;
            };
            if first.is_none() || (i == 0 && twist.abs() < 1e-9) {
                first = Some([i, j]);
            }
            row.push(summary(case, top));
            states.push(state(results, case)?);
        }
        cases.push(row);
        files.push((format!("elastic/{knot}"), Value::Array(states)));
    }
    let labels: Vec<String> = knots.iter().map(|k| text::knot_name(k)).collect();
    let said: Vec<String> = twists.iter().map(|t| text::signed(*t)).collect();
    // as addresses have them, with a hyphen for minus
    let values: Vec<String> = said.iter().map(|t| t.replace('−', "-")).collect();
    let index = json!({
        "names": knots,
        "knots": labels,
        "twists": said,
        "values": values,
        "cases": cases,
        "first": first,
        "ticks": root_ticks(top),
    });
    Ok(Some(Data { index, files }))
}

/// Numbers at the middle and the end of a colour scale by the square root.
fn root_ticks(top: f64) -> [String; 2] {
    [0.25 * top, top].map(|v| text::significant(v, 2))
}

/// What the table says of a state.
fn summary(case: &Case, top: f64) -> Value {
    let row = case.first();
    json!({
        "energy": text::number(row.energy, 3),
        "t99": row.t99.map(|t| text::number(t, 3)),
        "shade": ((row.energy / top).max(0.0).sqrt() * 255.0).round().min(255.0) as u8,
    })
}

/// The shapes of a state.
fn state(results: &Path, case: &Case) -> Result<Value, ViewError> {
    let folder = results.join("elastic").join(case.folder());
    let charged = Curve::read(&folder.join("charged.csv"))?;
    let turn = camera::flattest(&charged.points);
    let row = case.first();
    let mut shapes: Vec<(String, Vec<Vector3<f64>>, Vec<f64>)> = vec![(
        "0".to_owned(),
        camera::view(&charged.points, &turn),
        charged.density,
    )];
    let cut = |s: &&crate::data::Snapshot| (s.cut - row.cut).abs() < 1e-9;
    for s in snapshots(&folder.join("snapshots.csv"))?.iter().filter(cut) {
        shapes.push((
            text::significant(s.time, 2),
            camera::view(&s.curve.points, &turn),
            s.curve.density.clone(),
        ));
    }
    let density = shapes.iter().flat_map(|s| s.2.iter().copied());
    let high = density.fold(1e-9, f64::max);
    let colors = Scale::viridis_root(high);
    let scale = shapes.iter().map(|s| reach(&s.1)).fold(1e-9, f64::max);
    let (mut xyz, mut w) = (Vec::new(), Vec::new());
    for (_, points, density) in &shapes {
        for k in 0..N_POINTS {
            // the charged knot is closed, so that its last point is not its first
            let i = k * (points.len() - 1) / (N_POINTS - 1);
            xyz.push(points[i]);
            w.push(colors.fraction(density[i]));
        }
    }
    let times: Vec<&str> = shapes.iter().map(|s| s.0.as_str()).collect();
    Ok(json!({
        "n": N_POINTS,
        "radius": 1.0,
        "scale": scale,
        "ticks": root_ticks(high),
        "times": times,
        "xyz": shorts(coordinates(&xyz), scale),
        "w": shades(w.into_iter()),
    }))
}
