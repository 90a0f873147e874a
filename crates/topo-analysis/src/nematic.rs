//! Analysis of tables of colloids.

mod late;
mod resonance;
mod table;

pub use late::late_rate;
pub use resonance::{NematicResonance, buckling, nematic_resonance, resonance_peak};
pub use table::{BUCKLED, Flow, LinePoint, NematicRow, NematicSample, SlicePoint};
