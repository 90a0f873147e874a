//! What a caller may hang into a run of a nematic.

use super::record::NematicSample;
use crate::NematicState;
use crate::flow::FlowCoupling;

/// Hooks of a charge or a discharge; none of them changes its result.
///
/// The function that sees samples is given each sample of a discharge, its state, and the flow if there is one. A finished charge
/// leaves its checkpoint, so that the next call has its result at once; a finished discharge removes its own.
pub type RunHooks<'a> =
    topo_core::RunHooks<'a, dyn FnMut(&NematicSample, &NematicState, Option<&FlowCoupling>) + 'a>;
