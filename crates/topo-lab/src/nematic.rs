//! Nematic scenes: colloids, charged, switched and followed.

mod battery;
mod by_goal;
mod case;
mod check;
mod cost;
mod field;
mod file;
mod frames;
mod identity;
mod keys;
mod name;
mod onset;
mod options;
mod print;
mod probe;
mod run;
mod scene;
mod snapshot;
mod sweep;

pub use battery::Colloid;
pub use case::NematicCase;
pub use field::FieldSnapshot;
pub use frames::{NematicFrame, nematic_frames};
pub use identity::RESULTS_VERSION as NEMATIC_RESULTS_VERSION;
#[cfg(test)]
pub(crate) use keys::COLLOID_KEYS;
pub use onset::{BucklingCase, BucklingRow, buckling_cases, buckling_study};
#[cfg(test)]
pub(crate) use probe::COLLOID_PROBE;
pub use scene::NematicScene;
pub(crate) use scene::fit;
pub use sweep::{NematicReport, estimate_nematic_sweep, run_nematic_sweep};
