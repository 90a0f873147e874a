//! Elastic scenes: knots, charged, cut and followed.

mod accuracy;
mod battery;
mod by_wish;
mod case;
mod check;
mod choices;
mod cost;
mod defaults;
mod file;
mod frames;
mod identity;
mod imperfection;
mod job;
mod keys;
mod name;
mod options;
mod print;
mod probe;
mod record;
mod run;
mod scene;
mod sweep;
mod variants;

pub use accuracy::{ACCURACY_CASES, AccuracyRow, measure_accuracy, reference_scene};
pub(crate) use accuracy::{MeasuredDischarge, exact_discharge, measured_discharge};
pub use battery::Elastic;
pub use case::ElasticCase;
pub use choices::{Cuts, NEAR_TIE, Names};
pub use frames::{ShapeFrame, discharge_frames};
pub use identity::RESULTS_VERSION;
pub use imperfection::perturbed;
pub(crate) use job::CaseJob;
pub(crate) use probe::ROD_PROBE;
pub use scene::{ElasticScene, OwnKnots};
pub use sweep::{ElasticReport, Rods, estimate_sweep, run_sweep};
pub use variants::{Purpose, Variant};
