//! All charged states as tubes coloured by energy density, one row a knot, one column a twist.

use super::figure::{Context, Drawn, Figure, face};
use super::series::{Table, bounds, root_ticks};
use super::shapes::{Shape, high_density, turn_alike, widest};
use crate::data::{Curve, Sweep};
use crate::error::ViewError;
use crate::plot::canvas::Canvas;
use crate::plot::color::Scale;
use crate::plot::style::Style;
use crate::plot::text;
use rayon::prelude::*;

pub(super) const FIGURE: Figure = Figure {
    name: "elastic-configurations",
    title: "Charged states",
    caption: "Every charged state: a closed fibre of radius h tied into one of 14 knots (rows) and fused \
              with one of 17 twist densities θ′h (columns; θ′ is the angle of twist per length), \
              relaxed. Colour is the elastic energy w per unit length in E_b h², with \
              the bending modulus E_b; all tubes have one scale, and neighbours in a row are turned alike.",
    claim: "238 initial configurations, 17 twist densities for 14 knot types.",
    table: "elastic/sweep.csv",
    draw,
};

const CELL: [f64; 2] = [40.0, 40.0];

/// Upper left corner of the states.
const CORNER: [f64; 2] = [34.0, 34.0];

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let sweep = Sweep::read(context.results)?;
    let (knots, twists) = (sweep.knots(), sweep.twists());
    let rows = knots
        .par_iter()
        .map(|knot| row(context, &sweep, knot))
        .collect::<Result<Vec<_>, _>>()?;
    let states: Vec<&State> = rows.iter().flatten().collect();
    let shapes = || states.iter().map(|s| &s.shape);
    let scale = Scale::viridis_root(high_density(shapes()));
    let unit = (CELL[0].min(CELL[1]) - 1.0) / widest(shapes());

    let [left, top] = CORNER;
    // A few twists still leave room for the note at the foot.
    let width = (left + CELL[0] * twists.len() as f64 + 50.0).max(620.0);
    let bottom = top + CELL[1] * knots.len() as f64;
    let mut canvas = Canvas::new(width, bottom + 34.0, 5.0 * context.detail);
    name_columns(&mut canvas, &twists);
    let images = states
        .par_iter()
        .map(|s| {
            let name = format!("{} at {}", s.knot, s.twist);
            s.shape.image(&name, CELL, unit, canvas.zoom(), &scale)
        })
        .collect::<Result<Vec<_>, _>>()?;
    for (state, image) in states.iter().zip(&images) {
        let column = twists
            .iter()
            .position(|t| (t - state.twist).abs() < 1e-9)
            .unwrap_or(0);
        let line = knots.iter().position(|k| *k == state.knot).unwrap_or(0);
        let at = [left + CELL[0] * column as f64, top + CELL[1] * line as f64];
        canvas.image(at, CELL, image);
    }
    name_rows(&mut canvas, &knots);
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
        csv: table(&states).finish(),
        finding: finding(&sweep, &states),
    })
}

fn name_columns(canvas: &mut Canvas, twists: &[f64]) {
    let middle = CORNER[0] + CELL[0] * twists.len() as f64 / 2.0;
    canvas.text(
        middle,
        13.0,
        "Twist density θ′*h*",
        Style::default().middle().size(10.5),
    );
    for (i, twist) in twists.iter().enumerate() {
        let x = CORNER[0] + CELL[0] * (i as f64 + 0.5);
        canvas.text(
            x,
            28.0,
            &text::signed(*twist),
            Style::default().middle().size(9.0),
        );
    }
}

fn name_rows(canvas: &mut Canvas, knots: &[&str]) {
    for (i, knot) in knots.iter().enumerate() {
        let y = CORNER[1] + CELL[1] * (i as f64 + 0.5) + 4.0;
        canvas.text(
            CORNER[0] - 6.0,
            y,
            &text::knot_name(knot),
            Style::default().end().bold().size(11.5),
        );
    }
}

fn table(states: &[&State]) -> Table {
    let mut table = Table::new("knot,twist,s,x,y,z,energy_density");
    for state in states {
        let curves = state.shape.curves.iter();
        let all = curves.flat_map(|c| c.s.iter().zip(&c.points).zip(&c.density));
        for ((s, p), e) in all {
            table.row(&[&state.knot], &[state.twist, *s, p.x, p.y, p.z, *e]);
        }
    }
    table
}

struct State {
    knot: String,
    twist: f64,
    shape: Shape,
}

/// The states of a knot, each turned like its neighbour nearer to zero twist.
fn row(context: &Context, sweep: &Sweep, knot: &str) -> Result<Vec<State>, ViewError> {
    let (mut twists, mut shapes) = (Vec::new(), Vec::new());
    for case in sweep.of(knot) {
        let folder = context.results.join("elastic").join(case.folder());
        shapes.push(Shape::new(Curve::read_all(&folder.join("charged.csv"))?));
        twists.push(case.first().twist);
    }
    let mut order: Vec<usize> = (0..shapes.len()).collect();
    order.sort_by(|&a, &b| twists[a].abs().total_cmp(&twists[b].abs()));
    turn_alike(&mut shapes, &order, |j, i| (twists[j] - twists[i]).abs());
    let state = |(twist, shape)| State {
        knot: knot.to_owned(),
        twist,
        shape,
    };
    Ok(twists.into_iter().zip(shapes).map(state).collect())
}

fn finding(sweep: &Sweep, states: &[&State]) -> String {
    let energies = bounds(sweep.cases.iter().map(|c| c.first().energy));
    let densities = bounds(
        states
            .iter()
            .flat_map(|s| &s.shape.curves)
            .flat_map(|curve| curve.density.iter().copied()),
    );
    format!(
        "{} states. Stored energy {} to {} E₀; energy density {} to {} E_b h².",
        states.len(),
        text::number(energies.0, 3),
        text::number(energies.1, 3),
        text::number(densities.0, 3),
        text::number(densities.1, 2)
    )
}
