//! What a battery says of an experiment.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::cost::Cost;
use crate::error::LabError;
use crate::folder::Outcome;
use crate::progress::{Event, SweepSettings};
use crate::system::System;
use topo_analysis::Warnings;

/// What a battery says so that its scenes can be swept.
pub(crate) trait Experiment: Sync {
    /// One charge with its discharges.
    type Case: Sync;
    /// A row of its table.
    type Row: Row;
    /// What cases start from, made once for all of them.
    type Start: Sync + Send;

    /// Changes whenever the same scene gives other numbers than before.
    const RESULTS: u32;
    /// Whose speed tells how long its cases take.
    const SYSTEM: System;

    /// Folder of the table below the output folder.
    fn folder(&self) -> &str;

    /// The scene with every value written out.
    fn text(&self) -> String;

    /// The cases, in the order of the table.
    fn cases(&self) -> Result<Vec<Self::Case>, LabError>;

    /// Name of a case's folder, of no other case.
    fn name(&self, case: &Self::Case) -> String;

    /// Hash of everything that the numbers of a case depend on.
    fn fingerprint(&self, case: &Self::Case) -> Result<String, LabError>;

    /// A row with the settings of a case only.
    fn blank_row(&self, case: &Self::Case) -> Self::Row;

    /// What a case is expected to take; a finished one with its number of rows.
    fn cost(&self, case: &Self::Case, n_rows: Option<usize>) -> Result<Cost, LabError>;

    /// Whether a case makes use of several threads when it has them for itself.
    fn uses_all_threads(&self) -> bool {
        false
    }

    /// Whether what is finished in `folder` has all that is asked for.
    fn has_all(&self, _folder: &Path, _settings: &SweepSettings) -> bool {
        true
    }

    /// What the cases to be computed start from.
    fn prepare(
        &self,
        todo: &[&Self::Case],
        settings: &SweepSettings,
        progress: &(dyn Fn(Event<'_>) + Sync),
    ) -> Result<Self::Start, LabError>;

    /// Runs a case and writes its folder; `None` when interrupted.
    fn run(
        &self,
        case: &Self::Case,
        start: &Self::Start,
        place: &Place<'_>,
    ) -> Result<Option<Outcome<Self::Row>>, LabError>;
}

/// A row of a sweep's table.
pub(crate) trait Row: Serialize + DeserializeOwned + Clone + Send + Sync {
    /// Processor seconds that it took.
    fn cpu_seconds(&self) -> f64;

    /// What is doubtful about it.
    fn warnings(&self) -> &Warnings;

    /// The row with the settings of another: finished cases of earlier programs may lack some.
    fn with_settings_of(self, blank: &Self) -> Self;
}

/// Where and how a case runs.
pub(crate) struct Place<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its folder.
    pub folder: &'a Path,
    /// Of the sweep.
    pub settings: &'a SweepSettings,
    /// Whether it has all threads for itself.
    pub is_alone: bool,
    /// Processor seconds that it is expected to take on the models' machine.
    pub expected: f64,
    /// Told where it is.
    pub progress: &'a (dyn Fn(Event<'_>) + Sync),
}
