//! From scenes to discharge times, knot timelines, ensembles and resonances.
//!
//! Reading order: [`Scene`] (what a TOML file says): [`ElasticScene`] → [`run_sweep`] (its cases, in parallel, resumable) → [`SweepRow`]
//! (the table) → [`DischargeTimes`], [`Timeline`], [`ensembles`], [`resonances`] (what the table says); and [`NematicScene`] →
//! [`run_nematic_sweep`] → [`NematicRow`] → [`nematic_resonance`].
//!
//! Elastic energies are in E_0 = E_b h² L and times in T_0 = 2 L η/(h E_b), with L the row's own length; nematic energies in
//! L ξ_N and times in τ_N.

mod cost;
mod elastic;
mod error;
mod folder;
mod knots;
mod nematic;
mod progress;
mod scene;
mod stability;
mod statistics;
mod sweep;
mod system;
mod table;
mod terms;
mod timeline;
mod times;
mod tradeoff;
mod wish;

pub use cost::Estimate;
pub use elastic::{
    ACCURACY_CASES, AccuracyRow, Cuts, ElasticCase, ElasticReport, ElasticScene, Ensemble,
    NEAR_TIE, Names, Numbers, OwnKnots, Preset, Purpose, RESULTS_VERSION, Regime, Resonance,
    ShapeFrame, Variant, crossover, discharge_frames, ensembles, estimate_sweep, measure_accuracy,
    perturbed, reference_scene, regime, resonances, run_sweep,
};
pub use error::AnalysisError;
pub use folder::writable;
pub use knots::{Shapes, knots_folder, tight_shapes, write_knots};
pub use nematic::{
    BucklingCase, BucklingRow, FieldSnapshot, LinePoint, NEMATIC_RESULTS_VERSION, NEMATIC_SHARES,
    NematicCase, NematicFrame, NematicReport, NematicResonance, NematicRow, NematicSample,
    NematicScene, SlicePoint, buckling, buckling_cases, buckling_study, estimate_nematic_sweep,
    nematic_frames, nematic_resonance, resonance_peak, run_nematic_sweep,
};
pub use progress::{Event, Shard, SweepSettings, with_jobs};
pub use scene::{Axis, AxisValue, Scene};
pub use stability::{StabilityRow, n_extremes, stability};
pub use statistics::{Spread, median, quantile, standard_deviation};
pub use sweep::{FailedCase, SweepReport};
pub use system::{Effort, System};
pub use table::{KnotRow, SweepRow, parse_table, read_table, table_bytes, write_table};
pub use terms::{TermCost, term_costs};
pub use timeline::{Timeline, TimelineSettings, TypedSample, UNKNOT};
pub use times::{DischargeTimes, ELASTIC_SHARES, Interpolated};
pub use tradeoff::{
    CaseSet, PeakBytes, REFERENCE, Setting, TradeoffEvent, TradeoffRow, TradeoffRun, TradeoffWork,
    compared, ladder, settings_of, tradeoff,
};
pub use wish::{
    CheckRow, Cover, ErrorRow, Factor, Grant, Measured, Point, Record, Stamp, Wish,
    check_estimates, errors_of_colloids, errors_of_rods, factor_of_estimates, points, table_hash,
};
