//! Charging a chiral and an achiral knot: energy against twist, and where the energy sits.

use super::figure::{Context, Drawn, Figure, face};
use super::series::{Table, bounds, line, root_ticks, step};
use crate::data::{Case, Curve, Sweep};
use crate::error::ViewError;
use crate::plot::canvas::Canvas;
use crate::plot::color::{BLUE, INK, QUIET, Scale, VERMILION};
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::{Anchor, Style};
use crate::plot::tube::Tube;
use crate::plot::{camera, text};
use kuva::prelude::{Plot, ScatterPlot};
use nalgebra::Vector3;

pub(super) const FIGURE: Figure = Figure {
    name: "elastic-charging",
    title: "Charging",
    caption: "Trefoil 3₁ (chiral) and figure-eight 4₁ (achiral). (a) Stored energy E and its parts \
              against the twist density θ′h (θ′: angle of twist per length, h: radius of the fibre), \
              with the charged states above; E_0 = E_b h² L, with the bending modulus E_b and the length \
              L of the fibre. (b) Energy density w along the fibre at the \
              two opposite largest twists. Writhe: signed self-crossings, averaged over all directions \
              of view.",
    claim: "Stored energy depends on knot type and twist; the trefoil buckles differently for the \
            two hands of twist, the figure-eight does not.",
    table: "elastic/sweep.csv",
    draw,
};

const KNOTS: [&str; 2] = ["3_1", "4_1"];

/// The energies shown, with colours and widths of their lines.
const PARTS: [(&str, &str, f64); 3] = [
    ("total", INK, 1.8),
    ("twist", VERMILION, 1.4),
    ("bend", BLUE, 1.4),
];

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let sweep = Sweep::read(context.results)?;
    let mut table = Table::new("panel,knot,twist,x,y");
    let mut rows = Vec::new();
    for knot in KNOTS {
        rows.push(Row::read(context, &sweep, knot)?);
    }
    let densities = rows
        .iter()
        .flat_map(|r| r.states.iter().flat_map(|s| s.1.density.iter().copied()));
    let high = bounds(densities).1;
    let scale = Scale::viridis_root(high);
    let unit = rows.iter().map(Row::unit).fold(f64::MAX, f64::min);
    let energy_top = rows
        .iter()
        .flat_map(|r| r.cases.iter().map(|c| c.first().energy))
        .fold(0.0, f64::max);

    let mut canvas = Canvas::new(720.0, 520.0, 4.0 * context.detail);
    canvas.letter(8.0, 18.0, "a");
    canvas.letter(392.0, 18.0, "b");
    for (k, row) in rows.iter().enumerate() {
        let top = 10.0 + 240.0 * k as f64;
        row.draw_tubes(&mut canvas, top, unit, &scale)?;
        row.draw_energy(&mut canvas, top + 92.0, energy_top, k == 0, &mut table);
        row.draw_density(&mut canvas, top + 10.0, k == 0, &mut table);
    }
    canvas.color_bar(
        [672.0, 150.0],
        [9.0, 190.0],
        &scale,
        &root_ticks(high),
        "Energy density *w* / *E*_{b}*h*^{2}",
    );
    canvas.footnote(&face(&sweep, context.quality));
    let finding = rows.iter().map(Row::finding).collect::<Vec<_>>().join(" ");
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding,
    })
}

struct Row<'a> {
    knot: &'static str,
    cases: Vec<&'a Case>,
    /// Twist, curve and view of five states from one end of the twists to the other.
    states: Vec<(f64, Curve, Vec<Vector3<f64>>)>,
}

impl<'a> Row<'a> {
    fn read(context: &Context, sweep: &'a Sweep, knot: &'static str) -> Result<Self, ViewError> {
        let cases = sweep.of(knot);
        if cases.is_empty() {
            let path = context.results.join("elastic/sweep.csv");
            return Err(ViewError::Table {
                path,
                reason: format!("no rows of the knot {knot}"),
            });
        }
        let last = cases.len() - 1;
        let mut picked: Vec<usize> = (0..5).map(|k| k * last / 4).collect();
        picked.dedup();
        let mut states: Vec<(f64, Curve, Vec<Vector3<f64>>)> = Vec::new();
        for i in picked {
            let path = context
                .results
                .join("elastic")
                .join(cases[i].folder())
                .join("charged.csv");
            let curve = Curve::read(&path)?;
            let like = states
                .last()
                .and_then(|s| camera::aligned(&curve.points, &s.2));
            let turn = like.unwrap_or_else(|| camera::flattest(&curve.points));
            let view = camera::flattened(camera::view(&curve.points, &turn));
            states.push((cases[i].first().twist, curve, view));
        }
        Ok(Self {
            knot,
            cases,
            states,
        })
    }

    fn unit(&self) -> f64 {
        let fits = self.states.iter().map(|(_, _, view)| {
            let [x0, y0, x1, y1] = camera::extent(view);
            (60.0 / (x1 - x0 + 2.2)).min(74.0 / (y1 - y0 + 2.2))
        });
        fits.fold(20.0, f64::min)
    }

    fn panel_x(&self) -> Axis {
        let (low, high) = bounds(self.cases.iter().map(|c| c.first().twist));
        let room = 0.06 * (high - low).max(0.1);
        Axis::linear(
            "Twist density θ′*h*",
            (low - room, high + room),
            step(high - low, 4.0),
        )
    }

    fn draw_tubes(
        &self,
        canvas: &mut Canvas,
        top: f64,
        unit: f64,
        scale: &Scale,
    ) -> Result<(), ViewError> {
        let size = [66.0, 76.0];
        for (twist, curve, view) in &self.states {
            let x = 52.0 + 300.0 * self.panel_x().fraction(*twist) - size[0] / 2.0;
            let [x0, y0, x1, y1] = camera::extent(view);
            let tube = Tube::new(view, &curve.density, true, 1.0, scale);
            let tube = tube.ok_or_else(|| ViewError::Drawing {
                reason: format!("{} is no curve", self.knot),
            })?;
            canvas.tubes(
                [x, top],
                size,
                [(x0 + x1) / 2.0, (y0 + y1) / 2.0],
                unit,
                &[tube],
            )?;
            let style = Style::default().middle().size(8.5).color(QUIET);
            canvas.text(x + size[0] / 2.0, top + 83.0, &text::signed(*twist), style);
        }
        Ok(())
    }

    fn draw_energy(
        &self,
        canvas: &mut Canvas,
        top: f64,
        high: f64,
        first: bool,
        table: &mut Table,
    ) {
        let y_step = step(high, 4.0);
        let panel = Panel {
            at: [52.0, top],
            size: [300.0, 108.0],
            x: self.panel_x(),
            y: Axis::linear("Energy *E* / *E*_{0}", (0.0, high * 1.06), y_step),
        };
        let mut plots = Vec::new();
        for (part, color, width) in PARTS {
            let firsts = self.cases.iter().map(|c| c.first());
            let points: Vec<(f64, f64)> = firsts
                .map(|c| {
                    let energy = match part {
                        "total" => c.energy,
                        "twist" => c.twist_energy,
                        _ => c.bend,
                    };
                    (c.twist, energy)
                })
                .collect();
            for (x, y) in &points {
                table.row(&["a-energy", self.knot], &[*x, *x, *y]);
            }
            if part == "total" {
                let dots = ScatterPlot::new()
                    .with_data(points.clone())
                    .with_color(color)
                    .with_size(2.2);
                plots.push(Plot::Scatter(dots));
            }
            plots.push(line(points, color, width));
        }
        panel.draw(canvas, plots, &[]);
        let name = text::knot_name(self.knot);
        canvas.text(
            panel.at[0] + 150.0,
            top + 20.0,
            &name,
            Style::default().middle().bold().size(13.0),
        );
        if first {
            draw_legend(canvas, panel.at[0] + 118.0, top + 36.0);
        }
    }

    fn draw_density(&self, canvas: &mut Canvas, top: f64, first: bool, table: &mut Table) {
        let ends = [self.states.first(), self.states.last()];
        let length = ends
            .iter()
            .flatten()
            .map(|s| round(&s.1))
            .fold(1.0, f64::max);
        // Twist spreads evenly: its share would leave most of the panel empty.
        let shown = ends
            .iter()
            .flatten()
            .flat_map(|s| s.1.density.iter().copied());
        let (low, high) = bounds(shown);
        let (floor, ceiling) = (
            (low - 0.15 * (high - low)).max(0.0),
            high + 0.4 * (high - low),
        );
        let panel = Panel {
            at: [434.0, top],
            size: [206.0, 190.0],
            x: Axis::linear("Arc length *s* / *h*", (0.0, length), step(length, 5.0)),
            y: Axis::linear(
                "Energy density *w* / *E*_{b}*h*^{2}",
                (floor, ceiling),
                step(ceiling - floor, 5.0),
            ),
        };
        let mut plots = Vec::new();
        let colors = [BLUE, VERMILION];
        // the first is wider, so that it shows where the second lies on it
        for ((state, color), width) in ends.iter().flatten().zip(colors).zip([3.4, 1.4]) {
            let curve = &state.1;
            let (s, w) = (curve.s.iter().copied(), curve.density.iter().copied());
            let mut points: Vec<(f64, f64)> = s.zip(w).collect();
            points.push((round(curve), curve.density[0]));
            for (x, y) in &points {
                table.row(&["b-density", self.knot], &[state.0, *x, *y]);
            }
            plots.push(line(points, color, width));
        }
        panel.draw(canvas, plots, &[]);
        let name = text::knot_name(self.knot);
        let bold = Style::default().bold().size(13.0);
        canvas.text(panel.at[0] + 8.0, top + 17.0, &name, bold);
        if first {
            for (k, (state, color)) in ends.iter().flatten().zip(colors).enumerate() {
                let x = panel.at[0] + 198.0;
                let label = format!("θ′*h* = {}", text::signed(state.0));
                let style = Style {
                    anchor: Anchor::End,
                    ..Style::default().bold().size(9.5).color(color)
                };
                canvas.text(x, top + 15.0 + 12.0 * k as f64, &label, style);
            }
        }
    }

    fn finding(&self) -> String {
        let (Some(first), Some(last)) = (self.cases.first(), self.cases.last()) else {
            return String::new();
        };
        let (a, b) = (first.first(), last.first());
        format!(
            "{}: energy {} and {} E₀, writhe {} and {} at θ′h = {} and {}.",
            text::knot_name(self.knot),
            text::number(a.energy, 3),
            text::number(b.energy, 3),
            text::number(a.writhe, 2),
            text::number(b.writhe, 2),
            text::signed(a.twist),
            text::signed(b.twist)
        )
    }
}

/// Length of a closed curve whose last edge returns to its first vertex.
/// Names of the energies beside samples of their lines.
fn draw_legend(canvas: &mut Canvas, left: f64, top: f64) {
    for (k, (part, color, _)) in PARTS.iter().enumerate() {
        let y = top + 11.0 * k as f64;
        canvas.line([left, y - 3.0], [left + 16.0, y - 3.0], color, 1.8);
        canvas.text(left + 20.0, y, part, Style::default().size(9.0));
    }
}

fn round(curve: &Curve) -> f64 {
    let n = curve.s.len();
    let last = curve.s[n - 1] - curve.s[0];
    last * n as f64 / (n - 1) as f64
}
