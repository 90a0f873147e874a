//! Analysis of tables of rods.

mod resonance;
mod table;

pub use resonance::{Ensemble, Regime, Resonance, crossover, ensembles, regime, resonances};
pub use table::SweepRow;
