//! Colloids in a nematic, as one battery among others.

use super::identity::RESULTS_VERSION;
use crate::battery::Battery;

/// Charged colloids in a nematic.
#[derive(Debug, Clone, Copy)]
pub struct Colloid;

impl Battery for Colloid {
    fn table(&self) -> &'static str {
        "nematic"
    }

    fn what(&self) -> &'static str {
        "a colloid"
    }

    fn schema(&self) -> &'static str {
        "topo-nematic-case/1"
    }

    fn results(&self) -> u32 {
        RESULTS_VERSION
    }
}
