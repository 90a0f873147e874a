//! One case of a scene of rods.

use serde::Serialize;
use topo_rod::RodParameters;

/// One charge with its cuts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ElasticCase {
    /// Knot type.
    pub knot: String,
    /// Material, twist, reading and resolution.
    pub rod: RodParameters,
    /// Size of the random perturbation of the start curve, in h.
    #[serde(skip)]
    pub imperfection: f64,
    /// Seed of that perturbation and of the closures.
    #[serde(skip)]
    pub seed: u64,
}
