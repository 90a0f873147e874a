//! What a caller can attach to a run of any battery: an interrupt, a progress report, a checkpoint file, a look at samples.

mod progress;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::checkpoint::{checkpoint_bytes, load_checkpoint};
use crate::file::{FileError, write_atomic_bytes};
use crate::stop::Interrupt;

pub use progress::{Phase, Progress};

/// More steps than any run takes: counters beyond it come from a broken file.
pub const MOST_COUNTED: u64 = 1 << 53;

/// Seconds between two checkpoints, unless set otherwise.
const INTERVAL: Duration = Duration::from_secs(30);

type ProgressFn<'a> = dyn FnMut(&Progress) + 'a;

/// Hooks of a run. None of them changes its result.
///
/// `F` is the function that sees samples, as each battery defines it.
///
/// A run with a checkpoint file writes it when the last one is older than the interval, and when it is interrupted; a run that
/// finds the checkpoint of its own case continues from there and ends with the same bits. One set of hooks may serve all phases
/// of a case: each [names its file](Self::keep_in), and what was finished but not yet written is written together with the next
/// checkpoint. So a killed case loses at most the work of one interval, and a short case writes no checkpoint.
///
/// # Validation
/// `a_checkpoint_is_found_by_its_own_case_only`, `finished_phases_are_written_with_the_next_checkpoint`
pub struct RunHooks<'a, F: ?Sized> {
    interrupt: Interrupt,
    progress: Option<&'a mut ProgressFn<'a>>,
    samples: Option<&'a mut F>,
    checkpoint: Option<PathBuf>,
    interval: Duration,
    last: Instant,
    /// Finished phases that are in no file yet.
    finished: Vec<(PathBuf, Vec<u8>)>,
}

impl<F: ?Sized> Default for RunHooks<'_, F> {
    fn default() -> Self {
        Self::new(&Interrupt::new())
    }
}

impl<'a, F: ?Sized> RunHooks<'a, F> {
    /// Hooks with an interrupt only.
    pub fn new(interrupt: &Interrupt) -> Self {
        Self {
            interrupt: interrupt.clone(),
            progress: None,
            samples: None,
            checkpoint: None,
            interval: INTERVAL,
            last: Instant::now(),
            finished: Vec::new(),
        }
    }

    /// With a function to which progress is reported every few steps.
    pub fn with_progress(mut self, progress: &'a mut ProgressFn<'a>) -> Self {
        self.progress = Some(progress);
        self
    }

    /// With a function that sees each sample of a discharge.
    pub fn with_samples(mut self, samples: &'a mut F) -> Self {
        self.samples = Some(samples);
        self
    }

    /// With a checkpoint file, written at most every `interval` seconds (30 by default).
    pub fn with_checkpoint(mut self, path: &Path, interval: f64) -> Self {
        self.checkpoint = Some(path.to_owned());
        self.interval = Duration::try_from_secs_f64(interval).unwrap_or(INTERVAL);
        self
    }

    /// Names the checkpoint file of the next phase.
    pub fn keep_in(&mut self, path: &Path) {
        self.checkpoint = Some(path.to_owned());
    }

    /// Names the checkpoint file of a further phase: that of the first, with `phase` as its last extension.
    pub fn begin_phase(&mut self, phase: &str) {
        if let Some(path) = &mut self.checkpoint {
            path.as_mut_os_string().push(format!(".{phase}"));
        }
    }

    /// The token by which the run can be stopped.
    pub fn interrupt(&self) -> &Interrupt {
        &self.interrupt
    }

    /// Whether a stop of the run was requested.
    pub fn is_interrupted(&self) -> bool {
        self.interrupt.is_requested()
    }

    /// Whether there is a function for progress reports.
    pub fn wants_progress(&self) -> bool {
        self.progress.is_some()
    }

    /// Reports how far the run is.
    pub fn report(&mut self, progress: &Progress) {
        if let Some(f) = &mut self.progress {
            f(progress);
        }
    }

    /// The function that sees samples, if there is one.
    pub fn samples(&mut self) -> Option<&mut F> {
        self.samples.as_deref_mut()
    }

    /// The checkpoint of the case, if there is one; `flaw` names what does not fit the case.
    ///
    /// # Errors
    /// [`FileError::Foreign`] for the checkpoint of another case, [`FileError::Corrupt`] for one with a flaw, and the errors of
    /// [`load_checkpoint`].
    pub fn resume<T: DeserializeOwned>(
        &self,
        schema: &str,
        case: &str,
        flaw: impl Fn(&T) -> Option<&'static str>,
    ) -> Result<Option<T>, FileError> {
        let Some(path) = self.checkpoint.as_ref().filter(|p| p.exists()) else {
            return Ok(None);
        };
        let (found, value): (String, T) = load_checkpoint(path, schema)?;
        if found != case {
            return Err(FileError::Foreign { path: path.clone() });
        }
        match flaw(&value) {
            None => Ok(Some(value)),
            Some(what) => Err(self.refused(what)),
        }
    }

    /// The refusal of a checkpoint whose parts do not fit each other.
    pub fn refused(&self, what: &str) -> FileError {
        FileError::Corrupt {
            path: self.checkpoint.clone().unwrap_or_default(),
            what: what.to_owned(),
        }
    }

    /// Whether there is a file for checkpoints.
    pub fn keeps_checkpoints(&self) -> bool {
        self.checkpoint.is_some()
    }

    /// Whether a checkpoint should be written now.
    pub fn is_due(&self) -> bool {
        self.keeps_checkpoints() && (self.last.elapsed() >= self.interval || self.is_interrupted())
    }

    /// Writes the checkpoint of the current phase, and the results of earlier phases that are not written yet.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    pub fn save<T: Serialize>(
        &mut self,
        schema: &str,
        case: &str,
        value: &T,
    ) -> Result<(), FileError> {
        self.put(schema, case, value)?;
        self.write()
    }

    /// Keeps the result of a finished phase, in memory until the next checkpoint is due. A resumed case continues from there.
    ///
    /// # Errors
    /// [`FileError`] when a file cannot be written.
    pub fn keep<T: Serialize>(
        &mut self,
        schema: &str,
        case: &str,
        value: &T,
    ) -> Result<(), FileError> {
        self.put(schema, case, value)?;
        if self.is_due() { self.write() } else { Ok(()) }
    }

    /// Puts what a phase remembers with what is to be written, where there is a file for it.
    fn put<T: Serialize>(&mut self, schema: &str, case: &str, value: &T) -> Result<(), FileError> {
        if let Some(path) = &self.checkpoint {
            let bytes = checkpoint_bytes(path, schema, &(case, value))?;
            self.finished.push((path.clone(), bytes));
        }
        Ok(())
    }

    fn write(&mut self) -> Result<(), FileError> {
        for (path, bytes) in self.finished.drain(..) {
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder)
                    .map_err(|e| FileError::io("create the folder", folder, e))?;
            }
            write_atomic_bytes(&path, &bytes)?;
        }
        self.last = Instant::now();
        Ok(())
    }

    /// Removes the checkpoint of a finished phase.
    pub fn finish(&self) {
        if let Some(path) = &self.checkpoint {
            // A file that is not there needs no removal.
            drop(std::fs::remove_file(path));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Hooks<'a> = RunHooks<'a, dyn FnMut(f64) + 'a>;

    fn at(path: &Path, interval: f64) -> Hooks<'static> {
        Hooks::default().with_checkpoint(path, interval)
    }

    fn never(_: &f64) -> Option<&'static str> {
        None
    }

    #[test]
    fn a_checkpoint_is_found_by_its_own_case_only() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("case/run.checkpoint");
        let mut hooks = at(&path, 0.0);
        assert_eq!(hooks.resume("test/1", "a", never).unwrap(), None);
        hooks.save("test/1", "a", &0.1).unwrap();
        assert_eq!(hooks.resume("test/1", "a", never).unwrap(), Some(0.1));
        let foreign = hooks.resume("test/1", "b", never).unwrap_err();
        assert!(matches!(foreign, FileError::Foreign { .. }), "{foreign}");
        let flawed = hooks.resume("test/1", "a", |_: &f64| Some("it is odd"));
        let flawed = flawed.unwrap_err().to_string();
        assert!(flawed.contains("corrupt (it is odd)"), "{flawed}");
        assert!(hooks.resume("test/2", "a", never).is_err());
        hooks.finish();
        assert!(!path.exists() && hooks.resume("test/1", "a", never).unwrap().is_none());
        // without a file nothing is kept
        let mut none = Hooks::default();
        none.save("test/1", "a", &0.1).unwrap();
        assert!(!none.is_due() && none.resume("test/1", "a", never).unwrap().is_none());
    }

    #[test]
    fn finished_phases_are_written_with_the_next_checkpoint() {
        let folder = tempfile::tempdir().unwrap();
        let [first, second] = ["first", "second"].map(|name| folder.path().join(name));
        let interrupt = Interrupt::new();
        let mut hooks = Hooks::new(&interrupt).with_checkpoint(&first, 1e9);
        hooks.keep("test/1", "a", &1.0).unwrap();
        hooks.keep_in(&second);
        assert!(!hooks.is_due() && !first.exists());
        interrupt.request();
        assert!(hooks.is_due());
        hooks.save("test/1", "b", &2.0).unwrap();
        let found = [(&first, "a"), (&second, "b")]
            .map(|(path, case)| at(path, 1.0).resume("test/1", case, never).unwrap());
        assert_eq!(found, [Some(1.0), Some(2.0)]);
        // once the interval is over a finished phase is written at once
        let mut late = at(&first, 0.0);
        late.keep("test/1", "a", &3.0).unwrap();
        assert_eq!(late.resume("test/1", "a", never).unwrap(), Some(3.0));
    }

    #[test]
    fn progress_and_samples_reach_their_functions() {
        let (mut steps, mut seen) = (Vec::new(), Vec::new());
        let mut note_step = |p: &Progress| steps.push(p.step);
        let mut see = |x: f64| seen.push(x);
        let mut hooks = Hooks::default()
            .with_progress(&mut note_step)
            .with_samples(&mut see);
        assert!(hooks.wants_progress());
        hooks.report(&Progress {
            step: 7,
            ..Progress::at(Phase::Charge)
        });
        if let Some(see) = hooks.samples() {
            see(0.5);
        }
        assert_eq!((steps, seen), (vec![7], vec![0.5]));
        assert!(Hooks::default().samples().is_none() && !Hooks::default().wants_progress());
    }
}
