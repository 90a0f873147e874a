//! Smooth random displacements that lift a curve off symmetric saddle points.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_pcg::Pcg64;
use topo_core::Polyline;

use crate::V;

/// Displaces a closed curve by a random sum of its first harmonics so that the largest displacement is `amplitude`.
///
/// With an amplitude below the thickness no strand can pass another. None if vertices come to coincide.
pub(crate) fn kick(curve: &Polyline, amplitude: f64, rng: &mut Pcg64) -> Option<Polyline> {
    let n = curve.n_vertices();
    let n_modes = rng.random_range(3..=8);
    let mut shift = vec![V::zeros(); n];
    for mode in 1..=n_modes {
        let mut random = || {
            V::new(
                rng.random_range(-1.0..1.0),
                rng.random_range(-1.0..1.0),
                rng.random_range(-1.0..1.0),
            )
        };
        let (a, b) = (random(), random());
        for (i, s) in shift.iter_mut().enumerate() {
            let (sin, cos) = (TAU * (mode * i) as f64 / n as f64).sin_cos();
            *s += a * cos + b * sin;
        }
    }
    let largest = shift.iter().map(|s| s.norm()).fold(0.0, f64::max);
    let moved = curve
        .vertices()
        .iter()
        .zip(&shift)
        .map(|(x, s)| x + s * (amplitude / largest));
    Polyline::new(moved.collect(), true).ok()
}
