//! What a battery says of an experiment.

use std::path::Path;

use super::place::Place;
use super::row::Row;
use crate::battery::{Battery, Stage};
use crate::cost::Cost;
use crate::error::LabError;
use crate::folder::Outcome;
use crate::goal::{Choice, ErrorRow};
use crate::progress::{Event, SweepSettings};

/// What a battery says so that its scenes can be swept, and their tables printed.
///
/// Every experiment is a [`Sweep`](crate::Sweep): its cases run in parallel, in shards, are resumed where an earlier run stopped,
/// and are gathered into `sweep.csv`.
pub trait Experiment: Sync {
    /// One charge with its discharges.
    type Case: Sync;
    /// A row of its table.
    type Row: Row;
    /// What cases start from, made once for all of them; `()` where there is nothing.
    type Start: Sync + Send;

    /// Whose experiment it is.
    fn battery(&self) -> &'static dyn Battery;

    /// Folder of the table below the output folder: [`folder_of`](crate::folder_of) the scene's file.
    fn folder(&self) -> &str;

    /// The scene with every value written out; it is kept beside the table, and tells another scene what differs.
    fn text(&self) -> String;

    /// The cases, in the order of the table.
    ///
    /// # Errors
    /// A scene that makes no sense.
    fn cases(&self) -> Result<Vec<Self::Case>, LabError>;

    /// Name of a case's folder, of no other case: see [`CaseName`](crate::CaseName).
    fn name(&self, case: &Self::Case) -> String;

    /// Hash of everything that the numbers of a case depend on: see [`identity`](crate::identity).
    ///
    /// # Errors
    /// A case that makes no sense.
    fn fingerprint(&self, case: &Self::Case) -> Result<String, LabError>;

    /// A row with the settings of a case only.
    fn blank_row(&self, case: &Self::Case) -> Self::Row;

    /// What a case is expected to take; a finished one with its number of rows.
    ///
    /// # Errors
    /// A case that makes no sense.
    fn cost(&self, case: &Self::Case, n_rows: Option<usize>) -> Result<Cost, LabError>;

    /// Whether a case makes use of several threads when it has them for itself.
    fn uses_all_threads(&self) -> bool {
        false
    }

    /// Whether what is finished in `folder` has all that is asked for.
    fn has_all(&self, _folder: &Path, _settings: &SweepSettings) -> bool {
        true
    }

    /// Stages of work before the cases, and what they are expected to take.
    ///
    /// # Errors
    /// A scene that makes no sense.
    fn stages_before(&self, _settings: &SweepSettings) -> Result<Vec<Stage>, LabError> {
        Ok(Vec::new())
    }

    /// What the cases to be computed start from.
    ///
    /// # Errors
    /// What is not possible; no case is run then.
    fn prepare(
        &self,
        todo: &[&Self::Case],
        settings: &SweepSettings,
        progress: &(dyn Fn(Event<'_>) + Sync),
    ) -> Result<Self::Start, LabError>;

    /// Runs a case and writes its folder through [`Place::open`]; `None` when
    /// [interrupted](SweepSettings::interrupt).
    ///
    /// Its numbers depend on nothing but what its [fingerprint](Self::fingerprint) knows: neither on the number of threads, nor on
    /// whether it was resumed.
    ///
    /// # Errors
    /// [`LabError::Case`] where the case is refused: others go on. Any other error ends the sweep.
    fn run(
        &self,
        case: &Self::Case,
        start: &Self::Start,
        place: &Place<'_>,
    ) -> Result<Option<Outcome<Self::Row>>, LabError>;

    /// Writes further tables of all rows beside `sweep.csv`, in the folder of the scene, and takes away those of an earlier run that are
    /// asked for no more.
    ///
    /// # Errors
    /// Files that cannot be written.
    fn write_beside(&self, _folder: &Path, _rows: &[Self::Row]) -> Result<(), LabError> {
        Ok(())
    }

    /// The line above the rows of the printed table.
    fn header(&self) -> String;

    /// Lines below the printed table that say what its columns are, with their units.
    fn legend(&self) -> &'static [&'static str] {
        &[]
    }

    /// A row of the printed table, its warnings left out.
    fn line(&self, row: &Self::Row) -> String;

    /// Lines below the table.
    fn findings(&self, _rows: &[Self::Row]) -> Vec<String> {
        Vec::new()
    }

    /// Picks the settings that meets the goal of the scene; a battery without measured settings has no goals.
    ///
    /// # Errors
    /// A goal that no measured setting meets, with what is possible.
    fn choose_settings(&mut self, _jobs: usize) -> Result<Option<Choice>, LabError> {
        Ok(None)
    }

    /// The coarser experiment whose difference to the runs `rows` of this one tells their error; nothing where there are no
    /// goals.
    ///
    /// # Errors
    /// A scene that makes no sense.
    fn coarser(&self, _grant: &Choice, _rows: &[Self::Row]) -> Result<Option<Self>, LabError>
    where
        Self: Sized,
    {
        Ok(None)
    }

    /// Errors of the runs `rows`, beside those of the [coarser](Self::coarser) experiment.
    fn errors(
        &self,
        _grant: &Choice,
        _rows: &[Self::Row],
        _coarser: &[Self::Row],
    ) -> Vec<ErrorRow> {
        Vec::new()
    }
}
