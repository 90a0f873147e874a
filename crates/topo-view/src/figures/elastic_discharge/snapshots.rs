//! Panel (a): the fastest and the slowest discharge at zero twist, as tubes.

use super::super::figure::Context;
use super::super::series::{bounds, root_ticks};
use super::super::shapes::tubes;
use crate::data::{self, Case, Snapshot, Sweep, points_of};
use crate::error::ViewError;
use crate::plot::canvas::Canvas;
use crate::plot::color::{QUIET, Scale};
use crate::plot::style::Style;
use crate::plot::{camera, text};
use nalgebra::Vector3;
use std::path::Path;

/// Snapshots, each with its points turned to the reader.
type Strip = Vec<(Snapshot, Vec<Vector3<f64>>)>;

/// Snapshots shown of a discharge.
const SHOWN: usize = 6;

/// A discharge in the panel.
struct Row<'a> {
    /// What sets it apart.
    name: &'static str,
    case: &'a Case,
    t99: f64,
    strip: Strip,
}

/// Where the panel lies, and what all its rows share.
struct Layout<'a> {
    at: [f64; 2],
    size: [f64; 2],
    scale: &'a Scale,
    /// Height of a row.
    height: f64,
    /// Length on paper of h.
    unit: f64,
}

/// Room for the color bar and for the names of the knots, and between snapshots.
const BAR: f64 = 56.0;
const LABEL: f64 = 44.0;
const GAP: f64 = 7.0;

/// Draws the panel into a box and says which states it shows.
pub fn draw(
    context: &Context,
    sweep: &Sweep,
    canvas: &mut Canvas,
    at: [f64; 2],
    size: [f64; 2],
) -> Result<String, ViewError> {
    let rows = rows(context.results, sweep)?;
    if rows.is_empty() {
        return Ok(String::new());
    }
    let high = high_density(&rows);
    let scale = Scale::viridis_root(high.max(1e-12));
    let height = size[1] / rows.len() as f64;
    let layout = Layout {
        at,
        size,
        scale: &scale,
        height,
        unit: unit(&rows, size[0], height),
    };
    for (k, row) in rows.iter().enumerate() {
        layout.draw_row(canvas, row, at[1] + height * k as f64)?;
    }
    let bar_at = [at[0] + size[0] - 42.0, at[1] + 24.0];
    let bar_size = [9.0, size[1] - 58.0];
    canvas.color_bar(
        bar_at,
        bar_size,
        &scale,
        &root_ticks(high),
        "Energy density *w* / *E*_{b}*h*^{2}",
    );
    let said: Vec<String> = rows
        .iter()
        .map(|row| {
            format!(
                "{} ({}) t99 = {} T₀",
                text::knot_name(&row.case.first().knot),
                row.name,
                text::number(row.t99, 2)
            )
        })
        .collect();
    Ok(format!("Snapshots at zero twist: {}.", said.join(", ")))
}

/// The fastest and the slowest discharge at zero twist, or the only one.
fn rows<'a>(results: &Path, sweep: &'a Sweep) -> Result<Vec<Row<'a>>, ViewError> {
    let zero = sweep
        .twists()
        .into_iter()
        .min_by(|a, b| a.abs().total_cmp(&b.abs()))
        .unwrap_or(0.0);
    let mut cases: Vec<(&Case, f64)> = sweep
        .knots()
        .iter()
        .filter_map(|k| sweep.at(k, zero))
        .filter_map(|c| Some((c, c.first().t99?)))
        .collect();
    cases.sort_by(|a, b| a.1.total_cmp(&b.1));
    let shown = match (cases.first(), cases.last()) {
        (Some(fast), Some(slow)) if cases.len() > 1 => vec![("fast", *fast), ("slow", *slow)],
        (Some(only), _) => vec![("", *only)],
        _ => Vec::new(),
    };
    shown
        .into_iter()
        .map(|(name, (case, t99))| {
            Ok(Row {
                name,
                case,
                t99,
                strip: strip(results, case)?,
            })
        })
        .collect()
}

/// End of the scale: it leaves out the hottest spots of the tight bends.
fn high_density(rows: &[Row<'_>]) -> f64 {
    let shots = rows.iter().flat_map(|row| &row.strip);
    let mut sorted: Vec<f64> = shots
        .flat_map(|s| &s.0.curves)
        .flat_map(|curve| curve.density.iter().copied())
        .collect();
    sorted.sort_by(f64::total_cmp);
    sorted
        .get((0.985 * sorted.len() as f64) as usize)
        .copied()
        .unwrap_or(1.0)
}

/// Length on paper of h, such that all rows fit.
fn unit(rows: &[Row<'_>], width: f64, height: f64) -> f64 {
    let room = width - BAR - LABEL - GAP * SHOWN as f64;
    let widths = rows
        .iter()
        .map(|row| row.strip.iter().map(|(_, v)| span(v)[0]).sum::<f64>());
    let unit = widths.map(|w| room / w).fold(8.0, f64::min);
    let views = rows.iter().flat_map(|row| &row.strip);
    let tallest = bounds(views.map(|(_, v)| span(v)[1])).1;
    unit.min((height - 20.0) / tallest)
}

impl Layout<'_> {
    fn draw_row(&self, canvas: &mut Canvas, row: &Row<'_>, top: f64) -> Result<(), ViewError> {
        let Self {
            at,
            size,
            scale,
            height,
            unit,
        } = *self;
        let shots = &row.strip;
        let middle = top + (height - 18.0) / 2.0;
        let knot = text::knot_name(&row.case.first().knot);
        canvas.text(
            at[0] + 14.0,
            middle,
            &knot,
            Style::default().bold().size(13.0),
        );
        canvas.text(
            at[0] + 14.0,
            middle + 13.0,
            row.name,
            Style::default().size(9.5).color(QUIET),
        );
        let used: f64 = shots.iter().map(|(_, v)| span(v)[0] * unit).sum();
        let free = (size[0] - BAR - LABEL - used) / shots.len().max(1) as f64;
        let mut x = at[0] + LABEL + free / 2.0;
        for (shot, view) in shots {
            let [w, h] = span(view);
            let [x0, y0, x1, y1] = camera::extent(view);
            let tubes = tubes(&shot.curves, view, scale).ok_or_else(|| ViewError::Drawing {
                reason: format!("snapshot at {} is no curve", shot.time),
            })?;
            let side = [w * unit, h * unit];
            canvas.tubes(
                [x, middle - side[1] / 2.0],
                side,
                [(x0 + x1) / 2.0, (y0 + y1) / 2.0],
                unit,
                &tubes,
            )?;
            let time = time_label(shot.time);
            canvas.text(
                x + side[0] / 2.0,
                top + height - 8.0,
                &time,
                Style::default().middle().size(9.0),
            );
            x += side[0] + free;
        }
        Ok(())
    }
}

/// A time in T0 with as many decimals as it needs.
fn time_label(time: f64) -> String {
    if time == 0.0 {
        return "*t* = 0".to_owned();
    }
    let places = if time < 0.1 {
        3
    } else {
        usize::from(time < 10.0) + 1
    };
    format!("{} *T*_{{0}}", text::number(time, places))
}

/// The snapshots whose energies are spread most evenly from the first to the last 6 %.
fn spread(shots: Vec<Snapshot>, energies: &[(f64, f64)]) -> Vec<Snapshot> {
    if shots.len() <= SHOWN || energies.is_empty() {
        return shots;
    }
    let start = energies[0].1.max(f64::MIN_POSITIVE);
    let left = |time: f64| {
        let gap = |m: &&(f64, f64)| (m.0 - time).abs();
        let near = energies.iter().min_by(|a, b| gap(a).total_cmp(&gap(b)));
        near.map_or(0.0, |m| m.1 / start)
    };
    let lefts: Vec<f64> = shots.iter().map(|s| left(s.time)).collect();
    let mut kept: Vec<usize> = Vec::new();
    for k in 0..SHOWN {
        let aim = 1.0 - 0.94 * k as f64 / (SHOWN - 1) as f64;
        let free = (0..shots.len()).filter(|i| !kept.contains(i));
        kept.extend(
            free.min_by(|&a, &b| (lefts[a] - aim).abs().total_cmp(&(lefts[b] - aim).abs())),
        );
    }
    let mut i = 0;
    let mut shots = shots;
    shots.retain(|_| {
        i += 1;
        kept.contains(&(i - 1))
    });
    shots
}

fn span(view: &[Vector3<f64>]) -> [f64; 2] {
    let [x0, y0, x1, y1] = camera::extent(view);
    [x1 - x0 + 2.4, y1 - y0 + 2.4]
}

/// Snapshots of the first cut, spread evenly over those stored, each turned like the last.
fn strip(results: &Path, case: &Case) -> Result<Strip, ViewError> {
    let folder = results.join("elastic").join(case.folder());
    let cut = case.first().cut;
    let mut shots = data::snapshots(&folder)?;
    shots.retain(|s| (s.cut - cut).abs() < 1e-9);
    let energies = data::series(&folder.join("series.csv"))?;
    let energies: Vec<(f64, f64)> = energies
        .iter()
        .filter(|m| (m.cut - cut).abs() < 1e-9)
        .map(|m| (m.time, m.energy))
        .collect();
    let shots = spread(shots, &energies);
    // Turned backwards from the straight end, which lies along x, to the knot.
    let mut strip = Strip::new();
    for shot in shots.into_iter().rev() {
        let points = &points_of(&shot.curves);
        let like = strip.last().and_then(|(_, v)| camera::aligned(points, v));
        let view = camera::view(points, &like.unwrap_or_else(|| camera::flattest(points)));
        strip.push((shot, view));
    }
    strip.reverse();
    Ok(strip)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Curve;

    #[test]
    fn snapshots_are_spread_in_energy() {
        let shots: Vec<Snapshot> = (0..40)
            .map(|k| Snapshot {
                cut: 0.0,
                time: f64::from(k),
                curves: vec![Curve::default()],
            })
            .collect();
        // Nothing happens until 20, and nothing after 30.
        let energies: Vec<(f64, f64)> = (0..40)
            .map(|k| {
                (
                    f64::from(k),
                    1.0 - (f64::from(k) - 20.0).clamp(0.0, 10.0) / 10.0,
                )
            })
            .collect();
        let times: Vec<f64> = spread(shots, &energies).iter().map(|s| s.time).collect();
        assert_eq!(times.len(), SHOWN);
        assert!(times.windows(2).all(|w| w[0] < w[1]));
        assert!(times[1] > 20.0 && times[4] < 30.0, "{times:?}");
    }

    #[test]
    fn times_are_reported_briefly() {
        assert_eq!(time_label(0.0), "*t* = 0");
        assert_eq!(time_label(0.0123), "0.012 *T*_{0}");
        assert_eq!(time_label(20.55), "20.6 *T*_{0}");
    }
}
