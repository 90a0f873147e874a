//! Earlier solutions of a symmetric system, and the best start they can give.

use serde::{Deserialize, Serialize};

use crate::stokes::field::dot;

/// Solutions kept.
const N_KEPT: usize = 3;

/// A vector whose part along the others falls below this, in the norm of the system, is round-off.
const DEPENDENT: f64 = 1e-12;

/// Last solutions x of S x = b with their images S x, oldest overwritten first, and an S-orthonormal basis of their span.
pub(super) struct History {
    solutions: [Vec<f64>; N_KEPT],
    images: [Vec<f64>; N_KEPT],
    basis: [Vec<f64>; N_KEPT],
    basis_images: [Vec<f64>; N_KEPT],
    n_pushed: usize,
}

/// What a checkpoint keeps of a history: the basis is rebuilt from it.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::stokes) struct SavedHistory {
    solutions: [Vec<f64>; N_KEPT],
    images: [Vec<f64>; N_KEPT],
    n_pushed: usize,
}

impl History {
    pub fn new(n: usize) -> Self {
        let zeros = || std::array::from_fn(|_| vec![0.0; n]);
        Self {
            solutions: zeros(),
            images: zeros(),
            basis: zeros(),
            basis_images: zeros(),
            n_pushed: 0,
        }
    }

    pub fn clear(&mut self) {
        self.n_pushed = 0;
    }

    pub fn kept(&self) -> SavedHistory {
        SavedHistory {
            solutions: self.solutions.clone(),
            images: self.images.clone(),
            n_pushed: self.n_pushed,
        }
    }

    /// Takes up what was kept; whether it is of the same size.
    pub fn restore(&mut self, kept: SavedHistory) -> bool {
        let n = self.solutions[0].len();
        let fits = kept
            .solutions
            .iter()
            .chain(&kept.images)
            .all(|x| x.len() == n && x.iter().all(|x| x.is_finite()));
        let fits = fits && kept.n_pushed < usize::MAX / 2;
        if fits {
            (self.solutions, self.images) = (kept.solutions, kept.images);
            self.n_pushed = kept.n_pushed;
        }
        fits
    }

    /// Keeps the solution `x` of S x = b - r.
    pub fn push(&mut self, x: &[f64], b: &[f64], r: &[f64]) {
        let at = self.n_pushed % N_KEPT;
        self.solutions[at].copy_from_slice(x);
        for ((image, b), r) in self.images[at].iter_mut().zip(b).zip(r) {
            *image = b - r;
        }
        self.n_pushed += 1;
    }

    /// Writes to `x` the combination of the kept solutions with the smallest error x^T S x, and to `r` its residual b - S x.
    pub fn guess(&mut self, b: &[f64], x: &mut [f64], r: &mut [f64]) {
        x.fill(0.0);
        r.copy_from_slice(b);
        let mut n = 0;
        // Newest first: it matters most, and later ones only count for what they add.
        for age in 0..self.n_pushed.min(N_KEPT) {
            let at = (self.n_pushed - 1 - age) % N_KEPT;
            let (done, rest) = self.basis.split_at_mut(n);
            let (done_images, rest_images) = self.basis_images.split_at_mut(n);
            let (v, image) = (&mut rest[0], &mut rest_images[0]);
            v.copy_from_slice(&self.solutions[at]);
            image.copy_from_slice(&self.images[at]);
            let whole = dot(v, image);
            for (u, u_image) in done.iter().zip(done_images.iter()) {
                let along = dot(u_image, v);
                subtract(v, along, u);
                subtract(image, along, u_image);
            }
            let square = dot(v, image);
            if !(whole > 0.0 && square > DEPENDENT * whole) {
                continue;
            }
            let scale = 1.0 / square.sqrt();
            v.iter_mut().for_each(|v| *v *= scale);
            image.iter_mut().for_each(|image| *image *= scale);
            let share = dot(v, r);
            subtract(x, -share, v);
            subtract(r, share, image);
            n += 1;
        }
    }

    pub fn n_bytes(&self) -> usize {
        4 * N_KEPT * self.solutions[0].len() * size_of::<f64>()
    }
}

/// `y -= factor x`.
fn subtract(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y -= factor * x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_combination_of_earlier_solutions_is_found() {
        // S = diag(1, 2, 3, 4).
        let apply = |x: [f64; 4]| [x[0], 2.0 * x[1], 3.0 * x[2], 4.0 * x[3]];
        let earlier = [
            [1.0, 2.0, 0.0, 1.0],
            [1.0, 2.1, 0.0, 1.0],
            [1.0, 2.2, 0.3, 1.0],
        ];
        let mut history = History::new(4);
        let (mut x, mut r) = ([1.0; 4], [0.0; 4]);
        history.guess(&[1.0; 4], &mut x, &mut r);
        assert_eq!((x, r), ([0.0; 4], [1.0; 4]));
        for old in [[9.0; 4]].iter().chain(&earlier) {
            history.push(old, &apply(*old), &[0.0; 4]);
        }
        // Quadratic extrapolation of the three lies in their span.
        let new: [f64; 4] =
            std::array::from_fn(|i| earlier[0][i] - 3.0 * earlier[1][i] + 3.0 * earlier[2][i]);
        history.guess(&apply(new), &mut x, &mut r);
        for i in 0..4 {
            assert!((x[i] - new[i]).abs() < 1e-9 && r[i].abs() < 1e-9, "{x:?}");
        }
        // The same solution three times is one.
        for _ in 0..3 {
            history.push(&new, &apply(new), &[0.0; 4]);
        }
        history.guess(&apply(new), &mut x, &mut r);
        assert!(x.iter().zip(new).all(|(x, y)| (x - y).abs() < 1e-12));
    }
}
