//! Fourier transforms of planes and lines: the one file that names rustfft and realfft.
//!
//! ```math
//! X_k = \sum_{j=0}^{n-1} x_j\, e^{-2\pi i\, jk/n}, \qquad n\, x_j = \sum_{k=0}^{n-1} X_k\, e^{2\pi i\, jk/n}
//! ```
//!
//! Neither direction is normalised: forward and back multiplies by the number of points.
//!
//! The libraries are generic and compile their transforms in the crate that first uses them with doubles. This crate is separate so that
//! they are compiled once, and not again whenever the solvers change.

use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};

pub use rustfft::num_complex::Complex;

/// A complex number of the transforms.
pub type Complex64 = Complex<f64>;

/// Edge of the square blocks in which a plane is transposed: two of them fit in the first cache.
const BLOCK: usize = 8;

/// Unnormalised transforms of real planes of n_x x n_y numbers, x running fastest, into n_x/2 + 1 columns of n_y modes.
pub struct PlaneFft {
    n_x: usize,
    n_y: usize,
    forward_x: Arc<dyn RealToComplex<f64>>,
    inverse_x: Arc<dyn ComplexToReal<f64>>,
    forward_y: Arc<dyn Fft<f64>>,
    inverse_y: Arc<dyn Fft<f64>>,
}

/// What one thread needs to transform a plane.
pub struct PlaneScratch {
    row: Vec<f64>,
    /// Row after row of modes along x.
    rows: Vec<Complex64>,
    /// Column after column, transposed.
    columns: Vec<Complex64>,
    fft: Vec<Complex64>,
}

impl PlaneScratch {
    /// Bytes of the buffers.
    pub fn n_bytes(&self) -> usize {
        let n_modes = self.rows.len() + self.columns.len() + self.fft.len();
        n_modes * size_of::<Complex64>() + self.row.len() * size_of::<f64>()
    }
}

impl PlaneFft {
    /// Plans the transforms of planes of `n_x` x `n_y` numbers.
    pub fn new(n_x: usize, n_y: usize) -> Self {
        let (mut real, mut complex) = (RealFftPlanner::new(), FftPlanner::new());
        Self {
            n_x,
            n_y,
            forward_x: real.plan_fft_forward(n_x),
            inverse_x: real.plan_fft_inverse(n_x),
            forward_y: complex.plan_fft_forward(n_y),
            inverse_y: complex.plan_fft_inverse(n_y),
        }
    }

    /// Columns of a transformed plane.
    pub fn n_columns(&self) -> usize {
        self.n_x / 2 + 1
    }

    /// Working memory for one thread.
    pub fn scratch(&self) -> PlaneScratch {
        let n_fft = [
            self.forward_x.get_scratch_len(),
            self.inverse_x.get_scratch_len(),
            self.forward_y.get_outofplace_scratch_len(),
            self.inverse_y.get_outofplace_scratch_len(),
        ];
        let zero = Complex64::default();
        PlaneScratch {
            row: vec![0.0; self.n_x],
            rows: vec![zero; self.n_columns() * self.n_y],
            columns: vec![zero; self.n_columns() * self.n_y],
            fft: vec![zero; n_fft.into_iter().max().unwrap_or(0)],
        }
    }

    /// Transforms a plane: `fill(j, row)` writes row j and returns whether it did (else the row counts as zero); `emit(column,
    /// transform)` passes its destination of n_y modes to `transform`.
    pub fn forward(
        &self,
        s: &mut PlaneScratch,
        mut fill: impl FnMut(usize, &mut [f64]) -> bool,
        mut emit: impl FnMut(usize, &mut dyn FnMut(&mut [Complex64])),
    ) {
        let n = self.n_columns();
        for (j, modes) in s.rows.chunks_exact_mut(n).enumerate() {
            if fill(j, &mut s.row) {
                // Lengths are right by construction, the only thing that can fail.
                let _ = self
                    .forward_x
                    .process_with_scratch(&mut s.row, modes, &mut s.fft);
            } else {
                modes.fill(Complex64::default());
            }
        }
        transpose(&s.rows, &mut s.columns, self.n_y, n);
        for (column, modes) in s.columns.chunks_exact_mut(self.n_y).enumerate() {
            emit(column, &mut |out| {
                self.forward_y
                    .process_outofplace_with_scratch(modes, out, &mut s.fft);
            });
        }
    }

    /// Transforms a plane back: `take(column, transform)` passes the n_y modes of a column, which are overwritten, to
    /// `transform`; `keep(j)` returns whether row j is needed, and `emit(j, row)` receives it.
    pub fn inverse(
        &self,
        s: &mut PlaneScratch,
        mut take: impl FnMut(usize, &mut dyn FnMut(&mut [Complex64])),
        keep: impl Fn(usize) -> bool,
        mut emit: impl FnMut(usize, &mut dyn FnMut(&mut [f64]), &mut [f64]),
    ) {
        let n = self.n_columns();
        for (column, out) in s.columns.chunks_exact_mut(self.n_y).enumerate() {
            take(column, &mut |modes| {
                self.inverse_y
                    .process_outofplace_with_scratch(modes, out, &mut s.fft);
            });
        }
        transpose(&s.columns, &mut s.rows, n, self.n_y);
        for (j, modes) in s.rows.chunks_exact_mut(n).enumerate() {
            if !keep(j) {
                continue;
            }
            // Real by symmetry; round-off would be refused.
            modes[0].im = 0.0;
            if self.n_x.is_multiple_of(2) {
                modes[n - 1].im = 0.0;
            }
            let fft = &mut s.fft;
            emit(
                j,
                &mut |row| {
                    let _ = self.inverse_x.process_with_scratch(modes, row, fft);
                },
                &mut s.row,
            );
        }
    }
}

/// Unnormalised complex transforms of lines.
pub struct LineFft {
    forward: Arc<dyn Fft<f64>>,
    inverse: Arc<dyn Fft<f64>>,
}

impl LineFft {
    /// Plans the transforms of lines of `n` numbers.
    pub fn new(n: usize) -> Self {
        let mut planner = FftPlanner::new();
        Self {
            forward: planner.plan_fft_forward(n),
            inverse: planner.plan_fft_inverse(n),
        }
    }

    /// Working memory for one thread.
    pub fn scratch(&self) -> Vec<Complex64> {
        let n = self
            .forward
            .get_inplace_scratch_len()
            .max(self.inverse.get_inplace_scratch_len());
        vec![Complex64::default(); n]
    }

    /// Transforms each line in `lines`.
    pub fn forward(&self, lines: &mut [Complex64], scratch: &mut [Complex64]) {
        self.forward.process_with_scratch(lines, scratch);
    }

    /// Transforms each line in `lines` back.
    pub fn inverse(&self, lines: &mut [Complex64], scratch: &mut [Complex64]) {
        self.inverse.process_with_scratch(lines, scratch);
    }
}

/// Writes the `n_rows` rows of `n_columns` numbers in `from` as columns of `to`.
fn transpose(from: &[Complex64], to: &mut [Complex64], n_rows: usize, n_columns: usize) {
    for row in (0..n_rows).step_by(BLOCK) {
        for column in (0..n_columns).step_by(BLOCK) {
            let rows = row..(row + BLOCK).min(n_rows);
            for c in column..(column + BLOCK).min(n_columns) {
                let line = &mut to[c * n_rows..][rows.clone()];
                for (r, x) in rows.clone().zip(line) {
                    *x = from[r * n_columns + c];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn plane_modes_are_those_of_the_definition() {
        for (n_x, n_y) in [(6, 5), (5, 4)] {
            let value = |i: usize, j: usize| ((3 * i + 7 * j * j + i * j) % 11) as f64;
            let fft = PlaneFft::new(n_x, n_y);
            let mut scratch = fft.scratch();
            let mut modes = vec![Complex64::default(); fft.n_columns() * n_y];
            fft.forward(
                &mut scratch,
                |j, row| {
                    row.iter_mut()
                        .enumerate()
                        .for_each(|(i, x)| *x = value(i, j));
                    j != 2
                },
                |column, transform| transform(&mut modes[column * n_y..][..n_y]),
            );
            let at = |i, j| if j == 2 { 0.0 } else { value(i, j) };
            for kx in 0..fft.n_columns() {
                for ky in 0..n_y {
                    let mut sum = Complex64::default();
                    for (i, j) in (0..n_x).flat_map(|i| (0..n_y).map(move |j| (i, j))) {
                        let phase = (kx * i) as f64 / n_x as f64 + (ky * j) as f64 / n_y as f64;
                        sum += Complex64::from_polar(at(i, j), -TAU * phase);
                    }
                    assert!((sum - modes[kx * n_y + ky]).norm() < 1e-11);
                }
            }
            let mut n_rows = 0;
            fft.inverse(
                &mut scratch,
                |column, transform| transform(&mut modes[column * n_y..][..n_y]),
                |j| j != 1,
                |j, transform, row| {
                    transform(row);
                    n_rows += 1;
                    for (i, x) in row.iter().enumerate() {
                        assert!((x / (n_x * n_y) as f64 - at(i, j)).abs() < 1e-13);
                    }
                },
            );
            assert_eq!(n_rows, n_y - 1);
        }
    }
}
