//! Tight shapes of the knots with their ropelengths against the published ones.

use super::figure::{Context, Drawn, Figure};
use super::series::{Table, bounds};
use super::tight::{self, Numbers, STRUT_NOTE, Tight};
use crate::data::{Curve, KnotRow, read_csv};
use crate::error::ViewError;
use crate::plot::text;

pub(super) const FIGURE: Figure = Figure {
    name: "knots-table",
    title: "Tight knots",
    caption: "The tightest shapes that the code finds for each knot, as tubes of radius 1 on one \
              scale, coloured by curvature (1 is the bound that a solid tube sets), and their \
              numbers beside the published ropelengths L/r, length over radius. Columns are explained \
              below the table.",
    claim: "Ideal knots are the starting shapes; published ropelengths are the outside truth.",
    table: "knots/table.csv",
    draw,
};

/// Headings and ends of the columns.
const COLUMNS: [(&str, f64); 11] = [
    ("Knot", 40.0),
    ("Vertices", 92.0),
    ("*L*/*r*", 142.0),
    ("*L*/*r* published", 226.0),
    ("Excess (%)", 286.0),
    ("Writhe", 328.0),
    ("Mean crossings", 404.0),
    ("Struts", 442.0),
    ("Kinks", 476.0),
    ("Determinant", 540.0),
    ("Signature", 592.0),
];
/// Left end of the bars of the table.
const BARS: f64 = 612.0;

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let path = context.results.join("knots/table.csv");
    let rows: Vec<KnotRow> = read_csv(&path)?;
    if rows.is_empty() {
        return Err(ViewError::Table {
            path,
            reason: "no rows".to_owned(),
        });
    }
    let mut notes = vec![
        format!(
            "{} quality. *L*/*r*: length of the centreline over the radius of the thickest tube that fits around it (ropelength). Excess: over the published *L*/*r*, as number and as bar.",
            context.quality
        ),
        "Writhe: signed crossings, mean crossings: crossings without sign, both averaged over all directions of view. Strut: a pair of touching points; kink: a vertex at the bound of curvature.".to_owned(),
        "Determinant and signature: invariants of the knot type, computed from the tight shape.".to_owned(),
    ];
    if context.struts {
        notes.push(STRUT_NOTE.to_owned());
    }
    let mut canvas = tight::canvas(context, rows.len(), notes.len());
    let shape = |row: &KnotRow| -> Result<Tight, ViewError> {
        let curve = Curve::read(&context.results.join(format!("knots/{}.csv", row.knot)))?;
        Ok(Tight::new(text::knot_name(&row.knot), &[curve.points]))
    };
    let shapes = rows.iter().map(shape).collect::<Result<Vec<_>, _>>()?;
    tight::draw(context, &mut canvas, &shapes)?;
    numbers(&rows).draw(&mut canvas);
    canvas.footnote(&notes);
    let (low, high) = bounds(rows.iter().map(excess));
    let finding = format!(
        "{} knots; excess over the published ropelength {} to {} %.",
        rows.len(),
        text::number(low, 3),
        text::number(high, 3)
    );
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table(&rows).finish(),
        finding,
    })
}

fn table(rows: &[KnotRow]) -> Table {
    let mut table = Table::new(
        "knot,length_over_radius,reference,excess_percent,writhe,average_crossing_number,struts,kinks",
    );
    for r in rows {
        let numbers = [
            r.length_over_radius,
            r.reference.unwrap_or(f64::NAN),
            excess(r),
            r.writhe,
            r.average_crossing_number,
            r.struts as f64,
            r.kinks as f64,
        ];
        table.row(&[&r.knot], &numbers);
    }
    table
}

fn numbers(rows: &[KnotRow]) -> Numbers<'static> {
    let (_, worst) = bounds(rows.iter().map(excess));
    let cells = |r: &KnotRow| {
        vec![
            text::knot_name(&r.knot),
            r.vertices.to_string(),
            text::fixed(r.length_over_radius, 3),
            text::optional(r.reference, 3),
            text::optional(r.excess_percent, 3),
            text::fixed(r.writhe, 3),
            text::fixed(r.average_crossing_number, 3),
            r.struts.to_string(),
            r.kinks.to_string(),
            r.determinant.to_string(),
            text::number(f64::from(r.signature), 0),
        ]
    };
    let heading = format!("Excess, 0 to {} %", text::significant(worst, 2));
    Numbers {
        columns: &COLUMNS,
        rows: rows.iter().map(cells).collect(),
        bars: (heading, BARS),
        shares: rows.iter().map(|r| excess(r) / worst.max(1e-9)).collect(),
    }
}

fn excess(row: &KnotRow) -> f64 {
    row.excess_percent.unwrap_or(f64::NAN)
}
