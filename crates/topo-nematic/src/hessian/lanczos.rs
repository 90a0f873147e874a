//! The lowest eigenvalue of a Hessian and its mode, by the method of Lanczos.

use super::Hessian;
use super::start::start;
use super::tridiagonal::Tridiagonal;
use crate::Particle;

/// Products between looks at the tridiagonal matrix.
const CHECK_EVERY: usize = 10;
/// Most products.
const MOST_PRODUCTS: usize = 4000;

/// How far a lowest eigenvalue is to be known: near zero, where its sign counts, to `near_zero`, elsewhere to a share of its size.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Accuracy {
    /// Accuracy near zero, in L/ξ_N².
    pub near_zero: f64,
    /// Scale of the lowest eigenvalues, in L/ξ_N².
    pub unit: f64,
    /// Stop at the first direction in which the energy clearly falls: enough to leave a saddle.
    pub any_saddle: bool,
}

/// Accuracy as a share of the eigenvalue.
const SHARE: f64 = 3e-3;
/// Residual that is good enough, as a share of the unit or of the eigenvalue, and of an eigenvalue near zero.
const RESIDUAL: [f64; 2] = [0.05, 0.2];

impl Accuracy {
    /// Whether it is reached with this residual and distance to the next eigenvalue.
    ///
    /// The error is at most the residual's square over the distance; a pair that is not resolved yet looks like one eigenvalue,
    /// wrong by its distance, which the residual shows.
    fn is_reached(self, eigenvalue: f64, residual: f64, gap: f64) -> bool {
        if self.any_saddle && eigenvalue < -3.0 * self.near_zero {
            return true;
        }
        let size = eigenvalue.abs();
        let error = residual.min(residual * residual / gap);
        let wrong = (RESIDUAL[1] * size).min(RESIDUAL[0] * size.max(self.unit));
        error <= self.near_zero.max(SHARE * size) && residual <= wrong.max(2.0 * self.near_zero)
    }
}

/// The lowest eigenvalue that was found.
#[derive(Debug, Clone)]
pub(crate) struct LowestMode {
    /// The eigenvalue, in L/ξ_N²; an upper bound of the lowest.
    pub eigenvalue: f64,
    /// Norm of A v − λ v for the mode v of norm 1.
    pub residual: f64,
    /// The mode as a combination of Lanczos vectors.
    combination: Vec<f64>,
    /// The recurrence that made them.
    matrix: Tridiagonal,
}

/// Three vectors of the recurrence, each `scale` times shorter than stored.
struct Vectors {
    old: Vec<f64>,
    new: Vec<f64>,
    product: Vec<f64>,
    old_scale: f64,
    new_scale: f64,
}

impl Hessian<'_> {
    /// The lowest eigenvalue; `None` when `stop` said so, or when it was not found within the limit of products.
    ///
    /// Of the vectors only three are kept: without orthogonalising again, an eigenvalue that has converged comes up once more, which
    /// does not matter for the lowest. `n_products` is counted up.
    pub(crate) fn lowest(
        &self,
        particle: Option<&Particle>,
        wanted: Accuracy,
        n_products: &mut u64,
        mut stop: impl FnMut() -> bool,
    ) -> Option<LowestMode> {
        let mut vectors = self.first(particle)?;
        let mut matrix = Tridiagonal::default();
        for step in 1..=MOST_PRODUCTS {
            if stop() {
                return None;
            }
            let diagonal = self.product(&mut vectors);
            *n_products += 1;
            let before = matrix.beside.last().copied().unwrap_or(0.0);
            matrix.diagonal.push(diagonal);
            let next = self.advance(&mut vectors, diagonal, before);
            // Not a number ends it too.
            let ends = next.is_nan() || next <= 1e-13 * diagonal.abs();
            if step.is_multiple_of(CHECK_EVERY) || ends {
                let eigenvalue = matrix.eigenvalue(0);
                let combination = matrix.eigenvector(eigenvalue);
                let residual = next * combination[step - 1].abs();
                let gap = if step > 1 {
                    matrix.eigenvalue(1) - eigenvalue
                } else {
                    0.0
                };
                if ends || wanted.is_reached(eigenvalue, residual, gap) {
                    return Some(LowestMode {
                        eigenvalue,
                        residual,
                        combination,
                        matrix,
                    });
                }
            }
            matrix.beside.push(next);
        }
        None
    }

    /// The mode of a lowest eigenvalue, of norm 1: its vectors are made once more.
    pub(crate) fn mode(
        &self,
        particle: Option<&Particle>,
        lowest: &LowestMode,
        n_products: &mut u64,
    ) -> Option<Vec<f64>> {
        let mut vectors = self.first(particle)?;
        let mut mode = vec![0.0; self.q.len()];
        let n = lowest.combination.len();
        for (k, share) in lowest.combination.iter().enumerate() {
            let add = [(share * vectors.new_scale, &vectors.new[..])];
            self.kernel.linear(&mut mode, 1.0, add);
            if k + 1 < n {
                self.product(&mut vectors);
                *n_products += 1;
                let before = if k > 0 {
                    lowest.matrix.beside[k - 1]
                } else {
                    0.0
                };
                self.advance(&mut vectors, lowest.matrix.diagonal[k], before);
            }
        }
        Some(mode)
    }

    fn first(&self, particle: Option<&Particle>) -> Option<Vectors> {
        let n = self.q.len();
        let (domain, stride) = (&self.kernel.domain, self.kernel.stride);
        let mut new = start(domain, particle, self.q, stride);
        let empty = vec![0.0; n];
        let square = self.combine((0.0, &empty), (0.0, &empty), 1.0, &mut new);
        (square > 0.0 && square.is_finite()).then(|| Vectors {
            old: vec![0.0; n],
            new,
            product: empty,
            old_scale: 1.0,
            new_scale: 1.0 / square.sqrt(),
        })
    }

    /// The product with the newest vector, and its inner product with that vector.
    fn product(&self, v: &mut Vectors) -> f64 {
        v.new_scale * v.new_scale * self.apply(&v.new, &mut v.product)
    }

    /// The next vector takes the place of the oldest; gives its norm before it is scaled.
    fn advance(&self, v: &mut Vectors, diagonal: f64, before: f64) -> f64 {
        let square = self.combine(
            (-diagonal * v.new_scale, &v.new),
            (v.new_scale, &v.product),
            -before * v.old_scale,
            &mut v.old,
        );
        std::mem::swap(&mut v.old, &mut v.new);
        let norm = square.sqrt();
        v.old_scale = v.new_scale;
        v.new_scale = 1.0 / norm;
        norm
    }
}
