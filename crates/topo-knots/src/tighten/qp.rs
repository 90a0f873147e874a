//! Convex quadratic programs with linear inequalities, by Mehrotra's predictor-corrector interior point method.

use topo_sparse::SparseCholesky;

use super::constraints::Row;

/// Hessian of the objective: a cyclic pentadiagonal matrix for each of the three coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hessian {
    /// Diagonal, first and second neighbour.
    pub stencil: [f64; 3],
    /// Factor of the stencil for each coordinate.
    pub weights: [f64; 3],
}

impl Hessian {
    /// out = H y
    pub fn multiply(&self, y: &[f64], out: &mut [f64]) {
        let n = y.len();
        let [h0, h1, h2] = self.stencil;
        for i in 0..n {
            let along = h0 * y[i]
                + h1 * (y[(i + 3) % n] + y[(i + n - 3) % n])
                + h2 * (y[(i + 6) % n] + y[(i + n - 6) % n]);
            out[i] = self.weights[i % 3] * along;
        }
    }
}

/// Solution of a quadratic program.
#[derive(Debug, Default)]
pub(crate) struct Solution {
    /// Displacements, three numbers a vertex.
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
/// `mehrotra1992`, `nocedal2006`
pub(crate) fn solve(
    hessian: Hessian,
    gradient: &[f64],
    rows: &[Row],
    tolerance: f64,
) -> Option<Solution> {
    let (dim, m) = (gradient.len(), rows.len());
    let mut system = System::new(dim / 3, rows)?;
    let mut y = vec![0.0; dim];
    let mut dual_residual = gradient.to_vec();
    let mut step = vec![0.0; dim];
    if m == 0 {
        system.assemble(hessian, rows, &[]);
        system.matrix.factor().ok()?;
        y.iter_mut().zip(gradient).for_each(|(y, g)| *y = -g);
        system.matrix.solve_in_place(&mut y, 1);
        return Some(Solution {
            y,
            n_iterations: 1,
            converged: true,
        });
    }
    // A tube at rest carries tension 1: each vertex gathers about the force of one edge from its rows.
    let force = gradient.iter().map(|g| g.abs()).sum::<f64>() / m as f64;
    let mut slack: Vec<f64> = rows.iter().map(|r| (-r.bound).max(0.02)).collect();
    let mean_slack = slack.iter().sum::<f64>() / m as f64;
    let mut multiplier: Vec<f64> = slack
        .iter()
        .map(|s| 0.5 * force * mean_slack / (s + 0.1 * mean_slack))
        .collect();
    let mut weights = vec![0.0; m];
    let mut primal_residual = vec![0.0; m];
    let (mut d_slack, mut d_multiplier) = (vec![0.0; m], vec![0.0; m]);
    let mut correction = vec![0.0; m];
    let scale = gradient.iter().fold(1e-300_f64, |a, g| a.max(g.abs()));
    let mut n_iterations = 0;
    let mut converged;
    loop {
        hessian.multiply(&y, &mut dual_residual);
        dual_residual
            .iter_mut()
            .zip(gradient)
            .for_each(|(r, g)| *r += g);
        for (row, l) in rows.iter().zip(&multiplier) {
            row.add(-l, &mut dual_residual);
        }
        let mut worst_primal = 0.0_f64;
        for (k, row) in rows.iter().enumerate() {
            primal_residual[k] = row.dot(&y) - slack[k] - row.bound;
            worst_primal = worst_primal.max(primal_residual[k].abs());
        }
        let worst_dual = dual_residual.iter().fold(0.0_f64, |a, r| a.max(r.abs()));
        let gap: f64 = slack.iter().zip(&multiplier).map(|(s, l)| s * l).sum();
        if !(gap.is_finite() && worst_dual.is_finite()) {
            return None;
        }
        converged = gap < tolerance && worst_primal < 1e-7 && worst_dual < 1e-5 * scale;
        if converged || n_iterations >= MAX_ITERATIONS {
            break;
        }
        n_iterations += 1;
        for k in 0..m {
            weights[k] = multiplier[k] / slack[k];
        }
        system.assemble(hessian, rows, &weights);
        if system.matrix.factor().is_err() {
            break;
        }
        let mean = gap / m as f64;
        // Predictor: straight for complementarity.
        for k in 0..m {
            correction[k] = slack[k] * multiplier[k];
        }
        let mut direction = |correction: &[f64],
                             d_slack: &mut [f64],
                             d_multiplier: &mut [f64],
                             step: &mut [f64]| {
            step.iter_mut()
                .zip(&dual_residual)
                .for_each(|(s, r)| *s = -r);
            for (k, row) in rows.iter().enumerate() {
                row.add(
                    -(correction[k] / slack[k] + weights[k] * primal_residual[k]),
                    step,
                );
            }
            system.matrix.solve_in_place(step, 1);
            for (k, row) in rows.iter().enumerate() {
                d_slack[k] = row.dot(step) + primal_residual[k];
                d_multiplier[k] = -correction[k] / slack[k] - weights[k] * d_slack[k];
            }
        };
        direction(&correction, &mut d_slack, &mut d_multiplier, &mut step);
        let reach = longest_step(&slack, &d_slack).min(longest_step(&multiplier, &d_multiplier));
        let affine: f64 = (0..m)
            .map(|k| (slack[k] + reach * d_slack[k]) * (multiplier[k] + reach * d_multiplier[k]))
            .sum::<f64>()
            / m as f64;
        let centring = (affine / mean).clamp(0.0, 1.0).powi(3) * mean;
        for k in 0..m {
            correction[k] = slack[k] * multiplier[k] + d_slack[k] * d_multiplier[k] - centring;
        }
        direction(&correction, &mut d_slack, &mut d_multiplier, &mut step);
        let reach = longest_step(&slack, &d_slack).min(longest_step(&multiplier, &d_multiplier));
        let reach = (0.995 * reach).min(1.0);
        for (y, d) in y.iter_mut().zip(&step) {
            *y += reach * d;
        }
        for k in 0..m {
            slack[k] += reach * d_slack[k];
            multiplier[k] += reach * d_multiplier[k];
        }
    }
    Some(Solution {
        y,
        n_iterations,
        converged,
    })
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

impl System {
    fn new(n: usize, rows: &[Row]) -> Option<Self> {
        let mut keys: Vec<u64> = Vec::with_capacity(3 * n + 10 * rows.len());
        let key = |i: usize, j: usize| ((i.max(j) as u64) << 32) | i.min(j) as u64;
        for i in 0..n {
            keys.extend([key(i, i), key(i, (i + 1) % n), key(i, (i + 2) % n)]);
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
        for i in 0..n {
            stencil.push([find(i, i)?, find(i, (i + 1) % n)?, find(i, (i + 2) % n)?]);
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

    fn assemble(&mut self, hessian: Hessian, rows: &[Row], weights: &[f64]) {
        let values = self.matrix.values_mut();
        values.fill(0.0);
        for places in &self.stencil {
            for (place, h) in places.iter().zip(hessian.stencil) {
                let slots = &self.blocks[*place as usize];
                for p in 0..3 {
                    values[slots[4 * p] as usize] += hessian.weights[p] * h;
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
    fn active_and_idle_rows_are_told_apart() {
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
            stencil: [2.0, 0.0, 0.0],
            weights: [1.0; 3],
        };
        let found = solve(hessian, &gradient, &rows, 1e-10).expect("solved");
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
            stencil: [6.5, -4.0, 1.0],
            weights: [1.0; 3],
        };
        let found = solve(hessian, &gradient, &[], 1e-9).expect("solved");
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
