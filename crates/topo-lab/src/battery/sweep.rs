//! What programs do with an experiment, whatever its battery.

use std::path::{Path, PathBuf};

use topo_analysis::write_table;

use crate::LabError;
use crate::cost::Estimate;
use crate::goal::{Choice, ErrorRow};
use crate::progress::{Event, SweepSettings};
use crate::sweep::FailedCase;

/// An experiment that can be estimated and run; every [`Experiment`](crate::Experiment) is one.
pub trait Sweep {
    /// What it is called while it runs.
    fn label(&self) -> &'static str;

    /// Where its tables lie below an output folder.
    fn results(&self, out: &Path) -> PathBuf;

    /// Picks the settings that meets its goal; nothing without one.
    ///
    /// # Errors
    /// A goal that no measured setting meets, with what is possible.
    fn choose(&mut self, jobs: usize) -> Result<Option<Choice>, LabError>;

    /// What of it is to be done, stage after stage; nothing where all is finished.
    ///
    /// # Errors
    /// As [`sweep`](Self::sweep).
    fn stages(&self, settings: &SweepSettings) -> Result<Vec<Stage>, LabError>;

    /// Runs all its cases; what an earlier run finished with the same settings is kept.
    ///
    /// Each case writes its own folder and is complete when its `run.json` is there; `sweep.csv`, and `failed.csv` where a case
    /// failed, are written at the end, also after an interrupt, from what is finished, whichever shard computed it. A case that
    /// fails leaves the others alone. Results do not depend on the number of jobs.
    ///
    /// # Errors
    /// A scene that makes no sense, a folder with the results of another scene, or files that cannot be written.
    fn sweep(
        &self,
        settings: &SweepSettings,
        progress: &(dyn Fn(Event<'_>) + Sync),
    ) -> Result<Box<dyn Swept + '_>, LabError>;
}

/// A stage of work and what it is expected to take.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage {
    /// What it is called.
    pub name: &'static str,
    /// What one of its parts is called, such as `case`.
    pub part: &'static str,
    /// What it is expected to take.
    pub estimate: Estimate,
}

impl Stage {
    /// The cases themselves.
    pub(crate) fn cases(estimate: Estimate) -> Self {
        Self {
            name: "cases",
            part: "case",
            estimate,
        }
    }

    /// Tight shapes of knots.
    pub fn shapes(estimate: Estimate) -> Self {
        Self {
            name: "tight shapes",
            part: "knot",
            estimate,
        }
    }
}

/// A sweep that has been run.
pub trait Swept {
    /// Cases without a result, or whose run did not finish.
    fn failed(&self) -> &[FailedCase];

    /// Cases computed now.
    fn n_computed(&self) -> usize;

    /// Cases found finished.
    fn n_reused(&self) -> usize;

    /// Whether it was asked to stop before the end.
    fn is_interrupted(&self) -> bool;

    /// What it was expected to take.
    fn estimate(&self) -> &Estimate;

    /// Seconds that its cases took, what they start from not counted.
    fn wall_seconds(&self) -> f64;

    /// Its table and what is found in it, line by line, warnings below their rows.
    fn lines(&self) -> Vec<String>;

    /// What is doubtful about its rows.
    fn warnings(&self) -> Vec<String>;

    /// Runs the coarser experiment whose difference tells the errors of this one; nothing where there is none.
    ///
    /// # Errors
    /// As [`Sweep::sweep`].
    fn check(
        &self,
        choice: &Choice,
        settings: &SweepSettings,
        progress: &(dyn Fn(Event<'_>) + Sync),
    ) -> Result<Option<Checked>, LabError>;
}

/// What a coarser run tells.
#[derive(Debug, Clone)]
pub struct Checked {
    /// Errors of the results.
    pub errors: Vec<ErrorRow>,
    /// Its cases that failed.
    pub failed: Vec<FailedCase>,
    /// Where its tables lie.
    pub folder: PathBuf,
    /// Whether it was asked to stop before the end.
    pub is_interrupted: bool,
}

impl Checked {
    /// Writes its errors beside the table of the results and says where.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<PathBuf, LabError> {
        let path = folder.join("errors.csv");
        write_table(&path, &self.errors)?;
        Ok(path)
    }
}
