//! A slice as a picture: vorticity, director, flow arrows and the particle.

use crate::data::{DefectLine, Slice};
use crate::error::ViewError;
use crate::figures::series::step;
use crate::plot::canvas::Canvas;
use crate::plot::color::{INK, Scale};
use crate::plot::style::Style;
use crate::plot::{render, text};
use resvg::tiny_skia::{Pixmap, PremultipliedColorU8};
use topo_analysis::SlicePoint;

/// What a slice is drawn with.
pub struct Look<'a> {
    /// Colours of the vorticity.
    pub vorticity: &'a Scale,
    /// Speed whose arrow is as long as the distance of two arrows.
    pub speed: f64,
    /// Radius of the particle.
    pub radius: f64,
    /// Units of the canvas per unit of length.
    pub unit: f64,
    /// Centre on the canvas.
    pub center: [f64; 2],
}

/// Points from one arrow to the next.
fn stride(slice: &Slice) -> i64 {
    let across = 2.0 * slice.half_size()[0] / slice.pitch();
    ((across / 16.0).round().max(1.0)) as i64
}

impl Look<'_> {
    /// Distance of two arrows on the canvas.
    fn apart(&self, slice: &Slice) -> f64 {
        stride(slice) as f64 * slice.pitch() * self.unit
    }

    /// Ticks on the frame at multiples of the radius, with numbers at the foot and on the left, in type of a size.
    pub fn ticks(&self, canvas: &mut Canvas, [half_x, half_z]: [f64; 2], size: f64) {
        let [cx, cy] = self.center;
        let (left, foot) = (cx - half_x * self.unit, cy + half_z * self.unit);
        let style = Style::default().size(size);
        let within = |half: f64| {
            let n = (half / self.radius).floor() as i32;
            (-n..=n).map(|k| (k, f64::from(k) * self.radius * self.unit))
        };
        for (k, d) in within(half_x) {
            canvas.line([cx + d, foot], [cx + d, foot + 4.0], INK, 0.8);
            let label = text::number(f64::from(k), 0);
            canvas.text(cx + d, foot + 4.0 + size, &label, style.middle());
        }
        canvas.text(left - 6.0, foot + 4.0 + size, "*x*/*R*", style.end());
        for (k, d) in within(half_z) {
            canvas.line([left - 4.0, cy - d], [left, cy - d], INK, 0.8);
            let label = text::number(f64::from(k), 0);
            canvas.text(left - 6.0, cy - d + 0.35 * size, &label, style.end());
        }
        let top = cy - half_z * self.unit;
        canvas.text(left - 6.0, top + 0.8 * size, "*z*/*R*", style.end());
    }

    /// A sample arrow with its speed, its left end at a place; `size` is that of the type.
    pub fn arrow_key(&self, canvas: &mut Canvas, slice: &Slice, [x, y]: [f64; 2], size: f64) {
        // a round speed whose arrow is neither a dot nor longer than its words
        let round = step(1.2 * self.speed, 1.0) / 2.0;
        let length = round / self.speed * self.apart(slice);
        arrow(canvas, [x + 0.5 * length, y - 0.35 * size], [length, 0.0]);
        let label = format!("{} ξ_{{N}}/τ_{{N}}", text::significant(round, 2));
        let style = Style::default().size(size);
        canvas.text(x + length + 0.6 * size, y, &label, style);
    }
}

/// Colour bar of vorticity in units of ω_0, the largest shown, its middle at `x`.
pub fn vorticity_bar(canvas: &mut Canvas, [x, y]: [f64; 2], width: f64, size: f64) {
    let ticks = [(-1.0, "−ω_{0}"), (0.0, "0"), (1.0, "ω_{0}")];
    let at = [x - 0.5 * width, y];
    canvas.flat_bar(
        at,
        [width, 0.8 * size],
        &Scale::diverging(1.0),
        &ticks,
        size,
    );
}

/// Draws the slice with the places where defect lines pass it.
pub fn draw(
    canvas: &mut Canvas,
    slice: &Slice,
    lines: &[&DefectLine],
    look: &Look<'_>,
) -> Result<(), ViewError> {
    let [half_x, half_z] = slice.half_size();
    let (unit, [cx, cy]) = (look.unit, look.center);
    let corner = [cx - half_x * unit, cy - half_z * unit];
    let size = [2.0 * half_x * unit, 2.0 * half_z * unit];
    canvas.image(corner, size, &heat(slice, look.vorticity)?);
    let pitch = slice.pitch();
    let stride = stride(slice);
    let apart = look.apart(slice);
    let outside = |p: &&SlicePoint| p.x.hypot(p.z) > look.radius + 0.5 * pitch;
    let place = |p: &SlicePoint| [cx + p.x * unit, cy - p.z * unit];
    // a rod at the plates would stick out of the picture
    let inside = |p: &&SlicePoint| p.z.abs() + 0.36 * apart / unit * p.nz.abs() < half_z;
    for p in slice.thinned(stride).filter(outside).filter(inside) {
        let (at, d) = (place(p), [0.36 * apart * p.nx, -0.36 * apart * p.nz]);
        let (from, to) = ([at[0] - d[0], at[1] - d[1]], [at[0] + d[0], at[1] + d[1]]);
        canvas.line(from, to, "#5d9a4e", 0.9);
    }
    for p in slice.shifted(stride, stride / 2).filter(outside) {
        if let (Some(ux), Some(uz)) = (p.ux, p.uz) {
            arrow(canvas, place(p), [ux, -uz].map(|u| u / look.speed * apart));
        }
    }
    canvas.raw(&format!(
        r##"<circle cx="{cx:.2}" cy="{cy:.2}" r="{:.2}" fill="#d9dde2" stroke="{INK}" stroke-width="0.8"/>"##,
        look.radius * unit
    ));
    for line in lines {
        crossings(canvas, line, look);
    }
    canvas.raw(&format!(
        r##"<rect x="{:.2}" y="{:.2}" width="{:.2}" height="{:.2}" fill="none" stroke="{INK}" stroke-width="0.8"/>"##,
        corner[0], corner[1], size[0], size[1]
    ));
    Ok(())
}

/// Most slices side by side.
const MOST: usize = 4;

/// Share of the largest vorticity that has the colour of the end of the scale.
pub const SATURATED: f64 = 0.7;

/// Height that [`moments`] needs below its slices.
pub const KEY_HEIGHT: f64 = 50.0;

/// Up to four slices of a discharge side by side, across a text width, each with its own scale of vorticity and speed; returns the
/// height of the foot of the slices.
pub fn moments(
    canvas: &mut Canvas,
    after: &[&Slice],
    lines: &[DefectLine],
    radius: f64,
) -> Result<f64, ViewError> {
    let n = after.len().min(MOST);
    let picked: Vec<&Slice> = (0..n)
        .map(|k| after[(k * (after.len() - 1)) / (n - 1).max(1)])
        .collect();
    let Some(first) = picked.first() else {
        return Ok(32.0);
    };
    let [half_x, half_z] = first.half_size();
    let unit = (160.0 / (2.0 * half_x)).min(150.0 / (2.0 * half_z));
    let foot = 32.0 + 2.0 * half_z * unit;
    let mut flows = false;
    for (k, slice) in picked.iter().enumerate() {
        let center = [12.0 + 168.0 * (k as f64 + 0.5), 32.0 + half_z * unit];
        flows |= moment(canvas, slice, lines, (radius, unit, center))?;
    }
    if flows {
        let middle = 12.0 + 168.0 * n as f64 / 2.0;
        vorticity_bar(canvas, [middle, foot + 24.0], 150.0, 8.5);
        let label = "Vorticity ω_{y}, red: clockwise";
        canvas.text(
            middle + 88.0,
            foot + 31.0,
            label,
            Style::default().size(9.0),
        );
    }
    Ok(foot)
}

/// One of the slices with its time above and its scales below; says whether anything flows.
fn moment(
    canvas: &mut Canvas,
    slice: &Slice,
    lines: &[DefectLine],
    (radius, unit, center): (f64, f64, [f64; 2]),
) -> Result<bool, ViewError> {
    let (speed, most) = (top_speed(slice, radius), top_vorticity(slice));
    let scale = Scale::diverging(SATURATED * most.max(1e-30));
    let look = Look {
        vorticity: &scale,
        speed: 0.6 * speed.max(1e-30),
        radius,
        unit,
        center,
    };
    let now: Vec<&DefectLine> = lines.iter().filter(|l| l.time == slice.time).collect();
    draw(canvas, slice, &now, &look)?;
    let time = slice.time.unwrap_or(0.0) / radius.powi(2);
    let label = format!("*t* = {} *R*^{{2}}/Γ*L*", text::significant(time, 2));
    canvas.text(center[0], 24.0, &label, Style::default().middle().size(9.0));
    if most > 0.0 {
        let [half_x, half_z] = slice.half_size();
        let (left, y) = (center[0] - half_x * unit, center[1] + half_z * unit + 12.0);
        let largest = text::significant(SATURATED * most, 2);
        let label = format!("ω_{{0}} = {largest} /τ_{{N}}");
        canvas.text(left, y, &label, Style::default().size(8.5));
        look.arrow_key(canvas, slice, [center[0] + 8.0, y], 8.5);
    }
    Ok(most > 0.0)
}

/// Largest speed outside of the particle; zero without flow.
pub fn top_speed(slice: &Slice, radius: f64) -> f64 {
    let outside = slice.points.iter().filter(|p| p.x.hypot(p.z) > radius);
    let speeds = outside.filter_map(|p| Some(p.ux?.hypot(p.uz?)));
    speeds.fold(0.0, f64::max)
}

/// Largest size of the vorticity; zero without flow.
pub fn top_vorticity(slice: &Slice) -> f64 {
    let turns = slice.points.iter().filter_map(|p| p.vorticity);
    turns.map(f64::abs).fold(0.0, f64::max)
}

/// Red dots where a line passes the plane y = 0.
fn crossings(canvas: &mut Canvas, line: &DefectLine, look: &Look<'_>) {
    let n = line.points.len();
    for i in 0..if line.closed { n } else { n.saturating_sub(1) } {
        let (a, b) = (line.points[i], line.points[(i + 1) % n]);
        if (a.y < 0.0) != (b.y < 0.0) {
            let p = a + (b - a) * (a.y / (a.y - b.y));
            canvas.raw(&format!(
                r##"<circle cx="{:.2}" cy="{:.2}" r="2.6" fill="#d62728" stroke="#fff" stroke-width="0.7"/>"##,
                look.center[0] + p.x * look.unit,
                look.center[1] - p.z * look.unit
            ));
        }
    }
}

fn arrow(canvas: &mut Canvas, at: [f64; 2], d: [f64; 2]) {
    let length = d[0].hypot(d[1]);
    if length < 1.5 {
        return;
    }
    let (from, to) = (
        [at[0] - 0.5 * d[0], at[1] - 0.5 * d[1]],
        [at[0] + 0.5 * d[0], at[1] + 0.5 * d[1]],
    );
    canvas.line(from, to, INK, 0.8);
    let head = (0.45 * length).min(3.6);
    let e = [d[0] / length * head, d[1] / length * head];
    let points = format!(
        "{:.2},{:.2} {:.2},{:.2} {:.2},{:.2}",
        to[0] + 0.3 * e[0],
        to[1] + 0.3 * e[1],
        to[0] - e[0] - 0.45 * e[1],
        to[1] - e[1] + 0.45 * e[0],
        to[0] - e[0] + 0.45 * e[1],
        to[1] - e[1] - 0.45 * e[0]
    );
    canvas.raw(&format!(r#"<polygon points="{points}" fill="{INK}"/>"#));
}

/// One pixel a point, coloured by vorticity; white where there is no flow.
fn heat(slice: &Slice, scale: &Scale) -> Result<Vec<u8>, ViewError> {
    let pitch = slice.pitch();
    let [half_x, half_z] = slice.half_size();
    let side = |half: f64| ((2.0 * half / pitch).round().clamp(1.0, 4000.0)) as u32;
    let (width, height) = (side(half_x), side(half_z));
    let mut pixmap = Pixmap::new(width, height).ok_or_else(|| ViewError::Drawing {
        reason: "a slice without points".to_owned(),
    })?;
    let pixels = pixmap.pixels_mut();
    for p in &slice.points {
        let column = ((p.x + half_x) / pitch).floor().max(0.0) as u32;
        let row = ((half_z - p.z) / pitch).floor().max(0.0) as u32;
        if column < width && row < height {
            let [r, g, b] = scale.rgb(p.vorticity.unwrap_or(0.0));
            let color = PremultipliedColorU8::from_rgba(r, g, b, 255);
            pixels[(row * width + column) as usize] =
                color.unwrap_or(PremultipliedColorU8::TRANSPARENT);
        }
    }
    render::png(&pixmap)
}
