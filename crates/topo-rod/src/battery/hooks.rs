//! What a caller may hang into a run of a rod.

use super::record::RodSample;

/// Hooks of a charge or a discharge; none of them changes its result.
///
/// The function that sees samples is given each of them, of charges too. A finished phase keeps its checkpoint, so that the next call
/// has its result at once: in memory, until the next one is due.
pub type RunHooks<'a> = topo_core::RunHooks<'a, dyn FnMut(&RodSample) + 'a>;
