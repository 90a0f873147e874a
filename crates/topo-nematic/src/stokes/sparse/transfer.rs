//! Linear interpolation from a coarse to a fine grid that fill the same box, and its adjoint.

use super::operator::Operator;

/// Of each fine place along one axis: two coarse places and their weights.
type Weights = Vec<[(usize, f64); 2]>;

/// Interpolation of one component.
pub(super) struct Transfer {
    axes: [Weights; 3],
    coarse_cells: [usize; 3],
    fine_cells: [usize; 3],
    /// Ratio of the cell volumes, fine over coarse.
    volume: f64,
    /// One coarse row.
    row: Vec<f64>,
}

impl Transfer {
    pub fn new(fine: &Operator, coarse: &Operator) -> Self {
        let ratio = |axis: usize| coarse.cells[axis] as f64 / fine.cells[axis] as f64;
        Self {
            axes: [0, 1, 2].map(|axis| weights(fine, coarse.cells[axis], axis)),
            coarse_cells: coarse.cells,
            fine_cells: fine.cells,
            volume: (0..3).map(ratio).product(),
            row: vec![0.0; coarse.cells[0]],
        }
    }

    /// Adds the interpolated `coarse` to `fine`.
    pub fn prolong(&mut self, coarse: &[f64], fine: &mut [f64]) {
        let n = self.coarse_cells[0];
        let Self { axes, row, .. } = self;
        for (place, fine) in fine.chunks_exact_mut(self.fine_cells[0]).enumerate() {
            row.fill(0.0);
            for (start, weight) in coarse_rows(axes, self.fine_cells, self.coarse_cells, place) {
                for (r, c) in row.iter_mut().zip(&coarse[start..start + n]) {
                    *r += weight * c;
                }
            }
            for (x, [(a, w_a), (b, w_b)]) in fine.iter_mut().zip(&axes[0]) {
                *x += w_a * row[*a] + w_b * row[*b];
            }
        }
    }

    /// Writes the adjoint, averaged: what a coarse cell gets of the residuals in `fine`.
    pub fn restrict(&mut self, fine: &[f64], coarse: &mut [f64]) {
        let n = self.coarse_cells[0];
        let Self { axes, row, .. } = self;
        coarse.fill(0.0);
        for (place, fine) in fine.chunks_exact(self.fine_cells[0]).enumerate() {
            row.fill(0.0);
            for (x, [(a, w_a), (b, w_b)]) in fine.iter().zip(&axes[0]) {
                row[*a] += w_a * x;
                row[*b] += w_b * x;
            }
            for (start, weight) in coarse_rows(axes, self.fine_cells, self.coarse_cells, place) {
                let weight = weight * self.volume;
                for (c, r) in coarse[start..start + n].iter_mut().zip(row.iter()) {
                    *c += weight * r;
                }
            }
        }
    }

    pub fn n_bytes(&self) -> usize {
        let n: usize = self.axes.iter().map(Vec::len).sum();
        n * size_of::<[(usize, f64); 2]>() + self.row.len() * size_of::<f64>()
    }
}

/// The four coarse rows around fine row `place`, and their weights.
fn coarse_rows(
    axes: &[Weights; 3],
    fine: [usize; 3],
    coarse: [usize; 3],
    place: usize,
) -> impl Iterator<Item = (usize, f64)> {
    let (y, z) = (axes[1][place % fine[1]], axes[2][place / fine[1]]);
    z.into_iter()
        .flat_map(move |(k, w_k)| y.map(|(j, w_j)| ((k * coarse[1] + j) * coarse[0], w_j * w_k)))
}

/// Weights along `axis`: faces along the component's own, centres along the others.
fn weights(fine: &Operator, n_coarse: usize, axis: usize) -> Weights {
    let n = fine.cells[axis];
    let offset = if axis == fine.component { 0.0 } else { 0.5 };
    let weight = |i: usize| {
        let at = (i as f64 + offset) * n_coarse as f64 / n as f64 - offset;
        let lower = at.floor();
        let t = at - lower;
        let ends = [lower as i64, lower as i64 + 1];
        let mut pair = [(0, 1.0 - t), (0, t)];
        for (place, (index, weight)) in ends.into_iter().zip(&mut pair) {
            let inside = (0..n_coarse as i64).contains(&place);
            if !inside && fine.reflects(axis) {
                *index = if place < 0 { 0 } else { n_coarse - 1 };
                *weight = -*weight;
            } else {
                *index = place.rem_euclid(n_coarse as i64) as usize;
            }
        }
        pair
    };
    (0..n).map(weight).collect()
}
