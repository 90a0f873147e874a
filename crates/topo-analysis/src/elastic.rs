//! What tables of rods say.

mod resonance;
mod table;

pub use resonance::{Ensemble, Regime, Resonance, crossover, ensembles, regime, resonances};
pub use table::SweepRow;
