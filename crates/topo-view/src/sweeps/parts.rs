//! One case alone: what its energy consists of, and where it goes, over its discharge.

use super::cases::Cases;
use super::curves::{Sample, begin_at, samples, span};
use super::groups::{Key, Look};
use super::sheet::{self, Chart, Line, Scaling};
use crate::error::ViewError;
use crate::figures::Drawn;
use crate::figures::series::Table;
use crate::guide::Quantity;

/// Draws the parts; `None` where there are several cases, or none with a curve.
pub fn draw(cases: &Cases) -> Result<Option<Drawn>, ViewError> {
    let [row] = cases.first_rows()[..] else {
        return Ok(None);
    };
    let curve = &cases.guide.curve;
    let folder = cases.case_folder(row);
    let samples = samples(curve, &folder, row)?;
    let Some(x) = span(curve, &folder, row)? else {
        return Ok(None);
    };
    let mut table = Table::new("quantity,time,value");
    let charts: Vec<Chart> = cases
        .guide
        .parts
        .iter()
        .filter_map(|q| chart(cases, q, &samples, &x, &mut table))
        .collect();
    if charts.is_empty() {
        return Ok(None);
    }
    let n = cases.rows.len();
    let note = (n > 1).then(|| format!("The first of {n} discharges of the case."));
    let notes: Vec<String> = note.into_iter().collect();
    Ok(Some(Drawn {
        picture: sheet::draw(&charts, &Key::None, &notes)?,
        csv: table.finish(),
        finding: notes.join(" "),
    }))
}

fn chart(
    cases: &Cases,
    quantity: &Quantity,
    samples: &[Sample],
    x: &Scaling,
    table: &mut Table,
) -> Option<Chart> {
    let curve = &cases.guide.curve;
    let number = |s: &Sample, column: &str| {
        let value = s.get(column)?.parse::<f64>().ok();
        value.filter(|v| v.is_finite())
    };
    let mut lines = Vec::new();
    for (k, column) in quantity.columns.iter().enumerate() {
        let mut points: Vec<(f64, f64)> = samples
            .iter()
            .filter_map(|s| Some((number(s, curve.time)?, number(s, column.name)?)))
            .collect();
        if points.len() < 2 || points.iter().all(|p| p.1 == 0.0) {
            continue;
        }
        for (t, value) in &points {
            table.row(&[column.name], &[*t, *value]);
        }
        begin_at(&mut points, x);
        lines.push(Line {
            label: column.label.to_owned(),
            ..Line::new(points, Look::named(k))
        });
    }
    (!lines.is_empty()).then(|| Chart {
        x: (curve.time_label.to_owned(), x.clone()),
        y: (quantity.label.to_owned(), Scaling::Linear),
        lines,
    })
}
