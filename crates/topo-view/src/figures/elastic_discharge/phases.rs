//! Panel (c): energy against time, with the knot types passed on the way.

use super::super::figure::Context;
use super::super::series::{Table, bounds};
use crate::data::{self, Case, Moment, Sweep};
use crate::error::ViewError;
use crate::plot::canvas::Canvas;
use crate::plot::color::{INK, QUIET};
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::plot::text;
use kuva::prelude::{BandPlot, LinePlot, LineStyle, Plot};

/// Shades below the curve, by crossing number of the knot type: the unknot is left white.
fn shade(knot: &str) -> Option<&'static str> {
    let crossings = knot.trim_start_matches('m').split('_').next()?;
    let crossings: u32 = crossings.parse().ok()?;
    match crossings {
        0 => None,
        3 => Some("#c6daf0"),
        4 => Some("#cfe6cf"),
        5 => Some("#f6dfb4"),
        6 => Some("#ead0e4"),
        _ => Some("#d0d4d9"),
    }
}

/// A discharge in the panel.
struct Shown<'a> {
    case: Option<&'a Case>,
    /// Time in T0, and energy over that before the cut.
    curve: Vec<(f64, f64)>,
    ink: &'static str,
}

impl<'a> Shown<'a> {
    fn new(case: Option<&'a Case>, moments: &[Moment], ink: &'static str) -> Self {
        let start = case.map_or(1.0, |c| c.first().energy).max(1e-300);
        let curve = moments
            .iter()
            .filter(|m| m.time > 0.0)
            .map(|m| (m.time, m.energy / start))
            .collect();
        Self { case, curve, ink }
    }

    /// Its line from the left edge of the panel on.
    fn line(&self, first: f64, style: LineStyle) -> Plot {
        let seen = self.curve.iter().copied().filter(|p| p.0 >= first);
        let line = LinePlot::new().with_data(seen.collect::<Vec<_>>());
        let line = line.with_color(self.ink).with_stroke_width(1.8);
        Plot::Line(line.with_line_style(style))
    }

    /// Energy at a time, between the points of the curve.
    fn energy(&self, time: f64) -> f64 {
        let after = self.curve.iter().position(|p| p.0 >= time);
        match after {
            Some(0) => self.curve[0].1,
            Some(k) => {
                let ((t0, e0), (t1, e1)) = (self.curve[k - 1], self.curve[k]);
                e0 + (e1 - e0) * (time / t0).ln() / (t1 / t0).ln()
            }
            None => self.curve.last().map_or(0.0, |p| p.1),
        }
    }

    /// The area below the curve from one time to another.
    fn below(&self, from: f64, to: f64, color: &str) -> Plot {
        let inside = self
            .curve
            .iter()
            .map(|p| p.0)
            .filter(|t| from < *t && *t < to);
        let times: Vec<f64> = [from].into_iter().chain(inside).chain([to]).collect();
        let energies: Vec<f64> = times.iter().map(|t| self.energy(*t)).collect();
        let floor = vec![0.0; times.len()];
        Plot::Band(
            BandPlot::new(times, floor, energies)
                .with_color(color)
                .with_opacity(1.0),
        )
    }
}

/// Energy against time of the state that passes the most knot types at zero twist (7_4 when
/// it passes as many as any), beside the same knot at its largest twist.
pub fn draw(
    context: &Context,
    sweep: &Sweep,
    canvas: &mut Canvas,
    at: [f64; 2],
    table: &mut Table,
) -> Result<String, ViewError> {
    let zero = sweep
        .twists()
        .into_iter()
        .min_by(|a, b| a.abs().total_cmp(&b.abs()))
        .unwrap_or(0.0);
    let Some((case, moments)) = most_types(context, sweep, zero)? else {
        return Ok(String::new());
    };
    let knot = &case.first().knot;
    let twisted = sweep
        .of(knot)
        .into_iter()
        .last()
        .filter(|c| c.first().twist != zero);
    let other = twisted
        .map(|c| read_first_cut(context, c))
        .transpose()?
        .unwrap_or_default();
    let plain = Shown::new(Some(case), &moments, INK);
    let dashed = Shown::new(twisted, &other, QUIET);
    let (_, last) = bounds(plain.curve.iter().chain(&dashed.curve).map(|p| p.0));
    let first = (last / 3e4)
        .max(bounds(plain.curve.iter().map(|p| p.0)).0)
        .min(last / 10.0);
    let panel = Panel {
        at,
        size: [282.0, 178.0],
        x: Axis::log("Time *t* / *T*_{0}", (first, last * 1.02)),
        y: Axis::linear("Energy *E*(*t*) / *E*(0)", (0.0, 1.24), 0.2),
    };
    let bands = stretches(&moments);
    draw_bands(canvas, &panel, (&plain, &dashed), &bands, first);
    for shown in [&plain, &dashed] {
        for (x, y) in &shown.curve {
            let twist = shown.case.map_or(f64::NAN, |c| c.first().twist);
            table.row(&["c", knot], &[twist, *x, *y, *y, *y]);
        }
        name_curve(canvas, &panel, shown, first);
    }
    let path: Vec<String> = bands.iter().map(|b| text::knot_name(&b.0)).collect();
    Ok(format!("Knot types on the way: {}.", path.join(" → ")))
}

/// The case that passes the most knot types at a twist, 7_4 when it passes as many as any.
fn most_types<'a>(
    context: &Context,
    sweep: &'a Sweep,
    twist: f64,
) -> Result<Option<(&'a Case, Vec<Moment>)>, ViewError> {
    let mut best: Option<(usize, &Case, Vec<Moment>)> = None;
    for knot in sweep.knots() {
        let Some(case) = sweep.at(knot, twist) else {
            continue;
        };
        let moments = read_first_cut(context, case)?;
        let score = 10 * stretches(&moments).len() + usize::from(knot == "7_4");
        if best.as_ref().is_none_or(|b| score > b.0) {
            best = Some((score, case, moments));
        }
    }
    Ok(best.map(|(_, case, moments)| (case, moments)))
}

/// The curves, the area below the plain one shaded and named by the knot type that it passes.
fn draw_bands(
    canvas: &mut Canvas,
    panel: &Panel,
    (plain, dashed): (&Shown<'_>, &Shown<'_>),
    bands: &[(String, f64, f64)],
    first: f64,
) {
    let until = plain.curve.last().map_or(first, |p| p.0);
    let mut plots = Vec::new();
    for (knot, from, to) in bands {
        let (from, to) = (from.max(first), to.min(until));
        if let Some(color) = shade(knot).filter(|_| to > from) {
            plots.push(plain.below(from, to, color));
        }
    }
    plots.push(plain.line(first, LineStyle::Solid));
    if !dashed.curve.is_empty() {
        plots.push(dashed.line(first, LineStyle::Dashed));
    }
    panel.draw(canvas, plots, &[]);
    for (k, (knot, from, to)) in bands.iter().enumerate() {
        let [x0, x1] = [from.max(first), to.min(until)].map(|t| panel.place(t, 0.0)[0]);
        let [top, foot] = [1.22, 0.0].map(|e| panel.place(first, e)[1]);
        if k > 0 && x0 > panel.at[0] {
            let reach = panel.place(first, plain.energy(*from))[1];
            canvas.line([x0, top], [x0, reach.min(foot)], QUIET, 0.6);
        }
        if x1 - x0 > 13.0 {
            let style = Style::default().middle().bold().size(10.0);
            let middle = (x0 + x1) / 2.0;
            canvas.text(middle, panel.at[1] + 13.0, &text::knot_name(knot), style);
        }
    }
}

/// The name of a curve stands by its fall through 0.88 (the plain one, before it passes other knot types) or 0.34.
fn name_curve(canvas: &mut Canvas, panel: &Panel, shown: &Shown<'_>, first: f64) {
    let ink = shown.ink;
    let level = if ink == INK { 0.88 } else { 0.34 };
    let beside = shown.curve.iter().find(|p| p.1 < level && p.0 >= first);
    if let (Some((x, y)), Some(c)) = (beside, shown.case) {
        let [px, py] = panel.place(*x, *y);
        let label = format!(
            "{}, θ′*h* = {}",
            text::knot_name(&c.first().knot),
            text::signed(c.first().twist)
        );
        let style = Style::default().halo().size(9.0).color(ink);
        if ink == INK {
            canvas.text(px + 6.0, py, &label, style);
        } else {
            canvas.text(px - 6.0, py + 3.0, &label, style.end());
        }
    }
}

/// Rows of the first cut of a case.
fn read_first_cut(context: &Context, case: &Case) -> Result<Vec<Moment>, ViewError> {
    let path = context
        .results
        .join("elastic")
        .join(case.folder())
        .join("series.csv");
    let cut = case.first().cut;
    let mut moments = data::series(&path)?;
    moments.retain(|m| (m.cut - cut).abs() < 1e-9);
    Ok(moments)
}

/// Knot types with the times from and to which they last; changes lie midway (in log time)
/// between the two evaluations that bracket them.
fn stretches(moments: &[Moment]) -> Vec<(String, f64, f64)> {
    let mut out: Vec<(String, f64, f64)> = Vec::new();
    let mut seen = 0.0_f64;
    for m in moments {
        let Some(knot) = m.knot.as_deref().filter(|k| !k.is_empty()) else {
            continue;
        };
        match out.last_mut() {
            Some(last) if last.0 == knot => last.2 = m.time,
            Some(last) => {
                let change = if seen > 0.0 {
                    (seen * m.time).sqrt()
                } else {
                    m.time
                };
                last.2 = change;
                out.push((knot.to_owned(), change, m.time));
            }
            None => out.push((knot.to_owned(), 0.0, m.time)),
        }
        seen = m.time;
    }
    if let (Some(last), Some(end)) = (out.last_mut(), moments.last()) {
        last.2 = last.2.max(end.time);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moment(time: f64, knot: &str) -> Moment {
        Moment {
            cut: 0.0,
            time,
            energy: 1.0,
            knot: Some(knot.to_owned()),
        }
    }

    #[test]
    fn stretches_join_and_meet_between_evaluations() {
        let rows = [
            moment(0.0, "7_4"),
            moment(1.0, "7_4"),
            moment(2.0, ""),
            moment(4.0, "5_2"),
            moment(9.0, "0_1"),
        ];
        let got = stretches(&rows);
        let expected = [
            ("7_4".to_owned(), 0.0, 2.0),
            ("5_2".to_owned(), 2.0, 6.0),
            ("0_1".to_owned(), 6.0, 9.0),
        ];
        assert_eq!(got, expected);
        assert!(stretches(&[]).is_empty());
    }
}
