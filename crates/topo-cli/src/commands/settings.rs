//! What the options that commands share ask for.

use crate::cli::WorkArgs;
use crate::error::CliError;
use crate::interrupt;
use topo_lab::SweepSettings;

/// What the options of a computation ask for.
pub fn settings(work: &WorkArgs) -> Result<SweepSettings, CliError> {
    Ok(SweepSettings {
        jobs: threads(work.jobs)?,
        fresh: work.fresh,
        interrupt: interrupt::install(),
        ..SweepSettings::new(&work.out)
    })
}

/// Gives rayon `jobs` threads, or all processors, and returns the number (0 for all).
pub fn threads(jobs: Option<usize>) -> Result<usize, CliError> {
    let Some(n) = jobs else { return Ok(0) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(n);
    pool.build_global().map_err(|e| CliError::Argument {
        key: "--jobs",
        value: n.to_string(),
        remedy: e.to_string(),
    })?;
    Ok(n)
}
