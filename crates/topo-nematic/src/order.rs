//! The order parameter of buckling: the mean horizontal director.

use serde::{Deserialize, Serialize};

use crate::NematicState;
use crate::directors::Directors;

/// Mean horizontal tilt of the director, by two definitions.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct OrderParameter {
    /// (⟨Q_xz⟩, ⟨Q_yz⟩) 2/(3 S_eq), means over the fluid: the tilt in radians where it is small.
    pub tilt: [f64; 2],
    /// (⟨n_x⟩, ⟨n_y⟩), with the sign of n such that n_z > 0.
    pub director: [f64; 2],
}

impl OrderParameter {
    /// Length of the tilt: zero by symmetry below the buckling transition.
    pub fn magnitude(&self) -> f64 {
        self.tilt[0].hypot(self.tilt[1])
    }

    /// Azimuth of the tilt, in radians; even charges lock it to the lattice, odd charges keep the azimuth of the seed.
    pub fn azimuth(&self) -> f64 {
        self.tilt[1].atan2(self.tilt[0])
    }

    /// Length of the mean horizontal director.
    pub fn director_magnitude(&self) -> f64 {
        self.director[0].hypot(self.director[1])
    }
}

/// Order parameter of a state, with tensors of order `order` (S_eq) in equilibrium.
pub fn order_parameter(state: &NematicState, order: f64) -> OrderParameter {
    let grid = state.grid();
    let ([nx, ny, nz], n) = (grid.cells(), grid.n_cells());
    let q = state.q_tensor();
    let (mut tilt, mut director, mut count) = ([0.0; 2], [0.0; 2], 0.0_f64);
    let mut directors = Directors::default();
    for k in 0..nz {
        for j in 0..ny {
            let start = grid.index([0, j, k]);
            directors.find(state, start..start + nx);
            let is_fluid = state.fluid_in_row(j, k);
            for i in (0..nx).filter(|i| is_fluid(*i)) {
                tilt[0] += q[2 * n + start + i];
                tilt[1] += q[4 * n + start + i];
                director[0] += directors.director[0][i];
                director[1] += directors.director[1][i];
                count += 1.0;
            }
        }
    }
    let scale = if order > 0.0 {
        2.0 / (3.0 * order)
    } else {
        0.0
    };
    OrderParameter {
        tilt: tilt.map(|t| scale * t / count.max(1.0)),
        director: director.map(|d| d / count.max(1.0)),
    }
}

impl NematicState {
    /// Order S, the largest eigenvalue of Q, of every cell.
    pub fn order_field(&self) -> Vec<f64> {
        Directors::of(self).order
    }

    /// Director of every cell, with n_z >= 0.
    pub fn director_field(&self) -> Vec<[f64; 3]> {
        let [x, y, z] = Directors::of(self).director;
        let all = x.into_iter().zip(y).zip(z);
        all.map(|((x, y), z)| [x, y, z]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::uniaxial;
    use crate::{Faces, Grid, Particle};

    #[test]
    fn a_tilt_between_plates_has_its_mean_and_its_azimuth() {
        // Director (sin t cos a, sin t sin a, cos t), t = t0 cos(pi z/d) from the middle: means by quadrature.
        let (n, tilt, azimuth) = (64, 0.3_f64, -2.0_f64);
        let faces = [Faces::Periodic, Faces::Periodic, Faces::Wall];
        let grid = Grid::new([4, 4, n], 0.5, faces).unwrap();
        let angle = |z: f64| tilt * (std::f64::consts::PI * (z / 32.0 - 0.5)).cos();
        let state = NematicState::from_fn(grid, None, |[_, _, z]| {
            let (sin, cos) = angle(z).sin_cos();
            uniaxial(0.53, [sin * azimuth.cos(), sin * azimuth.sin(), cos])
        })
        .unwrap();
        let found = order_parameter(&state, 0.53);
        // By Simpson's rule on a grid of its own.
        let mean = |f: &dyn Fn(f64) -> f64| {
            let weight = |k: u32| match k {
                0 | 600 => 1.0,
                _ if k % 2 == 1 => 4.0,
                _ => 2.0,
            };
            let at = |k: u32| weight(k) * f(angle(f64::from(k) * 32.0 / 600.0));
            (0..=600).map(at).sum::<f64>() / 1800.0
        };
        let (q_xz, n_x) = (mean(&|t| t.sin() * t.cos()), mean(&f64::sin));
        assert!(
            (found.magnitude() / q_xz - 1.0).abs() < 1e-3,
            "{found:?} {q_xz}"
        );
        assert!(
            (found.director_magnitude() / n_x - 1.0).abs() < 1e-3,
            "{found:?} {n_x}"
        );
        assert!((found.azimuth() - azimuth).abs() < 1e-12);
        assert!((found.director[1].atan2(found.director[0]) - azimuth).abs() < 1e-12);
        // An order parameter is in units of the equilibrium order; without order there is none.
        let half = order_parameter(&state, 0.265);
        assert!((half.magnitude() / found.magnitude() - 2.0).abs() < 1e-12);
        assert_eq!(order_parameter(&state, 0.0).tilt, [0.0; 2]);
    }

    #[test]
    fn only_the_fluid_is_averaged() {
        let grid = Grid::new([12; 3], 1.0, [Faces::Periodic; 3]).unwrap();
        let particle = Particle::new([6.0; 3], 3.0).unwrap();
        let tilted = [0.6, 0.0, 0.8];
        let state = NematicState::from_fn(grid, Some(particle), |p| {
            let inside = p.iter().map(|x| (x - 6.0).powi(2)).sum::<f64>() < 9.0;
            uniaxial(0.5, if inside { [0.0, 1.0, 0.0] } else { tilted })
        })
        .unwrap();
        let found = order_parameter(&state, 0.5);
        assert!((found.director[0] - 0.6).abs() < 1e-12 && found.director[1].abs() < 1e-12);
        assert!((found.magnitude() - 0.48).abs() < 1e-12, "{found:?}");
    }
}
