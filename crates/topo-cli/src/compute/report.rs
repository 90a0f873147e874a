//! What a sweep says on the terminal while it runs and when it is done.

use crate::duration::{count, duration};
use crate::error::CliError;
use crate::output;
use crate::progress::Progress;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use topo_lab::{Estimate, Event, FailedCase};

/// Says what they took.
pub fn print_taken(estimate: &Estimate, seconds: f64) {
    if estimate.n_cases > 0 {
        say!(
            "{} in {}; estimated {}",
            count(estimate.n_cases, "case"),
            duration(seconds),
            duration(estimate.wall_seconds)
        );
    }
}

/// Reports the events of a sweep on the terminal.
pub struct Reporter {
    label: &'static str,
    progress: OnceLock<Progress>,
}

impl Reporter {
    pub fn new(label: &'static str) -> Self {
        Self {
            label,
            progress: OnceLock::new(),
        }
    }

    pub fn report(&self, event: Event<'_>) {
        let progress = self.progress.get();
        match (event, progress) {
            (
                Event::Begin {
                    n_cases,
                    n_reused,
                    estimate,
                },
                _,
            ) => {
                if n_reused > 0 {
                    let verb = if n_cases == 1 { "is" } else { "are" };
                    let cases = count(n_cases, "case");
                    note!("{n_reused} of {cases} {verb} finished already");
                }
                self.progress
                    .get_or_init(|| Progress::expecting(self.label, n_cases - n_reused, estimate));
            }
            (Event::Replaced { names, reason }, _) => {
                let shown = names.iter().take(3).cloned().collect::<Vec<_>>().join(", ");
                let more = if names.len() > 3 { ", ..." } else { "" };
                let text = format!(
                    "warning: computed again: {} of the earlier cases ({shown}{more}): {reason}",
                    names.len()
                );
                match progress {
                    Some(progress) => progress.note(&text),
                    None => note!("{text}"),
                }
            }
            (Event::Working { name, what }, Some(progress)) => progress.working(name, &what),
            (
                Event::Progress {
                    name,
                    progress: far,
                },
                Some(progress),
            ) => {
                progress.working(name, far);
            }
            (Event::Knot { .. }, Some(progress)) => progress.restart(),
            (
                Event::Case {
                    name,
                    expected,
                    warnings,
                    ..
                },
                Some(progress),
            ) => {
                progress.done_of(name, expected);
                if !warnings.is_empty() {
                    progress.note(&format!("warning: {name}: {warnings}"));
                }
            }
            _ => {}
        }
    }

    /// Ends the stage; a sweep that was interrupted becomes that error.
    pub fn finish(self, interrupted: bool) -> Result<(), CliError> {
        if let Some(progress) = self.progress.into_inner() {
            progress.finish();
        }
        if interrupted {
            Err(CliError::Interrupted)
        } else {
            Ok(())
        }
    }
}

/// Cases that failed, of one sweep or several.
#[derive(Debug, Default)]
pub struct Failures {
    n: usize,
    /// Where the first of them are listed.
    path: PathBuf,
}

impl Failures {
    /// Adds those of a sweep whose table is in `folder`, and says which they are.
    pub fn add(&mut self, failed: &[FailedCase], folder: &Path) {
        for one in failed {
            let FailedCase { case, reason } = one;
            output::failed(one);
            note!("failed: {case}: {reason}");
        }
        if self.n == 0 {
            self.path = folder.join("failed.csv");
        }
        self.n += failed.len();
    }

    /// An error if there are any.
    pub fn into_result(self) -> Result<(), CliError> {
        match self {
            Self { n: 0, .. } => Ok(()),
            Self { n, path } => Err(CliError::Failed { n, path }),
        }
    }
}
