//! Forward and back substitution with a supernodal factor.

/// Columns of the factor with the same rows below them: a dense triangle on a dense rectangle, stored column after column.
pub(super) struct Panel {
    /// First column, and the one after the last.
    pub begin: usize,
    pub end: usize,
    /// Where its values start.
    pub start: usize,
    /// Rows below the triangle.
    pub below: Vec<u32>,
}

impl Panel {
    pub fn n_columns(&self) -> usize {
        self.end - self.begin
    }

    pub fn n_rows(&self) -> usize {
        self.n_columns() + self.below.len()
    }

    fn values<'a>(&self, factor: &'a [f64]) -> &'a [f64] {
        &factor[self.start..self.start + self.n_rows() * self.n_columns()]
    }
}

/// Replaces `x` by the solution; `outer` has room for the rows below any panel.
///
/// These panels are too small for a general dense kernel to pay: this is four times as fast at one right-hand side.
pub(super) fn substitute(panels: &[Panel], factor: &[f64], x: &mut [f64], outer: &mut [f64]) {
    for panel in panels {
        let (n_columns, n_rows) = (panel.n_columns(), panel.n_rows());
        let added = &mut outer[..panel.below.len()];
        added.fill(0.0);
        let inner = &mut x[panel.begin..panel.end];
        for (k, column) in panel.values(factor).chunks_exact(n_rows).enumerate() {
            let pivoted = inner[k] / column[k];
            inner[k] = pivoted;
            subtract(&mut inner[k + 1..], &column[k + 1..n_columns], pivoted);
            subtract(added, &column[n_columns..], pivoted);
        }
        for (row, a) in panel.below.iter().zip(added.iter()) {
            x[*row as usize] += a;
        }
    }
    for panel in panels.iter().rev() {
        let (n_columns, n_rows) = (panel.n_columns(), panel.n_rows());
        let outer = &mut outer[..panel.below.len()];
        for (row, o) in panel.below.iter().zip(outer.iter_mut()) {
            *o = x[*row as usize];
        }
        let inner = &mut x[panel.begin..panel.end];
        for (k, column) in panel.values(factor).chunks_exact(n_rows).enumerate().rev() {
            let known =
                dot(&column[n_columns..], outer) + dot(&column[k + 1..n_columns], &inner[k + 1..]);
            inner[k] = (inner[k] - known) / column[k];
        }
    }
}

/// `y -= factor x`.
fn subtract(y: &mut [f64], x: &[f64], factor: f64) {
    for (y, x) in y.iter_mut().zip(x) {
        *y -= factor * x;
    }
}

/// Dot product in four partial sums, which the compiler can keep in vector registers.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, a_rest) = a.as_chunks::<4>();
    let (b, b_rest) = b.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_with_a_factor_written_by_hand() {
        // L = [[2], [1, 1], [0.5, -1, 4]]: two columns in one panel, the last in its own.
        let panels = [
            Panel {
                begin: 0,
                end: 2,
                start: 0,
                below: vec![2],
            },
            Panel {
                begin: 2,
                end: 3,
                start: 6,
                below: vec![],
            },
        ];
        let factor = [2.0, 1.0, 0.5, f64::NAN, 1.0, -1.0, 4.0];
        let l = nalgebra::Matrix3::new(2.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.5, -1.0, 4.0);
        let exact = nalgebra::Vector3::new(3.0, -1.0, 2.0);
        let mut x = l * l.transpose() * exact;
        substitute(&panels, &factor, x.as_mut_slice(), &mut [0.0; 3]);
        assert!((x - exact).norm() < 1e-14, "{x}");
    }

    #[test]
    fn dot_takes_every_entry() {
        for n in 0..12 {
            let a: Vec<f64> = (0..n).map(|i| (i + 1) as f64).collect();
            assert_eq!(dot(&a, &a), (n * (n + 1) * (2 * n + 1) / 6) as f64);
        }
    }
}
