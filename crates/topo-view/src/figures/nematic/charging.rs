//! Charging the colloid: the ring and its profiles, its buckling, the order parameter and the free energy.

use super::{UNKNOWN, colloid, face, mark_onset, onset, particle_bar, profile_bar, winding_axis};
use crate::data::NematicSweep;
use crate::error::ViewError;
use crate::figures::beside::{self, Named};
use crate::figures::figure::{Context, Drawn, Figure};
use crate::figures::series::{Table, bounds, line, step};
use crate::plot::canvas::Canvas;
use crate::plot::color::{BLUE, INK, Scale, VERMILION, css};
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::plot::text;
use kuva::prelude::{Plot, ScatterPlot};
use topo_analysis::{NematicRow, nematic_resonance};

pub const FIGURE: Figure = Figure {
    name: "nematic-charging",
    title: "Charging a nematic colloid",
    caption: "(a) The particle, coloured by the x component of the director that its surface is given \
              (blue −1, yellow 1), the director in the plane through its centre, and the defect ring, \
              a spline through the points where the order is lowest, coloured by its local \
              cross-section: +½ (dark), twisted, −½ (bright), grey where it is not determined. \
              (b) Rings of several charges q, the turns of the surface director around the \
              equator. (c) Horizontal order parameter of every charge as a vector: the mean of \
              (Q_xz, Q_yz) over the nematic times 2/(3 S_eq), the mean tilt in radians where it is \
              small; Q: order tensor, S_eq: its order in equilibrium. (d) Its size against q. \
              (e) Free energy F of the charged state against q in L ξ_N, with the elastic constant \
              L and the nematic correlation length ξ_N. The dashed line at q_c marks the buckling.",
    claim: "The defect ring buckles for q ≥ q_c (published: 7) into a loop with q maxima; a \
            horizontal mean director appears there, while the free energy grows with q all the way.",
    table: "nematic/sweep.csv",
    draw,
};

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let sweep = NematicSweep::read(context.results)?;
    let mut table = Table::new("panel,q,x,y");
    let mut canvas = Canvas::new(720.0, 582.0, 4.0 * context.detail);
    canvas.letter(8.0, 18.0, "a");
    overview(&sweep, &mut canvas)?;
    canvas.letter(372.0, 18.0, "b");
    rings(&sweep, &mut canvas)?;
    color_key(&mut canvas);
    canvas.letter(8.0, 344.0, "c");
    vectors(&sweep, &mut canvas, &mut table);
    canvas.letter(250.0, 344.0, "d");
    order(&sweep, &mut canvas, &mut table);
    canvas.letter(486.0, 344.0, "e");
    energy(&sweep, &mut canvas, &mut table);
    canvas.footnote(&face(&sweep, context.quality));
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding: finding(&sweep),
    })
}

/// The row in whose picture profiles and undulations show best: q = 2 or the nearest.
fn shown(sweep: &NematicSweep) -> &NematicRow {
    let far = |r: &&NematicRow| (i64::from(r.q) - 2).abs();
    sweep.rows.iter().min_by_key(far).unwrap_or(&sweep.rows[0])
}

fn overview(sweep: &NematicSweep, canvas: &mut Canvas) -> Result<(), ViewError> {
    let row = shown(sweep);
    let slices = sweep.slices(row)?;
    let slice = slices.iter().find(|s| s.time.is_none());
    let solids = colloid(row.radius, row.q, &sweep.rings(row)?, slice, 14.0);
    let [x0, y0, x1, y1] = solids.extent();
    let (at, size) = ([14.0, 26.0], [330.0, 248.0]);
    let unit = (size[0] / (x1 - x0)).min(size[1] / (y1 - y0)) * 0.97;
    // plates above and below, as the edges of what is drawn
    let tall = 0.5 * unit * (y1 - y0) + 6.0;
    for y in [
        at[1] + size[1] / 2.0 - tall,
        at[1] + size[1] / 2.0 + tall - 5.0,
    ] {
        canvas.rect([at[0], y], [size[0], 5.0], "#c9ced4");
    }
    canvas.solids(at, size, [(x0 + x1) / 2.0, (y0 + y1) / 2.0], unit, &solids)?;
    let label = format!("*q* = {}", row.q);
    canvas.text(
        at[0] + 4.0,
        at[1] - 8.0 + 2.0,
        &label,
        Style::default().bold().size(11.0),
    );
    Ok(())
}

/// What the colours of rings and particles mean.
fn color_key(canvas: &mut Canvas) {
    const TOP: f64 = 308.0;
    let small = Style::default().size(9.0);
    profile_bar(canvas, [30.0, TOP], [120.0, 7.0], 8.5);
    canvas.text(162.0, TOP + 7.0, "Ring: local cross-section", small);
    canvas.rect([280.0, TOP], [16.0, 7.0], &css(UNKNOWN));
    canvas.text(301.0, TOP + 7.0, "not determined", small);
    particle_bar(canvas, [414.0, TOP], [120.0, 7.0], 8.5);
    let label = "Particle: *x* component of the surface director";
    canvas.text(546.0, TOP + 7.0, label, small);
}

fn rings(sweep: &NematicSweep, canvas: &mut Canvas) -> Result<(), ViewError> {
    let n = sweep.rows.len();
    let buckled = sweep.rows.iter().position(NematicRow::is_buckled);
    let mut picked = match buckled {
        Some(k) => vec![0, k / 2, k.saturating_sub(1), k, (k + n) / 2, n - 1],
        None => (0..6).map(|k| k * (n - 1) / 5).collect(),
    };
    picked.retain(|k| *k < n);
    picked.dedup();
    let (size, mut unit) = ([112.0, 118.0], f64::MAX);
    let mut pictures = Vec::new();
    for &k in &picked {
        let row = &sweep.rows[k];
        let solids = colloid(row.radius, row.q, &sweep.rings(row)?, None, 22.0);
        let [x0, y0, x1, y1] = solids.extent();
        unit = unit.min(size[0] / (x1 - x0)).min(size[1] / (y1 - y0));
        pictures.push((row, solids));
    }
    for (k, (row, solids)) in pictures.iter().enumerate() {
        let at = [
            376.0 + 114.0 * (k % 3) as f64,
            26.0 + 142.0 * (k / 3) as f64,
        ];
        canvas.solids(at, size, [0.0, 0.0], unit * 0.98, solids)?;
        let label = format!("*q* = {}", row.q);
        let style = Style::default().middle().size(9.5);
        canvas.text(at[0] + size[0] / 2.0, at[1] + size[1] + 8.0, &label, style);
    }
    Ok(())
}

fn vectors(sweep: &NematicSweep, canvas: &mut Canvas, table: &mut Table) {
    let ends: Vec<(u32, f64, f64)> = sweep
        .rows
        .iter()
        .filter_map(|r| {
            let start = sweep.series(r).ok()?.into_iter().next()?;
            Some((r.q, start.order_x, start.order_y))
        })
        .collect();
    let most = ends
        .iter()
        .map(|(_, x, y)| x.hypot(*y))
        .fold(0.02, f64::max);
    let half = 1.25 * most;
    let panel = Panel {
        at: [52.0, 352.0],
        size: [166.0, 166.0],
        x: Axis::linear(
            "2⟨*Q*_{xz}⟩ / 3*S*_{eq}",
            (-half, half),
            step(2.0 * half, 5.0),
        ),
        y: Axis::linear(
            "2⟨*Q*_{yz}⟩ / 3*S*_{eq}",
            (-half, half),
            step(2.0 * half, 5.0),
        ),
    };
    let scale = Scale::viridis(
        f64::from(sweep.rows[0].q),
        f64::from(sweep.rows[sweep.rows.len() - 1].q),
    );
    let mut plots = Vec::new();
    for (q, x, y) in &ends {
        table.row(&["c", &q.to_string()], &[*x, *y]);
        let color = scale.css(f64::from(*q));
        plots.push(line(vec![(0.0, 0.0), (*x, *y)], &color, 1.4));
        let dot = ScatterPlot::new()
            .with_data(vec![(*x, *y)])
            .with_color(color)
            .with_size(3.2);
        plots.push(Plot::Scatter(dot));
    }
    panel.draw(canvas, plots, &[]);
    let far: Vec<&(u32, f64, f64)> = ends
        .iter()
        .filter(|(_, x, y)| x.hypot(*y) > 0.1 * most)
        .collect();
    let origin = panel.place(0.0, 0.0);
    let lines: Vec<[[f64; 2]; 2]> = far
        .iter()
        .map(|(_, x, y)| [origin, panel.place(*x, *y)])
        .collect();
    let named: Vec<Named> = far
        .iter()
        .map(|(q, x, y)| Named {
            at: panel.place(*x, *y),
            name: q.to_string(),
        })
        .collect();
    let [left, top] = panel.at;
    let inside = [left, top, left + panel.size[0], top + panel.size[1]];
    beside::draw(canvas, &named, &lines, inside);
}

fn order(sweep: &NematicSweep, canvas: &mut Canvas, table: &mut Table) {
    let sizes: Vec<(f64, f64)> = sweep
        .rows
        .iter()
        .map(|r| (f64::from(r.q), r.order_parameter))
        .collect();
    let (_, high) = bounds(sizes.iter().map(|p| p.1));
    let high = 1.12 * high.max(0.02);
    let panel = Panel {
        at: [298.0, 352.0],
        size: [158.0, 166.0],
        x: winding_axis(sweep),
        y: Axis::linear(
            "2 |⟨(*Q*_{xz}, *Q*_{yz})⟩| / 3*S*_{eq}",
            (-0.03 * high, high),
            step(high, 4.0),
        ),
    };
    for (x, y) in &sizes {
        table.row(&["d", &x.to_string()], &[*x, *y]);
    }
    panel.draw(canvas, marked(sizes, BLUE), &[]);
    mark_onset(sweep, canvas, &panel);
}

fn marked(points: Vec<(f64, f64)>, color: &str) -> Vec<Plot> {
    let dots = ScatterPlot::new()
        .with_data(points.clone())
        .with_color(color)
        .with_size(3.0);
    vec![line(points, color, 1.4), Plot::Scatter(dots)]
}

fn energy(sweep: &NematicSweep, canvas: &mut Canvas, table: &mut Table) {
    let values: Vec<(f64, f64)> = sweep
        .rows
        .iter()
        .map(|r| (f64::from(r.q), r.f_charged))
        .collect();
    let (_, high) = bounds(values.iter().map(|p| p.1));
    let panel = Panel {
        at: [538.0, 352.0],
        size: [166.0, 166.0],
        x: winding_axis(sweep),
        y: Axis::linear(
            "Free energy *F* / *L*ξ_{N}",
            (0.0, 1.08 * high),
            step(high, 4.0),
        ),
    };
    for (x, y) in &values {
        table.row(&["e", &x.to_string()], &[*x, *y]);
    }
    panel.draw(canvas, marked(values, VERMILION), &[]);
    mark_onset(sweep, canvas, &panel);
    if let Some(x) = onset(sweep) {
        let [px, py] = panel.place(x, 0.0);
        let style = Style::default().size(8.5).color(INK).end();
        canvas.text(px - 3.0, py - 6.0, "*q*_{c}", style);
    }
}

fn finding(sweep: &NematicSweep) -> String {
    let found = nematic_resonance(&sweep.rows);
    let (first, last) = (&sweep.rows[0], &sweep.rows[sweep.rows.len() - 1]);
    let ring = sweep
        .rows
        .iter()
        .filter(|r| r.is_buckled())
        .filter_map(|r| Some((r.q, r.ring_mode?)))
        .collect::<Vec<_>>();
    let modes = if ring.is_empty() {
        String::new()
    } else {
        let right = ring.iter().filter(|(q, m)| q == m).count();
        format!(
            " Of {} buckled rings {right} have q undulations.",
            ring.len()
        )
    };
    format!(
        "{} Free energy {} to {} Lξ_N from q = {} to {}, {}.{modes}",
        found.q_c.map_or(
            format!("No ring up to q = {} buckles.", last.q),
            |q| format!("Rings buckle from q = {q} on (R = {} ξ_N).", first.radius)
        ),
        text::significant(first.f_charged, 4),
        text::significant(last.f_charged, 4),
        first.q,
        last.q,
        if found.energy_is_monotonic {
            "growing all the way"
        } else {
            "not monotonic"
        }
    )
}
