//! What a caller may hang into a run: an interrupt, a progress report, a checkpoint file, an observer.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Serialize;
use serde::de::DeserializeOwned;
use topo_core::{FileError, Interrupt, load_checkpoint, save_checkpoint};

use super::record::NematicSample;
use crate::{FlowCoupling, NematicError, NematicState};

/// Which phase a run is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Relaxing with the pattern on the surface.
    Charge,
    /// Relaxing to the state that released energy counts from.
    FinalState,
    /// After the switch.
    Discharge,
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// The phase.
    pub phase: Phase,
    /// Steps taken in it.
    pub step: u64,
    /// Time reached in a discharge, in tau_N.
    pub time: f64,
    /// Energy, where it is known, in L xi_N.
    pub energy: Option<f64>,
    /// Root mean square of the molecular field.
    pub rms_field: f64,
}

/// More steps than any run takes: counters beyond it come from a broken file.
pub(super) const MOST_COUNTED: u64 = 1 << 53;

type ProgressFn<'a> = dyn FnMut(&Progress) + 'a;
type SampleFn<'a> = dyn FnMut(&NematicSample, &NematicState, Option<&FlowCoupling>) + 'a;

/// Hooks of a run; none of them changes its result.
pub struct RunHooks<'a> {
    interrupt: Interrupt,
    progress: Option<&'a mut ProgressFn<'a>>,
    samples: Option<&'a mut SampleFn<'a>>,
    checkpoint: Option<PathBuf>,
    interval: Duration,
    last: Instant,
}

impl<'a> RunHooks<'a> {
    /// Hooks with an interrupt only.
    pub fn new(interrupt: &Interrupt) -> Self {
        Self {
            interrupt: interrupt.clone(),
            progress: None,
            samples: None,
            checkpoint: None,
            interval: Duration::from_secs(30),
            last: Instant::now(),
        }
    }

    /// With a function that is told of progress every few steps.
    pub fn with_progress(mut self, progress: &'a mut ProgressFn<'a>) -> Self {
        self.progress = Some(progress);
        self
    }

    /// With a function that sees each sample of a discharge, its state, and the flow if there is one.
    pub fn with_samples(mut self, samples: &'a mut SampleFn<'a>) -> Self {
        self.samples = Some(samples);
        self
    }

    /// With a checkpoint file, written every `interval` seconds at most (30 by default); a run that finds its own checkpoint goes on
    /// from there. A finished charge leaves one, so that the next call has its result at once; a finished discharge removes its own.
    pub fn with_checkpoint(mut self, path: &Path, interval: f64) -> Self {
        self.checkpoint = Some(path.to_owned());
        self.interval = Duration::try_from_secs_f64(interval).unwrap_or(self.interval);
        self
    }

    /// The interrupt alone, for work on the side.
    pub(crate) fn without_files(&self) -> RunHooks<'static> {
        RunHooks::new(&self.interrupt)
    }

    pub(crate) fn is_interrupted(&self) -> bool {
        self.interrupt.is_requested()
    }

    pub(crate) fn report(&mut self, progress: &Progress) {
        if let Some(f) = &mut self.progress {
            f(progress);
        }
    }

    pub(crate) fn wants_samples(&self) -> bool {
        self.samples.is_some()
    }

    pub(crate) fn show(
        &mut self,
        sample: &NematicSample,
        state: &NematicState,
        flow: Option<&FlowCoupling>,
    ) {
        if let Some(f) = &mut self.samples {
            f(sample, state, flow);
        }
    }

    /// The checkpoint of the case, if there is one; `flaw` names what does not fit the case.
    pub(crate) fn resume<T: DeserializeOwned>(
        &self,
        schema: &str,
        case: &str,
        flaw: impl Fn(&T) -> Option<&'static str>,
    ) -> Result<Option<T>, NematicError> {
        let Some(path) = self.checkpoint.as_ref().filter(|p| p.exists()) else {
            return Ok(None);
        };
        let (found, value): (String, T) = load_checkpoint(path, schema)?;
        if found != case {
            return Err(NematicError::ForeignCheckpoint {
                path: path.display().to_string(),
            });
        }
        match flaw(&value) {
            None => Ok(Some(value)),
            Some(what) => Err(FileError::Corrupt {
                path: path.clone(),
                what: what.to_owned(),
            }
            .into()),
        }
    }

    /// Whether there is a file for checkpoints.
    pub(crate) fn keeps_checkpoints(&self) -> bool {
        self.checkpoint.is_some()
    }

    /// Whether a checkpoint should be written now.
    pub(crate) fn is_due(&self) -> bool {
        self.checkpoint.is_some() && (self.last.elapsed() >= self.interval || self.is_interrupted())
    }

    pub(crate) fn save<T: Serialize>(
        &mut self,
        schema: &str,
        case: &str,
        value: &T,
    ) -> Result<(), NematicError> {
        if let Some(path) = &self.checkpoint {
            save_checkpoint(path, schema, &(case, value))?;
            self.last = Instant::now();
        }
        Ok(())
    }

    /// Removes the checkpoint of a finished phase.
    pub(crate) fn finish(&self) {
        if let Some(path) = &self.checkpoint {
            // A file that is not there needs no removal.
            drop(std::fs::remove_file(path));
        }
    }
}
