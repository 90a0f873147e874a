//! Experiments: from a scene to its tables.
//!
//! Reading order: [`Battery`] (what a program lists) → [`Scene`] (what a TOML file says) → [`Experiment`] (its cases) → [`Sweep`] (in
//! parallel, resumable, into one table). [`Elastic`] fills them with [`ElasticScene`] and [`topo_analysis::SweepRow`], [`Colloid`] with
//! [`NematicScene`] and [`topo_analysis::NematicRow`]; a battery of another crate does the same. Then what is
//! made of many runs: [`tradeoff`] (what accuracy costs) and [`Goal`] (settings picked by it), [`stability`] (extremes), [`term_costs`].
//!
//! Elastic energies are in E_0 = E_b h² L and times in T_0 = 2 L η/(h E_b), with L the row's own length; nematic energies in
//! L ξ_N and times in τ_N.

mod battery;
mod cost;
mod elastic;
mod error;
mod folder;
mod goal;
mod knots;
mod links;
mod nematic;
mod preset;
mod progress;
mod scene;
mod stability;
mod sweep;
mod system;
mod terms;
mod tradeoff;

pub use battery::{
    Battery, Checked, Options, Scene, Stage, Sweep, Swept, parse_scene, read_scene, scene_faults,
};
pub use cost::{Cost, Estimate, Probe};
pub use elastic::{
    ACCURACY_CASES, AccuracyRow, Cuts, Elastic, ElasticCase, ElasticReport, ElasticScene, NEAR_TIE,
    Names, Observable, OwnKnots, OwnTerm, Purpose, RESULTS_VERSION, Rest, RestKeys, RestProfile,
    Rods, ShapeFrame, Si, Tie, Tied, Variant, discharge_frames, estimate_sweep, measure_accuracy,
    perturbed, reference_scene, run_sweep,
};
pub use error::LabError;
pub use folder::{Outcome, identity, writable};
pub use goal::{
    CheckRow, Choice, Cover, ErrorKind, ErrorRow, Factor, Goal, Measured, Point, Record, Stamp,
    check_estimates, errors_of_colloids, errors_of_rods, factor_of_estimates, points, table_hash,
};
pub use knots::{Shapes, knots_folder, tight_shapes, write_knots};
pub use links::{tight_links, write_links};
pub use nematic::{
    BucklingCase, BucklingRow, Colloid, FieldSnapshot, NEMATIC_RESULTS_VERSION, NematicCase,
    NematicFrame, NematicReport, NematicScene, buckling_cases, buckling_study,
    estimate_nematic_sweep, nematic_frames, run_nematic_sweep,
};
pub use preset::Preset;
pub use progress::{Event, Shard, SweepSettings, with_jobs};
pub use scene::{Axis, AxisValue, Document, KeyRow, Keys, Numbers, SceneFault, folder_of, numbers};
pub use stability::{Ending, StabilityRow, n_extremes, stability};
pub use sweep::{About, CaseFolder, CaseName, Experiment, FailedCase, Place, Row, SweepReport};
pub use system::System;
pub use terms::{TermCost, term_costs};
pub use tradeoff::{
    CaseSet, PeakBytes, REFERENCE, Setting, TradeoffEvent, TradeoffRow, TradeoffRun, TradeoffWork,
    compared, ladder, settings_of, tradeoff,
};
