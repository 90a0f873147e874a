//! Linearised constraints of a unit tube: struts between strands, kinks at sharp vertices.

use std::f64::consts::PI;

use topo_core::{closest_points, vertex_radius};

use super::pairs::all_close_pairs;
use crate::V;
use crate::rings::Rings;

/// Vertices with a larger radius of curvature (in tube radii) cannot become sharp in one step.
const KINK_REACH: f64 = 3.0;

/// What a row of the constraint matrix guards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Guard {
    /// Two strands keep a diameter apart.
    Strut,
    /// A vertex keeps its radius of curvature.
    Kink,
}

/// One inequality `gradient . y >= bound` on the displacements of up to four vertices.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub guard: Guard,
    pub vertices: [u32; 4],
    pub gradients: [V; 4],
    pub bound: f64,
}

impl Row {
    /// Number of vertices that the row acts on.
    pub fn n(&self) -> usize {
        match self.guard {
            Guard::Strut => 4,
            Guard::Kink => 3,
        }
    }

    /// Rate of change of the guarded quantity under displacements `y` (three numbers per vertex).
    pub fn dot(&self, y: &[f64]) -> f64 {
        (0..self.n())
            .map(|k| {
                let (g, i) = (&self.gradients[k], 3 * self.vertices[k] as usize);
                g.x * y[i] + g.y * y[i + 1] + g.z * y[i + 2]
            })
            .sum()
    }

    /// Adds `weight` times the gradient to `out`.
    pub fn add(&self, weight: f64, out: &mut [f64]) {
        for k in 0..self.n() {
            let (g, i) = (&self.gradients[k], 3 * self.vertices[k] as usize);
            out[i] += weight * g.x;
            out[i + 1] += weight * g.y;
            out[i + 2] += weight * g.z;
        }
    }
}

/// Rebuilds the constraints of a unit tube around the closed polygons `x` that a step of at most `delta` a vertex may meet.
///
/// Struts are all pairs of edges more than π apart along a curve, or of different curves, and closer than 2 + 2 `delta`; kinks all
/// vertices with a radius of curvature below 3.
pub(crate) fn rebuild(
    x: &[V],
    rings: &Rings,
    delta: f64,
    pairs: &mut Vec<(u32, u32)>,
    rows: &mut Vec<Row>,
) {
    rows.clear();
    let (next, before) = (rings.next(), rings.before());
    let arcs = Arcs::of(x, rings);
    let reach = 2.0 + 2.0 * delta;
    all_close_pairs(x, rings, reach, pairs);
    for &(i, j) in pairs.iter() {
        let (i, j) = (i as usize, j as usize);
        if arcs.between(i, j) < PI {
            continue;
        }
        let (a, b, c, d) = (x[i], x[next[i]], x[j], x[next[j]]);
        let (d2, s, t) = closest_points(&a, &b, &c, &d);
        if d2 >= reach * reach || d2 == 0.0 {
            continue;
        }
        let distance = d2.sqrt();
        let normal = ((a + (b - a) * s) - (c + (d - c) * t)) / distance;
        rows.push(Row {
            guard: Guard::Strut,
            vertices: [i as u32, next[i] as u32, j as u32, next[j] as u32],
            gradients: [
                normal * (1.0 - s),
                normal * s,
                normal * (t - 1.0),
                normal * -t,
            ],
            bound: 2.0 - distance,
        });
    }
    for i in 0..x.len() {
        let (before, after) = (before[i], next[i]);
        let (a, b) = (x[i] - x[before], x[after] - x[i]);
        let radius = vertex_radius(&a, &b);
        if radius < KINK_REACH {
            let (da, db) = radius_gradient(&a, &b);
            rows.push(Row {
                guard: Guard::Kink,
                vertices: [before as u32, i as u32, after as u32, 0],
                gradients: [-da, da - db, db, V::zeros()],
                bound: 1.0 - radius,
            });
        }
    }
}

/// Distances along curves.
struct Arcs {
    /// Component of each edge.
    ring: Vec<usize>,
    /// Where each edge begins and ends, along its component.
    ends: Vec<(f64, f64)>,
    lengths: Vec<f64>,
}

impl Arcs {
    fn of(x: &[V], rings: &Rings) -> Self {
        let next = rings.next();
        let mut arcs = Self {
            ring: Vec::with_capacity(x.len()),
            ends: Vec::with_capacity(x.len()),
            lengths: Vec::with_capacity(rings.n_rings()),
        };
        for (ring, range) in rings.ranges().enumerate() {
            let mut at = 0.0;
            for i in range {
                let end = at + (x[next[i]] - x[i]).norm();
                arcs.ring.push(ring);
                arcs.ends.push((at, end));
                at = end;
            }
            arcs.lengths.push(at);
        }
        arcs
    }

    /// Distance of the middles of two edges i < j along their curve; infinite for edges of two curves.
    fn between(&self, i: usize, j: usize) -> f64 {
        if self.ring[i] != self.ring[j] {
            return f64::INFINITY;
        }
        let ((i0, i1), (j0, j1)) = (self.ends[i], self.ends[j]);
        let apart = 0.5 * (j0 + j1 - i0 - i1);
        apart.min(self.lengths[self.ring[i]] - apart)
    }
}

/// Derivatives of the radius of curvature at a vertex with respect to the edges before and after.
pub(super) fn radius_gradient(a: &V, b: &V) -> (V, V) {
    let (la, lb) = (a.norm(), b.norm());
    let normal = a.cross(b);
    let s = normal.norm().max(1e-12 * la * lb);
    let sum = la * lb + a.dot(b);
    let least = la.min(lb);
    let radius = 0.5 * least * sum / s;
    let mut da = (a * (lb / la) + b) * (0.5 * least / s) - b.cross(&normal) * (radius / (s * s));
    let mut db = (b * (la / lb) + a) * (0.5 * least / s) - normal.cross(a) * (radius / (s * s));
    if la <= lb {
        da += a * (radius / (la * la));
    } else {
        db += b * (radius / (lb * lb));
    }
    (da, db)
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_core::finite_difference_gradient;

    #[test]
    fn gradients_are_those_of_the_guarded_quantities() {
        let curve = crate::closed_braid(&[1, -2, 1, -2])
            .expect("a knot")
            .resampled(90);
        let mut x = curve.expect("resampled").into_vertices();
        // Unequal edges: the shorter of two equal ones has no derivative.
        x.iter_mut()
            .enumerate()
            .for_each(|(i, v)| *v *= 1.0 + 0.02 * (2.4 * i as f64).sin());
        let (mut pairs, mut rows) = (Vec::new(), Vec::new());
        rebuild(&x, &Rings::one(x.len()), 0.6, &mut pairs, &mut rows);
        assert!(rows.iter().any(|r| r.guard == Guard::Strut));
        assert!(rows.iter().any(|r| r.guard == Guard::Kink));
        for row in rows.iter().step_by(5) {
            let at: Vec<f64> = (0..row.n())
                .flat_map(|k| {
                    x[row.vertices[k] as usize]
                        .iter()
                        .copied()
                        .collect::<Vec<_>>()
                })
                .collect();
            let value = |at: &[f64]| {
                let p = |k: usize| V::new(at[3 * k], at[3 * k + 1], at[3 * k + 2]);
                match row.guard {
                    Guard::Strut => closest_points(&p(0), &p(1), &p(2), &p(3)).0.sqrt(),
                    Guard::Kink => vertex_radius(&(p(1) - p(0)), &(p(2) - p(1))),
                }
            };
            let gradient = finite_difference_gradient(value, &at, 1e-4);
            for (k, g) in gradient.iter().enumerate() {
                let exact = row.gradients[k / 3][k % 3];
                assert!(
                    (g - exact).abs() < 1e-6 * (1.0 + exact.abs()),
                    "{row:?} {k}: {g} {exact}"
                );
            }
        }
    }
}
