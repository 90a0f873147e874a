//! Preconditioned MINRES for symmetric indefinite systems.

use rayon::prelude::*;

use crate::stokes::field::dot;
use crate::stokes::reduce::sum_over;

/// Numbers of one job.
const CHUNK: usize = 1 << 14;

/// Vectors of the iteration, kept from one solve to the next.
///
/// # References
/// [paige1975], [elman2014]
///
/// [paige1975]: https://doi.org/10.1137/0712047
/// [elman2014]: https://doi.org/10.1093/acprof:oso/9780199678792.001.0001
pub(super) struct Minres {
    solution: Vec<f64>,
    /// Lanczos vectors, the newer one first the right-hand side.
    older: Vec<f64>,
    newer: Vec<f64>,
    /// The newer one preconditioned, and what the operator or the preconditioner makes of a vector.
    preconditioned: Vec<f64>,
    image: Vec<f64>,
    /// Search directions.
    direction: Vec<f64>,
    direction_before: Vec<f64>,
}

/// How a solve ended.
pub(super) struct Outcome {
    pub n_iterations: usize,
    /// Residual over that of zero, in the norm of the preconditioner.
    pub residual: f64,
}

impl Minres {
    /// How many vectors are kept.
    pub const N_VECTORS: usize = 7;

    pub fn new(n: usize) -> Self {
        let zeros = || vec![0.0; n];
        Self {
            solution: zeros(),
            older: zeros(),
            newer: zeros(),
            preconditioned: zeros(),
            image: zeros(),
            direction: zeros(),
            direction_before: zeros(),
        }
    }

    /// Where the right-hand side goes.
    pub fn rhs(&mut self) -> &mut [f64] {
        &mut self.newer
    }

    pub fn solution(&self) -> &[f64] {
        &self.solution
    }

    pub fn n_bytes(&self) -> usize {
        Self::N_VECTORS * self.solution.len() * size_of::<f64>()
    }

    /// Solves A x = rhs from zero; `apply(x, y)` writes A x, `precondition(x, y)` a symmetric positive definite M x.
    pub fn solve(
        &mut self,
        tolerance: f64,
        max_iterations: usize,
        apply: impl Fn(&[f64], &mut [f64]),
        mut precondition: impl FnMut(&[f64], &mut [f64]),
    ) -> Outcome {
        for vector in [
            &mut self.solution,
            &mut self.older,
            &mut self.direction,
            &mut self.direction_before,
        ] {
            vector.fill(0.0);
        }
        precondition(&self.newer, &mut self.preconditioned);
        let first = root(inner(&self.preconditioned, &self.newer));
        let (mut norm_before, mut norm) = (1.0, first);
        let mut left = first;
        let ([mut sine_before, mut sine], [mut cosine_before, mut cosine]) = ([0.0; 2], [1.0; 2]);
        let mut n_iterations = 0;
        // A broken force gives NaN, which ends the loop too.
        while n_iterations < max_iterations && left.abs() > tolerance * first {
            n_iterations += 1;
            scale(&mut self.preconditioned, 1.0 / norm);
            apply(&self.preconditioned, &mut self.image);
            let along = inner(&self.image, &self.preconditioned);
            // The next Lanczos vector takes the place of the oldest.
            combine(
                &mut self.older,
                -norm / norm_before,
                [(-along / norm, &self.newer), (1.0, &self.image)],
            );
            std::mem::swap(&mut self.older, &mut self.newer);
            precondition(&self.newer, &mut self.image);
            let norm_after = root(inner(&self.image, &self.newer));
            let reduced = cosine * along - cosine_before * sine * norm;
            let diagonal = reduced.hypot(norm_after);
            if diagonal.is_nan() || diagonal <= 0.0 {
                // The force is balanced by pressure alone, or broken.
                break;
            }
            let second = sine * along + cosine_before * cosine * norm;
            let third = sine_before * norm;
            (sine_before, cosine_before) = (sine, cosine);
            (sine, cosine) = (norm_after / diagonal, reduced / diagonal);
            combine(
                &mut self.direction_before,
                -third / diagonal,
                [
                    (-second / diagonal, &self.direction),
                    (1.0 / diagonal, &self.preconditioned),
                ],
            );
            std::mem::swap(&mut self.direction_before, &mut self.direction);
            add(&mut self.solution, cosine * left, &self.direction);
            left *= -sine;
            std::mem::swap(&mut self.preconditioned, &mut self.image);
            (norm_before, norm) = (norm, norm_after);
        }
        let residual = if first == 0.0 {
            0.0
        } else {
            left.abs() / first
        };
        Outcome {
            n_iterations,
            residual,
        }
    }
}

/// Square root of what may be round-off below zero; NaN stays NaN.
fn root(square: f64) -> f64 {
    if square < 0.0 { 0.0 } else { square.sqrt() }
}

/// Inner product, the same to the bit for any number of threads.
fn inner(a: &[f64], b: &[f64]) -> f64 {
    sum_over(0..a.len().div_ceil(CHUNK), &|job| {
        let range = job * CHUNK..a.len().min((job + 1) * CHUNK);
        dot(&a[range.clone()], &b[range])
    })
}

fn scale(x: &mut [f64], factor: f64) {
    x.par_chunks_mut(CHUNK)
        .for_each(|x| x.iter_mut().for_each(|x| *x *= factor));
}

/// `x += factor y`.
fn add(x: &mut [f64], factor: f64, y: &[f64]) {
    x.par_chunks_mut(CHUNK)
        .zip(y.par_chunks(CHUNK))
        .for_each(|(x, y)| x.iter_mut().zip(y).for_each(|(x, y)| *x += factor * y));
}

/// `x = own x + a y + b z`.
fn combine(x: &mut [f64], own: f64, [(a, y), (b, z)]: [(f64, &[f64]); 2]) {
    x.par_chunks_mut(CHUNK)
        .zip(y.par_chunks(CHUNK).zip(z.par_chunks(CHUNK)))
        .for_each(|(x, (y, z))| {
            for ((x, y), z) in x.iter_mut().zip(y).zip(z) {
                *x = own * *x + a * y + b * z;
            }
        });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_saddle_point() {
        // [2 0 1; 0 3 -1; 1 -1 0] x = b, preconditioned by the diagonal of the first block.
        let apply = |x: &[f64], y: &mut [f64]| {
            y[0] = 2.0 * x[0] + x[2];
            y[1] = 3.0 * x[1] - x[2];
            y[2] = x[0] - x[1];
        };
        let precondition = |x: &[f64], y: &mut [f64]| {
            (y[0], y[1], y[2]) = (x[0] / 2.0, x[1] / 3.0, x[2]);
        };
        let mut minres = Minres::new(3);
        let exact = [0.3, -1.2, 2.5];
        apply(&exact, minres.rhs());
        let outcome = minres.solve(1e-13, 10, apply, precondition);
        assert_eq!(outcome.n_iterations, 3);
        for (x, exact) in minres.solution().iter().zip(exact) {
            assert!((x - exact).abs() < 1e-12, "{:?}", minres.solution());
        }
        minres.rhs().fill(0.0);
        let nothing = minres.solve(1e-13, 10, apply, precondition);
        assert_eq!((nothing.n_iterations, nothing.residual), (0, 0.0));
        minres.rhs().fill(f64::NAN);
        let broken = minres.solve(1e-13, 10, apply, precondition);
        assert!(broken.residual.is_nan());
    }
}
