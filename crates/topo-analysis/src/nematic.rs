//! Nematic scenes: colloids, charged, switched and followed; their tables and what these say.

mod resonance;
mod table;

pub use resonance::{NematicResonance, buckling, nematic_resonance, resonance_peak};
pub use table::{LinePoint, NematicRow, NematicSample, SlicePoint};
