//! A symmetric multigrid cycle for one velocity component, over a factorised coarsest grid.

use topo_sparse::SparseCholesky;

use super::operator::Operator;
use super::transfer::Transfer;
use crate::stokes::StokesError;

/// Fewest cells along an axis that is still halved.
const SMALLEST: usize = 6;

/// Share of the smallest wave's decay rate that holds the uniform velocity of a periodic box.
const SHIFT: f64 = 0.1;

/// Approximate inverse of an [`Operator`], symmetric and positive definite.
pub(super) struct Multigrid {
    levels: Vec<Level>,
    /// Of the coarsest grid, and its factor.
    operator: Operator,
    factor: SparseCholesky,
    /// Right-hand side and solution of the coarsest grid.
    coarsest: Vec<f64>,
}

struct Level {
    operator: Operator,
    transfer: Transfer,
    rhs: Vec<f64>,
    solution: Vec<f64>,
    residual: Vec<f64>,
}

/// Cells of all grids, finest first.
pub(super) fn cells_of_levels(finest: [usize; 3], direct_up_to: usize) -> Vec<[usize; 3]> {
    let mut levels = vec![finest];
    let mut cells = finest;
    while cells.iter().product::<usize>() > direct_up_to {
        let coarser = cells.map(|n| if n >= SMALLEST { n.div_ceil(2) } else { n });
        if coarser == cells {
            break;
        }
        levels.push(coarser);
        cells = coarser;
    }
    levels
}

impl Multigrid {
    pub fn new(finest: Operator, direct_up_to: usize) -> Result<Self, StokesError> {
        let mut operator = finest;
        let mut levels = Vec::new();
        for cells in cells_of_levels(finest.cells, direct_up_to)
            .into_iter()
            .skip(1)
        {
            let coarser = operator.coarsened(cells);
            let zeros = || vec![0.0; operator.n()];
            levels.push(Level {
                transfer: Transfer::new(&operator, &coarser),
                rhs: zeros(),
                solution: zeros(),
                residual: zeros(),
                operator,
            });
            operator = coarser;
        }
        Ok(Self {
            levels,
            factor: factor(&operator)?,
            operator,
            coarsest: vec![0.0; operator.n()],
        })
    }

    /// `x` = approximately A^-1 `b`, by a cycle from zero.
    pub fn cycle(&mut self, b: &[f64], x: &mut [f64]) {
        if self.levels.is_empty() {
            x.copy_from_slice(b);
            self.factor.solve_in_place(x, 1);
            return;
        }
        self.levels[0].rhs.copy_from_slice(b);
        for depth in 0..self.levels.len() {
            let (above, below) = self.levels.split_at_mut(depth + 1);
            let level = &mut above[depth];
            level.solution.fill(0.0);
            level.operator.relax(&level.rhs, &mut level.solution, false);
            level
                .operator
                .residual(&level.rhs, &level.solution, &mut level.residual);
            let (operator, next) = match below.first_mut() {
                Some(next) => (next.operator, &mut next.rhs),
                None => (self.operator, &mut self.coarsest),
            };
            level.transfer.restrict(&level.residual, next);
            operator.clear_walls(next);
        }
        self.factor.solve_in_place(&mut self.coarsest, 1);
        for depth in (0..self.levels.len()).rev() {
            let (above, below) = self.levels.split_at_mut(depth + 1);
            let level = &mut above[depth];
            let coarse = below.first().map_or(&self.coarsest, |next| &next.solution);
            level.transfer.prolong(coarse, &mut level.solution);
            level.operator.clear_walls(&mut level.solution);
            level.operator.relax(&level.rhs, &mut level.solution, true);
        }
        x.copy_from_slice(&self.levels[0].solution);
    }

    pub fn n_bytes(&self) -> usize {
        let level = |l: &Level| 3 * l.rhs.len() * size_of::<f64>() + l.transfer.n_bytes();
        let entries = self.factor.n_factor_nonzeros() + self.factor.n_nonzeros();
        self.levels.iter().map(level).sum::<usize>()
            + (entries + 2 * self.coarsest.len()) * size_of::<f64>()
    }
}

/// Cholesky factor; what lies on walls is the identity.
fn factor(operator: &Operator) -> Result<SparseCholesky, StokesError> {
    let (mut diagonal, entries) = entries(operator);
    if operator.is_singular() {
        let decay = (0..3).map(|axis| {
            let wave = std::f64::consts::TAU / operator.cells[axis] as f64;
            operator.weights[axis] * wave * wave
        });
        let shift = SHIFT * decay.fold(f64::INFINITY, f64::min);
        diagonal.iter_mut().for_each(|d| *d += shift);
    }
    let pattern: Vec<(u32, u32)> = entries.iter().map(|&(a, b, _)| (a, b)).collect();
    let mut matrix = SparseCholesky::new(operator.n(), &pattern)?;
    for (a, b, value) in entries {
        if let Some(slot) = matrix.slot(a as usize, b as usize) {
            matrix.values_mut()[slot] += value;
        }
    }
    for (i, value) in diagonal.into_iter().enumerate() {
        if let Some(slot) = matrix.slot(i, i) {
            matrix.values_mut()[slot] += value;
        }
    }
    matrix.factor()?;
    Ok(matrix)
}

/// Diagonal of the operator, and its other entries, each pair once.
fn entries(operator: &Operator) -> (Vec<f64>, Vec<(u32, u32, f64)>) {
    let n_x = operator.cells[0];
    let mut entries: Vec<(u32, u32, f64)> = Vec::new();
    let mut add = |a: usize, b: usize, value: f64| {
        if a != b {
            entries.push((a as u32, b as u32, value));
        }
    };
    let mut diagonal = vec![1.0; operator.n()];
    let first = operator.first();
    let x_weight = operator.weights[0];
    for (_, row) in operator.rows() {
        for i in first..n_x {
            let place = row.start + i;
            let at_end = i == 0 || i + 1 == n_x;
            let reflected = if at_end && operator.reflects(0) {
                x_weight
            } else {
                0.0
            };
            diagonal[place] = row.diagonal + 2.0 * x_weight + reflected;
            // Each pair once: the neighbours above. On a wall, wrapping leads to what is held.
            let last = i + 1 == n_x;
            if !(last && operator.reflects(0)) {
                let east = row.start + (i + 1) % n_x;
                if !operator.on_wall(0, (i + 1) % n_x) {
                    add(place, east, -x_weight);
                }
            }
            for side in [1, 3] {
                let above = row.beside[side] + i;
                let axis = 1 + side / 2;
                let held = is_held(operator, above);
                if row.weights[side] > 0.0 && !held {
                    add(place, above, -operator.weights[axis]);
                }
            }
        }
    }
    (diagonal, entries)
}

/// Whether the face at `index` lies on a wall.
fn is_held(operator: &Operator, index: usize) -> bool {
    let [n_x, n_y, _] = operator.cells;
    let ijk = [index % n_x, index / n_x % n_y, index / n_x / n_y];
    (0..3).any(|axis| operator.on_wall(axis, ijk[axis]))
}
