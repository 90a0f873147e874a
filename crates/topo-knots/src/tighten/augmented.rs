//! A second, independent method of tightening: an augmented Lagrangian minimised by limited-memory quasi-Newton steps.

use std::collections::HashMap;
use std::f64::consts::PI;

use topo_core::{Polyline, closest_points, vertex_radius};
use topo_sparse::SparseCholesky;

use super::constraints::radius_gradient;
use super::lbfgs::minimise;
use super::pairs::all_close_pairs;
use super::stop::Stop;
use crate::V;
use crate::curves::Curves;
use crate::rings::Rings;

/// Strands nearer than this have a strut; more distant ones are included only when the list is rebuilt.
const REACH: f64 = 2.3;
/// Largest displacement after which the list of struts is rebuilt.
const STALE: f64 = 0.1;
/// Vertices with a larger radius of curvature are not watched.
const KINK_REACH: f64 = 3.0;
/// Stiffness of the constraints, in units of the tension of the tube: at first, and where doubling ends; stiffer ones slow the
/// quasi-Newton steps more than they spare rounds.
const STIFFNESS: f64 = 100.0;
const MOST_STIFFNESS: f64 = 300.0;
/// Rounds of multipliers, and quasi-Newton steps in each.
const MOST_ROUNDS: usize = 200;
const MOST_STEPS: usize = 400;

/// What the second method came to.
pub(super) struct Settled {
    /// The curves, at thickness about 1.
    pub curves: Curves,
    /// Evaluations of energy and gradient.
    pub n_evaluations: usize,
    /// Whether the constraints were met to the tolerance.
    pub converged: bool,
}

/// Shortens closed curves at thickness 1, keeping their numbers of vertices, until constraints are violated by less than
/// `tolerance` tube radii.
///
/// ```math
/// \mathcal{L} = \frac{N}{2 L_0} \sum_i |e_i|^2 + \frac{1}{2 \rho} \sum_k \left( \max(0, \lambda_k - \rho c_k)^2 - \lambda_k^2 \right),
/// \qquad \lambda_k \leftarrow \max(0, \lambda_k - \rho c_k)
/// ```
///
/// Here c is the distance between two edges minus 2, or the radius of curvature at a vertex minus 1, N the number of edges of a curve,
/// L_0 its length at the start and ρ the stiffness.
pub(super) fn settle(start: &Curves, tolerance: f64, stop: &Stop) -> Option<Settled> {
    let curves = start.scaled(1.0 / start.thickness().tau).ok()?;
    let mut problem = Problem::new(&curves)?;
    let mut x = curves.coordinates();
    let mut n_evaluations = 0;
    let mut last_violation = f64::INFINITY;
    let mut converged = false;
    let mut last_length = f64::INFINITY;
    for _ in 0..MOST_ROUNDS {
        if stop.asks() {
            break;
        }
        // Each list of struts serves until a vertex has moved too far for it.
        loop {
            problem.watch(&x);
            let home = x.clone();
            let evaluated = minimise(&mut problem, &mut x, MOST_STEPS, 1e-3 * tolerance, |x| {
                stop.asks() || x.iter().zip(&home).any(|(a, b)| (a - b).abs() > STALE)
            })?;
            n_evaluations += evaluated.n_evaluations;
            if !evaluated.interrupted || stop.asks() {
                break;
            }
        }
        let violation = problem.update(&x);
        let length = problem.length(&x);
        if violation < tolerance && (length / last_length - 1.0).abs() < 0.1 * tolerance {
            converged = true;
            break;
        }
        last_length = length;
        if violation > 0.3 * last_violation && problem.stiffness < MOST_STIFFNESS {
            problem.stiffen(2.0)?;
        }
        last_violation = violation;
    }
    let vertices = x.chunks_exact(3).map(V::from_column_slice);
    Some(Settled {
        curves: curves.with_vertices(vertices)?,
        n_evaluations,
        converged,
    })
}

/// The augmented Lagrangian of curves.
pub(super) struct Problem {
    n: usize,
    rings: Rings,
    /// The vertex after each, and before.
    next: Vec<usize>,
    before: Vec<usize>,
    /// Spring constant of each edge.
    spring: Vec<f64>,
    stiffness: f64,
    struts: Vec<(u32, u32)>,
    strut_force: Vec<f64>,
    kink_force: Vec<f64>,
    /// Springs and a mean stiffness of the struts: what a quasi-Newton step starts from.
    preconditioner: SparseCholesky,
    pairs: Vec<(u32, u32)>,
    column: Vec<f64>,
}

impl Problem {
    fn new(curves: &Curves) -> Option<Self> {
        let rings = curves.rings();
        let (n, next) = (rings.n(), rings.next());
        let pattern: Vec<(u32, u32)> = next.iter().zip(0..).map(|(j, i)| (i, *j as u32)).collect();
        let constant = |part: &Polyline| {
            let n = part.n_vertices();
            std::iter::repeat_n(n as f64 / part.length(), n)
        };
        let mut problem = Self {
            n,
            before: rings.before(),
            next,
            rings,
            spring: curves.parts().iter().flat_map(constant).collect(),
            stiffness: STIFFNESS,
            struts: Vec::new(),
            strut_force: Vec::new(),
            kink_force: vec![0.0; n],
            preconditioner: SparseCholesky::new(n, &pattern).ok()?,
            pairs: Vec::new(),
            column: vec![0.0; n],
        };
        problem.stiffen(1.0)?;
        Some(problem)
    }

    /// Multiplies the stiffness and renews the preconditioner.
    fn stiffen(&mut self, factor: f64) -> Option<()> {
        self.stiffness *= factor;
        for i in 0..self.n {
            let diagonal = self.preconditioner.slot(i, i)?;
            let next = self.preconditioner.slot(i, self.next[i])?;
            let values = self.preconditioner.values_mut();
            values[diagonal] = 2.0 * self.spring[i] + 0.3 * self.stiffness;
            values[next] = -self.spring[i];
        }
        self.preconditioner.factor().ok()
    }

    fn at(&self, x: &[f64], i: usize) -> V {
        V::new(x[3 * i], x[3 * i + 1], x[3 * i + 2])
    }

    fn length(&self, x: &[f64]) -> f64 {
        (0..self.n)
            .map(|i| (self.at(x, self.next[i]) - self.at(x, i)).norm())
            .sum()
    }

    /// Lists the pairs of edges that may touch; pairs that stay keep their force.
    fn watch(&mut self, x: &[f64]) {
        let vertices: Vec<V> = x.chunks_exact(3).map(V::from_column_slice).collect();
        let h = self.length(x) / self.n as f64;
        all_close_pairs(&vertices, &self.rings, REACH, &mut self.pairs);
        let before: HashMap<(u32, u32), f64> = self
            .struts
            .iter()
            .copied()
            .zip(self.strut_force.iter().copied())
            .collect();
        let apart = |&(i, j): &(u32, u32)| {
            let ring = self.rings.ring(i as usize);
            let between = (j - i) as usize;
            let range = self.rings.range(ring);
            j as usize >= range.end || between.min(range.len() - between) as f64 * h >= PI
        };
        self.struts.clear();
        self.struts.extend(self.pairs.iter().copied().filter(apart));
        self.strut_force.clear();
        self.strut_force.extend(
            self.struts
                .iter()
                .map(|pair| before.get(pair).copied().unwrap_or(0.0)),
        );
    }

    /// Value of a strut's constraint with the unit vector from the second edge to the first, and where on both.
    fn strut(&self, x: &[f64], (i, j): (u32, u32)) -> (f64, V, f64, f64) {
        let (i, j) = (i as usize, j as usize);
        let (a, b) = (self.at(x, i), self.at(x, self.next[i]));
        let (c, d) = (self.at(x, j), self.at(x, self.next[j]));
        let (d2, s, t) = closest_points(&a, &b, &c, &d);
        let distance = d2.sqrt().max(1e-12);
        let normal = ((a + (b - a) * s) - (c + (d - c) * t)) / distance;
        (distance - 2.0, normal, s, t)
    }

    fn edges(&self, x: &[f64], i: usize) -> (V, V) {
        let here = self.at(x, i);
        (
            here - self.at(x, self.before[i]),
            self.at(x, self.next[i]) - here,
        )
    }

    /// New multipliers; returns the largest violation.
    fn update(&mut self, x: &[f64]) -> f64 {
        let mut worst = 0.0_f64;
        for k in 0..self.struts.len() {
            let (value, ..) = self.strut(x, self.struts[k]);
            worst = worst.max(-value);
            self.strut_force[k] = (self.strut_force[k] - self.stiffness * value).max(0.0);
        }
        for i in 0..self.n {
            let (a, b) = self.edges(x, i);
            let value = vertex_radius(&a, &b) - 1.0;
            worst = worst.max(-value);
            self.kink_force[i] = if value + 1.0 < KINK_REACH {
                (self.kink_force[i] - self.stiffness * value).max(0.0)
            } else {
                0.0
            };
        }
        worst
    }
}

impl super::lbfgs::Objective for Problem {
    fn value(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        let n = self.n;
        gradient.fill(0.0);
        let (next, before) = (&self.next, &self.before);
        let mut add = |i: usize, v: V| {
            let i = 3 * i;
            gradient[i] += v.x;
            gradient[i + 1] += v.y;
            gradient[i + 2] += v.z;
        };
        let mut total = 0.0;
        for i in 0..n {
            let e = self.at(x, next[i]) - self.at(x, i);
            total += 0.5 * self.spring[i] * e.norm_squared();
            add(i, e * -self.spring[i]);
            add(next[i], e * self.spring[i]);
        }
        let rho = self.stiffness;
        for (k, &pair) in self.struts.iter().enumerate() {
            let (value, normal, s, t) = self.strut(x, pair);
            let force = self.strut_force[k] - rho * value;
            if force > 0.0 {
                total += 0.5 * force * force / rho;
                let (i, j) = (pair.0 as usize, pair.1 as usize);
                add(i, normal * (-force * (1.0 - s)));
                add(next[i], normal * (-force * s));
                add(j, normal * (force * (1.0 - t)));
                add(next[j], normal * (force * t));
            }
        }
        for i in 0..n {
            let (a, b) = self.edges(x, i);
            let radius = vertex_radius(&a, &b);
            let force = self.kink_force[i] - rho * (radius - 1.0);
            if radius < KINK_REACH && force > 0.0 {
                total += 0.5 * force * force / rho;
                let (da, db) = radius_gradient(&a, &b);
                add(before[i], da * force);
                add(i, (db - da) * force);
                add(next[i], db * -force);
            }
        }
        total
    }

    fn precondition(&mut self, direction: &mut [f64]) {
        for k in 0..3 {
            for i in 0..self.n {
                self.column[i] = direction[3 * i + k];
            }
            self.preconditioner.solve_in_place(&mut self.column, 1);
            for i in 0..self.n {
                direction[3 * i + k] = self.column[i];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::lbfgs::Objective;
    use super::*;
    use topo_core::finite_difference_gradient;

    #[test]
    fn gradient_is_that_of_the_lagrangian() {
        // A trefoil, and a circle and a trefoil linked.
        for (word, n) in [(&[1, 1, 1][..], 70), (&[1, 1, 1, 2, 2], 110)] {
            check_gradient(crate::braid_closure(word).expect("closed").into(), n);
        }
    }

    fn check_gradient(curves: Curves, n: usize) {
        let curves = curves.resampled(n).expect("resampled");
        let curves = curves.scaled(0.8).expect("scaled");
        let mut problem = Problem::new(&curves).expect("a problem");
        let mut x = curves.coordinates();
        // Unequal edges: the shorter of two equal ones has no derivative.
        x.iter_mut()
            .enumerate()
            .for_each(|(i, c)| *c *= 1.0 + 0.02 * (1.7 * i as f64).sin());
        problem.watch(&x);
        problem.strut_force.fill(0.3);
        problem.kink_force.fill(0.2);
        let mut gradient = vec![0.0; x.len()];
        problem.value(&x, &mut gradient);
        let mut unused = vec![0.0; x.len()];
        let numeric = finite_difference_gradient(|x| problem.value(x, &mut unused), &x, 1e-5);
        let size = gradient.iter().fold(0.0_f64, |a, g| a.max(g.abs()));
        for (a, b) in gradient.iter().zip(&numeric) {
            assert!((a - b).abs() < 1e-5 * size, "{a} {b}");
        }
    }
}
