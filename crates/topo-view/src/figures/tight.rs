//! Tight knots and links: tubes of radius 1 on one scale, coloured by curvature, and their numbers in a table below.

use super::figure::Context;
use crate::error::ViewError;
use crate::plot::camera;
use crate::plot::canvas::{Canvas, tubes_and_rods_png};
use crate::plot::color::{INK, Scale};
use crate::plot::raster::Rods;
use crate::plot::style::Style;
use crate::plot::tube::{Strand, Tube};
use nalgebra::Vector3;
use rayon::prelude::*;
use topo_core::Polyline;
use topo_knots::struts_of_all;

const COLUMNS: usize = 7;
const CELL: [f64; 2] = [96.0, 104.0];
/// Side of a picture.
const PICTURE: [f64; 2] = [CELL[0], CELL[1] - 16.0];
/// Tube radius when struts are shown; at the full radius 1 they lie inside.
const THIN: f64 = 0.32;
/// Radius and colour of a strut.
const STRUT: f64 = 0.055;
const STRUT_COLOR: [u8; 3] = [214, 96, 77];
/// What the foot of a figure says of struts.
pub const STRUT_NOTE: &str = "Tubes are drawn at a third of their radius, with struts: lines between points at which the full tubes touch.";
/// Strands this fraction of a diameter further apart than the nearest ones are shown as touching.
const SLACK: f64 = 5e-3;
/// Struts shown per unit of length along a line of contact.
const STRUTS_PER_UNIT: f64 = 2.0;
/// Height of a line of the table.
const LINE: f64 = 14.0;
/// Length of the longest bar of the table.
const BAR: f64 = 86.0;

/// A tight shape turned to the reader.
pub struct Tight {
    /// What stands below it.
    label: String,
    /// Vertices of each component.
    curves: Vec<Vec<Vector3<f64>>>,
}

impl Tight {
    /// Turns the closed curves of a knot or link to the reader.
    pub fn new(label: String, curves: &[Vec<Vector3<f64>>]) -> Self {
        let points = curves.concat();
        let mut view = camera::view(&points, &camera::flattest(&points)).into_iter();
        let turned = curves.iter().map(|c| view.by_ref().take(c.len()).collect());
        Self {
            label,
            curves: turned.collect(),
        }
    }

    fn extent(&self) -> [f64; 4] {
        camera::extent(&self.curves.concat())
    }

    /// Its tubes coloured by curvature, with struts if they are asked for.
    fn image(&self, context: &Context, unit: f64, zoom: f64) -> Result<Vec<u8>, ViewError> {
        let values: Vec<Vec<f64>> = self.curves.iter().map(|c| curvature(c)).collect();
        let strands = self.curves.iter().zip(&values);
        let strands: Vec<Strand<'_>> = strands
            .map(|(vertices, values)| Strand {
                vertices,
                values,
                closed: true,
            })
            .collect();
        let (radius, rods) = match context.struts {
            true => (THIN, rods(&self.curves)?),
            false => (1.0, Rods::default()),
        };
        let tubes = Tube::all(&strands, radius, &scale()).ok_or_else(|| ViewError::Drawing {
            reason: format!("{} is no curve", self.label),
        })?;
        let [x0, y0, x1, y1] = self.extent();
        let centre = [(x0 + x1) / 2.0, (y0 + y1) / 2.0];
        tubes_and_rods_png(PICTURE, centre, unit, zoom, &tubes, &rods)
    }
}

fn scale() -> Scale {
    Scale::viridis(0.0, 1.0)
}

/// Height of the pictures of `n` shapes.
fn height(n: usize) -> f64 {
    CELL[1] * n.div_ceil(COLUMNS) as f64
}

/// A canvas for the pictures and the table of `n` shapes with so many notes at the foot.
pub fn canvas(context: &Context, n: usize, n_notes: usize) -> Canvas {
    let table = 44.0 + LINE * n as f64 + LINE;
    let height = 8.0 + height(n) + table + 12.0 * n_notes as f64;
    Canvas::new(720.0, height, 4.0 * context.detail)
}

/// All shapes on one scale, each in its cell with its label, and the colour bar beside them.
pub fn draw(context: &Context, canvas: &mut Canvas, shapes: &[Tight]) -> Result<(), ViewError> {
    let units = shapes.iter().map(|shape| {
        let [x0, y0, x1, y1] = shape.extent();
        ((CELL[0] - 4.0) / (x1 - x0 + 2.0)).min((CELL[1] - 18.0) / (y1 - y0 + 2.0))
    });
    let unit = units.fold(20.0, f64::min);
    let zoom = canvas.zoom();
    let images = shapes.par_iter().map(|s| s.image(context, unit, zoom));
    let images = images.collect::<Result<Vec<_>, _>>()?;
    for (i, (shape, image)) in shapes.iter().zip(&images).enumerate() {
        let at = [
            CELL[0] * (i % COLUMNS) as f64,
            8.0 + CELL[1] * (i / COLUMNS) as f64,
        ];
        canvas.image(at, PICTURE, image);
        let style = Style::default().middle().bold().size(11.5);
        let below = at[1] + CELL[1] - 4.0;
        canvas.text(at[0] + CELL[0] / 2.0, below, &shape.label, style);
    }
    let size = [9.0, (height(shapes.len()) - 44.0).min(150.0)];
    let ticks = [0.0, 0.5, 1.0];
    canvas.color_bar([677.0, 30.0], size, &scale(), &ticks, "Curvature κ*r*");
    Ok(())
}

/// A table: a line a shape.
pub struct Numbers<'a> {
    /// Headings, and where the columns end.
    pub columns: &'a [(&'a str, f64)],
    /// A cell for each column.
    pub rows: Vec<Vec<String>>,
    /// Heading of the bars and where they begin.
    pub bars: (String, f64),
    /// What the bars show, as share of the longest; NaN: nothing.
    pub shares: Vec<f64>,
}

impl Numbers<'_> {
    /// Draws the table below the pictures.
    pub fn draw(&self, canvas: &mut Canvas) {
        let top = 8.0 + height(self.rows.len()) + 26.0;
        let header = Style::default().bold().size(9.5);
        for (name, x) in self.columns {
            canvas.text(*x, top, name, header.end());
        }
        let (heading, left) = (&self.bars.0, self.bars.1);
        canvas.text(left, top, heading, header);
        canvas.line([14.0, top + 5.0], [706.0, top + 5.0], INK, 0.8);
        for (i, (row, share)) in self.rows.iter().zip(&self.shares).enumerate() {
            let y = top + 17.0 + LINE * i as f64;
            if i % 2 == 1 {
                canvas.rect([14.0, y - 10.5], [692.0, LINE], "#f4f5f7");
            }
            for (k, (cell, (_, x))) in row.iter().zip(self.columns).enumerate() {
                let style = Style::default().end().size(9.5);
                canvas.text(*x, y, cell, if k == 0 { style.bold() } else { style });
            }
            let share = share.clamp(0.0, 1.0);
            if share.is_finite() {
                canvas.rect([left, y - 7.0], [1.0 + BAR * share, 6.5], "#5b8fb9");
            }
        }
    }
}

/// Struts of tight curves.
fn rods(curves: &[Vec<Vector3<f64>>]) -> Result<Rods, ViewError> {
    let polyline = |points: &Vec<Vector3<f64>>| Polyline::new(points.clone(), true);
    let curves: Result<Vec<Polyline>, _> = curves.iter().map(polyline).collect();
    let curves = curves.map_err(|e| ViewError::Drawing {
        reason: format!("a tight shape is no curve: {e}"),
    })?;
    let n: usize = curves.iter().map(Polyline::n_vertices).sum();
    let per_unit = n as f64 / curves.iter().map(Polyline::length).sum::<f64>();
    let spacing = (per_unit / STRUTS_PER_UNIT).round().max(1.0) as usize;
    Ok(Rods {
        ends: struts_of_all(&curves, SLACK, spacing),
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
