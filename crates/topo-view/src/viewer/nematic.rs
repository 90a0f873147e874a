//! Colloids by topological charge, with director and defect lines during the discharge.

use super::Data;
use super::bytes::{coordinates, reach, shades, shorts};
use crate::data::{NematicSweep, Slice};
use crate::error::ViewError;
use crate::figures::nematic::ring;
use crate::figures::profile_scale;
use crate::plot::text;
use serde_json::{Value, json};
use std::path::Path;
use topo_analysis::NematicRow;

/// Rods along the wider side of a slice.
const N_RODS: f64 = 30.0;

/// What the viewer needs, a file a colloid, if there is a nematic sweep.
pub fn data(results: &Path) -> Result<Option<Data>, ViewError> {
    let sweep = match NematicSweep::read(results) {
        Err(ViewError::Missing { .. }) => return Ok(None),
        other => other?,
    };
    let (mut cases, mut files) = (Vec::new(), Vec::new());
    for row in &sweep.rows {
        let flow = if row.flow.is_on() { "-flow" } else { "" };
        let file = format!("q{:02}{flow}", row.q);
        cases.push(json!({
            "q": row.q,
            "flow": row.flow.is_on(),
            "file": file,
            "energy": text::significant(row.f_charged, 4),
            "buckled": row.is_buckled(),
        }));
        files.push((format!("nematic/{file}"), colloid(&sweep, row)?));
    }
    let first = sweep.rows.iter().position(|r| r.q == 2).unwrap_or(0);
    let index = json!({ "cases": cases, "first": first });
    Ok(Some(Data { index, files }))
}

/// Distance of the points of a ring, as a share of the particle's radius.
const RING_STEP: f64 = 0.05;

/// Shapes of a colloid over its discharge.
fn colloid(sweep: &NematicSweep, row: &NematicRow) -> Result<Value, ViewError> {
    let (slices, lines) = (sweep.slices(row)?, sweep.rings(row)?);
    let scale = slices
        .iter()
        .map(|s| s.half_size()[0].max(s.half_size()[1]))
        .chain(lines.iter().map(|l| reach(&l.points)))
        .fold(row.radius, f64::max);
    let mut rod = 1.0;
    let frames: Vec<Value> = slices
        .iter()
        .map(|slice| {
            let here: Vec<Value> = lines
                .iter()
                .filter(|l| l.time == slice.time && l.points.len() > 2)
                .map(|l| ring::smooth(l, RING_STEP * row.radius))
                .map(|l| {
                    let angles = l.angles.iter();
                    json!({
                        "closed": l.closed,
                        "xyz": shorts(coordinates(&l.points), scale),
                        "w": shades(angles.map(|a| a.map_or(0.5, |a| profile_scale().fraction(a)))),
                    })
                })
                .collect();
            let (values, long) = rods(slice, row.radius, scale);
            rod = long;
            let time = slice.time.unwrap_or(0.0) / row.radius.powi(2);
            json!({ "t": text::significant(time, 2), "lines": here, "rods": shorts(values.into_iter(), scale) })
        })
        .collect();
    Ok(json!({
        "q": row.q,
        "radius": row.radius,
        "scale": scale,
        "rod": rod,
        "half": slices.first().map_or([row.radius; 2], |s| s.half_size()),
        "frames": frames,
    }))
}

/// Place and director (as fractions of `scale`) of rods outside the particle, and their length.
fn rods(slice: &Slice, radius: f64, scale: f64) -> (Vec<f64>, f64) {
    let pitch = slice.pitch();
    let [half_x, half_z] = slice.half_size();
    let stride = ((2.0 * half_x.max(half_z) / pitch / N_RODS).round().max(1.0)) as i64;
    let mut values = Vec::new();
    for p in slice.thinned(stride) {
        if p.x.hypot(p.z) > radius + 0.5 * pitch {
            values.extend([p.x, p.z, p.nx * scale, p.ny * scale, p.nz * scale]);
        }
    }
    (values, 0.8 * stride as f64 * pitch)
}
