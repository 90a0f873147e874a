//! What the curvature of an energy says of a state at rest.

use serde::{Deserialize, Serialize};

/// What the lowest eigenvalue λ of the Hessian says of a state, in units of the decay of the director's slowest mode between the
/// plates, λ₀ = L π²/L_z².
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MinimumState {
    /// λ > λ₀/100: every small change decays.
    Minimum,
    /// λ < −λ₀/1000: one change grows; a charge that stays there after all kicks says so.
    Saddle,
    /// Between: a change that hardly does either. Normal above the buckling, where the energy hardly depends on the direction of the
    /// tilt: only the lattice ties it, least for odd charges.
    Marginal,
}

impl MinimumState {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Minimum => "minimum",
            Self::Saddle => "saddle",
            Self::Marginal => "marginal",
        }
    }
}
