//! Analysis of tables of discharges: discharge times, knot timelines, ensembles and resonances.
//!
//! Reading order: [`DischargeTimes`] (when which share of an energy was released) and [`Timeline`] (which knot an open rod is
//! tied in) of one discharge → [`SweepRow`], [`NematicRow`] (its row of a table) → [`read_table`] → [`ensembles`],
//! [`resonances`] and [`nematic_resonance`] (results of a whole table).
//!
//! Elastic energies are in E_0 = E_b h² L and times in T_0 = 2 L η/(h E_b), with L the row's own length; nematic energies in
//! L ξ_N and times in τ_N.

mod elastic;
mod error;
mod further;
mod nematic;
mod statistics;
mod table;
mod timeline;
mod times;
mod warnings;

pub use elastic::{
    Ensemble, Regime, Resonance, SweepRow, crossover, ensembles, regime, resonances,
};
pub use error::AnalysisError;
pub use further::Further;
pub use nematic::{
    BUCKLED, Flow, LinePoint, NematicResonance, NematicRow, NematicSample, SlicePoint, buckling,
    late_rate, nematic_resonance, resonance_peak,
};
pub use statistics::{Spread, median, quantile, standard_deviation};
pub use table::{KnotRow, LinkRow, columns, parse_table, read_table, table_bytes, write_table};
pub use timeline::{Timeline, TimelineSettings, TypedSample, UNKNOT};
pub use times::{DischargeTimes, ELASTIC_SHARES, Interpolated, NEMATIC_SHARES};
pub use warnings::{Warning, Warnings};
