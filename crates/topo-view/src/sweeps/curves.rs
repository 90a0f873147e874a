//! Discharge curves of all cases: the share of the energy that is still stored, against time.

use std::collections::BTreeMap;
use std::path::Path;

use super::against::quoted;
use super::cases::{Cases, Row};
use super::groups::{Groups, others};
use super::sheet::{self, Chart, Line, Scaling};
use crate::data::read_csv;
use crate::error::ViewError;
use crate::figures::Drawn;
use crate::figures::series::{Table, bounds};
use crate::guide::Curve;

/// Least share that is drawn.
const LEAST: f64 = 1e-3;

/// Draws the discharge curves; `None` where no case has one.
pub fn draw(cases: &Cases) -> Result<Option<Drawn>, ViewError> {
    let curve = &cases.guide.curve;
    let groups = Groups::of(&cases.rows, &others(cases, None));
    let mut table = Table::new("case,line,time,stored");
    let mut lines: Vec<Line> = Vec::new();
    let mut n_without = 0;
    for group in &groups.groups {
        for row in &group.rows {
            let points = read(curve, &cases.case_folder(row), row)?;
            if points.len() < 2 {
                n_without += 1;
                continue;
            }
            for (t, share) in &points {
                table.row(&[row.case(), &quoted(&group.label)], &[*t, *share]);
            }
            lines.push(Line::new(points, group.look.clone()));
        }
    }
    if lines.is_empty() {
        return Ok(None);
    }
    let x = times(lines.iter().map(|l| &l.points[..]));
    for line in &mut lines {
        begin_at(&mut line.points, &x);
    }
    let late = lines.iter().cloned().map(|mut line| {
        line.points.retain(|p| p.1 >= LEAST);
        line
    });
    let late: Vec<Line> = late.collect();
    let lowest = bounds(late.iter().flat_map(|l| l.points.iter().map(|p| p.1))).0;
    let chart = |label: &str, y: Scaling, lines: Vec<Line>| Chart {
        x: (curve.time_label.to_owned(), x.clone()),
        y: (label.to_owned(), y),
        lines,
    };
    let mut charts = vec![chart(
        "Stored share of the energy",
        Scaling::Range(0.0, 1.05),
        lines,
    )];
    if lowest < 0.2 {
        let y = Scaling::Log(lowest.max(LEAST) / 1.2, 1.2);
        charts.push(chart("Stored share of the energy", y, late));
    }
    let mut notes: Vec<String> = groups.note.into_iter().collect();
    if n_without > 0 {
        notes.push(format!("{n_without} discharges have no curve."));
    }
    Ok(Some(Drawn {
        picture: sheet::draw(&charts, &groups.key, &notes)?,
        csv: table.finish(),
        finding: notes.join(" "),
    }))
}

/// The rows of a case's table that are of one discharge; none without the table.
pub fn samples(curve: &Curve, case: &Path, row: &Row) -> Result<Vec<Sample>, ViewError> {
    let path = case.join(curve.file);
    if !path.exists() {
        return Ok(Vec::new());
    }
    let all: Vec<Sample> = read_csv(&path)?;
    let number = |s: &Sample, column: &str| s.get(column).and_then(|v| v.parse::<f64>().ok());
    Ok(match curve.of {
        Some(column) => {
            let own = row.number(column);
            let is_own = |s: &Sample| own.is_none() || number(s, column) == own;
            all.into_iter().filter(is_own).collect()
        }
        None => all,
    })
}

/// A row of the table of a curve.
pub type Sample = BTreeMap<String, String>;

/// Times and shares of one discharge.
fn read(curve: &Curve, case: &Path, row: &Row) -> Result<Vec<(f64, f64)>, ViewError> {
    let empty = curve.empty.map_or(Some(0.0), |c| row.number(c));
    let (Some(full), Some(empty)) = (row.number(curve.full), empty) else {
        return Ok(Vec::new());
    };
    if full <= empty {
        return Ok(Vec::new());
    }
    let point = |s: &Sample| {
        let number = |column: &str| s.get(column)?.parse::<f64>().ok().filter(|v| v.is_finite());
        let share = (number(curve.energy)? - empty) / (full - empty);
        Some((number(curve.time)?, share))
    };
    Ok(samples(curve, case, row)?
        .iter()
        .filter_map(point)
        .collect())
}

/// The axis of the times of one discharge; `None` where it has no curve.
pub fn span(curve: &Curve, case: &Path, row: &Row) -> Result<Option<Scaling>, ViewError> {
    let points = read(curve, case, row)?;
    Ok((points.len() > 1).then(|| times([&points[..]].into_iter())))
}

/// The axis of times: logarithmic where they span more than a decade, from shortly before anything has fallen by a hundredth.
fn times<'a>(curves: impl Iterator<Item = &'a [(f64, f64)]> + Clone) -> Scaling {
    let last = curves.clone().filter_map(|c| c.last()).map(|p| p.0);
    let last = last.fold(f64::MIN_POSITIVE, f64::max);
    let fallen = curves.filter_map(|c| {
        let mut later = c.iter().filter(|p| p.0 > 0.0);
        later.find(|p| p.1 < 0.99 * c[0].1).map(|p| p.0)
    });
    let first = 0.5 * fallen.fold(f64::INFINITY, f64::min);
    if first > 0.0 && 10.0 * first < last {
        Scaling::Log(first, last)
    } else {
        Scaling::Range(0.0, last)
    }
}

/// Lets a curve begin where its axis does: what it had then is carried there.
pub fn begin_at(points: &mut Vec<(f64, f64)>, axis: &Scaling) {
    let (Scaling::Log(first, _) | Scaling::Range(first, _)) = axis else {
        return;
    };
    let n_before = points.iter().take_while(|p| p.0 < *first).count();
    if n_before > 0 {
        let value = points[n_before - 1].1;
        points.drain(..n_before - 1);
        points[0] = (*first, value);
    }
}
