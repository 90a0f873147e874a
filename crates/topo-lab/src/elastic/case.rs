//! One case of a scene of rods.

use std::sync::Arc;

use serde::Serialize;
use topo_rod::{EndLoad, RodParameters};

use super::tied::{self, Tied};

/// One charge with its cuts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ElasticCase {
    /// Name of the knot or link.
    pub knot: String,
    /// What the fibres are tied to, if it is no tight knot by name.
    #[serde(
        skip_serializing_if = "Option::is_none",
        serialize_with = "tied::of_case"
    )]
    pub tied: Option<Arc<Tied>>,
    /// Material, twist, reading and resolution.
    pub rod: RodParameters,
    /// What takes up the work of the discharge, if anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<EndLoad>,
    /// Size of the random perturbation of the start curve, in h.
    #[serde(skip)]
    pub imperfection: f64,
    /// Seed of that perturbation and of the closures.
    #[serde(skip)]
    pub seed: u64,
}
