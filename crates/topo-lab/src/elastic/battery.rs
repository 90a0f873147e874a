//! Knotted fibres, as one battery among others.

use super::identity::RESULTS_VERSION;
use crate::battery::Battery;

/// Knotted elastic fibres.
#[derive(Debug, Clone, Copy)]
pub struct Elastic;

impl Battery for Elastic {
    fn table(&self) -> &'static str {
        "rod"
    }

    fn what(&self) -> &'static str {
        "a knotted fibre"
    }

    fn schema(&self) -> &'static str {
        "topo-elastic-case/1"
    }

    fn results(&self) -> u32 {
        RESULTS_VERSION
    }
}
