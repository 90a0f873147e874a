//! Start shapes: lines, rings, torus knots, the figure-eight knot.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use topo_core::Polyline;

type V = Vector3<f64>;

/// A curve through `vertices`.
///
/// # Panics
/// When they make no curve.
pub fn polyline(vertices: Vec<V>, closed: bool) -> Polyline {
    Polyline::new(vertices, closed).expect("a test's own curve")
}

/// A straight line of `n_edges` edges and the given length along x.
pub fn line(n_edges: usize, length: f64) -> Polyline {
    let x = |k: usize| length * k as f64 / n_edges as f64;
    polyline(
        (0..=n_edges).map(|k| V::new(x(k), 0.0, 0.0)).collect(),
        false,
    )
}

/// An open curve of unit tangents `tangent(j)`, each edge `edge` long.
pub fn from_tangents(n_edges: usize, edge: f64, tangent: impl Fn(usize) -> V) -> Polyline {
    let mut vertices = vec![V::zeros()];
    let mut x = V::zeros();
    for j in 0..n_edges {
        x += tangent(j) * edge;
        vertices.push(x);
    }
    polyline(vertices, false)
}

/// A closed curve of `n` vertices, given over one turn of its parameter.
pub fn closed(n: usize, point: impl Fn(f64) -> V) -> Polyline {
    polyline(
        (0..n).map(|k| point(TAU * k as f64 / n as f64)).collect(),
        true,
    )
}

/// A regular polygon on a circle of radius `radius` in the xy plane.
pub fn ring(n: usize, radius: f64) -> Polyline {
    closed(n, |u| V::new(u.cos(), u.sin(), 0.0) * radius)
}

/// A right-handed trefoil on a torus of radii `major` and `minor`.
pub fn trefoil(n: usize, major: f64, minor: f64) -> Polyline {
    closed(n, |u| {
        let r = major + minor * (3.0 * u).cos();
        V::new(
            r * (2.0 * u).cos(),
            r * (2.0 * u).sin(),
            -1.2 * minor * (3.0 * u).sin(),
        )
    })
}

/// A figure-eight knot, which is its own mirror image up to deformation though this curve is not.
pub fn figure_eight(n: usize) -> Polyline {
    closed(n, |u| {
        let r = 2.0 + (2.0 * u).cos();
        V::new(
            r * (3.0 * u).cos(),
            r * (3.0 * u).sin(),
            1.2 * (4.0 * u).sin(),
        )
    })
}

/// The mirror image in the xy plane.
pub fn mirrored(curve: &Polyline) -> Polyline {
    let flipped = curve.vertices().iter().map(|v| V::new(v.x, v.y, -v.z));
    polyline(flipped.collect(), curve.is_closed())
}
