//! Charged shapes as small tubes side by side: turned alike, drawn to one scale of length and colour.

use crate::data::{Curve, points_of};
use crate::error::ViewError;
use crate::plot::camera;
use crate::plot::canvas::tubes_png;
use crate::plot::color::Scale;
use crate::plot::tube::{Strand, Tube};
use nalgebra::{Matrix3, Rotation3, Vector3};

/// A charged shape as it is seen.
#[derive(Debug)]
pub struct Shape {
    /// The curve, or those of a link.
    pub curves: Vec<Curve>,
    /// Their vertices one after the other, turned to the reader.
    pub view: Vec<Vector3<f64>>,
}

impl Shape {
    /// A shape that is not turned yet.
    pub fn new(curves: Vec<Curve>) -> Self {
        Self {
            curves,
            view: Vec::new(),
        }
    }

    /// Side of the square that it fills.
    fn side(&self) -> f64 {
        let [x0, y0, x1, y1] = camera::extent(&self.view);
        (x1 - x0).max(y1 - y0) + 2.0
    }

    /// Its picture, `unit` pixels of the canvas a unit of length.
    pub fn image(
        &self,
        name: &str,
        size: [f64; 2],
        unit: f64,
        zoom: f64,
        scale: &Scale,
    ) -> Result<Vec<u8>, ViewError> {
        let [x0, y0, x1, y1] = camera::extent(&self.view);
        let tubes = tubes(&self.curves, &self.view, scale).ok_or_else(|| ViewError::Drawing {
            reason: format!("{name} is no curve"),
        })?;
        let center = [(x0 + x1) / 2.0, (y0 + y1) / 2.0];
        tubes_png(size, center, unit, zoom, &tubes)
    }
}

/// Curves as tubes of radius 1, coloured by their energy density; `view` has their vertices one after the other.
pub fn tubes(curves: &[Curve], view: &[Vector3<f64>], scale: &Scale) -> Option<Vec<Tube>> {
    let mut rest = view;
    let mut strands = Vec::new();
    for curve in curves {
        let (vertices, others) = rest.split_at_checked(curve.points.len())?;
        rest = others;
        strands.push(Strand {
            vertices,
            values: &curve.density,
            closed: curve.closed,
        });
    }
    Tube::all(&strands, 1.0, scale)
}

/// Turns shapes, one after the other in an order, each like the nearest of those before it, and all so that they fill small squares.
pub fn turn_alike(shapes: &mut [Shape], order: &[usize], gap: impl Fn(usize, usize) -> f64) {
    for (k, &i) in order.iter().enumerate() {
        let done = order[..k].iter();
        let near = done.min_by(|&&a, &&b| gap(a, i).total_cmp(&gap(b, i)));
        let points = &points_of(&shapes[i].curves);
        let turn = near.and_then(|&j| camera::aligned(points, &shapes[j].view));
        let view = camera::view(points, &turn.unwrap_or_else(|| camera::flattest(points)));
        shapes[i].view = camera::flattened(view);
    }
    square_up(shapes);
}

/// Turns shapes in the plane of the page so that the widest picture is as small as can be.
fn square_up(shapes: &mut [Shape]) {
    let turned = |degrees: usize| -> Matrix3<f64> {
        *Rotation3::from_axis_angle(&Vector3::z_axis(), (degrees as f64).to_radians()).matrix()
    };
    let side = |degrees: usize| {
        let turn = turned(degrees);
        let sides = shapes.iter().map(|s| {
            let [x0, y0, x1, y1] = camera::extent(&camera::view(&s.view, &turn));
            (x1 - x0).max(y1 - y0)
        });
        sides.fold(0.0_f64, f64::max)
    };
    let best = (0..180)
        .step_by(3)
        .min_by(|&a, &b| side(a).total_cmp(&side(b)))
        .unwrap_or(0);
    for shape in shapes.iter_mut() {
        shape.view = camera::view(&shape.view, &turned(best));
    }
}

/// Side of the square that the widest shape fills.
pub fn widest<'a>(shapes: impl IntoIterator<Item = &'a Shape>) -> f64 {
    shapes.into_iter().map(Shape::side).fold(4.0, f64::max)
}

/// Density that all but 1 % of the vertices stay below: a few hot spots must not darken all.
pub fn high_density<'a>(shapes: impl IntoIterator<Item = &'a Shape>) -> f64 {
    let curves = shapes.into_iter().flat_map(|s| &s.curves);
    let all = curves.flat_map(|curve| &curve.density);
    let mut all: Vec<f64> = all.copied().collect();
    all.sort_by(f64::total_cmp);
    all.get((0.99 * all.len() as f64) as usize)
        .or(all.last())
        .copied()
        .unwrap_or(1.0)
}
