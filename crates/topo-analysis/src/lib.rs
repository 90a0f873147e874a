//! From scenes to discharge times, knot timelines, ensembles and resonances.
//!
//! Reading order: [`ElasticScene`] (what a TOML file says) → [`run_sweep`] (its cases, in parallel, resumable) → [`SweepRow`]
//! (the table) → [`DischargeTimes`], [`Timeline`], [`ensembles`], [`resonances`] (what the table says).
//!
//! Energies are in E_0 = E_b h² L and times in T_0 = 2 L η/(h E_b), with L the row's own length.

mod accuracy;
mod case;
mod error;
mod imperfection;
mod knots;
mod resonance;
mod scene;
mod statistics;
mod sweep;
mod table;
mod timeline;
mod times;

pub use accuracy::{ACCURACY_CASES, AccuracyRow, measure_accuracy, reference_scene};
pub use case::RESULTS_VERSION;
pub use error::AnalysisError;
pub use imperfection::perturbed;
pub use knots::{Shapes, knots_folder, tight_shapes, write_knots};
pub use resonance::{Ensemble, Regime, Resonance, crossover, ensembles, regime, resonances};
pub use scene::{Cuts, ElasticCase, ElasticScene, NEAR_TIE, Names, Numbers, Preset};
pub use statistics::{Spread, median, quantile};
pub use sweep::{Event, SweepReport, SweepSettings, run_sweep, with_jobs, writable};
pub use table::{KnotRow, SweepRow, read_table, write_table};
pub use timeline::{Timeline, TimelineSettings, TypedSample, UNKNOT};
pub use times::{DischargeTimes, ELASTIC_SHARES, Interpolated};
