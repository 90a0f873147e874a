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

/// A loose overhand knot of length 1: a trefoil on a torus, opened where it is farthest out, with straight tails that spread from there. Its
/// ends lie apart along x, the first one at the lower end, and outside of the knot.
///
/// # Panics
/// When it cannot be sampled by so few edges.
pub fn overhand(n_edges: usize, tail: f64) -> Polyline {
    let cut = 0.3;
    let knotted = |u: f64| {
        let r = 2.0 + (3.0 * u).cos();
        V::new(
            r * (2.0 * u).cos(),
            r * (2.0 * u).sin(),
            -1.2 * (3.0 * u).sin(),
        )
    };
    let at = |k: usize| knotted(cut + (TAU - 2.0 * cut) * k as f64 / 300.0);
    let out = |from: V, side: f64, k: usize| {
        from + V::new(1.0, side, -0.6 * side).normalize() * (tail * k as f64 / 100.0)
    };
    let vertices = (1..=100).rev().map(|k| out(at(0), 1.0, k));
    let vertices = vertices.chain((0..=300).map(at));
    let vertices = vertices.chain((1..=100).map(|k| out(at(300), -1.0, k)));
    let corners = polyline(vertices.collect(), false).resampled(400);
    let round = corners
        .and_then(|curve| curve.smoothed(100))
        .expect("a test's own curve");
    // its ends along x
    let (first, last) = (round.vertices()[0], round.vertices()[400]);
    let along = (last - first).normalize();
    let aside = (V::x() - along * along.x).normalize();
    let up = along.cross(&aside);
    let turned = round
        .vertices()
        .iter()
        .map(|v| V::new(v.dot(&along), v.dot(&aside), v.dot(&up)));
    let curve = polyline(turned.collect(), false)
        .resampled(n_edges)
        .expect("a test's own edges");
    curve
        .scaled(1.0 / curve.length())
        .expect("a test's own scale")
}
