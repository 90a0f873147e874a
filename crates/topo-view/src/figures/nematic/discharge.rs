//! Discharging the colloid: director and flow, energy against time, and the rates against q.

use super::slice;
use super::{face, mark_onset, winding_axis};
use crate::data::{NematicSweep, Slice};
use crate::error::ViewError;
use crate::figures::figure::{Context, Drawn, Figure};
use crate::figures::series::{Table, bounds, line, log_bounds};
use crate::plot::canvas::Canvas;
use crate::plot::color::{BLUE, PURPLE, Scale, VERMILION};
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::plot::text;
use kuva::prelude::{Plot, ScatterPlot};
use topo_analysis::{NematicRow, nematic_resonance};

pub const FIGURE: Figure = Figure {
    name: "nematic-discharge",
    title: "Discharging a nematic colloid",
    caption: "(a) Director (green), velocity (arrows, each panel with its own scale), vorticity \
              (colour) and defect line (red) in the vertical plane through the particle after its \
              anchoring is switched off. (b) Free energy against time for every charge. (c) Rate \
              of the first half, 1/t50. (d) Rates 1/t99 and 1/t99.9; the dashed line marks the \
              buckling.",
    claim: "The ring is drawn into the particle and drives a flow that changes direction. The 50 % \
            rate grows with q; the 99 % and 99.9 % rates peak near the buckling and fall behind it.",
    table: "nematic/sweep.csv",
    draw,
};

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let sweep = NematicSweep::read(context.results)?;
    let mut table = Table::new("panel,q,x,y");
    let mut canvas = Canvas::new(720.0, 440.0, 4.0 * context.detail);
    canvas.letter(8.0, 18.0, "a");
    let reversal = snapshots(&sweep, &mut canvas)?;
    canvas.letter(8.0, 206.0, "b");
    curves(&sweep, &mut canvas, &mut table)?;
    canvas.letter(262.0, 206.0, "c");
    let half: Rates = ("50 %", VERMILION, |r| r.t50);
    rates(&sweep, &mut canvas, 308.0, "c", &[half], &mut table);
    canvas.letter(496.0, 206.0, "d");
    let late: [Rates; 2] = [("99 %", BLUE, |r| r.t99), ("99.9 %", PURPLE, |r| r.t999)];
    rates(&sweep, &mut canvas, 544.0, "d", &late, &mut table);
    canvas.footnote(&face(&sweep, context.quality));
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding: format!("{}{reversal}", finding(&sweep)),
    })
}

/// A rate: its label, colour and time.
type Rates = (&'static str, &'static str, fn(&NematicRow) -> Option<f64>);

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
        at: [52.0, 214.0],
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
    canvas.color_bar([222.0, 232.0], [7.0, 120.0], &scale, &ticks, "");
    canvas.text(220.0, 224.0, "*q*", Style::default().size(9.5));
    Ok(())
}

fn rates(
    sweep: &NematicSweep,
    canvas: &mut Canvas,
    left: f64,
    letter: &str,
    shown: &[Rates],
    table: &mut Table,
) {
    let area = sweep.rows[0].radius.powi(2);
    let series: Vec<Vec<(f64, f64)>> = shown
        .iter()
        .map(|(_, _, time)| {
            let rate = |r: &NematicRow| Some((f64::from(r.q), area / time(r)?));
            sweep.rows.iter().filter_map(rate).collect()
        })
        .collect();
    let size = [160.0, 166.0];
    let label_at = |k: usize| 16.0 + 12.0 * k as f64;
    let range = log_bounds(series.iter().flatten().map(|p| p.1), 1.35);
    // Room for the labels above what lies in the left third.
    let third = sweep.rows[0].q + (sweep.rows[sweep.rows.len() - 1].q - sweep.rows[0].q) / 3;
    let below = 1.0 - label_at(shown.len()) / size[1];
    let left_points = series.iter().flatten().filter(|p| p.0 <= f64::from(third));
    let needed = left_points.map(|p| range.0 * (p.1 / range.0).powf(1.0 / below));
    let range = (range.0, needed.fold(range.1, f64::max));
    let panel = Panel {
        at: [left, 214.0],
        size,
        x: winding_axis(sweep),
        y: Axis::log("Rate *R*^{2}/Γ*Lt*", range),
    };
    let mut plots = Vec::new();
    for ((label, color, _), points) in shown.iter().zip(series) {
        for (x, y) in &points {
            table.row(&[&format!("{letter} {label}"), &x.to_string()], &[*x, *y]);
        }
        let dots = ScatterPlot::new()
            .with_data(points.clone())
            .with_color(*color)
            .with_size(3.0);
        plots.push(line(points, color, 1.4));
        plots.push(Plot::Scatter(dots));
    }
    panel.draw(canvas, plots, &[]);
    mark_onset(sweep, canvas, &panel);
    for (k, (label, color, _)) in shown.iter().enumerate() {
        let y = panel.at[1] + label_at(k);
        let style = Style::default().bold().halo().size(9.5).color(color);
        canvas.text(panel.at[0] + 8.0, y, label, style);
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
