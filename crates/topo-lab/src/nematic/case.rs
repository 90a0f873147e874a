//! One case of a scene of colloids.

use serde::Serialize;
use topo_nematic::{FlowParameters, NematicParameters};

/// One charge and its discharge.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NematicCase {
    /// Winding of the anchoring, 0 for a pattern without one.
    pub q: u32,
    /// Cell, particle with its pattern, material.
    pub nematic: NematicParameters,
    /// Flow, if any.
    pub flow: Option<FlowParameters>,
}
