//! Minus the 7-point Laplacian of one velocity component, and the gradient and divergence that couple it to pressure.

use crate::grid::{Faces, Grid};

/// Minus the Laplacian of the component along `component`, in units of the finest spacing.
///
/// A wall along the component's own axis holds its face 0, which stays zero and is skipped; the upper wall is reached by wrapping.
/// Walls along the other axes reflect: the ghost -u adds to the diagonal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Operator {
    pub cells: [usize; 3],
    pub faces: [Faces; 3],
    pub component: usize,
    /// Inverse squares of the spacings.
    pub weights: [f64; 3],
}

/// A row along x: the starts of the four rows beside it (the row itself where a wall reflects it), and its diagonal without x.
pub(super) struct Row {
    pub start: usize,
    pub beside: [usize; 4],
    /// Weights of these rows: zero where a wall reflects.
    pub weights: [f64; 4],
    pub diagonal: f64,
}

impl Operator {
    pub fn new(grid: &Grid, component: usize) -> Self {
        Self {
            cells: grid.cells(),
            faces: grid.faces(),
            component,
            weights: [1.0; 3],
        }
    }

    /// The same component on fewer cells that fill the same box.
    pub fn coarsened(&self, cells: [usize; 3]) -> Self {
        let ratio = |axis: usize| cells[axis] as f64 / self.cells[axis] as f64;
        Self {
            cells,
            weights: std::array::from_fn(|axis| self.weights[axis] * ratio(axis).powi(2)),
            ..*self
        }
    }

    pub fn n(&self) -> usize {
        self.cells.iter().product()
    }

    /// Whether nothing holds a uniform velocity.
    pub fn is_singular(&self) -> bool {
        self.faces == [Faces::Periodic; 3]
    }

    /// Whether walls reflect this component along `axis`.
    pub fn reflects(&self, axis: usize) -> bool {
        axis != self.component && self.faces[axis] == Faces::Wall
    }

    /// Whether `place` along `axis` is on the lower wall.
    pub fn on_wall(&self, axis: usize, place: usize) -> bool {
        axis == self.component && self.faces[axis] == Faces::Wall && place == 0
    }

    /// Row (j, k), unless it lies on a wall.
    pub fn row(&self, j: usize, k: usize) -> Option<Row> {
        if self.on_wall(1, j) || self.on_wall(2, k) {
            return None;
        }
        let [n_x, n_y, n_z] = self.cells;
        let start = (k * n_y + j) * n_x;
        let mut row = Row {
            start,
            beside: [start; 4],
            weights: [0.0; 4],
            diagonal: 0.0,
        };
        for (axis, place, n, stride) in [(1, j, n_y, n_x), (2, k, n_z, n_x * n_y)] {
            let weight = self.weights[axis];
            for up in [false, true] {
                let side = 2 * (axis - 1) + usize::from(up);
                let at_end = place == if up { n - 1 } else { 0 };
                if at_end && self.reflects(axis) {
                    // u - (-u).
                    row.diagonal += 2.0 * weight;
                    continue;
                }
                row.weights[side] = weight;
                row.diagonal += weight;
                row.beside[side] = match (up, at_end) {
                    (true, false) => start + stride,
                    (true, true) => start - (n - 1) * stride,
                    (false, false) => start - stride,
                    (false, true) => start + (n - 1) * stride,
                };
            }
        }
        Some(row)
    }

    /// All rows that are not on a wall.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = (usize, Row)> + '_ {
        let n_y = self.cells[1];
        (0..n_y * self.cells[2]).filter_map(move |row| {
            let (j, k) = (row % n_y, row / n_y);
            self.row(j, k).map(|row| (j + k, row))
        })
    }

    /// First place along x that is not on a wall.
    pub fn first(&self) -> usize {
        usize::from(self.on_wall(0, 0))
    }

    /// Diagonal entry at place i of a row, and the sum over its neighbours.
    #[inline(always)]
    pub fn stencil(&self, x: &[f64], row: &Row, i: usize) -> (f64, f64) {
        let n = self.cells[0];
        let weight = self.weights[0];
        let (mut diagonal, mut sum) = (row.diagonal + 2.0 * weight, 0.0);
        if i > 0 && i + 1 < n {
            sum += weight * (x[row.start + i - 1] + x[row.start + i + 1]);
        } else if self.reflects(0) {
            diagonal += weight;
            sum += weight * x[row.start + if i == 0 { 1 } else { n - 2 }];
        } else {
            sum += weight * (x[row.start + (i + n - 1) % n] + x[row.start + (i + 1) % n]);
        }
        for side in 0..4 {
            sum += row.weights[side] * x[row.beside[side] + i];
        }
        (diagonal, sum)
    }

    /// `y = A x`.
    pub fn apply(&self, x: &[f64], y: &mut [f64]) {
        self.clear_walls(y);
        for (_, row) in self.rows() {
            for i in self.first()..self.cells[0] {
                let (diagonal, sum) = self.stencil(x, &row, i);
                y[row.start + i] = diagonal * x[row.start + i] - sum;
            }
        }
    }

    /// `r = b - A x`.
    pub fn residual(&self, b: &[f64], x: &[f64], r: &mut [f64]) {
        self.clear_walls(r);
        for (_, row) in self.rows() {
            for i in self.first()..self.cells[0] {
                let (diagonal, sum) = self.stencil(x, &row, i);
                r[row.start + i] = b[row.start + i] + sum - diagonal * x[row.start + i];
            }
        }
    }

    /// One Gauss-Seidel sweep over both colours of the chequerboard; `reverse` is its adjoint.
    pub fn relax(&self, b: &[f64], x: &mut [f64], reverse: bool) {
        let n = self.cells[0];
        for pass in 0..2 {
            let colour = if reverse { 1 - pass } else { pass };
            let mut sweep = |(parity, row): (usize, Row)| {
                let first = self.first();
                let start = first + (first + parity + colour) % 2;
                let mut relax = |i: usize| {
                    let (diagonal, sum) = self.stencil(x, &row, i);
                    x[row.start + i] = (b[row.start + i] + sum) / diagonal;
                };
                if reverse {
                    (start..n).step_by(2).rev().for_each(&mut relax);
                } else {
                    (start..n).step_by(2).for_each(&mut relax);
                }
            };
            if reverse {
                self.rows().rev().for_each(&mut sweep);
            } else {
                self.rows().for_each(&mut sweep);
            }
        }
    }

    /// Sets what lies on walls to zero.
    pub fn clear_walls(&self, x: &mut [f64]) {
        if self.faces[self.component] == Faces::Periodic {
            return;
        }
        let [n_x, n_y, _] = self.cells;
        match self.component {
            0 => x.iter_mut().step_by(n_x).for_each(|x| *x = 0.0),
            1 => x
                .chunks_exact_mut(n_x * n_y)
                .for_each(|x| x[..n_x].fill(0.0)),
            _ => x[..n_x * n_y].fill(0.0),
        }
    }
}

/// Adds the pressure gradient along the component's axis.
pub(super) fn gradient(operator: &Operator, pressure: &[f64], force: &mut [f64]) {
    let n = operator.cells[0];
    let axis = operator.component;
    for (_, row) in operator.rows() {
        // The row below along y or z; along x, the cell before.
        let before = match axis {
            0 => row.start,
            _ => row.beside[2 * (axis - 1)],
        };
        for i in operator.first()..n {
            let lower = if axis == 0 { (i + n - 1) % n } else { i };
            force[row.start + i] += pressure[row.start + i] - pressure[before + lower];
        }
    }
}

/// Minus the divergence, the adjoint of [`gradient`].
pub(super) fn divergence(operators: &[Operator; 3], velocity: &[f64], outflow: &mut [f64]) {
    let [n_x, n_y, n_z] = operators[0].cells;
    let n = outflow.len();
    let (u_x, rest) = velocity.split_at(n);
    let (u_y, u_z) = rest.split_at(n);
    for (row, out) in outflow.chunks_exact_mut(n_x).enumerate() {
        let (j, k) = (row % n_y, row / n_y);
        let start = row * n_x;
        let above = |place: usize, n: usize, stride: usize| {
            if place + 1 < n {
                start + stride
            } else {
                start - (n - 1) * stride
            }
        };
        let (north, up) = (above(j, n_y, n_x), above(k, n_z, n_x * n_y));
        for (i, out) in out.iter_mut().enumerate() {
            let east = if i + 1 < n_x { start + i + 1 } else { start };
            *out = (u_x[start + i] - u_x[east])
                + (u_y[start + i] - u_y[north + i])
                + (u_z[start + i] - u_z[up + i]);
        }
    }
}
