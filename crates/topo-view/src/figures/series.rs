//! What the panels share: the chosen knots and their colours, lines, ranges, tidy labels.

use crate::plot::canvas::Canvas;
use crate::plot::color::{BLUE, INK, SKY, VERMILION};
use crate::plot::panel::Panel;
use crate::plot::style::Style;
use crate::plot::text::knot_name;
use kuva::prelude::{LinePlot, MarkerShape, Plot, ScatterPlot};
use std::fmt::Write;

/// Looks of a knot that is picked out.
#[derive(Debug, Clone, Copy)]
pub struct Chosen {
    /// Its name.
    pub knot: &'static str,
    /// Colour of its line.
    pub color: &'static str,
    /// Shape of its points.
    pub marker: MarkerShape,
    /// Width of its line: where two run on each other, the lower one shows at its sides.
    pub width: f64,
}

/// Knots that are picked out; the others stay grey.
pub const CHOSEN: [Chosen; 4] = [
    Chosen::new("3_1", BLUE, MarkerShape::Circle, 1.6),
    Chosen::new("4_1", VERMILION, MarkerShape::Square, 1.6),
    Chosen::new("7_1", SKY, MarkerShape::Triangle, 3.2),
    Chosen::new("7_4", INK, MarkerShape::Diamond, 1.0),
];

/// Grey of the knots that are not picked out.
pub const OTHERS: &str = "#c3c8ce";

impl Chosen {
    const fn new(knot: &'static str, color: &'static str, marker: MarkerShape, width: f64) -> Self {
        Self {
            knot,
            color,
            marker,
            width,
        }
    }

    /// The looks of a knot, if it is picked out.
    pub fn of(knot: &str) -> Option<&'static Self> {
        CHOSEN.iter().find(|c| c.knot == knot)
    }

    fn points(&self, points: Vec<(f64, f64)>) -> Plot {
        Plot::Scatter(
            ScatterPlot::new()
                .with_data(points)
                .with_color(self.color)
                .with_marker(self.marker)
                .with_size(0.6 * self.width.min(1.6) + 1.5),
        )
    }
}

/// The curve of a knot: with points where it is picked out, grey and thin where not.
pub fn knot_curve(knot: &str, points: Vec<(f64, f64)>) -> Vec<Plot> {
    match Chosen::of(knot) {
        Some(chosen) => vec![
            line(points.clone(), chosen.color, chosen.width),
            chosen.points(points),
        ],
        None => vec![line(points, OTHERS, 1.0)],
    }
}

/// Height that [`knot_key`] needs at the top of a panel.
pub const KEY_HEIGHT: f64 = 20.0;

/// Which curve is which knot, in one line at the top of a panel: samples, to be drawn with the panel's plots, and their names.
pub fn knot_key(panel: &Panel, canvas: &mut Canvas, knots: &[&str]) -> Vec<Plot> {
    const FROM_TOP: f64 = 11.0;
    let y = panel.y.value(1.0 - FROM_TOP / panel.size[1]);
    let mut plots = Vec::new();
    let mut left = 9.0;
    let mut sample = |plot: &dyn Fn(Vec<(f64, f64)>) -> Vec<Plot>, name: &str, width: f64| {
        let [from, middle, to] =
            [0.0, 7.5, 15.0].map(|d| (panel.x.value((left + d) / panel.size[0]), y));
        plots.extend(plot(vec![from, middle, to]));
        let at = [panel.at[0] + left + 19.0, panel.at[1] + FROM_TOP + 3.2];
        canvas.text(at[0], at[1], name, Style::default().size(9.5));
        left += width;
    };
    for chosen in CHOSEN.iter().filter(|c| knots.contains(&c.knot)) {
        let curve = |p: Vec<(f64, f64)>| {
            vec![
                line(vec![p[0], p[2]], chosen.color, chosen.width),
                chosen.points(vec![p[1]]),
            ]
        };
        sample(&curve, &knot_name(chosen.knot), 42.0);
    }
    let n_others = knots.iter().filter(|k| Chosen::of(k).is_none()).count();
    if n_others > 0 {
        let curve = |p: Vec<(f64, f64)>| vec![line(p, OTHERS, 1.0)];
        sample(&curve, &format!("{n_others} other knots"), 0.0);
    }
    plots
}

/// A line.
pub fn line(points: Vec<(f64, f64)>, color: &str, width: f64) -> Plot {
    Plot::Line(
        LinePlot::new()
            .with_data(points)
            .with_color(color)
            .with_stroke_width(width),
    )
}

/// Faint lines between the `n` columns of a panel, that leave `room` free at its top.
pub fn column_rules(panel: &Panel, n: usize, room: f64) -> Vec<Plot> {
    let low = panel.y.range.0;
    let high = panel.y.value(1.0 - room / panel.size[1]);
    let rule = |k: usize| line(vec![(k as f64, low), (k as f64, high)], "#e6e8eb", 0.6);
    (1..n).map(rule).collect()
}

/// Names of the knots below the columns of a panel, one each.
pub fn knot_names(panel: &Panel, knots: &[&str], canvas: &mut Canvas) {
    let n = knots.len().max(1) as f64;
    for (k, knot) in knots.iter().enumerate() {
        let x = panel.at[0] + panel.size[0] * (k as f64 + 0.5) / n;
        let y = panel.at[1] + panel.size[1] + 13.0;
        let style = Style::default().middle().size(9.5);
        canvas.text(x, y, &knot_name(knot), style);
    }
}

/// A line through points of the canvas.
pub fn line_path(canvas: &mut Canvas, points: &[[f64; 2]], color: &str, width: f64) {
    let mut path = String::new();
    for [x, y] in points {
        // Writing to a string cannot fail.
        let _ = write!(path, "{x:.2},{y:.2} ");
    }
    canvas.raw(&format!(
        r#"<polyline points="{path}" fill="none" stroke="{color}" stroke-width="{width}" stroke-linejoin="round"/>"#
    ));
}

/// Smallest and largest of finite values, or (0, 1) when there are none.
pub fn bounds(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let finite = values.into_iter().filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
    if low <= high { (low, high) } else { (0.0, 1.0) }
}

/// Positive range for a logarithmic axis, a little wider than the data.
pub fn log_bounds(values: impl IntoIterator<Item = f64>, room: f64) -> (f64, f64) {
    let (low, high) = bounds(values.into_iter().filter(|v| *v > 0.0));
    if low > 0.0 {
        (low / room, high * room)
    } else {
        (0.1, 1.0)
    }
}

/// A step of 1, 2 or 5 times a power of ten that divides a span into about `n` parts.
pub fn step(span: f64, n: f64) -> f64 {
    let raw = (span / n).max(f64::MIN_POSITIVE);
    let power = 10.0_f64.powf(raw.log10().floor());
    let multiple = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|m| m * power >= raw * 0.999);
    power * multiple.unwrap_or(10.0)
}

/// Values from `low` to `high` at multiples of `step`.
pub fn ticks(low: f64, high: f64, step: f64) -> Vec<f64> {
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last.min(first + 100))
        .map(|k| k as f64 * step)
        .collect()
}

/// Round values for a square-root scale from 0 to `high`: dense below, sparse above.
pub fn root_ticks(high: f64) -> Vec<f64> {
    let coarse = step(high, 3.0);
    let fine = [0.1 * coarse, 0.4 * coarse];
    let mut all = ticks(0.0, high, coarse);
    all.extend(fine);
    all
}

/// Labels to the right of `x`, each as near to its height as the others let it.
pub fn labels(canvas: &mut Canvas, x: f64, mut items: Vec<(f64, String, &str)>) {
    const PITCH: f64 = 10.5;
    items.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut heights: Vec<f64> = items.iter().map(|i| i.0).collect();
    // Neighbours push each other apart evenly; a few sweeps settle so few labels.
    for _ in 0..200 {
        for k in 1..heights.len() {
            let lack = PITCH - (heights[k] - heights[k - 1]);
            if lack > 0.0 {
                heights[k - 1] -= lack / 2.0;
                heights[k] += lack / 2.0;
            }
        }
    }
    for (height, (_, label, color)) in heights.iter().zip(&items) {
        canvas.text(
            x,
            height + 3.2,
            label,
            Style::default().bold().halo().size(9.5).color(color),
        );
    }
}

/// A CSV text with a header.
#[derive(Debug)]
pub struct Table(String);

impl Table {
    /// Empty table.
    pub fn new(header: &str) -> Self {
        Self(format!("{header}\n"))
    }

    /// One row; texts must not hold commas.
    pub fn row(&mut self, texts: &[&str], numbers: &[f64]) {
        let mut cells: Vec<String> = texts.iter().map(|&t| t.to_owned()).collect();
        cells.extend(numbers.iter().map(|v| {
            if v.is_finite() {
                v.to_string()
            } else {
                String::new()
            }
        }));
        // Writing to a string cannot fail.
        let _ = writeln!(self.0, "{}", cells.join(","));
    }

    /// The text.
    pub fn finish(self) -> String {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_ticks_multiples() {
        assert_eq!(step(4.0, 4.0), 1.0);
        assert!((step(0.9, 4.0) - 0.5).abs() < 1e-12);
        assert_eq!(ticks(-2.0, 2.0, 1.0), [-2.0, -1.0, 0.0, 1.0, 2.0]);
    }

    #[test]
    fn bounds_of_nothing_are_usable() {
        assert_eq!(bounds([f64::NAN]), (0.0, 1.0));
        assert_eq!(log_bounds([-1.0, 0.0], 2.0), (0.1, 1.0));
        assert_eq!(log_bounds([1.0, 4.0], 2.0), (0.5, 8.0));
    }

    #[test]
    fn labels_do_not_overlap() {
        let mut canvas = Canvas::new(100.0, 100.0, 1.0);
        let items = (0..4)
            .map(|k| (50.0 + k as f64, k.to_string(), "#000000"))
            .collect();
        labels(&mut canvas, 10.0, items);
        let svg = canvas.finish().unwrap().svg;
        let mut ys: Vec<f64> = svg
            .split("<text x=\"10.00\" y=\"")
            .skip(1)
            .map(|s| s[..s.find('"').unwrap()].parse().unwrap())
            .collect();
        // each lies on a rim of its own
        ys.dedup();
        assert!(
            ys.len() == 4 && ys.windows(2).all(|w| w[1] - w[0] > 10.0),
            "{ys:?}"
        );
    }

    #[test]
    fn picked_out_knots_are_in_the_table() {
        assert!(CHOSEN.iter().all(|c| crate::data::KNOTS.contains(&c.knot)));
    }
}
