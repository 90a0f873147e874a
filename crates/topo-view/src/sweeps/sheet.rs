//! Panels side by side with one key: what every picture of a sweep is made of.

use super::groups::{Key, Look};
use crate::error::ViewError;
use crate::figures::series::{bounds, labels, line, log_bounds, step};
use crate::plot::canvas::{Canvas, Picture};
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::plot::text;
use std::fmt::Write;

/// A line of a panel.
#[derive(Debug, Clone)]
pub struct Line {
    /// Its points, in order.
    pub points: Vec<(f64, f64)>,
    /// Bars: place, lowest, highest.
    pub bars: Vec<(f64, f64, f64)>,
    /// Its looks.
    pub look: Look,
    /// Said at its end, where the key does not name it.
    pub label: String,
    /// Whether its points are marked.
    pub is_marked: bool,
    /// Whether its points are joined.
    pub is_joined: bool,
}

impl Line {
    /// Points joined in their order, without marks, bars or a label.
    pub fn new(points: Vec<(f64, f64)>, look: Look) -> Self {
        Self {
            points,
            bars: Vec::new(),
            look,
            label: String::new(),
            is_marked: false,
            is_joined: true,
        }
    }
}

/// An axis before its range is known.
#[derive(Debug, Clone)]
pub enum Scaling {
    /// By the values.
    Linear,
    /// By the values, logarithmic where they span more than a decade.
    Decades,
    /// From this to that, logarithmic.
    Log(f64, f64),
    /// From this to that.
    Range(f64, f64),
    /// Names side by side, each one unit wide.
    Names(Vec<String>),
}

/// One panel.
#[derive(Debug)]
pub struct Chart {
    /// Horizontal axis: label and scaling.
    pub x: (String, Scaling),
    /// Vertical axis.
    pub y: (String, Scaling),
    /// What it shows.
    pub lines: Vec<Line>,
}

const WIDTH: f64 = 720.0;
const LEFT: f64 = 54.0;
const HEIGHT: f64 = 170.0;
const TOP: f64 = 26.0;
const FOOT: f64 = 46.0;
/// More lines than these are drawn thin.
const MANY: usize = 30;

/// Width of a text, about.
pub fn text_width(label: &str, size: f64) -> f64 {
    let plain = label
        .chars()
        .filter(|c| !matches!(c, '*' | '{' | '}' | '^' | '_'));
    plain.count() as f64 * 0.54 * size
}

/// Draws panels with their key and notes.
pub fn draw(charts: &[Chart], key: &Key, notes: &[String]) -> Result<Picture, ViewError> {
    let side = match key {
        Key::None => 6.0,
        Key::Bar { .. } => 64.0,
        Key::Legend(lines) => {
            let widths = lines.iter().map(|(_, l)| text_width(l, 9.0) + 40.0);
            widths.fold(70.0, f64::max).min(300.0)
        }
    };
    let n = charts.len().max(1);
    let is_wide = charts.iter().any(|c| n_names(c) > 8);
    let most = if is_wide || side > 180.0 {
        1
    } else if side > 70.0 {
        2
    } else {
        3
    };
    let n_columns = n.min(most).min(if n == 4 { 2 } else { 3 });
    let pitch = ((WIDTH - side) / n_columns as f64).min(if is_wide { 1e3 } else { 420.0 });
    let foot = FOOT + charts.iter().map(names_height).fold(0.0, f64::max);
    let n_rows = n.div_ceil(n_columns);
    let tall = (TOP + HEIGHT + foot) * n_rows as f64;
    let legend = match key {
        Key::Legend(lines) => 40.0 + 13.0 * lines.len() as f64,
        _ => 0.0,
    };
    let bottom = tall.max(legend) + 4.0 + 10.5 * notes.len() as f64;
    let width = (pitch * n_columns as f64 + side).max(460.0);
    let mut canvas = Canvas::new(width, bottom, 3.0);
    for (k, chart) in charts.iter().enumerate() {
        let (column, row) = (k % n_columns, k / n_columns);
        let corner = [pitch * column as f64, (TOP + HEIGHT + foot) * row as f64];
        if n > 1 {
            let letter = char::from(b'a' + (k % 26) as u8).to_string();
            canvas.letter(corner[0] + 8.0, corner[1] + 17.0, &letter);
        }
        chart.draw(
            &mut canvas,
            [corner[0] + LEFT, corner[1] + TOP],
            pitch - LEFT,
        );
    }
    let x = pitch * n_columns as f64 + 8.0;
    draw_key(key, &mut canvas, [x, TOP]);
    canvas.footnote(notes);
    canvas.finish()
}

fn n_names(chart: &Chart) -> usize {
    match &chart.x.1 {
        Scaling::Names(names) => names.len(),
        _ => 0,
    }
}

/// Whether names are written upwards, for want of room side by side.
fn is_upright(names: &[String], width: f64) -> bool {
    let slot = width / names.len().max(1) as f64;
    names.iter().any(|n| text_width(n, 8.5) > slot)
}

fn names_height(chart: &Chart) -> f64 {
    match &chart.x.1 {
        Scaling::Names(names) if is_upright(names, 150.0) => {
            let widths = names.iter().map(|n| text_width(n, 8.5));
            (widths.fold(0.0, f64::max) - 10.0).clamp(0.0, 120.0)
        }
        _ => 0.0,
    }
}

fn draw_key(key: &Key, canvas: &mut Canvas, at: [f64; 2]) {
    match key {
        Key::None => {}
        Key::Legend(lines) => {
            for (k, (look, label)) in lines.iter().enumerate() {
                let y = at[1] + 6.0 + 13.0 * k as f64;
                polyline(canvas, &[[at[0], y], [at[0] + 20.0, y]], look, 1.6);
                canvas.text(at[0] + 25.0, y + 3.2, label, Style::default().size(9.0));
            }
        }
        Key::Bar {
            scale,
            ticks,
            label,
        } => canvas.color_bar(
            [at[0] + 2.0, at[1] + 15.0],
            [9.0, HEIGHT - 30.0],
            scale,
            ticks,
            label,
        ),
    }
}

impl Chart {
    fn draw(&self, canvas: &mut Canvas, at: [f64; 2], room: f64) {
        let has_labels = self.lines.iter().any(|l| !l.label.is_empty());
        let beside = if has_labels {
            let widths = self.lines.iter().map(|l| text_width(&l.label, 9.5));
            widths.fold(0.0, f64::max) + 10.0
        } else {
            12.0
        };
        let xs = || self.lines.iter().flat_map(|l| l.points.iter().map(|p| p.0));
        let (x, _) = axis(&self.x, &xs().collect::<Vec<_>>(), true);
        let (y, power) = axis(&self.y, &self.heights(), false);
        let panel = Panel {
            at,
            size: [room - beside, HEIGHT],
            x,
            y,
        };
        // kuva draws no axes without data
        let corners = [
            (panel.x.range.0, panel.y.range.0),
            (panel.x.range.1, panel.y.range.1),
        ];
        panel.draw(canvas, vec![line(corners.to_vec(), "none", 0.0)], &[]);
        if let Scaling::Names(names) = &self.x.1 {
            draw_names(names, &panel, canvas);
        }
        let width = if self.lines.len() > MANY { 0.9 } else { 1.5 };
        let mut ends = Vec::new();
        for line in &self.lines {
            let place = |x: f64, y: f64| panel.place(x, y / power);
            let points: Vec<[f64; 2]> = line.points.iter().map(|p| place(p.0, p.1)).collect();
            for (x, low, high) in &line.bars {
                canvas.line(place(*x, *low), place(*x, *high), &line.look.color, 1.0);
            }
            if line.is_joined {
                polyline(canvas, &thinned(&points), &line.look, width);
            }
            if line.is_marked {
                points.iter().for_each(|p| mark(canvas, *p, &line.look));
            }
            if let Some(end) = points.last().filter(|_| !line.label.is_empty()) {
                ends.push((end[1], line.label.clone(), line.look.color.as_str()));
            }
        }
        labels(canvas, at[0] + panel.size[0] + 5.0, ends);
    }

    fn heights(&self) -> Vec<f64> {
        let points = self.lines.iter().flat_map(|l| l.points.iter().map(|p| p.1));
        let bars = self
            .lines
            .iter()
            .flat_map(|l| l.bars.iter().flat_map(|b| [b.1, b.2]));
        points.chain(bars).collect()
    }
}

/// Names below the axis, each in the middle of its unit.
fn draw_names(names: &[String], panel: &Panel, canvas: &mut Canvas) {
    let upward = is_upright(names, panel.size[0]);
    let foot = panel.at[1] + panel.size[1];
    for (k, name) in names.iter().enumerate() {
        let x = panel.place(k as f64 + 0.5, panel.y.range.0)[0];
        if upward {
            let style = Style {
                upward: true,
                ..Style::default().end().size(8.5)
            };
            canvas.text(x + 3.0, foot + 5.0, name, style);
        } else {
            canvas.text(x, foot + 12.0, name, Style::default().middle().size(8.5));
        }
        if k > 0 {
            let x = panel.place(k as f64, panel.y.range.0)[0];
            canvas.line([x, panel.at[1]], [x, foot], "#e6e8eb", 0.6);
        }
    }
}

/// The axis of values, and the power of ten that its label takes out of them.
fn axis((label, scaling): &(String, Scaling), values: &[f64], is_across: bool) -> (Axis, f64) {
    let (low, high) = bounds(values.iter().copied());
    let room = if is_across { 0.03 } else { 0.06 };
    let linear = |low: f64, high: f64| {
        let power = power_of(low, high);
        let label = match power.log10().round() as i32 {
            0 => label.clone(),
            e => format!("{label} (10^{{{}}})", text::number(f64::from(e), 0)),
        };
        let (low, high) = (low / power, high / power);
        let is_whole = is_across && values.iter().all(|v| v.fract() == 0.0);
        let step = step(high - low, if is_across { 5.0 } else { 4.0 });
        let step = if is_whole { step.max(1.0) } else { step };
        (Axis::linear(&label, (low, high), step), power)
    };
    match scaling {
        Scaling::Names(names) => {
            let n = names.len().max(1) as f64;
            (Axis::linear(label, (0.0, n), 1.0).bare(), 1.0)
        }
        Scaling::Range(low, high) => linear(*low, *high),
        Scaling::Log(low, high) => (Axis::log(label, (*low, *high)), 1.0),
        Scaling::Decades if low > 0.0 && high > 10.0 * low => (
            Axis::log(label, log_bounds(values.iter().copied(), 1.25)),
            1.0,
        ),
        Scaling::Linear | Scaling::Decades => {
            let span = if high > low {
                high - low
            } else {
                low.abs().max(1.0)
            };
            let (mut from, mut to) = (low - room * span, high + room * span);
            if !is_across && low >= 0.0 && low < 0.5 * high {
                from = 0.0;
            }
            if !is_across && high <= 0.0 && high > 0.5 * low {
                to = 0.0;
            }
            linear(from, to)
        }
    }
}

/// The power of ten that makes numbers readable; 1 where they are already.
fn power_of(low: f64, high: f64) -> f64 {
    let most = low.abs().max(high.abs());
    if most == 0.0 || (0.05..1e5).contains(&most) {
        return 1.0;
    }
    10.0_f64.powf(most.log10().floor())
}

/// Points of a curve that can be distinguished on the page.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for (k, p) in points.iter().enumerate() {
        let is_far = kept
            .last()
            .is_none_or(|q| (p[0] - q[0]).hypot(p[1] - q[1]) > 0.8);
        if is_far || k + 1 == points.len() {
            kept.push(*p);
        }
    }
    kept
}

fn polyline(canvas: &mut Canvas, points: &[[f64; 2]], look: &Look, width: f64) {
    if points.len() < 2 {
        return;
    }
    let mut path = String::new();
    for [x, y] in points {
        // Writing to a string cannot fail.
        let _ = write!(path, "{x:.2},{y:.2} ");
    }
    let dash = match look.dash {
        "" => String::new(),
        dash => format!(r#" stroke-dasharray="{dash}""#),
    };
    canvas.raw(&format!(
        r#"<polyline points="{path}" fill="none" stroke="{}" stroke-width="{width}" stroke-linejoin="round"{dash}/>"#,
        look.color
    ));
}

/// A point: full, or hollow for dashed lines.
fn mark(canvas: &mut Canvas, [x, y]: [f64; 2], look: &Look) {
    let fill = if look.dash.is_empty() {
        look.color.as_str()
    } else {
        "#ffffff"
    };
    canvas.raw(&format!(
        r#"<circle cx="{x:.2}" cy="{y:.2}" r="2.1" fill="{fill}" stroke="{}" stroke-width="0.8"/>"#,
        look.color
    ));
}
