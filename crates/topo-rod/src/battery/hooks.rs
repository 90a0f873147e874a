//! What a caller can attach to a run of a rod.

use super::record::RodSample;

/// Hooks of a charge or a discharge. None of them changes its result.
///
/// The sample function gets every sample, also those of a charge. A finished phase keeps its result, in memory until the next
/// checkpoint is due, so that the next call returns it at once.
pub type RunHooks<'a> = topo_core::RunHooks<'a, dyn FnMut(&RodSample) + 'a>;
