//! Lowest eigenvalues of a symmetric tridiagonal matrix, and the eigenvector of the lowest.

/// A symmetric tridiagonal matrix that grows by a row at a time.
#[derive(Debug, Clone, Default)]
pub(super) struct Tridiagonal {
    pub diagonal: Vec<f64>,
    /// One shorter than the diagonal.
    pub beside: Vec<f64>,
}

impl Tridiagonal {
    /// How many eigenvalues lie below `x` (Sturm's sequence).
    fn n_below(&self, x: f64) -> usize {
        let (mut count, mut pivot) = (0, f64::INFINITY);
        for (i, d) in self.diagonal.iter().enumerate() {
            let off = if i > 0 { self.beside[i - 1] } else { 0.0 };
            pivot = d - x - off * off / pivot;
            if pivot == 0.0 {
                pivot = f64::MIN_POSITIVE;
            }
            count += usize::from(pivot < 0.0);
        }
        count
    }

    /// Bounds of all eigenvalues, by Gershgorin's theorem.
    fn bounds(&self) -> [f64; 2] {
        let off = |i: usize| self.beside.get(i).map_or(0.0, |b| b.abs());
        let mut bounds = [f64::INFINITY, f64::NEG_INFINITY];
        for (i, d) in self.diagonal.iter().enumerate() {
            let around = off(i) + if i > 0 { off(i - 1) } else { 0.0 };
            bounds = [bounds[0].min(d - around), bounds[1].max(d + around)];
        }
        bounds
    }

    /// The eigenvalue of number `index` from below, to rounding.
    pub fn eigenvalue(&self, index: usize) -> f64 {
        let [mut low, mut high] = self.bounds();
        while high - low > 4.0 * f64::EPSILON * low.abs().max(high.abs()) {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if self.n_below(middle) > index {
                high = middle;
            } else {
                low = middle;
            }
        }
        0.5 * (low + high)
    }

    /// Unit eigenvector of the lowest eigenvalue `value`, its first entry not negative: three inverse iterations just below it, where
    /// all pivots are positive.
    pub fn eigenvector(&self, value: f64) -> Vec<f64> {
        let n = self.diagonal.len();
        let [low, high] = self.bounds();
        let scale = low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
        let shift = value - 1e-13 * scale;
        let mut pivots = vec![0.0; n];
        for i in 0..n {
            let before = if i > 0 {
                self.beside[i - 1].powi(2) / pivots[i - 1]
            } else {
                0.0
            };
            pivots[i] = (self.diagonal[i] - shift - before).max(1e-15 * scale);
        }
        let mut x = vec![1.0; n];
        for _ in 0..3 {
            for i in 1..n {
                x[i] -= self.beside[i - 1] / pivots[i - 1] * x[i - 1];
            }
            for i in 0..n {
                x[i] /= pivots[i];
            }
            for i in (1..n).rev() {
                x[i - 1] -= self.beside[i - 1] / pivots[i - 1] * x[i];
            }
            let norm = x.iter().map(|x| x * x).sum::<f64>().sqrt();
            x.iter_mut().for_each(|x| *x /= norm);
        }
        if x.first().is_some_and(|x| *x < 0.0) {
            x.iter_mut().for_each(|x| *x = -*x);
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lowest_pair_of_a_chain_is_the_closed_form_and_that_of_a_dense_solver() {
        // 2 - 2 cos(k pi/(n + 1)), with eigenvector sin(i k pi/(n + 1))
        let n = 40;
        let chain = Tridiagonal {
            diagonal: vec![2.0; n],
            beside: vec![-1.0; n - 1],
        };
        let angle = std::f64::consts::PI / (n + 1) as f64;
        for k in 0..2 {
            let exact = 2.0 - 2.0 * ((k + 1) as f64 * angle).cos();
            assert!((chain.eigenvalue(k) - exact).abs() < 1e-14);
        }
        let vector = chain.eigenvector(chain.eigenvalue(0));
        let norm = (2.0 / (n + 1) as f64).sqrt();
        for (i, x) in vector.iter().enumerate() {
            assert!((x - norm * ((i + 1) as f64 * angle).sin()).abs() < 1e-9);
        }
        let rough = Tridiagonal {
            diagonal: (0..30).map(|i| f64::from(i * 7 % 11)).collect(),
            beside: (0..29).map(|i| f64::from(i * 5 % 7) - 3.0).collect(),
        };
        let dense = nalgebra::DMatrix::from_fn(30, 30, |i, j| match i.abs_diff(j) {
            0 => rough.diagonal[i],
            1 => rough.beside[i.min(j)],
            _ => 0.0,
        });
        let mut values: Vec<f64> = dense.symmetric_eigenvalues().iter().copied().collect();
        values.sort_by(f64::total_cmp);
        assert!((rough.eigenvalue(0) - values[0]).abs() < 1e-12);
        assert!((rough.eigenvalue(1) - values[1]).abs() < 1e-12);
    }
}
