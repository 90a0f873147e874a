//! All charged states as tubes coloured by energy density, one row a knot, one column a twist.

use super::figure::{Context, Drawn, Figure, face};
use super::series::{Table, bounds, root_ticks};
use crate::data::{Curve, Sweep};
use crate::error::ViewError;
use crate::plot::canvas::{Canvas, tube_png};
use crate::plot::color::Scale;
use crate::plot::style::Style;
use crate::plot::tube::Tube;
use crate::plot::{camera, text};
use nalgebra::{Matrix3, Rotation3, Vector3};
use rayon::prelude::*;

pub(super) const FIGURE: Figure = Figure {
    name: "elastic-configurations",
    title: "Charged states",
    caption: "Every charged state: a closed fibre tied into one of 14 knots (rows) and fused with \
              one of 17 twist densities (columns), relaxed. Colour is the elastic energy per unit \
              length; all tubes have one scale, and neighbours in a row are turned alike.",
    claim: "238 initial configurations, 17 twist densities for 14 knot types.",
    table: "elastic/sweep.csv",
    draw,
};

const CELL: [f64; 2] = [40.0, 40.0];

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let sweep = Sweep::read(context.results)?;
    let (knots, twists) = (sweep.knots(), sweep.twists());
    let rows = knots
        .par_iter()
        .map(|knot| row(context, &sweep, knot))
        .collect::<Result<Vec<_>, _>>()?;
    let states: Vec<&State> = rows.iter().flatten().collect();
    let scale = Scale::viridis_root(high_density(&states));
    let unit = (CELL[0].min(CELL[1]) - 1.0) / widest(&states);

    let (left, top) = (34.0, 34.0);
    // A few twists still leave room for the note at the foot.
    let width = (left + CELL[0] * twists.len() as f64 + 50.0).max(620.0);
    let bottom = top + CELL[1] * knots.len() as f64;
    let mut canvas = Canvas::new(width, bottom + 34.0, 5.0 * context.detail);
    let middle = left + CELL[0] * twists.len() as f64 / 2.0;
    canvas.text(
        middle,
        13.0,
        "Twist density θ′*h*",
        Style::default().middle().size(10.5),
    );
    for (i, twist) in twists.iter().enumerate() {
        let x = left + CELL[0] * (i as f64 + 0.5);
        canvas.text(
            x,
            28.0,
            &text::signed(*twist),
            Style::default().middle().size(9.0),
        );
    }
    let images = states
        .par_iter()
        .map(|s| {
            let [x0, y0, x1, y1] = camera::extent(&s.view);
            let tube = Tube::new(&s.view, &s.curve.density, true, 1.0, &scale);
            let tube = tube.ok_or_else(|| ViewError::Drawing {
                reason: format!("{} at {} is no curve", s.knot, s.twist),
            })?;
            tube_png(
                CELL,
                [(x0 + x1) / 2.0, (y0 + y1) / 2.0],
                unit,
                canvas.zoom(),
                &tube,
            )
        })
        .collect::<Result<Vec<_>, _>>()?;
    let mut table = Table::new("knot,twist,s,x,y,z,energy_density");
    for (state, image) in states.iter().zip(&images) {
        let column = twists
            .iter()
            .position(|t| (t - state.twist).abs() < 1e-9)
            .unwrap_or(0);
        let line = knots.iter().position(|k| *k == state.knot).unwrap_or(0);
        let at = [left + CELL[0] * column as f64, top + CELL[1] * line as f64];
        canvas.image(at, CELL, image);
        for ((s, p), e) in state
            .curve
            .s
            .iter()
            .zip(&state.curve.points)
            .zip(&state.curve.density)
        {
            table.row(&[&state.knot], &[state.twist, *s, p.x, p.y, p.z, *e]);
        }
    }
    for (i, knot) in knots.iter().enumerate() {
        let y = top + CELL[1] * (i as f64 + 0.5) + 4.0;
        canvas.text(
            left - 6.0,
            y,
            &text::knot_name(knot),
            Style::default().end().bold().size(11.5),
        );
    }
    let high = scale.range().1;
    let bar = [width - 44.0, top + 0.28 * (bottom - top)];
    let size = [9.0, 0.44 * (bottom - top)];
    canvas.color_bar(
        bar,
        size,
        &scale,
        &root_ticks(high),
        "Energy density *w* / *E*_{b}*h*^{2}",
    );
    canvas.footnote(&face(&sweep, context.quality));
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding: finding(&sweep, &states),
    })
}

struct State {
    knot: String,
    twist: f64,
    curve: Curve,
    view: Vec<Vector3<f64>>,
}

/// The states of a knot, each turned like its neighbour nearer to zero twist.
fn row(context: &Context, sweep: &Sweep, knot: &str) -> Result<Vec<State>, ViewError> {
    let mut states = Vec::new();
    for case in sweep.of(knot) {
        let path = context
            .results
            .join("elastic")
            .join(case.folder())
            .join("charged.csv");
        let curve = Curve::read(&path)?;
        states.push(State {
            knot: knot.to_owned(),
            twist: case.first().twist,
            curve,
            view: Vec::new(),
        });
    }
    let mut order: Vec<usize> = (0..states.len()).collect();
    order.sort_by(|&a, &b| states[a].twist.abs().total_cmp(&states[b].twist.abs()));
    for (k, &i) in order.iter().enumerate() {
        let done = order[..k].iter();
        let near = done.min_by(|&&a, &&b| {
            let gap = |j: usize| (states[j].twist - states[i].twist).abs();
            gap(a).total_cmp(&gap(b))
        });
        let points = &states[i].curve.points;
        let turn = near.and_then(|&j| camera::aligned(points, &states[j].view));
        let view = camera::view(points, &turn.unwrap_or_else(|| camera::flattest(points)));
        states[i].view = camera::flattened(view);
    }
    square_up(&mut states);
    Ok(states)
}

/// Turns a row in the plane of the page so that its widest picture is as small as can be.
fn square_up(states: &mut [State]) {
    let turned = |degrees: usize| -> Matrix3<f64> {
        *Rotation3::from_axis_angle(&Vector3::z_axis(), (degrees as f64).to_radians()).matrix()
    };
    let side = |degrees: usize| {
        let turn = turned(degrees);
        let sides = states.iter().map(|s| {
            let [x0, y0, x1, y1] = camera::extent(&camera::view(&s.view, &turn));
            (x1 - x0).max(y1 - y0)
        });
        sides.fold(0.0_f64, f64::max)
    };
    let best = (0..180)
        .step_by(3)
        .min_by(|&a, &b| side(a).total_cmp(&side(b)))
        .unwrap_or(0);
    for state in states.iter_mut() {
        state.view = camera::view(&state.view, &turned(best));
    }
}

fn widest(states: &[&State]) -> f64 {
    let sides = states.iter().map(|s| {
        let [x0, y0, x1, y1] = camera::extent(&s.view);
        (x1 - x0).max(y1 - y0) + 2.0
    });
    sides.fold(4.0, f64::max)
}

/// Density that all but 1 % of the vertices stay below: a few hot spots must not darken all.
fn high_density(states: &[&State]) -> f64 {
    let mut all: Vec<f64> = states
        .iter()
        .flat_map(|s| s.curve.density.iter().copied())
        .collect();
    all.sort_by(f64::total_cmp);
    all.get((0.99 * all.len() as f64) as usize)
        .or(all.last())
        .copied()
        .unwrap_or(1.0)
}

fn finding(sweep: &Sweep, states: &[&State]) -> String {
    let energies = bounds(sweep.cases.iter().map(|c| c.first().energy));
    let densities = bounds(states.iter().flat_map(|s| s.curve.density.iter().copied()));
    format!(
        "{} states. Stored energy {} to {} E₀; energy density {} to {} E_b h².",
        states.len(),
        text::number(energies.0, 3),
        text::number(energies.1, 3),
        text::number(densities.0, 3),
        text::number(densities.1, 2)
    )
}
