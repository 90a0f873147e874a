//! Panel (e): the time to release 99 % of all states.

use super::super::series::{Table, line, log_bounds};
use super::SIZE;
use crate::data::{Case, Sweep};
use crate::plot::canvas::Canvas;
use crate::plot::color::Scale;
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::plot::text;
use kuva::prelude::{Plot, ScatterPlot};
use std::path::Path;
use topo_analysis::{SweepRow, read_table, resonances};

/// The time to release 99 %.
pub fn t99(case: &Case) -> Option<[f64; 3]> {
    case.spread(|c| c.t99)
}

/// Its axis.
pub fn time_axis(sweep: &Sweep) -> Axis {
    let all = sweep.cases.iter().filter_map(t99).flatten();
    Axis::log("Discharge time *t*_{99} / *T*_{0}", log_bounds(all, 1.25))
}

/// All states: knots side by side, in each from the most negative to the most positive twist.
pub fn all(sweep: &Sweep, canvas: &mut Canvas, at: [f64; 2], table: &mut Table) {
    let knots = sweep.knots();
    let n = knots.len() as f64;
    let size = [SIZE[0] + 16.0 - 44.0, SIZE[1]];
    let panel = Panel {
        at,
        size,
        x: Axis::linear("Knot", (0.0, n), 1.0).bare(),
        y: time_axis(sweep),
    };
    let (low_twist, high_twist) = super::bounds(sweep.twists());
    let scale = Scale::viridis(low_twist, high_twist);
    let mut plots = Vec::new();
    for (k, knot) in knots.iter().enumerate() {
        for case in sweep.of(knot) {
            let Some([mean, low, high]) = t99(case) else {
                continue;
            };
            let twist = case.first().twist;
            let place = 0.1 + 0.8 * (twist - low_twist) / (high_twist - low_twist).max(1e-9);
            let x = k as f64 + place;
            table.row(&["e", knot], &[twist, x, mean, low, high]);
            let ink = scale.css(twist);
            if high > low * 1.005 {
                plots.push(line(vec![(x, low), (x, high)], &ink, 0.9));
            }
            let dot = ScatterPlot::new()
                .with_data(vec![(x, mean)])
                .with_color(ink)
                .with_size(1.9);
            plots.push(Plot::Scatter(dot));
        }
    }
    // Thin rules part the knots.
    for k in 1..knots.len() {
        let (low, high) = panel.y.range;
        plots.insert(
            0,
            line(vec![(k as f64, low), (k as f64, high)], "#e6e8eb", 0.6),
        );
    }
    panel.draw(canvas, plots, &[]);
    for (k, knot) in knots.iter().enumerate() {
        let x = at[0] + size[0] * (k as f64 + 0.5) / n;
        let name = text::knot_name(knot);
        canvas.text(
            x,
            at[1] + size[1] + 12.0,
            &name,
            Style::default().middle().size(8.5),
        );
    }
    let ticks = [low_twist, (low_twist + high_twist) / 2.0, high_twist];
    let bar_at = [at[0] + size[0] + 12.0, at[1] + 20.0];
    canvas.color_bar(bar_at, [8.0, size[1] - 40.0], &scale, &ticks, "Twist θ′*h*");
}

/// A knot whose time exceeds the median of all by this factor is called slow.
const SLOW: f64 = 1.5;

/// Which untwisted knots are slow, and which of them also with the friction range at the contact diameter and in the reading
/// `tight`; empty while those runs are missing.
pub fn robust(results: &Path) -> String {
    let read = |folder: &str| read_table::<SweepRow>(&results.join(folder).join("sweep.csv")).ok();
    let (Some(mut rows), Some(contact), Some(tight)) = (
        read("elastic"),
        read("elastic-contact-range"),
        read("elastic-tight"),
    ) else {
        return String::new();
    };
    rows.retain(|r| r.twist == 0.0);
    let found = resonances(&rows, SLOW, &[&contact, &tight]);
    let list = |robust: bool| {
        let names: Vec<String> = found
            .iter()
            .filter(|r| r.robust || !robust)
            .map(|r| format!("{} {}", text::knot_name(&r.knot), text::number(r.ratio, 1)))
            .collect();
        if names.is_empty() {
            "none".to_owned()
        } else {
            names.join(", ")
        }
    };
    format!(
        " Untwisted knots slower than {SLOW} times the median, by the mean over the cuts of the table (ratio): {}; of these also with friction range = contact \
         diameter and in the reading tight: {}.",
        list(false),
        list(true)
    )
}

/// What the times say.
pub fn finding(sweep: &Sweep) -> String {
    let zero = |knot: &str| {
        let cases = sweep.of(knot);
        let near = cases
            .into_iter()
            .min_by(|a, b| a.first().twist.abs().total_cmp(&b.first().twist.abs()))?;
        Some(t99(near)?[0])
    };
    let mut slow: Vec<(&str, f64)> = sweep
        .knots()
        .into_iter()
        .filter_map(|k| Some((k, zero(k)?)))
        .collect();
    slow.sort_by(|a, b| b.1.total_cmp(&a.1));
    let ranked: Vec<String> = slow
        .iter()
        .take(4)
        .map(|(k, t)| format!("{} {}", text::knot_name(k), text::number(*t, 1)))
        .collect();
    let n = sweep.cases.len();
    let n_done = sweep.cases.iter().filter(|c| t99(c).is_some()).count();
    let tied: Vec<[f64; 3]> = sweep
        .cases
        .iter()
        .filter(|c| c.cuts.len() > 1)
        .filter_map(t99)
        .collect();
    let spread = tied
        .iter()
        .map(|[_, low, high]| high / low)
        .fold(1.0, f64::max);
    let ties = if tied.is_empty() {
        String::new()
    } else {
        format!(
            " {} states have near-tied cuts; the time depends on which, by up to a factor {}.",
            tied.len(),
            text::number(spread, 2)
        )
    };
    format!(
        "{n_done} of {n} discharges reach 99 %. Slowest knots at zero twist (t99 / T₀): {}.{ties}",
        ranked.join(", ")
    )
}
