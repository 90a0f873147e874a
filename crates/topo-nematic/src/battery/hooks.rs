//! What a caller can attach to a run of a nematic.

use super::record::NematicSample;
use crate::NematicState;
use crate::flow::FlowCoupling;

/// Hooks of a charge or a discharge. None of them changes its result.
///
/// The sample function gets each sample of a discharge, its state, and the flow if there is one. A finished charge leaves its
/// checkpoint, so that the next call returns its result at once; a finished discharge removes its checkpoint.
pub type RunHooks<'a> =
    topo_core::RunHooks<'a, dyn FnMut(&NematicSample, &NematicState, Option<&FlowCoupling>) + 'a>;
