//! Discharging: snapshots, energy against time through intermediate knots, and all times.

mod phases;
mod snapshots;
mod times;

use super::figure::{Context, Drawn, Figure, face};
use super::series::{OTHERS, Table, bounds, color, labels, line, log_bounds, step};
use crate::data::Sweep;
use crate::error::ViewError;
use crate::plot::canvas::Canvas;
use crate::plot::color::QUIET;
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::plot::text;

pub(super) const FIGURE: Figure = Figure {
    name: "elastic-discharge",
    title: "Discharging",
    caption: "(a) A fast and a slow untying at zero twist, after the cut; times in T₀. (b) Energy \
              at the cut against twist. (c) Elastic energy against time with the knot type of the \
              closed-up fibre as bands. (d) Time to release 99 % against twist; bars span the \
              near-tied cuts. (e) The same time for all states, in each knot by twist.",
    claim: "At low twist the stored energy depends on the knot, at high twist it does not. Energy \
            is released in phases as intermediate knots form and untie; 3₁ and 7₄ are slow at zero \
            twist, and strongly twisted states discharge faster.",
    table: "elastic/sweep.csv",
    draw,
};

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let sweep = Sweep::read(context.results)?;
    let mut table = Table::new("panel,knot,twist,x,y,low,high");
    let mut canvas = Canvas::new(720.0, 732.0, 4.0 * context.detail);
    canvas.letter(8.0, 18.0, "a");
    let bar = snapshots::draw(context, &sweep, &mut canvas, [10.0, 8.0], [700.0, 230.0])?;
    canvas.letter(8.0, 264.0, "b");
    initial_energy(&sweep, &mut canvas, [52.0, 258.0], &mut table);
    canvas.letter(376.0, 264.0, "c");
    let path = phases::draw(context, &sweep, &mut canvas, [422.0, 258.0], &mut table)?;
    canvas.letter(8.0, 496.0, "d");
    times::against_twist(&sweep, &mut canvas, [52.0, 490.0], &mut table);
    canvas.letter(376.0, 496.0, "e");
    times::all(&sweep, &mut canvas, [422.0, 490.0], &mut table);
    canvas.footnote(&face(&sweep, context.quality));
    let robust = times::robust(context.results);
    let finding = format!("{}{robust} {path} {bar}", times::finding(&sweep));
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding,
    })
}

fn twist_axis(sweep: &Sweep) -> Axis {
    let (low, high) = bounds(sweep.twists());
    let room = 0.04 * (high - low).max(0.1);
    Axis::linear(
        "Twist density θ′*h*",
        (low - room, high + room),
        step(high - low, 4.0),
    )
}

/// Knots in drawing order: the grey ones first, so that the picked-out ones lie on top.
fn drawing_order(sweep: &Sweep) -> Vec<&str> {
    let mut knots = sweep.knots();
    knots.sort_by_key(|k| color(k).is_some());
    knots
}

fn initial_energy(sweep: &Sweep, canvas: &mut Canvas, at: [f64; 2], table: &mut Table) {
    let range = log_bounds(sweep.cases.iter().map(|c| c.first().energy), 1.35);
    let panel = Panel {
        at,
        size: [266.0, 178.0],
        x: twist_axis(sweep),
        y: Axis::log("Initial energy *E* / *E*_{0}", range),
    };
    let mut plots = Vec::new();
    let mut names = Vec::new();
    for knot in drawing_order(sweep) {
        let points: Vec<(f64, f64)> = sweep
            .of(knot)
            .iter()
            .map(|c| (c.first().twist, c.first().energy))
            .collect();
        for (x, y) in &points {
            table.row(&["b", knot], &[*x, *x, *y, *y, *y]);
        }
        let middle = points.iter().min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        if let (Some(ink), Some((x, y))) = (color(knot), middle) {
            names.push((panel.place(*x, *y)[1], text::knot_name(knot), ink));
        }
        plots.push(line(
            points,
            color(knot).unwrap_or(OTHERS),
            if color(knot).is_some() { 1.8 } else { 1.0 },
        ));
    }
    panel.draw(canvas, plots, &[]);
    // Names stand where the curves differ most: beside the middle.
    let x = panel.place(0.0, 1.0)[0] + 42.0;
    for (y, _, ink) in &names {
        canvas.line([x - 40.0, *y], [x - 16.0, *y], ink, 0.6);
    }
    labels(canvas, x - 12.0, names);
    others_note(canvas, &panel, sweep);
}

fn others_note(canvas: &mut Canvas, panel: &Panel, sweep: &Sweep) {
    let n = sweep.knots().iter().filter(|k| color(k).is_none()).count();
    if n > 0 {
        let at = [panel.at[0] + 8.0, panel.at[1] + panel.size[1] - 8.0];
        let note = format!("grey: the other {n} knots");
        canvas.text(at[0], at[1], &note, Style::default().size(8.5).color(QUIET));
    }
}
