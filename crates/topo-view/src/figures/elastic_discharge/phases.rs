//! Panel (c): energy against time, with the knot types passed on the way.

use super::super::figure::Context;
use super::super::series::{Table, bounds, line};
use crate::data::{self, Case, Moment, Sweep};
use crate::error::ViewError;
use crate::plot::canvas::Canvas;
use crate::plot::color::{INK, QUIET};
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::plot::text;
use kuva::prelude::Plot;

/// Shades of the knot-type bands, by crossing number: the unknot is left white.
fn band_color(knot: &str) -> Option<(String, f64)> {
    let crossings = knot.trim_start_matches('m').split('_').next()?;
    let crossings: u32 = crossings.parse().ok()?;
    let shade = match crossings {
        0 => return None,
        3 => "#d7e3f4",
        4 => "#dcecdc",
        5 => "#f6e7cb",
        6 => "#efdcea",
        _ => "#d9dce0",
    };
    Some((shade.to_owned(), 1.0))
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
    fn line(&self, first: f64, width: f64) -> Plot {
        let seen = self.curve.iter().copied().filter(|p| p.0 >= first);
        line(seen.collect(), self.ink, width)
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
        y: Axis::linear("Energy *E*(*t*) / *E*(0)", (0.0, 1.18), 0.2),
    };
    let mut plots = vec![plain.line(first, 2.0)];
    if !dashed.curve.is_empty() {
        plots.push(dashed.line(first, 1.4));
    }
    let bands = stretches(&moments);
    draw_bands(canvas, &panel, plots, &bands, first);
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

/// The curves over shaded and named stretches of one knot type.
fn draw_bands(
    canvas: &mut Canvas,
    panel: &Panel,
    plots: Vec<Plot>,
    bands: &[(String, f64, f64)],
    first: f64,
) {
    let shaded: Vec<(f64, f64, String, f64)> = bands
        .iter()
        .filter_map(|(knot, from, to)| {
            let (shade, opacity) = band_color(knot)?;
            Some((from.max(first), to.max(first * 1.0001), shade, opacity))
        })
        .collect();
    panel.draw(canvas, plots, &shaded);
    for (knot, from, to) in bands {
        let [x0, x1] = [from.max(first), *to].map(|t| panel.place(t, 0.0)[0]);
        if x1 - x0 > 13.0 {
            canvas.text(
                (x0 + x1) / 2.0,
                panel.at[1] + 13.0,
                &text::knot_name(knot),
                Style::default().middle().bold().size(10.0),
            );
        }
    }
}

/// The name of a curve stands by its fall through 0.62 (the plain one) or 0.34.
fn name_curve(canvas: &mut Canvas, panel: &Panel, shown: &Shown<'_>, first: f64) {
    let ink = shown.ink;
    let level = if ink == INK { 0.62 } else { 0.34 };
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
