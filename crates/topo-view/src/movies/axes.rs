//! The curve below a movie: a quantity against the logarithm of time, with a dot for now.

use crate::figures::series::line_path;
use crate::plot::canvas::Canvas;
use crate::plot::color::{INK, QUIET, VERMILION};
use crate::plot::panel::Axis;
use crate::plot::style::Style;
use crate::plot::text;

/// Axes of a curve against time.
pub struct Axes<'a> {
    /// Left and top of the box.
    pub at: [f64; 2],
    /// Width and height of the box.
    pub size: [f64; 2],
    /// Time, logarithmic.
    pub time: Axis,
    /// The quantity.
    pub value: Axis,
    /// Its ticks, with their labels.
    pub ticks: &'a [(f64, String)],
    /// Font size of numbers and labels.
    pub type_size: f64,
}

impl Axes<'_> {
    /// Place of a point; what lies before the first time is at the left edge, what lies below the axis at its foot.
    fn place(&self, (time, value): (f64, f64)) -> [f64; 2] {
        let across = self.time.fraction(time.max(self.time.range.0));
        let value = if self.value.log {
            value.max(1e-300)
        } else {
            value
        };
        let up = self.value.fraction(value).clamp(0.0, 1.0);
        [
            self.at[0] + self.size[0] * across,
            self.at[1] + self.size[1] * (1.0 - up),
        ]
    }

    /// Axes, the curve, darker up to point `now`, and the dot at a time.
    pub fn draw(&self, canvas: &mut Canvas, curve: &[(f64, f64)], now: usize, time: f64) {
        let ([left, top], [width, height], small) = (self.at, self.size, self.type_size);
        let (right, foot) = (left + width, top + height);
        line_path(
            canvas,
            &[[left, top], [left, foot], [right, foot]],
            QUIET,
            1.0,
        );
        let (first, last) = self.time.range;
        let style = Style::default().size(small);
        for exponent in first.log10().ceil() as i32..=last.log10().floor() as i32 {
            let tick = 10.0_f64.powi(exponent);
            let x = left + width * self.time.fraction(tick);
            canvas.line([x, foot], [x, foot - 5.0], QUIET, 1.0);
            canvas.text(x, foot + 1.1 * small, &text::log_tick(tick), style.middle());
        }
        canvas.text(right, foot + 2.2 * small, &self.time.label, style.end());
        for (value, label) in self.ticks {
            let y = top + height * (1.0 - self.value.fraction(*value));
            canvas.line([left, y], [left + 5.0, y], QUIET, 1.0);
            canvas.text(left - 4.0, y + 0.35 * small, label, style.end());
        }
        let upward = Style {
            upward: true,
            ..style.middle()
        };
        canvas.text(
            left - 2.6 * small,
            top + 0.5 * height,
            &self.value.label,
            upward,
        );
        let path: Vec<[f64; 2]> = curve.iter().map(|p| self.place(*p)).collect();
        line_path(canvas, &path, QUIET, 1.0);
        line_path(canvas, &path[..=now], INK, 2.2);
        let [x, y] = self.place((time, curve[now].1));
        canvas.raw(&format!(
            r#"<circle cx="{x:.2}" cy="{y:.2}" r="4.5" fill="{VERMILION}"/>"#
        ));
    }
}
