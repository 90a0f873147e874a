//! Tight shapes of links with their lengths against the exact and published ones.

use super::figure::{Context, Drawn, Figure};
use super::series::{Table, bounds};
use super::tight::{self, Numbers, STRUT_NOTE, Tight};
use crate::data::read_csv;
use crate::error::ViewError;
use crate::plot::text;
use topo_analysis::LinkRow;
use topo_knots::{LinkTable, read_components};

pub(super) const FIGURE: Figure = Figure {
    name: "links-table",
    title: "Tight links",
    caption: "The tightest shapes that the code finds for links, as tubes of radius 1 on one scale, \
              coloured by curvature (1 is the bound that a solid tube sets), and their numbers beside \
              the lengths L/r of all components together, over the radius, that are known. Columns \
              are explained below the table.",
    claim: "Of chains of rings and of the Borromean rings the tight length is known in closed form: 8π \
            for the Hopf link, 4π + 4 more for each further ring of a chain, 58.0060 for the Borromean \
            rings.",
    table: "knots/links.csv",
    draw,
};

/// Headings and ends of the columns.
const COLUMNS: [(&str, f64); 11] = [
    ("Link", 58.0),
    ("Known as", 120.0),
    ("Components", 182.0),
    ("Vertices", 226.0),
    ("*L*/*r*", 270.0),
    ("*L*/*r* known", 332.0),
    ("Excess (%)", 386.0),
    ("Linking numbers", 464.0),
    ("Struts", 500.0),
    ("Kinks", 534.0),
    ("Residual", 584.0),
];
/// Left end of the bars of the table.
const BARS: f64 = 600.0;

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let path = context.results.join("knots/links.csv");
    let rows: Vec<LinkRow> = read_csv(&path)?;
    if rows.is_empty() {
        return Err(ViewError::Table {
            path,
            reason: "no rows".to_owned(),
        });
    }
    let notes = notes(context, &rows);
    let mut canvas = tight::canvas(context, rows.len(), notes.len());
    let shapes = rows.iter().map(|row| shape(context, row));
    tight::draw(
        context,
        &mut canvas,
        &shapes.collect::<Result<Vec<_>, _>>()?,
    )?;
    numbers(&rows).draw(&mut canvas);
    canvas.footnote(&notes);
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table(&rows).finish(),
        finding: finding(&rows),
    })
}

fn shape(context: &Context, row: &LinkRow) -> Result<Tight, ViewError> {
    let path = context.results.join(format!("knots/{}.vect", row.link));
    let components = read_components(&path).map_err(|e| ViewError::Table {
        path,
        reason: e.to_string(),
    })?;
    let curves: Vec<_> = components.into_iter().map(|c| c.vertices).collect();
    Ok(Tight::new(row.link.clone(), &curves))
}

fn notes(context: &Context, rows: &[LinkRow]) -> Vec<String> {
    let mut notes = vec![
        format!(
            "{} quality. *L*/*r*: length of all centrelines over the radius of the thickest tubes that fit around them (ropelength). Known: exact, or the best published; excess: over that.",
            context.quality
        ),
        "Linking numbers: of components 1 and 2, 1 and 3, 2 and 3, and so on. Strut: a pair of touching points; kink: a vertex at the bound of curvature.".to_owned(),
        "Residual, as number and as bar: share of the tension along the curves that struts and kinks leave unbalanced; 0 of a shape that no small change shortens.".to_owned(),
    ];
    let moving: Vec<&str> = rows
        .iter()
        .filter(|r| !r.converged)
        .map(|r| r.link.as_str())
        .collect();
    if !moving.is_empty() {
        notes.push(format!(
            "Still shrinking when the steps of this quality were used up: {}.",
            moving.join(", ")
        ));
    }
    if context.struts {
        notes.push(STRUT_NOTE.to_owned());
    }
    notes
}

/// The name of a link in words, where it has one.
fn known_as(link: &str) -> String {
    let Ok(entry) = LinkTable::builtin().get(link) else {
        return String::new();
    };
    let word = entry.aliases.iter().find(|a| !a.contains('('));
    word.map_or_else(String::new, |word| {
        let mut letters = word.chars();
        let first = letters.next().map(|c| c.to_uppercase().to_string());
        first.unwrap_or_default() + letters.as_str()
    })
}

fn numbers(rows: &[LinkRow]) -> Numbers<'static> {
    let (_, worst) = bounds(rows.iter().map(|r| r.residual));
    let cells = |r: &LinkRow| {
        vec![
            r.link.clone(),
            known_as(&r.link),
            r.components.to_string(),
            r.vertices.to_string(),
            text::fixed(r.length_over_radius, 3),
            text::optional(r.reference, 3),
            text::optional(r.excess_percent, 3),
            r.linking_numbers.replace('-', "−").replace(' ', ", "),
            r.struts.to_string(),
            r.kinks.to_string(),
            text::fixed(r.residual, 4),
        ]
    };
    let heading = format!("Residual, 0 to {}", text::significant(worst, 2));
    Numbers {
        columns: &COLUMNS,
        rows: rows.iter().map(cells).collect(),
        bars: (heading, BARS),
        shares: rows.iter().map(|r| r.residual / worst.max(1e-9)).collect(),
    }
}

fn table(rows: &[LinkRow]) -> Table {
    let mut table = Table::new(
        "link,known_as,source,linking_numbers,converged,components,vertices,length_over_radius,reference,excess_percent,residual,writhe,struts,kinks",
    );
    for r in rows {
        let (name, converged) = (known_as(&r.link), r.converged.to_string());
        let texts = [&r.link, &name, &r.source, &r.linking_numbers, &converged];
        let numbers = [
            r.components as f64,
            r.vertices as f64,
            r.length_over_radius,
            r.reference.unwrap_or(f64::NAN),
            r.excess_percent.unwrap_or(f64::NAN),
            r.residual,
            r.writhe,
            r.struts as f64,
            r.kinks as f64,
        ];
        table.row(&texts.map(String::as_str), &numbers);
    }
    table
}

fn finding(rows: &[LinkRow]) -> String {
    let known: Vec<f64> = rows.iter().filter_map(|r| r.excess_percent).collect();
    let (low, high) = bounds(known.iter().copied());
    let (_, worst) = bounds(rows.iter().map(|r| r.residual));
    let excess = match known.len() {
        0 => String::new(),
        n => format!(
            "; excess of the {n} whose length is known {} to {} %",
            text::number(low, 3),
            text::number(high, 3)
        ),
    };
    format!(
        "{} links{excess}; residual up to {}.",
        rows.len(),
        text::significant(worst, 2)
    )
}
