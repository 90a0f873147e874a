//! Elastic scenes: knots, charged, cut and followed; their tables and what these say.

mod accuracy;
mod case;
mod check;
mod choices;
mod cost;
mod file;
mod frames;
mod imperfection;
mod keys;
mod name;
mod record;
mod resonance;
mod scene;
mod sweep;
mod variants;

pub use accuracy::{ACCURACY_CASES, AccuracyRow, measure_accuracy, reference_scene};
pub(crate) use accuracy::{MeasuredDischarge, exact_discharge, measured_discharge};
pub(crate) use case::CaseJob;
pub use case::RESULTS_VERSION;
pub use choices::{Cuts, NEAR_TIE, Names, Numbers, Preset};
pub use frames::{ShapeFrame, discharge_frames};
pub use imperfection::perturbed;
pub use resonance::{Ensemble, Regime, Resonance, crossover, ensembles, regime, resonances};
pub use scene::{ElasticCase, ElasticScene, OwnKnots};
pub use sweep::{ElasticReport, estimate_sweep, run_sweep};
pub use variants::{Purpose, Variant};
