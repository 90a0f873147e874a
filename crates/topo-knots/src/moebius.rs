//! A short descent of the Moebius energy: it rounds a closed braid into a start of another basin.

use std::f64::consts::TAU;

use topo_core::Polyline;

use crate::{KnotError, V, thickness};

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
    let n = n_edges;
    let mut curve = start.resampled(n)?;
    let mut descent = Descent::new(n);
    let mut cap = LARGEST_STEP;
    let mut last_energy = f64::INFINITY;
    for step in 0..n_steps {
        if step % RESAMPLE_EVERY == 0 && step > 0 {
            curve = curve.resampled(n)?;
        }
        let energy = descent.gradient(&curve);
        let gap = thickness(&curve).tau;
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
        let moved = curve
            .vertices()
            .iter()
            .zip(&descent.direction)
            .map(|(x, d)| x - size * d);
        curve = Polyline::new(moved.collect(), true)?;
    }
    Ok(curve.resampled(n)?)
}

struct Descent {
    gradient: Vec<V>,
    direction: Vec<V>,
    kernel: Vec<f64>,
}

impl Descent {
    fn new(n: usize) -> Self {
        // Row of the circulant inverse of |k|^3 + 1, k the wave number around the curve.
        let kernel = (0..n)
            .map(|m| {
                let wave = |k: usize| {
                    (TAU * (k * m % n) as f64 / n as f64).cos() / ((k * k * k) as f64 + 1.0)
                };
                (1..n / 2).map(|k| 2.0 * wave(k)).sum::<f64>() + wave(0)
            })
            .collect();
        Self {
            gradient: vec![V::zeros(); n],
            direction: vec![V::zeros(); n],
            kernel,
        }
    }

    /// Fills the gradient for equal edges and returns the energy.
    fn gradient(&mut self, curve: &Polyline) -> f64 {
        let x = curve.vertices();
        let n = x.len();
        let h = curve.length() / n as f64;
        let mut energy = 0.0;
        self.gradient.fill(V::zeros());
        for i in 0..n {
            let mut here = V::zeros();
            for j in i + 1..n {
                let chord = x[i] - x[j];
                let inverse = 1.0 / chord.norm_squared();
                let steps = (j - i).min(n - (j - i));
                let arc = steps as f64 * h;
                energy += inverse - 1.0 / (arc * arc);
                let pull = chord * (inverse * inverse);
                here -= pull;
                self.gradient[j] += pull;
            }
            self.gradient[i] += here;
        }
        // The arc length term is a tension, the same everywhere, as the edges are equal.
        let tension: f64 = (1..=n / 2).map(|m| 1.0 / (m as f64 * h).powi(2)).sum();
        for i in 0..n {
            let (before, after) = (x[(i + n - 1) % n], x[(i + 1) % n]);
            let curvature = (before + after - 2.0 * x[i]) / (h * h);
            let tangent = (after - before).normalize();
            let total = self.gradient[i] - curvature * tension;
            self.gradient[i] = total - tangent * tangent.dot(&total);
        }
        energy
    }

    fn precondition(&mut self) {
        let n = self.kernel.len();
        for i in 0..n {
            let mut sum = V::zeros();
            for (j, g) in self.gradient.iter().enumerate() {
                sum += g * self.kernel[if i >= j { i - j } else { i + n - j }];
            }
            self.direction[i] = sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KnotTable, closed_braid};

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
