//! A run of a trade-off: what is to come, and what was measured.

use serde::{Deserialize, Serialize};
use topo_core::{CpuClock, Interrupt};

use crate::error::LabError;

/// Name of the setting that the others are compared with.
pub const REFERENCE: &str = "reference";

/// One quantity of one run, as measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TradeoffRun {
    /// What was run.
    pub case: String,
    /// Which setting was chosen.
    pub setting: String,
    /// Its value.
    pub value: String,
    /// What was found.
    pub quantity: String,
    /// Its number; empty when the run did not come so far.
    pub result: Option<f64>,
    /// Processor seconds of the run.
    pub cpu_seconds: f64,
    /// Most bytes held during the run.
    pub peak_bytes: u64,
}

/// One quantity of one run beside its reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TradeoffRow {
    /// `rod`, `nematic` or `knots`.
    pub system: String,
    /// What was run.
    pub case: String,
    /// Which setting was chosen.
    pub setting: String,
    /// Its value.
    pub value: String,
    /// What was found.
    pub quantity: String,
    /// Its number; empty when the run did not come so far.
    pub result: Option<f64>,
    /// The number of the reference.
    pub reference: Option<f64>,
    /// |result/reference − 1|; empty without one of them, or where the reference is zero.
    pub relative_error: Option<f64>,
    /// Processor seconds of the run.
    pub cpu_seconds: f64,
    /// Most bytes held during the run.
    pub peak_bytes: u64,
    /// Whether no other numerical setting is both cheaper and more accurate in this quantity over all cases.
    pub pareto: bool,
}

/// Measures the most bytes that a computation holds beyond those held before it.
pub type PeakBytes<'a> = &'a (dyn Fn(&mut dyn FnMut()) -> u64 + Sync);

/// Times a run and counts its bytes.
pub(crate) struct Meter<'a> {
    pub peak: PeakBytes<'a>,
}

impl Meter<'_> {
    pub(super) fn measure<T>(&self, run: impl FnOnce() -> T) -> (Option<T>, f64, u64) {
        let (mut run, mut found) = (Some(run), None);
        let clock = CpuClock::start();
        let bytes = (self.peak)(&mut || found = run.take().map(|run| run()));
        (found, clock.seconds(), bytes)
    }
}

/// Numbers by quantity; none where the run did not come so far.
pub(super) type Quantities = Vec<(&'static str, Option<f64>)>;

/// What a run found: numbers by quantity, processor seconds, most bytes held.
pub(crate) struct Outcome {
    pub quantities: Quantities,
    pub cpu_seconds: f64,
    pub peak_bytes: u64,
}

/// A run to come.
pub(crate) struct Trial {
    pub case: String,
    pub setting: &'static str,
    pub value: String,
    pub run: Box<TrialFn>,
}

type TrialFn = dyn Fn(&Meter<'_>, &Interrupt) -> Result<Option<Outcome>, LabError> + Send + Sync;

impl Trial {
    pub(super) fn is_of(&self, run: &TradeoffRun) -> bool {
        self.case == run.case && self.setting == run.setting && self.value == run.value
    }

    pub(super) fn name(&self) -> String {
        format!("{} {} {}", self.case, self.setting, self.value)
    }
}

/// What surrounds the runs of a trade-off.
pub struct TradeoffWork<'a> {
    /// Folder in which tight shapes are kept.
    pub out: &'a std::path::Path,
    /// Runs that were finished before.
    pub known: &'a [TradeoffRun],
    /// Asks to stop.
    pub interrupt: &'a Interrupt,
    /// How bytes are measured.
    pub peak_bytes: PeakBytes<'a>,
    /// Reported the number of runs to come, then the name of each that is finished with its rows.
    pub report: &'a (dyn Fn(TradeoffEvent<'_>) + Sync),
}

/// What a trade-off tells.
#[derive(Debug)]
pub enum TradeoffEvent<'a> {
    /// So many runs begin.
    Begin(usize),
    /// A run is finished.
    Done {
        /// Its name.
        name: &'a str,
        /// Its rows.
        runs: &'a [TradeoffRun],
    },
}
