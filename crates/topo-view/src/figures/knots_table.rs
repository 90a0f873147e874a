//! Tight shapes of the knots with their ropelengths against the published ones.

use super::figure::{Context, Drawn, Figure};
use super::series::{Table, bounds};
use crate::data::{Curve, KnotRow, read_csv};
use crate::error::ViewError;
use crate::plot::canvas::{Canvas, tube_and_rods_png};
use crate::plot::color::{INK, Scale};
use crate::plot::raster::Rods;
use crate::plot::style::Style;
use crate::plot::tube::Tube;
use crate::plot::{camera, text};
use nalgebra::Vector3;
use rayon::prelude::*;
use topo_core::Polyline;
use topo_knots::struts;

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

const COLUMNS: usize = 7;
const CELL: [f64; 2] = [96.0, 104.0];
/// Tube radius when struts are shown; at the full radius 1 they lie inside.
const THIN: f64 = 0.32;
/// Radius and colour of a strut.
const STRUT: f64 = 0.055;
const STRUT_COLOR: [u8; 3] = [214, 96, 77];
const STRUT_NOTE: &str = "Tubes are drawn at a third of their radius, with struts: lines between points at which the full tubes touch.";
/// Strands this fraction of a diameter further apart than the nearest ones are shown as touching.
const SLACK: f64 = 5e-3;
/// Struts shown per unit of length along a line of contact.
const STRUTS_PER_UNIT: f64 = 2.0;

/// Left end of the bars of the table, and length of the longest.
const BARS: [f64; 2] = [612.0, 86.0];

/// Points of a knot turned to the reader.
type View = Vec<Vector3<f64>>;

/// Side of a picture of a knot.
const PICTURE: [f64; 2] = [CELL[0], CELL[1] - 16.0];

fn draw(context: &Context) -> Result<Drawn, ViewError> {
    let rows: Vec<KnotRow> = read_csv(&context.results.join("knots/table.csv"))?;
    if rows.is_empty() {
        let path = context.results.join("knots/table.csv");
        return Err(ViewError::Table {
            path,
            reason: "no rows".to_owned(),
        });
    }
    let n_lines = rows.len().div_ceil(COLUMNS);
    let pictures = CELL[1] * n_lines as f64;
    let n_notes = if context.struts { 4.0 } else { 3.0 };
    let height = 8.0 + pictures + 44.0 + 14.0 * rows.len() as f64 + 14.0 + 12.0 * n_notes;
    let mut canvas = Canvas::new(720.0, height, 4.0 * context.detail);
    let scale = Scale::viridis(0.0, 1.0);
    draw_knots(context, &mut canvas, &rows, &scale)?;
    canvas.color_bar(
        [677.0, 30.0],
        [9.0, (pictures - 44.0).min(150.0)],
        &scale,
        &[0.0, 0.5, 1.0],
        "Curvature κ*r*",
    );
    numbers(&mut canvas, &rows, 8.0 + pictures + 26.0);
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

/// All knots on one scale, each in its cell with its name.
fn draw_knots(
    context: &Context,
    canvas: &mut Canvas,
    rows: &[KnotRow],
    scale: &Scale,
) -> Result<(), ViewError> {
    let views = views(context, rows)?;
    let sides = views.iter().map(|v| {
        let [x0, y0, x1, y1] = camera::extent(v);
        ((CELL[0] - 4.0) / (x1 - x0 + 2.0)).min((CELL[1] - 18.0) / (y1 - y0 + 2.0))
    });
    let unit = sides.fold(20.0, f64::min);
    let zoom = canvas.zoom();
    let images = views
        .par_iter()
        .map(|view| image(context, view, scale, unit, zoom))
        .collect::<Result<Vec<_>, _>>()?;
    for (i, (row, image)) in rows.iter().zip(&images).enumerate() {
        let at = [
            CELL[0] * (i % COLUMNS) as f64,
            8.0 + CELL[1] * (i / COLUMNS) as f64,
        ];
        canvas.image(at, PICTURE, image);
        let name = text::knot_name(&row.knot);
        let style = Style::default().middle().bold().size(11.5);
        canvas.text(at[0] + CELL[0] / 2.0, at[1] + CELL[1] - 4.0, &name, style);
    }
    Ok(())
}

fn views(context: &Context, rows: &[KnotRow]) -> Result<Vec<View>, ViewError> {
    rows.iter()
        .map(|r| {
            let curve = Curve::read(&context.results.join(format!("knots/{}.csv", r.knot)))?;
            Ok(camera::view(
                &curve.points,
                &camera::flattest(&curve.points),
            ))
        })
        .collect()
}

/// A knot as a tube coloured by curvature, with its struts if they are asked for.
fn image(
    context: &Context,
    view: &View,
    scale: &Scale,
    unit: f64,
    zoom: f64,
) -> Result<Vec<u8>, ViewError> {
    let [x0, y0, x1, y1] = camera::extent(view);
    let radius = if context.struts { THIN } else { 1.0 };
    let tube = Tube::new(view, &curvature(view), true, radius, scale);
    let tube = tube.ok_or_else(|| ViewError::Drawing {
        reason: "a knot is no curve".to_owned(),
    })?;
    let rods = if context.struts {
        rods(view)?
    } else {
        Rods::default()
    };
    let centre = [(x0 + x1) / 2.0, (y0 + y1) / 2.0];
    tube_and_rods_png(PICTURE, centre, unit, zoom, &tube, &rods)
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

fn numbers(canvas: &mut Canvas, rows: &[KnotRow], top: f64) {
    let columns: [(&str, f64); 11] = [
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
    let header = Style::default().bold().size(9.5);
    for (name, x) in columns {
        canvas.text(x, top, name, header.end());
    }
    let (_, worst) = bounds(rows.iter().map(excess));
    let bar_header = format!("Excess, 0 to {} %", text::significant(worst, 2));
    canvas.text(BARS[0], top, &bar_header, header);
    canvas.line([14.0, top + 5.0], [706.0, top + 5.0], INK, 0.8);
    for (i, r) in rows.iter().enumerate() {
        let y = top + 17.0 + 14.0 * i as f64;
        if i % 2 == 1 {
            canvas.rect([14.0, y - 10.5], [692.0, 14.0], "#f4f5f7");
        }
        let cells = [
            text::knot_name(&r.knot),
            r.vertices.to_string(),
            text::fixed(r.length_over_radius, 3),
            optional(r.reference),
            optional(r.excess_percent),
            text::fixed(r.writhe, 3),
            text::fixed(r.average_crossing_number, 3),
            r.struts.to_string(),
            r.kinks.to_string(),
            r.determinant.to_string(),
            text::number(f64::from(r.signature), 0),
        ];
        for (k, (cell, (_, x))) in cells.iter().zip(columns).enumerate() {
            let style = Style::default().end().size(9.5);
            canvas.text(x, y, cell, if k == 0 { style.bold() } else { style });
        }
        let share = (excess(r) / worst.max(1e-9)).clamp(0.0, 1.0);
        if share.is_finite() {
            canvas.rect([BARS[0], y - 7.0], [1.0 + BARS[1] * share, 6.5], "#5b8fb9");
        }
    }
}

fn excess(row: &KnotRow) -> f64 {
    row.excess_percent.unwrap_or(f64::NAN)
}

fn optional(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), |v| text::fixed(v, 3))
}

/// Struts of a tight curve.
fn rods(points: &[Vector3<f64>]) -> Result<Rods, ViewError> {
    let curve = Polyline::new(points.to_vec(), true).map_err(|e| ViewError::Drawing {
        reason: format!("a knot is no curve: {e}"),
    })?;
    let per_unit = points.len() as f64 / curve.length();
    let spacing = (per_unit / STRUTS_PER_UNIT).round().max(1.0) as usize;
    Ok(Rods {
        ends: struts(&curve, SLACK, spacing),
        radius: STRUT,
        color: STRUT_COLOR,
    })
}

/// Curvature at each vertex by the circle through it and its neighbours a radius away.
fn curvature(points: &[Vector3<f64>]) -> Vec<f64> {
    let n = points.len();
    let length: f64 = (0..n)
        .map(|i| (points[(i + 1) % n] - points[i]).norm())
        .sum();
    let reach = ((0.35 * n as f64 / length).round() as usize).clamp(1, (n / 3).max(1));
    (0..n)
        .map(|i| {
            let (a, b, c) = (
                points[(i + n - reach) % n],
                points[i],
                points[(i + reach) % n],
            );
            let (u, v, w) = (b - a, c - b, c - a);
            let product = u.norm() * v.norm() * w.norm();
            if product > 1e-12 {
                2.0 * u.cross(&v).norm() / product
            } else {
                0.0
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curvature_of_a_circle_is_one_over_its_radius() {
        let points: Vec<_> = (0..90)
            .map(|i| {
                let (s, c) = (i as f64 / 90.0 * std::f64::consts::TAU).sin_cos();
                Vector3::new(4.0 * c, 4.0 * s, 1.0)
            })
            .collect();
        assert!(curvature(&points).iter().all(|k| (k - 0.25).abs() < 1e-3));
    }
}
