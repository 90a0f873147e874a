//! Axes with data: kuva draws ticks and series, the canvas the labels around them.

use super::canvas::Canvas;
use super::color::INK;
use super::style::Style;
use super::text;
use kuva::backend::svg::SvgBackend;
use kuva::prelude::{Layout, Plot, TickFormat};
use kuva::render::annotations::ShadedRegion;
use kuva::render::layout::{TickAlign, TickPos};
use kuva::render::render::render_multiple;
use kuva::render::theme::Theme;
use std::sync::Arc;

/// Room that kuva gets around the axes for ticks and their labels.
const MARGIN: [f64; 4] = [40.0, 8.0, 14.0, 22.0];

/// One axis.
#[derive(Debug, Clone)]
pub struct Axis {
    /// Label in the markup of [`text`].
    pub label: String,
    /// Range of the data.
    pub range: (f64, f64),
    /// Distance of the ticks of a linear axis.
    pub step: Option<f64>,
    /// Logarithmic.
    pub log: bool,
    /// No ticks or numbers.
    pub bare: bool,
}

impl Axis {
    /// Linear axis with ticks every `step`.
    pub fn linear(label: &str, range: (f64, f64), step: f64) -> Self {
        Self {
            label: label.to_owned(),
            range,
            step: Some(step),
            log: false,
            bare: false,
        }
    }

    /// Logarithmic axis over a positive range.
    pub fn log(label: &str, range: (f64, f64)) -> Self {
        Self {
            label: label.to_owned(),
            range,
            step: None,
            log: true,
            bare: false,
        }
    }

    /// The same without ticks.
    pub fn bare(self) -> Self {
        Self { bare: true, ..self }
    }

    /// Fraction of the axis at a value.
    pub fn fraction(&self, value: f64) -> f64 {
        let (a, b) = self.range;
        if self.log {
            (value / a).log10() / (b / a).log10()
        } else {
            (value - a) / (b - a)
        }
    }

    /// Value at a fraction of the axis.
    pub fn value(&self, fraction: f64) -> f64 {
        let (a, b) = self.range;
        if self.log {
            a * (b / a).powf(fraction)
        } else {
            a + (b - a) * fraction
        }
    }

    /// The same with room for `height` of a panel `of` high above the data.
    pub fn with_room(self, height: f64, of: f64) -> Self {
        let range = (self.range.0, self.value(of / (of - height)));
        Self { range, ..self }
    }
}

/// A box of axes at a place of the canvas.
#[derive(Debug, Clone)]
pub struct Panel {
    /// Left and top of the axes' box.
    pub at: [f64; 2],
    /// Width and height of the axes' box.
    pub size: [f64; 2],
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
}

impl Panel {
    /// Canvas coordinates of a point of the data.
    pub fn place(&self, x: f64, y: f64) -> [f64; 2] {
        [
            self.at[0] + self.size[0] * self.x.fraction(x),
            self.at[1] + self.size[1] * (1.0 - self.y.fraction(y)),
        ]
    }

    /// Draws axes, shaded bands `(from, to, colour, opacity)` along x, and series.
    pub fn draw(&self, canvas: &mut Canvas, plots: Vec<Plot>, bands: &[(f64, f64, String, f64)]) {
        let mut layout = self.layout();
        for (from, to, color, opacity) in bands {
            let band = ShadedRegion::vertical(*from, *to).with_color(color.clone());
            layout = layout.with_shaded_region(band.with_opacity(*opacity));
        }
        let svg = SvgBackend::new().render_scene(&render_multiple(plots, layout));
        let [left, top, ..] = MARGIN;
        canvas.fragment(self.at[0] - left, self.at[1] - top, &svg);
        self.name_axes(canvas);
    }

    fn layout(&self) -> Layout {
        let [left, top, right, bottom] = MARGIN;
        let tick = |axis: &Axis| {
            let log = axis.log;
            TickFormat::Custom(Arc::new(move |v| {
                if log {
                    text::log_tick(v)
                } else {
                    text::number(v, 3)
                }
            }))
        };
        let mut layout = Layout::new(self.x.range, self.y.range)
            .with_width(self.size[0] + left + right)
            .with_height(self.size[1] + top + bottom)
            .with_force_margins(left, right)
            .with_force_margins_y(top, bottom)
            .with_box_axes()
            .with_tick_align(TickAlign::Inside)
            .with_tick_pos(TickPos::Both)
            .with_show_grid(false)
            .with_tick_size(9)
            .with_body_size(9)
            .with_label_size(10)
            .with_tick_length(3.5)
            .with_axis_line_width(0.8)
            .with_tick_width(0.7)
            .with_x_tick_format(tick(&self.x))
            .with_y_tick_format(tick(&self.y))
            .with_theme(theme())
            .with_x_axis_min(self.x.range.0)
            .with_x_axis_max(self.x.range.1)
            .with_y_axis_min(self.y.range.0)
            .with_y_axis_max(self.y.range.1);
        layout.show_legend = false;
        layout.suppress_x_ticks = self.x.bare;
        layout.suppress_y_ticks = self.y.bare;
        if self.x.log {
            layout = layout.with_log_x();
        }
        if self.y.log {
            layout = layout.with_log_y();
        }
        if let Some(step) = self.x.step {
            layout = layout.with_x_tick_step(step);
        }
        if let Some(step) = self.y.step {
            layout = layout.with_y_tick_step(step);
        }
        layout
    }

    fn name_axes(&self, canvas: &mut Canvas) {
        let middle = self.at[0] + self.size[0] / 2.0;
        let below = self.at[1] + self.size[1] + if self.x.bare { 26.0 } else { 28.0 };
        canvas.text(
            middle,
            below,
            &self.x.label,
            Style::default().middle().size(10.5),
        );
        let style = Style {
            upward: true,
            ..Style::default().middle().size(10.5)
        };
        let beside = self.at[0] - 31.0;
        canvas.text(
            beside,
            self.at[1] + self.size[1] / 2.0,
            &self.y.label,
            style,
        );
    }
}

fn theme() -> Theme {
    let mut theme = Theme::light();
    theme.background = "none".to_owned();
    theme.axis_color = INK.to_owned();
    theme.tick_color = INK.to_owned();
    theme.text_color = INK.to_owned();
    theme.font_family = None;
    theme.show_grid = false;
    theme
}

#[cfg(test)]
mod tests {
    use super::*;
    use kuva::prelude::LinePlot;

    #[test]
    fn a_line_is_drawn_where_the_panel_says() {
        let panel = Panel {
            at: [50.0, 20.0],
            size: [100.0, 60.0],
            x: Axis::linear("*x*", (0.0, 2.0), 1.0),
            y: Axis::log("*y*", (0.1, 10.0)),
        };
        assert_eq!(panel.place(1.0, 1.0), [100.0, 50.0]);
        assert_eq!((panel.x.value(0.5), panel.y.value(0.5)), (1.0, 1.0));
        // a tenth of the height is free above what was the top
        let roomy = panel.y.clone().with_room(6.0, 60.0);
        assert!((roomy.fraction(10.0) - 0.9).abs() < 1e-12);
        let line = LinePlot::new()
            .with_data(vec![(0.0, 1.0), (2.0, 1.0)])
            .with_color("#ff0000")
            .with_stroke_width(2.0);
        let mut canvas = Canvas::new(180.0, 120.0, 1.0);
        panel.draw(&mut canvas, vec![Plot::Line(line)], &[]);
        let picture = canvas.finish().unwrap();
        let pixels = super::super::render::pixels(&picture.svg, 1.0).unwrap();
        for x in [60, 100, 140] {
            let p = pixels.pixel(x, 50).unwrap();
            assert!(p.red() > 200 && p.green() < 120, "{x}: {p:?}");
            assert!(pixels.pixel(x, 40).unwrap().green() > 200);
        }
    }
}
