//! Random moves that lead from a tight curve to another basin: smooth kicks, and squeezing.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_pcg::Pcg64;

use super::level::{LOOSE_REACH, Level, tighten_level};
use super::stop::Stop;
use crate::V;
use crate::curves::Curves;

/// Displaces each closed curve by a random sum of its first harmonics so that the largest displacement is `amplitude`; several are
/// displaced as a whole too.
///
/// With an amplitude below the thickness no strand can pass another. None if vertices come to coincide.
pub(crate) fn kick(curves: &Curves, amplitude: f64, rng: &mut Pcg64) -> Option<Curves> {
    let rings = curves.rings();
    let mut shift = vec![V::zeros(); rings.n()];
    // Of a single curve, a displacement as a whole is none.
    let first_mode = usize::from(rings.n_rings() == 1);
    for range in rings.ranges() {
        let n = range.len();
        let n_modes = rng.random_range(3..=8);
        for mode in first_mode..=n_modes {
            let mut random = || {
                V::new(
                    rng.random_range(-1.0..1.0),
                    rng.random_range(-1.0..1.0),
                    rng.random_range(-1.0..1.0),
                )
            };
            let (a, b) = (random(), random());
            for (i, s) in shift[range.clone()].iter_mut().enumerate() {
                let (sin, cos) = (TAU * (mode * i) as f64 / n as f64).sin_cos();
                *s += a * cos + b * sin;
            }
        }
    }
    let largest = shift.iter().map(|s| s.norm()).fold(0.0, f64::max);
    let vertices = curves.vertices().into_iter().zip(&shift);
    curves.with_vertices(vertices.map(|(x, s)| x + s * (amplitude / largest)))
}

/// Squeezes closed curves: some steps of tightening under a tension that depends on the direction in space.
///
/// The tube stays legal, so the type is kept, while the shape moves much further than by a kick.
pub(crate) fn squeeze(curves: &Curves, rng: &mut Pcg64) -> Option<Curves> {
    let mut random = || rng.random_range(-1.0..1.0);
    let axis = nalgebra::Unit::new_normalize(V::new(random(), random(), random()));
    let turn = nalgebra::Rotation3::from_axis_angle(&axis, std::f64::consts::PI * random());
    let strength = 1.5 + 1.5 * (random() + 1.0);
    let level = Level {
        damping: 0.02,
        curvature_damping: 0.1,
        weights: [strength, 1.0, 1.0 / strength],
        tolerance: 1e-4,
        rest: 0.0,
        enough: 0.0,
        reach: LOOSE_REACH,
        max_steps: 12,
    };
    let turned = curves.with_vertices(curves.vertices().iter().map(|x| turn * x))?;
    let n = turned.n_vertices();
    tighten_level(&turned, &level, &Stop::default())?
        .last
        .resampled(n)
        .ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KnotTable, closed_braid};
    use rand::SeedableRng;

    #[test]
    fn kicks_and_squeezes_keep_the_type() {
        let mut rng = Pcg64::seed_from_u64(5);
        let table = KnotTable::builtin();
        let knot = table.get("4_1").expect("known");
        let braid = closed_braid(&knot.braid).expect("a knot").resampled(120);
        let braid = Curves::from(braid.expect("resampled"));
        let tau = braid.thickness().tau;
        for _ in 0..3 {
            let kicked = kick(&braid, 0.7 * tau, &mut rng).expect("moved");
            knot.verify(&kicked.parts()[0]).expect("the same knot");
            let moved = kicked.vertices().into_iter().zip(braid.vertices());
            let largest = moved.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            assert!((largest - 0.7 * tau).abs() < 1e-9);
            let squeezed = squeeze(&braid, &mut rng).expect("moved");
            knot.verify(&squeezed.parts()[0]).expect("the same knot");
            // Far more than a kick: the shape as a whole is another one.
            let spread = |c: &Curves| {
                let c = &c.parts()[0];
                let middle = c.centroid();
                c.vertices()
                    .iter()
                    .map(|x| (x - middle).norm())
                    .fold(0.0, f64::max)
                    / c.length()
            };
            assert!((spread(&squeezed) / spread(&braid) - 1.0).abs() > 0.02);
        }
    }
}
