//! Speed against accuracy, drawn and described.

use std::fmt::Write;

use crate::error::ViewError;
use crate::plot::canvas::{Canvas, Picture};
use crate::plot::color::{LINES, QUIET};
use crate::plot::panel::{Axis, Panel};
use crate::plot::style::Style;
use crate::program::program;
use kuva::prelude::{LinePlot, Plot, ScatterPlot};
use topo_analysis::quantile;
use topo_lab::Preset;
use topo_lab::{CheckRow, Point, REFERENCE, Setting, System, TradeoffRow, points, settings_of};

/// Errors that the short table asks for.
const GOALS: [f64; 8] = [0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.002];

/// Errors below this are drawn at it: numbers that agree to so many digits.
const LEAST_ERROR: f64 = 1e-5;

/// Quantities of a system in the order of its panels.
fn quantities(settings: &[Setting]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for s in settings {
        if !names.contains(&s.quantity.as_str()) {
            names.push(&s.quantity);
        }
    }
    names
}

const PANEL: [f64; 2] = [210.0, 170.0];
/// Width that the legend and the note need.
const LEGEND: f64 = 340.0;
/// From one panel to the next, across and down.
const STEP: [f64; 2] = [276.0, 226.0];

/// Whether a setting is a dot of the picture.
fn is_drawn(s: &&Setting) -> bool {
    s.setting != REFERENCE && s.cpu_seconds > 0.0
}

/// Kinds of settings, each with its own colour.
struct Families<'a>(Vec<&'a str>);

impl<'a> Families<'a> {
    fn of(settings: &'a [Setting]) -> Self {
        let mut families: Vec<&str> = Vec::new();
        for s in settings.iter().filter(is_drawn) {
            if !families.contains(&s.setting.as_str()) {
                families.push(&s.setting);
            }
        }
        Self(families)
    }

    fn ink(&self, family: &str) -> &'static str {
        let k = self.0.iter().position(|f| *f == family).unwrap_or(0);
        LINES[k % LINES.len()]
    }

    fn draw_legend(&self, canvas: &mut Canvas, foot: f64) {
        let mut x = 24.0;
        for family in &self.0 {
            canvas.rect([x, foot + 14.0], [8.0, 8.0], self.ink(family));
            canvas.text(x + 12.0, foot + 21.5, family, Style::default().size(9.0));
            x += 30.0 + 5.2 * family.len() as f64;
        }
    }
}

/// Error against cost, one panel a quantity; the front is joined by a line.
pub fn draw(system: System, rows: &[TradeoffRow]) -> Result<Picture, ViewError> {
    let settings = settings_of(rows);
    let names = quantities(&settings);
    // four panels make a square
    let columns = if names.len() == 4 {
        2
    } else {
        names.len().max(2)
    };
    let foot = STEP[1] * names.len().div_ceil(columns) as f64;
    let mut canvas = Canvas::new((STEP[0] * columns as f64).max(LEGEND), foot + 42.0, 4.0);
    let families = Families::of(&settings);
    for (k, name) in names.iter().enumerate() {
        let at = [
            54.0 + STEP[0] * (k % columns) as f64,
            22.0 + STEP[1] * (k / columns) as f64,
        ];
        draw_quantity(&mut canvas, at, name, &settings, &families);
        let letter = char::from(b'a' + k as u8).to_string();
        canvas.letter(at[0] - 44.0, at[1] - 8.0, &letter);
    }
    families.draw_legend(&mut canvas, foot);
    let note = format!(
        "{}: 90th percentile over cases; large dots and the line: nothing is cheaper and better",
        system.name()
    );
    canvas.text(
        24.0,
        foot + 36.0,
        &note,
        Style::default().size(8.5).color(QUIET),
    );
    canvas.finish()
}

/// A panel: error of a quantity against cost, a dot a setting.
fn draw_quantity(
    canvas: &mut Canvas,
    at: [f64; 2],
    name: &str,
    settings: &[Setting],
    families: &Families<'_>,
) {
    let costs: Vec<f64> = settings
        .iter()
        .filter(is_drawn)
        .map(|s| s.cpu_seconds)
        .collect();
    let range = |values: &[f64]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(0.0, f64::max);
        (low / 1.4, high * 1.4)
    };
    let of: Vec<&Setting> = settings
        .iter()
        .filter(is_drawn)
        .filter(|s| s.quantity == name)
        .collect();
    let error = |s: &Setting| 100.0 * s.high_error.max(LEAST_ERROR);
    let errors: Vec<f64> = of.iter().map(|s| error(s)).collect();
    let panel = Panel {
        at,
        size: PANEL,
        x: Axis::log("CPU seconds a case", range(&costs)),
        y: Axis::log(
            &format!("Error of {}, per cent", label(name)),
            range(&errors),
        ),
    };
    let mut front: Vec<(f64, f64)> = of
        .iter()
        .filter(|s| s.pareto && s.is_whole())
        .map(|s| (s.cpu_seconds, error(s)))
        .collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    let line = LinePlot::new().with_data(front);
    let mut plots = vec![Plot::Line(line.with_color(QUIET).with_stroke_width(1.2))];
    for s in &of {
        let dot = ScatterPlot::new()
            .with_data(vec![(s.cpu_seconds, error(s))])
            .with_color(families.ink(&s.setting))
            .with_size(if s.pareto { 3.4 } else { 2.0 });
        plots.push(Plot::Scatter(dot));
    }
    panel.draw(canvas, plots, &[]);
}

/// Name of a quantity in the markup of labels.
fn label(quantity: &str) -> &str {
    match quantity {
        "t50" => "*t*_{50}",
        "t99" => "*t*_{99}",
        "t99.9" => "*t*_{99.9}",
        "F" => "*F*",
        other => other,
    }
}

/// The report: what accuracy costs, and every setting with its errors.
pub fn report(quality: Preset, tables: &[(System, Vec<TradeoffRow>)]) -> String {
    let mut text = format!(
        "# What accuracy costs\n\nMade by `{} tradeoff` at {quality}; the tables are \
         `tradeoff/{{rod,nematic,knots}}.csv`. Errors are relative to converged references: the \
         median and the 90th percentile over the cases. Costs are processor seconds of one \
         thread a case, on the machine that ran the command.\n\n",
        program()
    );
    for (system, rows) in tables {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "## {}\n", system.name());
        text += &section(quality, *system, rows);
    }
    text
}

/// The part of the report on one system.
pub fn section(quality: Preset, system: System, rows: &[TradeoffRow]) -> String {
    let settings = settings_of(rows);
    let mut cases: Vec<&str> = rows.iter().map(|r| r.case.as_str()).collect();
    cases.dedup();
    cases.sort_unstable();
    cases.dedup();
    let mut lines = vec![format!("Cases: {}.\n", cases.join("; "))];
    put_goals(&mut lines, &settings);
    put_settings(&mut lines, &settings);
    let points = points(system, rows);
    if quality == Preset::Standard && !points.is_empty() {
        put_points(&mut lines, system, points);
    }
    lines.into_iter().map(|line| line + "\n").collect()
}

/// The cheapest setting that keeps each error.
fn put_goals(lines: &mut Vec<String>, settings: &[Setting]) {
    lines.extend([
        "If you can live with an error of ..., use this, it costs ...\n".to_owned(),
        "| quantity | error asked for | setting | median | 90 % | CPU s a case | MB |".to_owned(),
        "|---|---|---|---|---|---|---|".to_owned(),
    ]);
    for name in quantities(settings) {
        let mut last = "";
        for goal in GOALS {
            let best = settings
                .iter()
                .filter(|s| s.quantity == name && s.is_whole() && s.high_error <= goal)
                .min_by(|a, b| a.cpu_seconds.total_cmp(&b.cpu_seconds));
            let Some(s) = best else { continue };
            if s.value == last {
                continue;
            }
            last = &s.value;
            lines.push(format!(
                "| {name} | {} | {} {} | {} | {} | {:.2} | {:.1} |",
                percent(goal),
                s.setting,
                s.value,
                percent(s.median_error),
                percent(s.high_error),
                s.cpu_seconds,
                s.peak_bytes as f64 / 1e6,
            ));
        }
    }
}

/// Every setting with its errors, a column for each quantity.
fn put_settings(lines: &mut Vec<String>, settings: &[Setting]) {
    lines.push("\nEvery setting; a star marks the front.\n".to_owned());
    let names = quantities(settings);
    lines.push(format!(
        "| setting | value | CPU s | MB | {} |",
        names.join(" | ")
    ));
    lines.push(format!("|---|---|---|---|{}", "---|".repeat(names.len())));
    let mut seen: Vec<(&str, &str)> = Vec::new();
    for s in settings {
        let key = (s.setting.as_str(), s.value.as_str());
        if seen.contains(&key) {
            continue;
        }
        seen.push(key);
        let of = |name| {
            let is_it = |o: &&Setting| (o.setting.as_str(), o.value.as_str()) == key;
            settings.iter().filter(is_it).find(|o| o.quantity == name)
        };
        let cells: Vec<String> = names
            .iter()
            .map(|name| of(*name).map_or_else(String::new, errors_of))
            .collect();
        lines.push(format!(
            "| {} | {} | {:.2} | {:.1} | {} |",
            s.setting,
            s.value,
            s.cpu_seconds,
            s.peak_bytes as f64 / 1e6,
            cells.join(" | ")
        ));
    }
    lines.push(String::new());
}

/// Median and 90th percentile of the errors, how many runs gave none, and a star on the front.
fn errors_of(setting: &Setting) -> String {
    let lost = if setting.n_failed > 0 {
        let n = setting.n_cases + setting.n_failed;
        format!(" ({} of {n} without)", setting.n_failed)
    } else {
        String::new()
    };
    let star = if setting.pareto { " *" } else { "" };
    format!(
        "{} / {}{lost}{star}",
        percent(setting.median_error),
        percent(setting.high_error)
    )
}

/// What scenes with a goal choose from.
fn put_points(lines: &mut Vec<String>, system: System, points: Vec<Point>) {
    lines.extend([
        "What scenes with a goal choose from: errors of the last time listed; costs of both runs.\n"
            .to_owned(),
        "| setting | coarser run | cases | median | 90 % | CPU s a case | MB |".to_owned(),
        "|---|---|---|---|---|---|---|".to_owned(),
    ]);
    for p in points {
        lines.push(format!(
            "| {} | {} | {} | {} | {} | {:.2} | {:.1} |",
            system.resolution_name(p.resolution, p.tolerance),
            system.resolution_name(p.check_resolution, p.check_tolerance),
            p.n_cases,
            percent(p.median_error),
            percent(p.high_error),
            p.cpu_seconds,
            p.peak_bytes as f64 / 1e6,
        ));
    }
    lines.push(String::new());
}

/// How well promises and estimates of runs with a goal hold on cases that they were not measured on.
pub fn check_report(rows: &[CheckRow]) -> String {
    let mut text = String::from(
        "| system | setting | picked for | cases | promised in 90 % | true error, median | 90 % | as good as promised | covered by the estimate | estimate / true, median | CPU s a case |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    let mut groups: Vec<(&str, Option<&str>)> = Vec::new();
    for r in rows {
        for group in [
            (r.system.as_str(), Some(r.setting.as_str())),
            (&r.system, None),
        ] {
            if !groups.contains(&group) {
                groups.push(group);
            }
        }
    }
    groups.sort_by_key(|g| (g.0 != "rod", g.1.is_none()));
    for (system, setting) in groups {
        let of: Vec<&CheckRow> = rows
            .iter()
            .filter(|r| r.system == system && setting.is_none_or(|s| r.setting == s))
            .collect();
        let errors = || of.iter().filter_map(|r| r.relative_error);
        let (Some(middle), Some(high)) = (quantile(errors(), 0.5), quantile(errors(), 0.9)) else {
            continue;
        };
        let good = |r: &&&CheckRow| r.relative_error.is_some_and(|e| e <= r.promised);
        let share = |n: usize| format!("{n} ({:.0} %)", 100.0 * n as f64 / of.len() as f64);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "| {system} | {} | {} | {} | {} | {} | {} | {} | {} | {:.1} | {:.2} |",
            setting.unwrap_or("all"),
            setting.map_or("", |_| of[0].asked.as_str()),
            of.len(),
            setting.map_or_else(String::new, |_| percent(of[0].promised)),
            percent(middle),
            percent(high),
            share(of.iter().filter(good).count()),
            share(of.iter().filter(|r| r.is_covered()).count()),
            quantile(of.iter().filter_map(|r| r.ratio()), 0.5).unwrap_or(f64::NAN),
            of.iter().map(|r| r.cpu_seconds).sum::<f64>() / of.len() as f64,
        );
    }
    text
}

/// A relative error in per cent, to two digits.
fn percent(error: f64) -> String {
    let p = 100.0 * error;
    if p == 0.0 {
        "0".to_owned()
    } else if p >= 10.0 {
        format!("{p:.0} %")
    } else if p >= 1.0 {
        format!("{p:.1} %")
    } else if p >= 0.01 {
        format!("{p:.2} %")
    } else {
        format!("{p:.0e} %")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(system: &str, setting: &str, error: Option<f64>, estimate: f64) -> CheckRow {
        CheckRow {
            system: system.to_owned(),
            case: "a".to_owned(),
            setting: setting.to_owned(),
            asked: "2 %".to_owned(),
            promised: 0.02,
            result: error.map(|e| 1.0 + e),
            reference: Some(1.0),
            relative_error: error,
            estimate: error.map(|_| estimate),
            cpu_seconds: 2.0,
        }
    }

    #[test]
    fn the_check_counts_what_is_promised_and_covered() {
        let rows = [
            checked("nematic", "h = 1", Some(0.01), 0.03),
            checked("rod", "N = 200", Some(0.01), 0.02),
            checked("rod", "N = 200", Some(0.03), 0.02),
            checked("rod", "N = 200", None, 0.0),
            checked("rod", "N = 400", Some(0.01), 0.04),
        ];
        let text = check_report(&rows);
        let lines: Vec<&str> = text.lines().skip(2).collect();
        assert_eq!(
            lines,
            [
                "| rod | N = 200 | 2 % | 3 | 2.0 % | 2.0 % | 2.8 % | 1 (33 %) | 1 (33 %) | 1.3 | 2.00 |",
                "| rod | N = 400 | 2 % | 1 | 2.0 % | 1.0 % | 1.0 % | 1 (100 %) | 1 (100 %) | 4.0 | 2.00 |",
                "| rod | all |  | 4 |  | 1.0 % | 2.6 % | 2 (50 %) | 2 (50 %) | 2.0 | 2.00 |",
                "| nematic | h = 1 | 2 % | 1 | 2.0 % | 1.0 % | 1.0 % | 1 (100 %) | 1 (100 %) | 3.0 | 2.00 |",
                "| nematic | all |  | 1 |  | 1.0 % | 1.0 % | 1 (100 %) | 1 (100 %) | 3.0 | 2.00 |",
            ]
        );
    }

    fn row(value: &str, result: f64, error: f64, cpu_seconds: f64) -> TradeoffRow {
        TradeoffRow {
            system: "rod".to_owned(),
            case: "3_1 +0.00".to_owned(),
            setting: "resolution".to_owned(),
            value: value.to_owned(),
            quantity: "t99".to_owned(),
            result: Some(result),
            reference: Some(1.0),
            relative_error: Some(error),
            cpu_seconds,
            peak_bytes: 3_000_000,
            pareto: false,
        }
    }

    #[test]
    fn the_cheapest_setting_that_is_good_enough_is_named() {
        let rows = vec![
            row("coarse", 1.08, 0.08, 0.1),
            row("middle", 1.015, 0.015, 0.5),
            row("fine", 1.001, 0.001, 3.0),
        ];
        let text = report(Preset::Draft, &[(System::Rod, rows.clone())]);
        for line in [
            "| t99 | 20 % | resolution coarse | 8.0 % | 8.0 % | 0.10 | 3.0 |",
            "| t99 | 5.0 % | resolution middle | 1.5 %",
            "| t99 | 1.0 % | resolution fine | 0.10 %",
        ] {
            assert!(text.contains(line), "{line} is not in\n{text}");
        }
        let picture = draw(System::Rod, &rows).unwrap();
        assert!(picture.svg.contains("resolution") && !picture.png.is_empty());
    }
}
