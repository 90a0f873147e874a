//! How long work is asked for, how it tells where it is, and on how many threads it runs.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use topo_core::{Interrupt, Progress};

use crate::LabError;
use crate::cost::Estimate;

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
        /// What the others are expected to take.
        estimate: &'a Estimate,
    },
    /// Cases of an earlier run that cannot be used, and that are computed again if they belong to this shard.
    Replaced {
        /// Their names.
        names: &'a [String],
        /// Why.
        reason: &'a str,
    },
    /// The start shape of a knot is ready.
    Knot {
        /// Its name.
        name: &'a str,
        /// Its ropelength.
        length_over_radius: f64,
    },
    /// A case is at work, so far; reported at every step or every few steps.
    Progress {
        /// Its name.
        name: &'a str,
        /// How far it is.
        progress: &'a Progress,
    },
    /// A case is at work, in words; reported often by long ones.
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
        /// Processor seconds that it was expected to take on the models' machine; 0 if nothing was.
        expected: f64,
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
    /// The part of the cases that is computed here; `None`: all.
    pub shard: Option<Shard>,
    /// Compute nothing: gather the table from what is finished.
    pub only_finished: bool,
    /// Keep the whole nematic field at each time looked at, for other tools; tables do not need it.
    pub keep_fields: bool,
    /// Seconds between checkpoints inside a case: a killed run loses at most about that.
    pub checkpoint_seconds: f64,
}

/// Seconds between checkpoints.
const CHECKPOINT_SECONDS: f64 = 25.0;

impl SweepSettings {
    /// Everything that is not finished below `out`, one case a core.
    pub fn new(out: &Path) -> Self {
        Self {
            out: out.to_owned(),
            jobs: 0,
            fresh: false,
            interrupt: Interrupt::new(),
            shard: None,
            only_finished: false,
            keep_fields: false,
            checkpoint_seconds: CHECKPOINT_SECONDS,
        }
    }

    /// Whether the case at a place of the scene's list is computed here.
    pub(crate) fn takes(&self, place: usize) -> bool {
        !self.only_finished && self.shard.is_none_or(|s| s.takes(place))
    }
}

/// One of several parts of a sweep, each computed somewhere; they are merged by putting their case folders into one folder.
///
/// Part i of n takes every n-th case, the i-th first, so that the parts cost about the same.
///
/// # Validation
/// `shards_share_out_every_case_once`
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    n: usize,
}

/// Most parts that a sweep is divided into.
const MOST_SHARDS: usize = 10_000;

impl Shard {
    /// Whether the case at a place of the list belongs to this part.
    pub fn takes(&self, place: usize) -> bool {
        place % self.n == self.index - 1
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.index, self.n)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text
            .split_once('/')
            .and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
        match parsed {
            Some((index, n)) if n <= MOST_SHARDS && (1..=n).contains(&index) => {
                Ok(Self { index, n })
            }
            Some((index, n)) => Err(format!(
                "there is no part {index} of {n}: write i/n with i from 1 to n and n up to {MOST_SHARDS}, such as 1/{}",
                n.clamp(1, MOST_SHARDS)
            )),
            None => Err("write i/n, such as 2/4 for the second of four parts".to_owned()),
        }
    }
}

/// Runs `work` on a pool of `jobs` threads (0: one a core).
///
/// # Errors
/// Threads that cannot be started.
pub fn with_jobs<R: Send>(jobs: usize, work: impl FnOnce() -> R + Send) -> Result<R, LabError> {
    let failed = |e: rayon::ThreadPoolBuildError| LabError::Jobs {
        jobs,
        reason: e.to_string(),
    };
    Ok(rayon::ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(failed)?
        .install(work))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_out_every_case_once() {
        for n in 1..6 {
            let parts: Vec<Shard> = (1..=n)
                .map(|i| format!("{i}/{n}").parse().unwrap())
                .collect();
            for place in 0..23 {
                assert_eq!(parts.iter().filter(|s| s.takes(place)).count(), 1);
            }
            assert_eq!(parts[0].to_string(), format!("1/{n}"));
        }
        for bad in ["0/3", "4/3", "1/0", "1/20000", "2", "a/b", "1/2/3", "-1/2"] {
            assert!(bad.parse::<Shard>().unwrap_err().contains("i/n"), "{bad}");
        }
    }
}
