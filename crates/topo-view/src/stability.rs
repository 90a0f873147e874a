//! Maps of the extremes, drawn and described.

use std::fmt::Write;

use crate::error::ViewError;
use crate::plot::canvas::{Canvas, Picture};
use crate::plot::color::{BLUE, INK, VERMILION};
use crate::plot::style::Style;
use crate::program::program;
use topo_lab::Preset;
use topo_lab::StabilityRow;

/// Runs of one pair of axes.
struct Map<'a> {
    rows: Vec<&'a StabilityRow>,
    xs: Vec<&'a str>,
    ys: Vec<&'a str>,
}

/// The maps of a table, in its order.
fn maps(rows: &[StabilityRow]) -> Vec<Map<'_>> {
    let mut maps: Vec<Map<'_>> = Vec::new();
    for row in rows {
        let is_of = |map: &&mut Map<'_>| {
            (map.rows[0].axis_x.as_str(), map.rows[0].axis_y.as_str())
                == (row.axis_x.as_str(), row.axis_y.as_str())
        };
        match maps.iter_mut().find(is_of) {
            Some(map) => map.rows.push(row),
            None => maps.push(Map {
                rows: vec![row],
                xs: Vec::new(),
                ys: Vec::new(),
            }),
        }
    }
    for map in &mut maps {
        for row in &map.rows {
            if !map.xs.contains(&row.x.as_str()) {
                map.xs.push(&row.x);
            }
            if !map.ys.contains(&row.y.as_str()) {
                map.ys.push(&row.y);
            }
        }
    }
    maps
}

/// Breaks a rule, or stops where it must converge.
fn is_broken(row: &StabilityRow) -> bool {
    row.violations > 0 || (row.is_inner && !row.has_converged())
}

/// Runs that break a rule, or stop where they must converge.
pub fn n_broken(rows: &[StabilityRow]) -> usize {
    rows.iter().filter(|row| is_broken(row)).count()
}

/// One line on a system.
pub fn summary(system: &str, rows: &[StabilityRow], time: &str) -> String {
    let n = |f: fn(&StabilityRow) -> bool| rows.iter().filter(|r| f(r)).count();
    format!(
        "{system}: {} runs, {} converged, {} stopped with a reason; {} of {} converged where all must; {} violations; {time}",
        rows.len(),
        n(StabilityRow::has_converged),
        n(|r| !r.has_converged()),
        n(|r| r.is_inner && r.has_converged()),
        n(|r| r.is_inner),
        rows.iter().map(|r| r.violations).sum::<u32>(),
    )
}

/// Number of maps side by side.
const COLUMNS: usize = 3;
const WIDTH: f64 = 240.0;
const HEIGHT: f64 = 200.0;

/// Maps of a system: one square a run.
pub fn draw(rows: &[StabilityRow]) -> Result<Picture, ViewError> {
    let maps = maps(rows);
    let lines = maps.len().div_ceil(COLUMNS);
    let mut canvas = Canvas::new(COLUMNS as f64 * WIDTH, lines as f64 * HEIGHT + 34.0, 4.0);
    for (k, map) in maps.iter().enumerate() {
        let at = [(k % COLUMNS) as f64 * WIDTH, (k / COLUMNS) as f64 * HEIGHT];
        let letter = char::from(b'a' + k as u8).to_string();
        canvas.letter(at[0] + 8.0, at[1] + 16.0, &letter);
        draw_map(map, [at[0] + 78.0, at[1] + 24.0], &mut canvas);
    }
    let y = lines as f64 * HEIGHT + 12.0;
    let mut x = 20.0;
    for (fill, label) in [
        (BLUE, "converged"),
        ("#e8c9b0", "stopped with a reason"),
        (VERMILION, "broke a rule"),
    ] {
        canvas.rect([x, y], [9.0, 9.0], fill);
        canvas.text(x + 13.0, y + 8.0, label, Style::default().size(9.0));
        x += 150.0;
    }
    canvas.rect([x, y], [9.0, 9.0], BLUE);
    frame(&mut canvas, [x + 1.2, y + 1.2], [6.6, 6.6]);
    let style = Style::default().size(9.0);
    canvas.text(x + 13.0, y + 8.0, "every run must converge", style);
    canvas.finish()
}

fn draw_map(map: &Map<'_>, at: [f64; 2], canvas: &mut Canvas) {
    let (nx, ny) = (map.xs.len() as f64, map.ys.len() as f64);
    let side = (148.0 / nx).min(118.0 / ny);
    let place = |row: &StabilityRow| {
        let find = |list: &[&str], x: &str| list.iter().position(|y| *y == x).unwrap_or(0) as f64;
        // The first y lies at the foot.
        [
            at[0] + side * find(&map.xs, &row.x),
            at[1] + side * (ny - 1.0 - find(&map.ys, &row.y)),
        ]
    };
    for row in &map.rows {
        let fill = if is_broken(row) {
            VERMILION
        } else if row.has_converged() {
            BLUE
        } else {
            "#e8c9b0"
        };
        let p = place(row);
        canvas.rect([p[0] + 0.6, p[1] + 0.6], [side - 1.2, side - 1.2], fill);
        if row.is_inner {
            frame(canvas, [p[0] + 1.8, p[1] + 1.8], [side - 3.6, side - 3.6]);
        }
    }
    let style = Style::default().size(6.5);
    for (k, y) in map.ys.iter().enumerate() {
        let line = at[1] + side * (ny - 0.5 - k as f64) + 2.5;
        canvas.text(at[0] - 4.0, line, &short(y), style.end());
    }
    let foot = at[1] + side * ny;
    for (k, x) in map.xs.iter().enumerate() {
        let middle = at[0] + side * (k as f64 + 0.5);
        // Two heights keep neighbours apart.
        let drop = if k % 2 == 0 { 9.0 } else { 17.0 };
        canvas.text(middle, foot + drop, &short(x), style.middle());
    }
    let label = Style::default().size(8.5);
    canvas.text(
        at[0] + side * nx / 2.0,
        foot + 29.0,
        &map.rows[0].axis_x,
        label.middle(),
    );
    canvas.text(
        at[0] - 40.0,
        at[1] - 7.0,
        &map.rows[0].axis_y,
        label.color(INK),
    );
}

/// A value as short as it can be read.
fn short(text: &str) -> String {
    match text.parse::<f64>() {
        Ok(x) if x != 0.0 && (x.abs() >= 1e4 || x.abs() < 1e-2) => {
            format!("{x:e}").replace('-', "−")
        }
        Ok(_) => text.replace('-', "−"),
        Err(_) => text.to_owned(),
    }
}

fn frame(canvas: &mut Canvas, at: [f64; 2], size: [f64; 2]) {
    let (right, foot) = (at[0] + size[0], at[1] + size[1]);
    for (from, to) in [
        (at, [right, at[1]]),
        ([right, at[1]], [right, foot]),
        ([right, foot], [at[0], foot]),
        ([at[0], foot], at),
    ] {
        canvas.line(from, to, "#ffffff", 0.7);
    }
}

/// The report: what was run, where the edges are, and why runs stopped there.
pub fn report(quality: Preset, maps: &[(&str, Vec<StabilityRow>)]) -> String {
    let mut text = format!(
        "# Stability at the extremes\n\nMade by `{} extremes`; the tables are \
         `stability/{{rod,nematic,knots}}.csv`. Every run converges or stops with a named reason \
         within its budget, counted in steps.\n\n",
        program()
    );
    let mut put = |line: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{line}");
    };
    put(format!("Quality: {quality}.\n"));
    for (system, rows) in maps {
        put(format!("## {system}\n"));
        let seconds: f64 = rows.iter().map(|r| r.seconds).sum();
        put(format!(
            "{}\n",
            summary(system, rows, &format!("{seconds:.0} CPU seconds"))
        ));
        put("| along x | along y | runs | converged | inner converged | violations | why runs stopped |".to_owned());
        put("|---|---|---|---|---|---|---|".to_owned());
        for map in self::maps(rows) {
            let n = |f: &dyn Fn(&&&StabilityRow) -> bool| map.rows.iter().filter(f).count();
            put(format!(
                "| {} | {} | {} | {} | {} of {} | {} | {} |",
                map.rows[0].axis_x,
                map.rows[0].axis_y,
                map.rows.len(),
                n(&|r| r.has_converged()),
                n(&|r| r.is_inner && r.has_converged()),
                n(&|r| r.is_inner),
                map.rows.iter().map(|r| r.violations).sum::<u32>(),
                reasons(&map.rows),
            ));
        }
        put(String::new());
        let broken: Vec<&StabilityRow> = rows.iter().filter(|r| is_broken(r)).collect();
        if !broken.is_empty() {
            put("Runs that broke a rule:\n".to_owned());
            for row in broken {
                put(format!(
                    "- {} = {}, {} = {}: {} ({} violations) {}",
                    row.axis_x, row.x, row.axis_y, row.y, row.outcome, row.violations, row.reason
                ));
            }
            put(String::new());
        }
    }
    text
}

/// Reasons that differ in their numbers only, each once, with how many runs it stopped and the numbers of all of them.
fn reasons(rows: &[&StabilityRow]) -> String {
    let kind = |reason: &str| -> Vec<String> {
        let words = reason.split_whitespace();
        let words = words.filter(|w| !w.contains(|c: char| c.is_ascii_digit()));
        words.map(str::to_owned).collect()
    };
    let mut kinds: Vec<(Vec<String>, Vec<&str>)> = Vec::new();
    for row in rows.iter().filter(|r| !r.has_converged()) {
        let kind = kind(&row.reason);
        match kinds.iter_mut().find(|(k, _)| *k == kind) {
            Some((_, reasons)) => reasons.push(&row.reason),
            None => kinds.push((kind, vec![&row.reason])),
        }
    }
    kinds.sort_by_key(|(_, reasons)| std::cmp::Reverse(reasons.len()));
    let all = kinds.iter().map(|(_, reasons)| {
        let one = spread(reasons).unwrap_or_else(|| format!("such as {}", reasons[0]));
        format!("{one} ({})", reasons.len())
    });
    let all: Vec<String> = all.collect();
    all.join("; ").replace('|', "/")
}

/// Reasons that differ in their numbers as one, from the least of each number to the largest; none where they differ otherwise.
fn spread(reasons: &[&str]) -> Option<String> {
    let words = reasons
        .iter()
        .map(|reason| reason.split_whitespace().collect());
    let words: Vec<Vec<&str>> = words.collect();
    let n = words.first()?.len();
    if words.iter().any(|w| w.len() != n) {
        return None;
    }
    let bare = |word: &'_ str| {
        word.trim_matches(|c: char| !c.is_alphanumeric() && c != '-')
            .to_owned()
    };
    let one = |k: usize| -> Option<String> {
        let first = words[0][k];
        if words.iter().all(|w| w[k] == first) {
            return Some(first.to_owned());
        }
        let numbers = words
            .iter()
            .map(|w| Some((bare(w[k]).parse::<f64>().ok()?, bare(w[k]))));
        let mut numbers: Vec<(f64, String)> = numbers.collect::<Option<_>>()?;
        numbers.sort_by(|a, b| a.0.total_cmp(&b.0));
        let [(_, least), .., (_, most)] = &numbers[..] else {
            return None;
        };
        Some(first.replace(&bare(first), &format!("{least} to {most}")))
    };
    let all: Option<Vec<String>> = (0..n).map(one).collect();
    Some(all?.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_lab::Ending;

    fn row(x: &str, y: &str, reason: &str, violations: u32, is_inner: bool) -> StabilityRow {
        StabilityRow {
            axis_x: "twist".to_owned(),
            x: x.to_owned(),
            axis_y: "gamma".to_owned(),
            y: y.to_owned(),
            outcome: if reason.is_empty() {
                Ending::Converged
            } else {
                Ending::Stopped
            },
            reason: reason.to_owned(),
            seconds: 1.0,
            violations,
            is_inner,
        }
    }

    #[test]
    fn broken_runs_are_counted_and_told() {
        let rows = vec![
            row("0", "1", "", 0, true),
            row("1", "1", "step 3e-9 too small", 0, false),
            row("0", "2", "step 4e-9 too small", 0, true),
            row("1", "2", "", 2, false),
        ];
        assert_eq!(n_broken(&rows), 2);
        let report = report(Preset::Draft, &[("rod", rows.clone())]);
        // reasons of one kind are one, and keep their numbers
        assert!(
            report.contains("step 3e-9 to 4e-9 too small (2)"),
            "{report}"
        );
        assert!(!report.contains("too small (1)"), "{report}");
        assert!(report.contains("1 of 2"), "{report}");
        let picture = draw(&rows).unwrap();
        assert!(picture.svg.contains("twist") && !picture.png.is_empty());
    }

    #[test]
    fn reasons_of_one_kind_keep_the_spread_of_their_numbers() {
        for (reasons, one) in [
            (
                vec!["a spacing of 3 is too coarse for cores of size 0.998: use at most 2.5"],
                Some("a spacing of 3 is too coarse for cores of size 0.998: use at most 2.5"),
            ),
            (
                vec![
                    "a gap of 4.5 (at -2)",
                    "a gap of 12 (at -7)",
                    "a gap of 7 (at -2)",
                ],
                Some("a gap of 4.5 to 12 (at -7 to -2)"),
            ),
            (vec!["found t^2", "found t^3"], None),
            (vec!["edges 1 2", "edges 1"], None),
        ] {
            assert_eq!(spread(&reasons).as_deref(), one, "{reasons:?}");
        }
    }
}
