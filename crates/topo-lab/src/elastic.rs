//! Elastic scenes: knots, charged, cut and followed.

mod accuracy;
mod battery;
mod by_goal;
mod case;
mod case_run;
mod check;
mod choices;
mod cost;
mod defaults;
mod file;
mod frames;
mod identity;
mod imperfection;
mod keys;
mod name;
mod observable;
mod options;
mod own_term;
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
pub(crate) use case_run::CaseInputs;
pub use choices::{Cuts, NEAR_TIE, Names};
pub use frames::{ShapeFrame, discharge_frames};
pub use identity::RESULTS_VERSION;
pub use imperfection::perturbed;
#[cfg(test)]
pub(crate) use keys::ROD_KEYS;
pub use observable::Observable;
pub use own_term::OwnTerm;
pub(crate) use probe::ROD_PROBE;
pub use scene::{ElasticScene, OwnKnots};
pub use sweep::{ElasticReport, Rods, estimate_sweep, run_sweep};
pub use variants::{Purpose, Variant};
