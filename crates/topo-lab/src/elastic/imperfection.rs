//! A small smooth random perturbation of a start curve.

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64;
use topo_core::Vector3;
use topo_core::{CurveError, Polyline};

/// Longest and shortest wave of the perturbation: this many waves around the curve.
const MODES: std::ops::RangeInclusive<u32> = 1..=8;

/// The closed curve moved by a random sum of long waves whose largest displacement is `size`.
///
/// Tight knots are often symmetric, and a symmetric state that is unstable would otherwise be left only by rounding errors;
/// a real fibre is never that perfect. The same seed gives the same perturbation.
///
/// # Errors
/// A perturbation so large that it spoils the curve.
pub fn perturbed(curve: &Polyline, size: f64, seed: u64) -> Result<Polyline, CurveError> {
    if size == 0.0 {
        return Ok(curve.clone());
    }
    let mut random = Pcg64::seed_from_u64(seed);
    let mut wave = || Vector3::from_fn(|_, _| amplitude(&mut random));
    let waves: Vec<_> = MODES.map(|k| (f64::from(k), wave(), wave())).collect();
    let n = curve.n_vertices();
    let moved: Vec<Vector3<f64>> = (0..n)
        .map(|i| {
            let u = std::f64::consts::TAU * i as f64 / n as f64;
            waves
                .iter()
                .map(|(k, a, b)| a * (k * u).cos() + b * (k * u).sin())
                .sum()
        })
        .collect();
    let largest = moved
        .iter()
        .map(|d| d.norm())
        .fold(f64::MIN_POSITIVE, f64::max);
    let vertices = curve
        .vertices()
        .iter()
        .zip(&moved)
        .map(|(x, d)| x + d * (size / largest))
        .collect();
    Polyline::new(vertices, curve.is_closed())
}

fn amplitude(random: &mut impl Rng) -> f64 {
    random.random_range(-1.0..1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn perturbations_have_the_size_asked_for_and_repeat() {
        let ring: Vec<_> = (0..60)
            .map(|k| {
                Vector3::new(
                    (0.1047 * f64::from(k)).cos(),
                    (0.1047 * f64::from(k)).sin(),
                    0.0,
                )
            })
            .collect();
        let ring = Polyline::new(ring, true).unwrap();
        let (a, b, c) = (
            perturbed(&ring, 1e-3, 1).unwrap(),
            perturbed(&ring, 1e-3, 1).unwrap(),
            perturbed(&ring, 1e-3, 2).unwrap(),
        );
        let largest = a
            .vertices()
            .iter()
            .zip(ring.vertices())
            .map(|(p, q)| (p - q).norm())
            .fold(0.0, f64::max);
        assert!((largest - 1e-3).abs() < 1e-12);
        assert_eq!(a, b);
        assert_ne!(a, c);
    }
}
