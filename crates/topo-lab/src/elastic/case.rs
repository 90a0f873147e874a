//! One case of a scene of rods.

use std::sync::Arc;

use serde::{Serialize, Serializer};
use topo_rod::{EndLoad, RodParameters};

use super::rest::Rest;
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
    /// Natural shape, if it is not straight and untwisted.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "of_case")]
    pub rest: Option<Arc<Rest>>,
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

/// The natural shape, in the JSON of a case.
fn of_case<S: Serializer>(rest: &Option<Arc<Rest>>, to: S) -> Result<S::Ok, S::Error> {
    rest.as_deref().serialize(to)
}
