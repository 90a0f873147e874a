//! How a nematic is charged.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::{InvalidValue, finite, in_range, positive};

use crate::NematicError;

/// How a nematic is charged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ChargeSettings {
    /// Tilts of the start fields, in radians: each is relaxed, and the state of least energy kept.
    #[schemars(length(min = 1), extend("x-unit" = "rad", "examples" = [[0.05, -0.05]]))]
    pub seeds: Vec<f64>,
    /// Direction of the tilt, in radians from x.
    #[schemars(extend("x-unit" = "rad"), example = 1.0)]
    pub seed_azimuth: f64,
    /// Root mean square of the molecular field that counts as converged, in L/ξ_N².
    #[schemars(extend("x-unit" = "L/ξ_N²", "exclusiveMinimum" = 0), example = 1e-7)]
    pub tolerance: f64,
    /// Largest change of the order parameter over 25 steps that counts as converged.
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0), example = 1e-5)]
    pub order_tolerance: f64,
    /// Relax on a grid of twice the spacing first. Faster, but a coarse grid may buckle where a fine one does not.
    #[schemars(example = true)]
    pub coarse_start: bool,
    /// Limit of steps for each start field.
    #[schemars(range(min = 1, max = 1_000_000_000_000_000_u64), extend("x-unit" = "steps"), example = 10_000)]
    pub max_steps: u64,
}

impl Default for ChargeSettings {
    fn default() -> Self {
        Self {
            seeds: vec![0.05],
            seed_azimuth: 0.0,
            tolerance: 1e-8,
            order_tolerance: 1e-6,
            coarse_start: false,
            max_steps: 50_000,
        }
    }
}

impl ChargeSettings {
    /// Checks every number.
    ///
    /// # Errors
    /// Names the first value out of range and what would be right.
    pub fn check(&self) -> Result<(), NematicError> {
        if self.seeds.is_empty() {
            return Err(InvalidValue::new("charge.seeds", 0.0, "one tilt at least").into());
        }
        for seed in &self.seeds {
            finite("charge.seeds", *seed)?;
        }
        finite("charge.seed_azimuth", self.seed_azimuth)?;
        positive("charge.tolerance", self.tolerance)?;
        positive("charge.order_tolerance", self.order_tolerance)?;
        in_range("charge.max_steps", self.max_steps as f64, 1.0, 1e15)?;
        Ok(())
    }
}
