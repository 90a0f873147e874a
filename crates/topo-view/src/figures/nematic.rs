//! What the nematic figures share: the colloid in three dimensions, its colours, the foot.

pub mod charging;
pub mod discharge;
pub mod ring;
pub mod slice;

use super::series::step;
use crate::data::{DefectLine, NematicSweep, Slice};
use crate::plot::canvas::Canvas;
use crate::plot::color::{QUIET, Rgb, Scale};
use crate::plot::panel::{Axis, Panel};
use crate::plot::solids::{Solids, view};
use nalgebra::Vector3;
use topo_analysis::Flow;
use topo_analysis::buckling;
use topo_lab::Preset;

/// Colour of director rods.
const ROD: Rgb = [120, 160, 110];
/// Colour of a defect line without a known profile.
pub const UNKNOWN: Rgb = [150, 150, 150];

/// Colours of the profile angle, from +1/2 (0 degrees) over twisted (90) to −1/2 (180).
pub fn profile_scale() -> Scale {
    Scale::viridis(0.0, 180.0)
}

/// Flat colour bar of the profile angle, labelled below at a size of type.
pub fn profile_bar(canvas: &mut Canvas, at: [f64; 2], size: [f64; 2], type_size: f64) {
    let ticks = [(0.0, "+½"), (90.0, "twisted"), (180.0, "−½")];
    canvas.flat_bar(at, size, &profile_scale(), &ticks, type_size);
}

/// Flat colour bar of the particle.
pub fn particle_bar(canvas: &mut Canvas, at: [f64; 2], size: [f64; 2], type_size: f64) {
    let ticks = [(-1.0, "−1"), (0.0, "0"), (1.0, "1")];
    canvas.flat_bar(at, size, &Scale::blue_to_yellow(), &ticks, type_size);
}

/// The particle, coloured from blue to yellow by the horizontal component cos qφ sin θ of its anchoring.
fn particle(solids: &mut Solids<'_>, radius: f64, q: u32) {
    let scale = Scale::blue_to_yellow();
    solids.painted_sphere(Vector3::zeros(), radius, move |n| {
        let across = (n.x * n.x + n.y * n.y).sqrt();
        scale.rgb(across * (f64::from(q) * n.y.atan2(n.x)).cos())
    });
}

/// The charged colloid with its defect lines, seen a little from above.
pub fn colloid(
    radius: f64,
    q: u32,
    lines: &[DefectLine],
    slice: Option<&Slice>,
    height: f64,
) -> Solids<'static> {
    let charged: Vec<&DefectLine> = lines.iter().filter(|l| l.time.is_none()).collect();
    colloid_at(radius, Some(q), &charged, slice, [-90.0, height])
}

/// The colloid at one time, seen from an azimuth and a height; without `q` its anchoring is off and it is grey.
pub fn colloid_at(
    radius: f64,
    q: Option<u32>,
    lines: &[&DefectLine],
    slice: Option<&Slice>,
    [azimuth, height]: [f64; 2],
) -> Solids<'static> {
    let mut solids = Solids::default();
    match q {
        Some(q) => particle(&mut solids, radius, q),
        None => solids.sphere(Vector3::zeros(), radius, [205, 209, 214]),
    }
    let scale = profile_scale();
    let thick = 0.055 * radius;
    for line in lines {
        let line = ring::smooth(line, 0.3 * thick);
        let colors: Vec<Rgb> = line
            .angles
            .iter()
            .map(|a| a.map_or(UNKNOWN, |a| scale.rgb(a)))
            .collect();
        solids.line(&line.points, &colors, line.closed, thick);
    }
    if let Some(slice) = slice {
        rods(&mut solids, slice, radius);
    }
    solids.turned(&view(azimuth, height))
}

/// Director rods of a slice, thinned to about 28 along the wider side.
fn rods(solids: &mut Solids<'_>, slice: &Slice, radius: f64) {
    let pitch = slice.pitch();
    let [half_x, half_z] = slice.half_size();
    let stride = ((2.0 * half_x.max(half_z) / pitch / 28.0).round().max(1.0)) as i64;
    let long = 0.4 * stride as f64 * pitch;
    for p in slice.thinned(stride) {
        if p.x.hypot(p.z) > radius + 0.6 * pitch {
            let (at, n) = (Vector3::new(p.x, 0.0, p.z), Vector3::new(p.nx, p.ny, p.nz));
            solids.rod([at - n * long, at + n * long], 0.12 * long, ROD);
        }
    }
}

/// Axis over the windings of a sweep.
pub fn winding_axis(sweep: &NematicSweep) -> Axis {
    let high = sweep.rows.last().map_or(1.0, |r| f64::from(r.q));
    let low = sweep.rows.first().map_or(0.0, |r| f64::from(r.q));
    Axis::linear(
        "Topological charge *q*",
        (low - 0.5, high + 0.5),
        step(high - low + 1.0, 6.0),
    )
}

/// Place of the dashed line that marks the buckling, between the last flat and the first buckled ring.
pub fn onset(sweep: &NematicSweep) -> Option<f64> {
    buckling(&sweep.rows).map(|q| f64::from(q) - 0.5)
}

/// Draws that line into a panel over the windings.
pub fn mark_onset(sweep: &NematicSweep, canvas: &mut Canvas, panel: &Panel) {
    let Some(x) = onset(sweep).map(|q| panel.place(q, panel.y.range.0)[0]) else {
        return;
    };
    let (top, bottom) = (panel.at[1], panel.at[1] + panel.size[1]);
    let mut y = top;
    while y < bottom {
        canvas.line([x, y], [x, (y + 4.0).min(bottom)], QUIET, 0.9);
        y += 7.0;
    }
}

/// Foot of the nematic figures: quality, and where the runs depart from the published ones.
pub fn face(sweep: &NematicSweep, quality: Preset) -> Vec<String> {
    let first = &sweep.rows[0];
    let flow = match (first.flow, sweep.flowing.is_empty()) {
        (Flow::On, _) => "with flow".to_owned(),
        (_, true) => "without flow".to_owned(),
        _ if sweep.flowing.len() == sweep.rows.len() => {
            "curves and rates without flow, each *q* run with it as well".to_owned()
        }
        _ => format!(
            "without flow but where *q* = {} is shown with it",
            sweep
                .flowing
                .iter()
                .map(|r| r.q.to_string())
                .collect::<Vec<_>>()
                .join(", ")
        ),
    };
    let size = if (first.radius - 52.5).abs() < 1e-9 {
        "as published".to_owned()
    } else {
        "published: 52.5, with flow".to_owned()
    };
    vec![
        format!(
            "{quality} quality: {} charges, radius *R* = {} ξ_{{N}} ({size}), spacing {} ξ_{{N}}, {flow}.",
            sweep.rows.len(),
            first.radius,
            first.spacing
        ),
        format!(
            "Particle surface by {}, periodic sides, perpendicular plates. ξ_{{N}}: nematic correlation length, *L*: elastic constant, Γ: rotational mobility; τ_{{N}} = ξ_{{N}}^{{2}}/Γ*L*.",
            first.boundary
        ),
    ]
}
