//! The order parameter of buckling: the mean horizontal director.

use serde::{Deserialize, Serialize};

use crate::NematicState;
use crate::directors::Directors;

/// Mean horizontal tilt of the director, by two definitions.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct OrderParameter {
    /// (<Q_xz>, <Q_yz>) 2/(3 S_eq), means over the fluid.
    pub tilt: [f64; 2],
    /// (<n_x>, <n_y>), with the sign of n such that n_z > 0.
    pub director: [f64; 2],
}

impl OrderParameter {
    /// Length of the tilt: zero by symmetry below the buckling transition.
    pub fn magnitude(&self) -> f64 {
        self.tilt[0].hypot(self.tilt[1])
    }

    /// Azimuth of the tilt, in radians; even charges lock it to the lattice, odd ones keep that of the seed.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::uniaxial;
    use crate::{Faces, Grid, Particle};

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
