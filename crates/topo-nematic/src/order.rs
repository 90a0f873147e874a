//! The order parameter of buckling: the mean horizontal director.

use serde::{Deserialize, Serialize};

use crate::NematicState;
use crate::tensor::order_and_director;

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
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                if !state.is_fluid([i, j, k]) {
                    continue;
                }
                let cell = grid.index([i, j, k]);
                tilt[0] += q[2 * n + cell];
                tilt[1] += q[4 * n + cell];
                let (_, d) = order_and_director(&state.tensor(cell));
                director[0] += d[0];
                director[1] += d[1];
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
