//! Convex quadratic programs with linear inequalities, by Mehrotra's predictor-corrector interior point method.

use topo_sparse::SparseCholesky;

use super::constraints::Row;
use crate::rings::Rings;

/// Hessian of the objective: for each of the three coordinates, a cyclic pentadiagonal block for each curve.
#[derive(Debug, Clone)]
pub(crate) struct Hessian {
    /// Which vertices each curve has.
    pub rings: Rings,
    /// Diagonal, first and second neighbour in the block of each curve.
    pub stencils: Vec<[f64; 3]>,
    /// Factor of the stencil for each coordinate.
    pub weights: [f64; 3],
}

impl Hessian {
    /// out = H y
    pub fn multiply(&self, y: &[f64], out: &mut [f64]) {
        for (range, [h0, h1, h2]) in self.rings.ranges().zip(&self.stencils) {
            let (n, own) = (3 * range.len(), 3 * range.start..3 * range.end);
            let (y, out) = (&y[own.clone()], &mut out[own]);
            for i in 0..n {
                let along = h0 * y[i]
                    + h1 * (y[(i + 3) % n] + y[(i + n - 3) % n])
                    + h2 * (y[(i + 6) % n] + y[(i + n - 6) % n]);
                out[i] = self.weights[i % 3] * along;
            }
        }
    }
}

/// Solution of a quadratic program.
#[derive(Debug, Default)]
pub(crate) struct Solution {
    /// Displacements, three numbers per vertex.
    pub y: Vec<f64>,
    /// Factorisations used.
    pub n_iterations: usize,
    /// Whether the tolerance was met.
    pub converged: bool,
}

/// Limit of interior point iterations; about ten are needed.
const MAX_ITERATIONS: usize = 40;

/// Minimises `y.H y/2 + gradient.y` subject to every row, to a duality gap of `tolerance`.
///
/// # References
/// [mehrotra1992], [nocedal2006]
///
/// [mehrotra1992]: https://doi.org/10.1137/0802028
/// [nocedal2006]: https://doi.org/10.1007/978-0-387-40065-5
pub(crate) fn solve(
    hessian: &Hessian,
    gradient: &[f64],
    rows: &[Row],
    tolerance: f64,
) -> Option<Solution> {
    let mut system = System::new(&hessian.rings, rows)?;
    if rows.is_empty() {
        return system.solve_free(hessian, gradient);
    }
    let mut at = Iterate::new(gradient, rows);
    let scale = gradient.iter().fold(1e-300_f64, |a, g| a.max(g.abs()));
    let mut n_iterations = 0;
    let mut converged;
    loop {
        let worst_dual = at.find_dual_residual(hessian, gradient, rows);
        let worst_primal = at.find_primal_residual(rows);
        let gap: f64 = at.products().sum();
        if !(gap.is_finite() && worst_dual.is_finite()) {
            return None;
        }
        converged = gap < tolerance && worst_primal < 1e-7 && worst_dual < 1e-5 * scale;
        if converged || n_iterations >= MAX_ITERATIONS {
            break;
        }
        n_iterations += 1;
        at.weigh();
        system.assemble(hessian, rows, &at.weights);
        if system.matrix.factor().is_err() {
            break;
        }
        at.predict(&mut system, rows);
        at.correct(&mut system, rows, gap / rows.len() as f64);
        at.advance();
    }
    Some(Solution {
        y: at.y,
        n_iterations,
        converged,
    })
}

/// The present point and direction of the iteration: vectors over the coordinates and over the rows.
struct Iterate {
    y: Vec<f64>,
    slack: Vec<f64>,
    multiplier: Vec<f64>,
    dual_residual: Vec<f64>,
    primal_residual: Vec<f64>,
    /// Multiplier over slack.
    weights: Vec<f64>,
    /// What the products of slack and multiplier are to lose.
    correction: Vec<f64>,
    step: Vec<f64>,
    d_slack: Vec<f64>,
    d_multiplier: Vec<f64>,
}

impl Iterate {
    fn new(gradient: &[f64], rows: &[Row]) -> Self {
        let (dim, m) = (gradient.len(), rows.len());
        // A tube at rest carries tension 1: each vertex gathers about the force of one edge from its rows.
        let force = gradient.iter().map(|g| g.abs()).sum::<f64>() / m as f64;
        let slack: Vec<f64> = rows.iter().map(|r| (-r.bound).max(0.02)).collect();
        let mean_slack = slack.iter().sum::<f64>() / m as f64;
        let multiplier = slack
            .iter()
            .map(|s| 0.5 * force * mean_slack / (s + 0.1 * mean_slack))
            .collect();
        Self {
            y: vec![0.0; dim],
            slack,
            multiplier,
            dual_residual: gradient.to_vec(),
            primal_residual: vec![0.0; m],
            weights: vec![0.0; m],
            correction: vec![0.0; m],
            step: vec![0.0; dim],
            d_slack: vec![0.0; m],
            d_multiplier: vec![0.0; m],
        }
    }

    /// Residual of the balance of forces; returns the largest.
    fn find_dual_residual(&mut self, hessian: &Hessian, gradient: &[f64], rows: &[Row]) -> f64 {
        hessian.multiply(&self.y, &mut self.dual_residual);
        self.dual_residual
            .iter_mut()
            .zip(gradient)
            .for_each(|(r, g)| *r += g);
        for (row, l) in rows.iter().zip(&self.multiplier) {
            row.add(-l, &mut self.dual_residual);
        }
        self.dual_residual
            .iter()
            .fold(0.0_f64, |a, r| a.max(r.abs()))
    }

    /// Residuals of the rows; returns the largest.
    fn find_primal_residual(&mut self, rows: &[Row]) -> f64 {
        let mut worst = 0.0_f64;
        for (k, row) in rows.iter().enumerate() {
            self.primal_residual[k] = row.dot(&self.y) - self.slack[k] - row.bound;
            worst = worst.max(self.primal_residual[k].abs());
        }
        worst
    }

    /// Slack times multiplier of each row: all zero at the solution.
    fn products(&self) -> impl Iterator<Item = f64> {
        self.slack.iter().zip(&self.multiplier).map(|(s, l)| s * l)
    }

    fn weigh(&mut self) {
        for k in 0..self.weights.len() {
            self.weights[k] = self.multiplier[k] / self.slack[k];
        }
    }

    /// Predictor: straight for complementarity.
    fn predict(&mut self, system: &mut System, rows: &[Row]) {
        for k in 0..rows.len() {
            self.correction[k] = self.slack[k] * self.multiplier[k];
        }
        self.find_direction(system, rows);
    }

    /// Corrector: takes in the second order of the predictor, and as much centring as that was cut short; `mean` is the mean
    /// product now.
    fn correct(&mut self, system: &mut System, rows: &[Row], mean: f64) {
        let reach = self.reach();
        let m = rows.len();
        let affine: f64 = (0..m)
            .map(|k| {
                (self.slack[k] + reach * self.d_slack[k])
                    * (self.multiplier[k] + reach * self.d_multiplier[k])
            })
            .sum::<f64>()
            / m as f64;
        let centring = (affine / mean).clamp(0.0, 1.0).powi(3) * mean;
        for k in 0..m {
            self.correction[k] = self.slack[k] * self.multiplier[k]
                + self.d_slack[k] * self.d_multiplier[k]
                - centring;
        }
        self.find_direction(system, rows);
    }

    /// The Newton direction of the factored system for the correction.
    fn find_direction(&mut self, system: &mut System, rows: &[Row]) {
        self.step
            .iter_mut()
            .zip(&self.dual_residual)
            .for_each(|(s, r)| *s = -r);
        for (k, row) in rows.iter().enumerate() {
            row.add(
                -(self.correction[k] / self.slack[k] + self.weights[k] * self.primal_residual[k]),
                &mut self.step,
            );
        }
        system.matrix.solve_in_place(&mut self.step, 1);
        for (k, row) in rows.iter().enumerate() {
            self.d_slack[k] = row.dot(&self.step) + self.primal_residual[k];
            self.d_multiplier[k] =
                -self.correction[k] / self.slack[k] - self.weights[k] * self.d_slack[k];
        }
    }

    /// Share of the direction that keeps slacks and multipliers positive.
    fn reach(&self) -> f64 {
        longest_step(&self.slack, &self.d_slack)
            .min(longest_step(&self.multiplier, &self.d_multiplier))
    }

    fn advance(&mut self) {
        let reach = (0.995 * self.reach()).min(1.0);
        for (y, d) in self.y.iter_mut().zip(&self.step) {
            *y += reach * d;
        }
        for k in 0..self.slack.len() {
            self.slack[k] += reach * self.d_slack[k];
            self.multiplier[k] += reach * self.d_multiplier[k];
        }
    }
}

/// Largest step that keeps all values positive (above 1 when none falls fast).
fn longest_step(values: &[f64], steps: &[f64]) -> f64 {
    let mut reach = 1.1_f64;
    for (v, d) in values.iter().zip(steps) {
        if *d < 0.0 {
            reach = reach.min(-v / d);
        }
    }
    reach
}

/// The matrix H + A^T W A with its fixed pattern, and where each 3 x 3 block of each row goes.
struct System {
    matrix: SparseCholesky,
    /// Slots of the entries of each block (higher vertex, lower vertex), row by row.
    blocks: Vec<[u32; 9]>,
    /// Blocks of the objective: for each vertex itself, its first and second neighbour.
    stencil: Vec<[u32; 3]>,
    /// Blocks of each row, in the order of its pairs.
    row_blocks: Vec<[u32; 10]>,
}

/// A pair of vertices as one number, the larger in front.
fn key(i: usize, j: usize) -> u64 {
    ((i.max(j) as u64) << 32) | i.min(j) as u64
}

/// The pairs of vertices that share an entry of the matrix: neighbours, and those of each row; in order.
fn coupled(next: &[usize], rows: &[Row]) -> Vec<u64> {
    let mut keys: Vec<u64> = Vec::with_capacity(3 * next.len() + 10 * rows.len());
    for (i, &after) in next.iter().enumerate() {
        keys.extend([key(i, i), key(i, after), key(i, next[after])]);
    }
    for row in rows {
        for a in 0..row.n() {
            for b in 0..=a {
                keys.push(key(row.vertices[a] as usize, row.vertices[b] as usize));
            }
        }
    }
    keys.sort_unstable();
    keys.dedup();
    keys
}

impl System {
    fn new(rings: &Rings, rows: &[Row]) -> Option<Self> {
        let (n, next) = (rings.n(), rings.next());
        let keys = coupled(&next, rows);
        let mut pattern = Vec::with_capacity(9 * keys.len());
        for k in &keys {
            let (i, j) = ((k >> 32) as u32, *k as u32);
            for p in 0..3 {
                for q in 0..3 {
                    if i != j || q <= p {
                        pattern.push((3 * i + p, 3 * j + q));
                    }
                }
            }
        }
        let matrix = SparseCholesky::new(3 * n, &pattern).ok()?;
        let mut blocks = Vec::with_capacity(keys.len());
        for k in &keys {
            let (i, j) = ((k >> 32) as usize, *k as u32 as usize);
            let mut slots = [0; 9];
            for p in 0..3 {
                for q in 0..3 {
                    slots[3 * p + q] = matrix.slot(3 * i + p, 3 * j + q)? as u32;
                }
            }
            blocks.push(slots);
        }
        let find = |i: usize, j: usize| keys.binary_search(&key(i, j)).ok().map(|k| k as u32);
        let mut stencil = Vec::with_capacity(n);
        for (i, &after) in next.iter().enumerate() {
            stencil.push([find(i, i)?, find(i, after)?, find(i, next[after])?]);
        }
        let mut row_blocks = Vec::with_capacity(rows.len());
        for row in rows {
            let mut places = [0; 10];
            let mut k = 0;
            for a in 0..row.n() {
                for b in 0..=a {
                    places[k] = find(row.vertices[a] as usize, row.vertices[b] as usize)?;
                    k += 1;
                }
            }
            row_blocks.push(places);
        }
        Some(Self {
            matrix,
            blocks,
            stencil,
            row_blocks,
        })
    }

    /// The minimum without rows: one linear system.
    fn solve_free(&mut self, hessian: &Hessian, gradient: &[f64]) -> Option<Solution> {
        self.assemble(hessian, &[], &[]);
        self.matrix.factor().ok()?;
        let mut y: Vec<f64> = gradient.iter().map(|g| -g).collect();
        self.matrix.solve_in_place(&mut y, 1);
        Some(Solution {
            y,
            n_iterations: 1,
            converged: true,
        })
    }

    fn assemble(&mut self, hessian: &Hessian, rows: &[Row], weights: &[f64]) {
        let values = self.matrix.values_mut();
        values.fill(0.0);
        for (range, stencil) in hessian.rings.ranges().zip(&hessian.stencils) {
            for places in &self.stencil[range] {
                for (place, h) in places.iter().zip(stencil) {
                    let slots = &self.blocks[*place as usize];
                    for p in 0..3 {
                        values[slots[4 * p] as usize] += hessian.weights[p] * h;
                    }
                }
            }
        }
        for ((row, places), w) in rows.iter().zip(&self.row_blocks).zip(weights) {
            let mut k = 0;
            for a in 0..row.n() {
                for b in 0..=a {
                    let slots = &self.blocks[places[k] as usize];
                    let swapped = row.vertices[a] < row.vertices[b];
                    let (high, low) = if swapped { (b, a) } else { (a, b) };
                    let (g, h) = (row.gradients[high] * *w, row.gradients[low]);
                    for p in 0..3 {
                        let end = if a == b { p + 1 } else { 3 };
                        for q in 0..end {
                            values[slots[3 * p + q] as usize] += g[p] * h[q];
                        }
                    }
                    k += 1;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::V;
    use crate::tighten::constraints::Guard;

    fn row(vertices: [u32; 4], gradients: [V; 4], bound: f64) -> Row {
        Row {
            guard: Guard::Strut,
            vertices,
            gradients,
            bound,
        }
    }

    #[test]
    fn active_and_idle_rows_are_distinguished() {
        // Each vertex is drawn to (1, 0, 0); the first row keeps vertex 0 above y = 2, the second one is idle.
        let gradient: Vec<f64> = (0..8).flat_map(|_| [-2.0, 0.0, 0.0]).collect();
        let rows = [
            row(
                [0, 1, 2, 3],
                [V::y(), V::zeros(), V::zeros(), V::zeros()],
                2.0,
            ),
            row(
                [5, 4, 6, 7],
                [V::x(), V::zeros(), V::zeros(), V::zeros()],
                -3.0,
            ),
        ];
        let hessian = Hessian {
            rings: Rings::one(8),
            stencils: vec![[2.0, 0.0, 0.0]],
            weights: [1.0; 3],
        };
        let found = solve(&hessian, &gradient, &rows, 1e-10).expect("solved");
        assert!(found.converged);
        for (i, y) in found.y.chunks_exact(3).enumerate() {
            let expected = V::new(1.0, if i == 0 { 2.0 } else { 0.0 }, 0.0);
            assert!(
                (V::from_column_slice(y) - expected).norm() < 1e-5,
                "{i}: {y:?}"
            );
        }
    }

    #[test]
    fn without_rows_it_is_a_linear_system() {
        let gradient: Vec<f64> = (0..30).map(|k| (k as f64).sin()).collect();
        let hessian = Hessian {
            rings: Rings::of([4, 6]),
            stencils: vec![[7.5, -2.0, 0.5], [6.5, -4.0, 1.0]],
            weights: [1.0; 3],
        };
        let found = solve(&hessian, &gradient, &[], 1e-9).expect("solved");
        let mut product = vec![0.0; 30];
        hessian.multiply(&found.y, &mut product);
        assert!(
            product
                .iter()
                .zip(&gradient)
                .all(|(p, g)| (p + g).abs() < 1e-10)
        );
    }
}
