//! The charged shapes of a sweep, a row a knot where knots are swept.

use crate::data::Curve;
use crate::error::ViewError;
use crate::figures::Drawn;
use crate::figures::series::{Table, root_ticks};
use crate::figures::shapes::{Shape, high_density, turn_alike, widest};
use crate::plot::canvas::Canvas;
use crate::plot::color::Scale;
use crate::plot::style::Style;
use crate::sweeps::groups::{Groups, evenly};
use crate::sweeps::sheet::text_width;
use crate::sweeps::{Cases, OwnPicture, Row, Swept};
use rayon::prelude::*;

pub(super) const PICTURE: OwnPicture = OwnPicture {
    name: "shapes",
    title: "Charged shapes",
    draw,
};

/// Most shapes of a picture: a third of a second each.
const MOST: usize = 60;
/// Most shapes side by side.
const ACROSS: usize = 9;
/// Sides of the squares that shapes fill, where there are at most so many.
const SIDES: [(usize, f64); 3] = [(2, 180.0), (12, 100.0), (MOST, 66.0)];
/// A line of text below a shape.
const LINE: f64 = 14.0;

/// A shape with its place in the picture.
struct Cell {
    shape: Shape,
    label: String,
    case: String,
    column: usize,
    line: usize,
}

fn draw(cases: &Cases) -> Result<Option<Drawn>, ViewError> {
    let rows = cases.first_rows();
    let rows: Vec<&Row> = rows
        .into_iter()
        .filter(|r| cases.case_folder(r).join("charged.csv").exists())
        .collect();
    if rows.is_empty() {
        return Ok(None);
    }
    let n = rows.len();
    let knot = cases.swept.iter().find(|s| s.setting.column == "knot");
    let is_only = cases.swept.len() == 1;
    let by: Vec<&Swept> = knot.filter(|_| !is_only).into_iter().collect();
    let groups = Groups::of(rows, &by).groups;
    let most = (MOST / groups.len()).max(1);
    let (mut cells, mut names, mut line) = (Vec::new(), Vec::new(), 0);
    for group in groups.iter().take(MOST) {
        let picked: Vec<&Row> = evenly(group.rows.len(), most)
            .into_iter()
            .map(|k| group.rows[k])
            .collect();
        names.push((line, group.label.clone()));
        let shapes = turned(cases, &picked, knot.is_some() && is_only)?;
        for (k, (row, shape)) in picked.iter().zip(shapes).enumerate() {
            cells.push(Cell {
                shape,
                label: label(cases, row, &by),
                case: row.case().to_owned(),
                column: k % ACROSS,
                line: line + k / ACROSS,
            });
        }
        line += picked.len().div_ceil(ACROSS);
    }
    let mut notes = Vec::new();
    if cells.len() < n {
        notes.push(format!(
            "{} of {n} states are shown, picked evenly.",
            cells.len()
        ));
    }
    picture(&cells, &names, &notes).map(Some)
}

/// The shapes of cases; those of one knot are turned alike.
fn turned(cases: &Cases, rows: &[&Row], is_knot_by_knot: bool) -> Result<Vec<Shape>, ViewError> {
    let shape = |row: &&Row| {
        let path = cases.case_folder(row).join("charged.csv");
        Curve::read_all(&path).map(Shape::new)
    };
    let mut shapes: Vec<Shape> = rows.par_iter().map(shape).collect::<Result<_, _>>()?;
    if is_knot_by_knot {
        for shape in shapes.chunks_mut(1) {
            turn_alike(shape, &[0], |_, _| 0.0);
        }
    } else {
        let order: Vec<usize> = (0..shapes.len()).collect();
        turn_alike(&mut shapes, &order, |a, b| a.abs_diff(b) as f64);
    }
    Ok(shapes)
}

/// What tells a shape from the others of its row.
fn label(cases: &Cases, row: &Row, but: &[&Swept]) -> String {
    let is_said = |s: &&Swept| but.iter().all(|b| b.setting.column != s.setting.column);
    let words = cases.swept.iter().filter(is_said);
    let words: Vec<String> = words.map(|s| s.say(row.text(s.setting.column))).collect();
    words.join(", ")
}

fn picture(
    cells: &[Cell],
    names: &[(usize, String)],
    notes: &[String],
) -> Result<Drawn, ViewError> {
    let shapes = || cells.iter().map(|c| &c.shape);
    let scale = Scale::viridis_root(high_density(shapes()));
    let fitting = SIDES.iter().find(|(n, _)| cells.len() <= *n);
    let side = fitting.map_or(66.0, |(_, side)| *side);
    let unit = (side - 2.0) / widest(shapes());
    let across = 1 + cells.iter().map(|c| c.column).max().unwrap_or(0);
    let n_lines = 1 + cells.iter().map(|c| c.line).max().unwrap_or(0);
    let longest = cells.iter().map(|c| text_width(&c.label, 8.0));
    let longest = longest.fold(0.0, f64::max) + 6.0;
    let (pitch, tall) = (side.max(longest.min(150.0)), side + LINE);
    let left = names.iter().map(|(_, n)| text_width(n, 11.5) + 12.0);
    let left = left.fold(10.0, f64::max);
    let width = (left + pitch * across as f64 + 70.0).max(300.0);
    let height = (10.0 + tall * n_lines as f64).max(150.0);
    let mut canvas = Canvas::new(width, height + 6.0 + 10.5 * notes.len() as f64, 4.0);
    let images = cells
        .par_iter()
        .map(|c| {
            c.shape
                .image(&c.case, [side; 2], unit, canvas.zoom(), &scale)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let mut table = Table::new("case,component,s,x,y,z,energy_density");
    for (cell, image) in cells.iter().zip(&images) {
        let at = [
            left + pitch * cell.column as f64 + 0.5 * (pitch - side),
            8.0 + tall * cell.line as f64,
        ];
        canvas.image(at, [side; 2], image);
        let style = Style::default().middle().size(8.0);
        let below = at[1] + side + 8.0;
        canvas.text(at[0] + 0.5 * side, below, &cell.label, style);
        for curve in &cell.shape.curves {
            let component = curve.component.to_string();
            for ((s, p), e) in curve.s.iter().zip(&curve.points).zip(&curve.density) {
                table.row(&[&cell.case, &component], &[*s, p.x, p.y, p.z, *e]);
            }
        }
    }
    for (line, name) in names {
        let y = 8.0 + tall * *line as f64 + 0.5 * side + 4.0;
        let style = Style::default().end().bold().size(11.5);
        canvas.text(left - 4.0, y, name, style);
    }
    let high = scale.range().1;
    let size = [9.0, (0.6 * height).min(160.0)];
    let bar = [width - 56.0, 0.5 * (height - size[1])];
    let label = "Energy density *w* / *E*_{b}*h*^{2}";
    canvas.color_bar(bar, size, &scale, &root_ticks(high), label);
    canvas.footnote(notes);
    Ok(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding: notes.join(" "),
    })
}
