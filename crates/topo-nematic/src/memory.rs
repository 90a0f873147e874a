//! Bytes that a run needs, and bytes that it holds.

use serde::{Deserialize, Serialize};

use crate::{Grid, Precision};

/// Bytes held by each component of a run; what is absent holds none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct ByteAccount {
    /// Tensor fields and what integrators keep of them.
    pub fields: u64,
    /// Lists of cells and wall values.
    pub geometry: u64,
    /// Lists of the second elastic constant.
    pub second: u64,
    /// Velocities, forces and solvers of the flow.
    pub flow: u64,
}

impl ByteAccount {
    /// All together.
    pub fn total(&self) -> u64 {
        self.fields + self.geometry + self.second + self.flow
    }
}

/// Bytes that the phases of a run without flow will need, by estimate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct MemoryEstimate {
    /// To charge: positions, velocities, forces and the state; to leave a saddle, three vectors, a mode and the state twice.
    pub charge: u64,
    /// To discharge: five fields of the integrator and two states.
    pub discharge: u64,
}

impl MemoryEstimate {
    /// The larger one.
    pub fn total(&self) -> u64 {
        self.charge.max(self.discharge)
    }
}

/// Estimate for a grid, with a discharge in the given precision.
pub(crate) fn estimate(grid: &Grid, precision: Precision) -> MemoryEstimate {
    let field = |n_bytes: u64| 5 * n_bytes * grid.n_cells() as u64;
    let geometry = 9 * grid.n_cells() as u64;
    MemoryEstimate {
        charge: 6 * field(8) + geometry,
        discharge: 5 * field(precision.n_bytes()) + 2 * field(8) + geometry,
    }
}
