//! How long work is asked for, how it tells where it is, and on how many threads it runs.

use std::path::PathBuf;

use topo_core::Interrupt;

use crate::AnalysisError;

/// What a sweep tells while it runs; calls come from any of its threads.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum Event<'a> {
    /// The sweep begins.
    Begin {
        /// Cases of the scene.
        n_cases: usize,
        /// Those finished by an earlier run.
        n_reused: usize,
    },
    /// The start shape of a knot is ready.
    Knot {
        /// Its name.
        name: &'a str,
        /// Its ropelength.
        length_over_radius: f64,
    },
    /// A case is at work; told often by long ones.
    Working {
        /// Its name.
        name: &'a str,
        /// Where it is.
        what: &'a str,
    },
    /// A case is finished.
    Case {
        /// Its name.
        name: &'a str,
        /// Cases finished so far, those of earlier runs included.
        n_done: usize,
        /// Its warnings; empty if there are none.
        warnings: &'a str,
    },
}

/// Where and how a sweep runs.
#[derive(Debug, Clone)]
pub struct SweepSettings {
    /// Output folder; tables go to a folder of the scene's own below it.
    pub out: PathBuf,
    /// Cases at a time; 0: one a core.
    pub jobs: usize,
    /// Compute again what is finished.
    pub fresh: bool,
    /// Asks the sweep to stop; finished cases are kept.
    pub interrupt: Interrupt,
}

/// Runs `work` on a pool of `jobs` threads (0: one a core).
///
/// # Errors
/// Threads that cannot be started.
pub fn with_jobs<R: Send>(
    jobs: usize,
    work: impl FnOnce() -> R + Send,
) -> Result<R, AnalysisError> {
    let failed = |e: rayon::ThreadPoolBuildError| AnalysisError::Jobs {
        jobs,
        reason: e.to_string(),
    };
    Ok(rayon::ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(failed)?
        .install(work))
}
