//! Discharging the colloid: director and flow, energy against time, and the rates against q.

use super::slice;
use super::{face, mark_onset, winding_axis};
use crate::data::{NematicSweep, Slice};
use crate::error::ViewError;
use crate::figures::figure::{Context, Drawn, Figure};
use crate::figures::series::{Table, bounds, line, log_bounds};
use crate::plot::canvas::Canvas;
use crate::plot::color::{BLUE, INK, Scale, VERMILION};
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::plot::text;
use kuva::prelude::{MarkerShape, Plot, ScatterPlot};
use topo_analysis::{NematicRow, nematic_resonance};

pub const FIGURE: Figure = Figure {
    name: "nematic-discharge",
    title: "Discharging a nematic colloid",
    caption: "(a) Director (green), velocity (arrows), vorticity ω_y (colour; ω_0 is 70 % of its largest \
              size) and defect line (red) in the vertical plane through the particle after its \
              anchoring is switched off; each panel has its own scales, written below it. Times in \
              R²/ΓL, with the radius R, the rotational mobility Γ and the elastic constant L; ξ_N: \
              nematic correlation length, τ_N = ξ_N²/ΓL. (b) Free energy F against the time t since \
              the switch for every charge q. (c) Rate 1/t50: t50 is the time in which half of the \
              energy is released that F has right after the switch above its value in the final \
              equilibrium. (d) Rates 1/t99 and 1/t99.9 for 99 % and 99.9 % of that energy; the \
              dashed line marks the buckling.",
    claim: "The ring is drawn into the particle and drives a flow that changes direction. The 50 % \
            rate grows with q; the 99 % and 99.9 % rates peak near the buckling and fall behind it.",
    table: "nematic/sweep.csv",
    draw,
};

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let sweep = NematicSweep::read(context.results)?;
    let mut table = Table::new("panel,q,x,y");
    let mut canvas = Canvas::new(720.0, 476.0, 4.0 * context.detail);
    canvas.letter(8.0, 18.0, "a");
    let reversal = snapshots(&sweep, &mut canvas)?;
    canvas.letter(8.0, 242.0, "b");
    curves(&sweep, &mut canvas, &mut table)?;
    canvas.letter(262.0, 242.0, "c");
    let half = Rate::new(
        ["50 %", "*t*_{50}: 50 % of *F* released"],
        INK,
        MarkerShape::Circle,
        |r| r.t50,
    );
    rates(&sweep, &mut canvas, 308.0, "c", &[half], &mut table);
    canvas.letter(496.0, 242.0, "d");
    let late = [
        Rate::new(
            ["99 %", "*t*_{99}: 99 % of *F* released"],
            BLUE,
            MarkerShape::Circle,
            |r| r.t99,
        ),
        Rate::new(
            ["99.9 %", "*t*_{99.9}: 99.9 % of *F* released"],
            VERMILION,
            MarkerShape::Square,
            |r| r.t999,
        ),
    ];
    rates(&sweep, &mut canvas, 544.0, "d", &late, &mut table);
    canvas.footnote(&face(&sweep, context.quality));
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding: format!("{}{reversal}", finding(&sweep)),
    })
}

/// A rate with its looks.
struct Rate {
    /// The share of the energy, as the table has it.
    share: &'static str,
    label: &'static str,
    color: &'static str,
    marker: MarkerShape,
    /// The time that it is one over.
    time: fn(&NematicRow) -> Option<f64>,
}

impl Rate {
    fn new(
        [share, label]: [&'static str; 2],
        color: &'static str,
        marker: MarkerShape,
        time: fn(&NematicRow) -> Option<f64>,
    ) -> Self {
        Self {
            share,
            label,
            color,
            marker,
            time,
        }
    }
}

/// Four times of one run, with flow if there is one; says whether the flow reverses.
fn snapshots(sweep: &NematicSweep, canvas: &mut Canvas) -> Result<String, ViewError> {
    let row = sweep.flowing.first().unwrap_or(&sweep.rows[0]);
    let slices = sweep.slices(row)?;
    let after: Vec<&Slice> = slices.iter().filter(|s| s.time.is_some()).collect();
    if after.is_empty() {
        return Err(ViewError::Table {
            path: sweep.case(row).join("slices.csv"),
            reason: "no slice after the switch".to_owned(),
        });
    }
    slice::moments(canvas, &after, &sweep.rings(row)?, row.radius)?;
    let label = format!("*q* = {}", row.q);
    canvas.text(24.0, 18.0, &label, Style::default().bold().size(10.5));
    reversal(sweep, row)
}

/// Whether the flow changes its direction, in words; nothing without flow.
fn reversal(sweep: &NematicSweep, row: &NematicRow) -> Result<String, ViewError> {
    let series = sweep.series(row)?;
    let found = series
        .iter()
        .filter_map(|p| Some((p.time, p.flow_correlation?)));
    let Some((time, least)) = found.min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Ok(String::new());
    };
    Ok(format!(
        " With flow (q = {}) the correlation of the velocity with the first falls to {} at t = {} R²/ΓL.",
        row.q,
        text::number(least, 2),
        text::significant(time / row.radius.powi(2), 2)
    ))
}

fn curves(sweep: &NematicSweep, canvas: &mut Canvas, table: &mut Table) -> Result<(), ViewError> {
    let (low, high) = bounds(sweep.rows.iter().map(|r| f64::from(r.q)));
    let scale = Scale::viridis(low, high);
    let area = sweep.rows[0].radius.powi(2);
    let mut series = Vec::new();
    for row in &sweep.rows {
        let points: Vec<(f64, f64)> = sweep
            .series(row)?
            .iter()
            .filter(|s| s.time > 0.0 && s.energy > 0.0)
            .map(|s| (s.time / area, s.energy))
            .collect();
        series.push((row.q, points));
    }
    let (_, top) = log_bounds(series.iter().flat_map(|s| s.1.iter().map(|p| p.1)), 1.5);
    let (t0, t1) = log_bounds(series.iter().flat_map(|s| s.1.iter().map(|p| p.0)), 1.0);
    let panel = Panel {
        at: [52.0, 250.0],
        size: [162.0, 166.0],
        x: Axis::log("Time *t* Γ*L*/*R*^{2}", (t0.max(1e-4), t1.max(2e-4))),
        y: Axis::log("Free energy *F* / *L*ξ_{N}", (top * 1e-4, top)),
    };
    let mut plots = Vec::new();
    for (q, points) in series {
        for (x, y) in &points {
            table.row(&["b", &q.to_string()], &[*x, *y]);
        }
        let inside = |p: &(f64, f64)| p.1 > top * 1e-4 && p.0 >= t0.max(1e-4);
        let points = points.into_iter().filter(inside).collect();
        plots.push(line(points, &scale.css(f64::from(q)), 1.2));
    }
    panel.draw(canvas, plots, &[]);
    let ticks: Vec<f64> = [low, (0.5 * (low + high)).round(), high].to_vec();
    canvas.color_bar([222.0, 268.0], [7.0, 120.0], &scale, &ticks, "");
    canvas.text(220.0, 260.0, "*q*", Style::default().size(9.5));
    Ok(())
}

fn rates(
    sweep: &NematicSweep,
    canvas: &mut Canvas,
    left: f64,
    letter: &str,
    shown: &[Rate],
    table: &mut Table,
) {
    let area = sweep.rows[0].radius.powi(2);
    let series: Vec<Vec<(f64, f64)>> = shown
        .iter()
        .map(|shown| {
            let rate = |r: &NematicRow| Some((f64::from(r.q), area / (shown.time)(r)?));
            sweep.rows.iter().filter_map(rate).collect()
        })
        .collect();
    let size = [160.0, 166.0];
    let label_at = |k: usize| 16.0 + 12.0 * k as f64;
    let range = log_bounds(series.iter().flatten().map(|p| p.1), 1.35);
    let panel = Panel {
        at: [left, 250.0],
        size,
        x: winding_axis(sweep),
        y: Axis::log("Rate (*R*^{2}/Γ*L*) / *t*", range).with_room(label_at(shown.len()), size[1]),
    };
    let mut plots = Vec::new();
    for (rate, points) in shown.iter().zip(series) {
        for (x, y) in &points {
            table.row(
                &[&format!("{letter} {}", rate.share), &x.to_string()],
                &[*x, *y],
            );
        }
        let dots = ScatterPlot::new()
            .with_data(points.clone())
            .with_color(rate.color)
            .with_marker(rate.marker)
            .with_size(3.0);
        plots.push(line(points, rate.color, 1.4));
        plots.push(Plot::Scatter(dots));
    }
    panel.draw(canvas, plots, &[]);
    mark_onset(sweep, canvas, &panel);
    for (k, rate) in shown.iter().enumerate() {
        let y = panel.at[1] + label_at(k);
        let style = Style::default().halo().size(9.5).color(rate.color);
        canvas.text(panel.at[0] + 8.0, y, rate.label, style);
    }
}

fn finding(sweep: &NematicSweep) -> String {
    let found = nematic_resonance(&sweep.rows);
    let area = sweep.rows[0].radius.powi(2);
    let peak = |name: &str, peak: Option<(u32, f64)>| {
        peak.map_or(String::new(), |(q, rate)| {
            format!(
                " The {name} rate peaks at q = {q} with {} Γ L/R².",
                text::number(rate * area, 2)
            )
        })
    };
    format!(
        "The 50 % rate {} with q.{}{}{}",
        if found.half_rate_is_monotonic {
            "grows monotonically"
        } else {
            "is not monotonic"
        },
        peak("99 %", found.peak_99),
        peak("99.9 %", found.peak_999),
        match (found.q_c, found.collapse) {
            (Some(q), Some(c)) => format!(
                " Rings buckle from q = {q} on, where the 99.9 % rate is {} times smaller than at its peak.",
                text::number(c, 1)
            ),
            _ => String::new(),
        }
    )
}
