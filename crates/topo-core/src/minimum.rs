//! What the curvature of an energy says of a state at rest.

use serde::{Deserialize, Serialize};

/// What the lowest eigenvalue λ of the Hessian says of a state, in units of the decay of the director's slowest mode between the
/// plates, λ₀ = L π²/L_z².
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MinimumState {
    /// λ > λ₀/100: every small change decays.
    Minimum,
    /// λ < −λ₀/1000: one change grows: the state is a saddle. A charge that ends there after all kicks reports it.
    Saddle,
    /// In between: one change hardly grows or decays. Normal above the buckling transition, where the energy hardly depends on
    /// the direction of the tilt; only the lattice fixes it, least for odd charges.
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
