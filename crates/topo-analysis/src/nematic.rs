//! Nematic scenes: colloids, charged, switched and followed; their tables and what these say.

mod case;
mod check;
mod cost;
mod field;
mod file;
mod frames;
mod keys;
mod late;
mod name;
mod onset;
mod resonance;
mod scene;
mod snapshot;
mod sweep;
mod table;

pub use case::{NEMATIC_SHARES, RESULTS_VERSION as NEMATIC_RESULTS_VERSION};
pub use field::FieldSnapshot;
pub use frames::{NematicFrame, nematic_frames};
pub use onset::{BucklingCase, BucklingRow, buckling_cases, buckling_study};
pub use resonance::{NematicResonance, buckling, nematic_resonance, resonance_peak};
pub(crate) use scene::fit;
pub use scene::{NematicCase, NematicScene};
pub use sweep::{NematicReport, estimate_nematic_sweep, run_nematic_sweep};
pub use table::{LinePoint, NematicRow, NematicSample, SlicePoint};
