//! Which parts of a rod can touch: broad phase, Verlet list, window along the rod, and distances of segments.

mod broad_phase;
mod hard_core;
mod known;
mod pairs;
mod segments;
mod window;

pub(crate) use self::hard_core::Core;
pub use self::hard_core::CorePair;
pub use broad_phase::{BroadPhase, close_pairs};
pub(crate) use known::KnownPairs;
pub(crate) use pairs::PairsMemory;
pub use pairs::{ActivePair, ContactPairs};
pub use segments::segment_distance;
pub use window::{Window, arc_separation};
