//! Charged knots by knot and twist, with the shapes of their discharge.

use super::Data;
use super::bytes::{coordinates, reach, shades, shorts};
use crate::data::{Case, Curve, Sweep, points_of, snapshots};
use crate::error::ViewError;
use crate::plot::camera;
use crate::plot::color::Scale;
use crate::plot::text;
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::path::Path;

/// Points kept of each shape.
const N_POINTS: usize = 100;
/// Fewest of a component of a link, if it has so many.
const FEWEST_POINTS: usize = 30;

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

/// Number of points kept of each curve: of all together [`N_POINTS`], but no short component becomes a polygon.
fn kept(charged: &[Curve]) -> Vec<usize> {
    let lengths = charged.iter().map(|curve| curve.points.len());
    let all: usize = lengths.clone().sum();
    lengths
        .map(|n| (N_POINTS * n / all).max(FEWEST_POINTS).min(n))
        .collect()
}

/// A shape of a state: its time, curves, and their vertices turned to the reader one after the other.
struct Shown {
    time: String,
    curves: Vec<Curve>,
    view: Vec<Vector3<f64>>,
}

/// The shapes of a state.
fn state(results: &Path, case: &Case) -> Result<Value, ViewError> {
    let folder = results.join("elastic").join(case.folder());
    let charged = Curve::read_all(&folder.join("charged.csv"))?;
    let row = case.first();
    let mut shots = snapshots(&folder)?;
    shots.retain(|s| (s.cut - row.cut).abs() < 1e-9);
    // seen from where both the knot and the released fibre are wide
    let mut seen = vec![points_of(&charged)];
    seen.extend(shots.last().map(|s| points_of(&s.curves)));
    let seen: Vec<&[Vector3<f64>]> = seen.iter().map(Vec::as_slice).collect();
    let turn = camera::flattest_of(&seen);
    let n = kept(&charged);
    let all = shots
        .into_iter()
        .map(|s| (text::significant(s.time, 2), s.curves));
    let shapes: Vec<Shown> = std::iter::once(("0".to_owned(), charged))
        .chain(all)
        .map(|(time, curves)| Shown {
            time,
            view: camera::view(&points_of(&curves), &turn),
            curves,
        })
        .collect();
    let curves = || shapes.iter().flat_map(|s| &s.curves);
    let density = curves().flat_map(|c| c.density.iter().copied());
    let high = density.fold(1e-9, f64::max);
    let colors = Scale::viridis_root(high);
    let scale = shapes.iter().map(|s| reach(&s.view)).fold(1e-9, f64::max);
    let (mut xyz, mut w) = (Vec::new(), Vec::new());
    for shape in &shapes {
        let mut first = 0;
        for (curve, n) in shape.curves.iter().zip(&n) {
            for k in 0..*n {
                // a closed curve's last point is not its first
                let i = k * (curve.points.len() - 1) / (n - 1);
                xyz.push(shape.view[first + i]);
                w.push(colors.fraction(curve.density[i]));
            }
            first += curve.points.len();
        }
    }
    let closed: Vec<Vec<bool>> = shapes
        .iter()
        .map(|s| s.curves.iter().map(|c| c.closed).collect())
        .collect();
    let times: Vec<&str> = shapes.iter().map(|s| s.time.as_str()).collect();
    Ok(json!({
        "n": n,
        "closed": closed,
        "radius": 1.0,
        "scale": scale,
        "ticks": root_ticks(high),
        "times": times,
        "xyz": shorts(coordinates(&xyz), scale),
        "w": shades(w.into_iter()),
    }))
}
