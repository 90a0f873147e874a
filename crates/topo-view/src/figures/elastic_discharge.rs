//! Discharging: snapshots, energy against time through intermediate knots, and all times.

mod phases;
mod snapshots;
mod times;

use super::figure::{Context, Drawn, Figure, face};
use super::series::{
    Chosen, KEY_HEIGHT, Table, bounds, knot_curve, knot_key, line, log_bounds, step,
};
use crate::data::{Case, Sweep};
use crate::error::ViewError;
use crate::plot::canvas::Canvas;
use crate::plot::panel::{Axis, Panel};

pub(super) const FIGURE: Figure = Figure {
    name: "elastic-discharge",
    title: "Discharging",
    caption: "(a) A fast and a slow untying at zero twist, after the cut; times in T_0 = 2 L η/(h E_b), with \
              length L, radius h, viscosity η and bending modulus E_b of the fibre. (b) Energy E before \
              the cut against the twist density θ′h, in E_0 = E_b h² L. (c) Elastic energy over that \
              before the cut, E(0), against time: solid, the state at zero twist, the area below it \
              shaded by the knot type of its closed-up fibre, named above; dashed, the same knot \
              strongly twisted. (d) t99, the time in which 99 % of E(0) is released, against twist; \
              bars span the near-tied cuts. (e) The same time for all states, in each knot by twist.",
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
    let energies = sweep.cases.iter().map(|c| c.first().energy);
    let axis = Axis::log("Initial energy *E* / *E*_{0}", log_bounds(energies, 1.35));
    let energy: Quantity = |c| Some([c.first().energy; 3]);
    against_twist(
        &sweep,
        &mut canvas,
        ([52.0, 258.0], "b"),
        (axis, energy),
        &mut table,
    );
    canvas.letter(376.0, 264.0, "c");
    let path = phases::draw(context, &sweep, &mut canvas, [422.0, 258.0], &mut table)?;
    canvas.letter(8.0, 496.0, "d");
    let axis = times::time_axis(&sweep);
    against_twist(
        &sweep,
        &mut canvas,
        ([52.0, 490.0], "d"),
        (axis, times::t99),
        &mut table,
    );
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

/// Size of the panels (b) and (d).
const SIZE: [f64; 2] = [266.0, 178.0];

/// A quantity of a state: mean, smallest and largest over its cuts, where it is known.
type Quantity = fn(&Case) -> Option<[f64; 3]>;

/// A quantity against twist by knot, with a bar where the cuts of a state differ.
fn against_twist(
    sweep: &Sweep,
    canvas: &mut Canvas,
    (at, letter): ([f64; 2], &str),
    (y, quantity): (Axis, Quantity),
    table: &mut Table,
) {
    let panel = Panel {
        at,
        size: SIZE,
        x: twist_axis(sweep),
        y: y.with_room(KEY_HEIGHT, SIZE[1]),
    };
    let mut knots = sweep.knots();
    let mut plots = knot_key(&panel, canvas, &knots);
    // The grey ones first, so that the picked-out ones lie on top.
    knots.sort_by_key(|k| Chosen::of(k).is_some());
    for knot in knots {
        let mut points = Vec::new();
        for case in sweep.of(knot) {
            let Some([mean, low, high]) = quantity(case) else {
                continue;
            };
            let x = case.first().twist;
            points.push((x, mean));
            table.row(&[letter, knot], &[x, x, mean, low, high]);
            if let Some(chosen) = Chosen::of(knot).filter(|_| high > low * 1.005) {
                plots.push(line(vec![(x, low), (x, high)], chosen.color, 1.0));
            }
        }
        plots.extend(knot_curve(knot, points));
    }
    panel.draw(canvas, plots, &[]);
}
