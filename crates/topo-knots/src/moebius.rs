//! A short descent of the Moebius energy: it rounds a closed braid into a start of another basin.

use std::f64::consts::TAU;

use topo_core::Polyline;

use crate::curves::Curves;
use crate::rings::Rings;
use crate::{KnotError, V};

/// Largest displacement of a vertex in a step, in units of the thickness: two strands cannot pass each other below 1.
const LARGEST_STEP: f64 = 0.6;
/// Steps between which the edges are made equal again.
const RESAMPLE_EVERY: usize = 4;

/// Descends the Moebius energy of a closed curve by at most `n_steps` steps at `n_edges` equal edges.
///
/// ```math
/// E = \iint \left( \frac{1}{|x(s) - x(s')|^2} - \frac{1}{D(s, s')^2} \right) ds\, ds'
/// ```
///
/// D is the distance along the curve. The gradient is preconditioned by the fractional Laplacian of order 3, the order of the
/// second variation of the energy. No vertex moves by more than 0.6 of the thickness, so no strands can cross.
///
/// # Errors
/// [`KnotError::Curve`] if the curve cannot be resampled.
///
/// # Validation
/// `descends_to_the_circle`, `keeps_the_type`.
///
/// # References
/// `ohara1991`, `freedman1994`
pub fn relax_moebius(
    start: &Polyline,
    n_edges: usize,
    n_steps: usize,
) -> Result<Polyline, KnotError> {
    Ok(relax_moebius_of(&start.clone().into(), n_edges, n_steps)?.into_first())
}

/// The same of several curves together, `n_edges` in all. The energy of two different ones has no term of the distance along
/// them.
pub(crate) fn relax_moebius_of(
    start: &Curves,
    n_edges: usize,
    n_steps: usize,
) -> Result<Curves, KnotError> {
    let n = n_edges;
    let mut curve = start.resampled(n)?;
    let mut descent = Descent::new(curve.rings());
    let mut cap = LARGEST_STEP;
    let mut last_energy = f64::INFINITY;
    for step in 0..n_steps {
        if step % RESAMPLE_EVERY == 0 && step > 0 {
            curve = curve.resampled(n)?;
            if curve.rings() != descent.rings {
                descent = Descent::new(curve.rings());
            }
        }
        let energy = descent.gradient(&curve);
        let gap = curve.thickness().tau;
        // A rise means that the step overshot; the next ones are shorter, a single one does no harm.
        cap = if energy > last_energy {
            0.5 * cap
        } else {
            (1.1 * cap).min(LARGEST_STEP)
        };
        last_energy = energy;
        descent.precondition();
        let largest = descent
            .direction
            .iter()
            .map(|d| d.norm())
            .fold(0.0, f64::max);
        if !largest.is_finite() || largest == 0.0 || cap < 1e-3 {
            break;
        }
        let size = cap * gap / largest;
        let vertices = curve.vertices().into_iter().zip(&descent.direction);
        let moved = curve.with_vertices(vertices.map(|(x, d)| x - size * d));
        curve = moved.ok_or(KnotError::Degenerate)?;
    }
    curve.resampled(n)
}

struct Descent {
    rings: Rings,
    gradient: Vec<V>,
    direction: Vec<V>,
    /// For each curve.
    kernels: Vec<Vec<f64>>,
}

impl Descent {
    fn new(rings: Rings) -> Self {
        // Row of the circulant inverse of |k|^3 + 1, k the wave number around the curve.
        let entry = |n: usize, m: usize| {
            let wave =
                |k: usize| (TAU * (k * m % n) as f64 / n as f64).cos() / ((k * k * k) as f64 + 1.0);
            (1..n / 2).map(|k| 2.0 * wave(k)).sum::<f64>() + wave(0)
        };
        let kernel = |n: usize| (0..n).map(|m| entry(n, m)).collect();
        Self {
            gradient: vec![V::zeros(); rings.n()],
            direction: vec![V::zeros(); rings.n()],
            kernels: rings.ranges().map(|range| kernel(range.len())).collect(),
            rings,
        }
    }

    /// Fills the gradient for equal edges and returns the energy.
    fn gradient(&mut self, curves: &Curves) -> f64 {
        let x = curves.vertices();
        let mut energy = 0.0;
        self.gradient.fill(V::zeros());
        for (range, h) in self.rings.ranges().zip(curves.edge_lengths()) {
            let n = range.len();
            for i in range.clone() {
                let mut here = V::zeros();
                for j in i + 1..x.len() {
                    let chord = x[i] - x[j];
                    let inverse = 1.0 / chord.norm_squared();
                    energy += match j < range.end {
                        true => {
                            let arc = (j - i).min(n - (j - i)) as f64 * h;
                            inverse - 1.0 / (arc * arc)
                        }
                        false => inverse,
                    };
                    let pull = chord * (inverse * inverse);
                    here -= pull;
                    self.gradient[j] += pull;
                }
                self.gradient[i] += here;
            }
        }
        let rings = self.rings.clone();
        for (range, h) in rings.ranges().zip(curves.edge_lengths()) {
            self.straighten(&x[range.clone()], range.start, h);
        }
        energy
    }

    /// Adds the arc length term of a curve, a tension, the same everywhere, as the edges are equal; and takes out what is along it.
    fn straighten(&mut self, x: &[V], first: usize, h: f64) {
        let n = x.len();
        let tension: f64 = (1..=n / 2).map(|m| 1.0 / (m as f64 * h).powi(2)).sum();
        for (i, gradient) in self.gradient[first..first + n].iter_mut().enumerate() {
            let (before, after) = (x[(i + n - 1) % n], x[(i + 1) % n]);
            let curvature = (before + after - 2.0 * x[i]) / (h * h);
            let tangent = (after - before).normalize();
            let total = *gradient - curvature * tension;
            *gradient = total - tangent * tangent.dot(&total);
        }
    }

    fn precondition(&mut self) {
        for (range, kernel) in self.rings.ranges().zip(&self.kernels) {
            let n = kernel.len();
            for i in 0..n {
                let mut sum = V::zeros();
                for (j, g) in self.gradient[range.clone()].iter().enumerate() {
                    sum += g * kernel[if i >= j { i - j } else { i + n - j }];
                }
                self.direction[range.start + i] = sum;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KnotTable, closed_braid, thickness};

    #[test]
    fn descends_to_the_circle() {
        let bent = (0..90)
            .map(|k| TAU * k as f64 / 90.0)
            .map(|t| V::new(2.0 * t.cos(), t.sin(), 0.5 * (2.0 * t).sin()));
        let bent = Polyline::new(bent.collect(), true).expect("a curve");
        let round = relax_moebius(&bent, 90, 400).expect("relaxed");
        // The circle has the smallest length for its radius of curvature.
        let ratio = |c: &Polyline| c.length() / (TAU * thickness(c).min_rad);
        assert!(
            ratio(&bent) > 2.0 && ratio(&round) < 1.05,
            "{}",
            ratio(&round)
        );
    }

    #[test]
    fn keeps_the_type() {
        let table = KnotTable::builtin();
        for name in ["3_1", "4_1", "7_7"] {
            let entry = table.get(name).expect("known");
            let start = closed_braid(&entry.braid).expect("a knot");
            let round = relax_moebius(&start, 200, 100).expect("relaxed");
            entry.verify(&round).expect("the same knot");
        }
    }
}
