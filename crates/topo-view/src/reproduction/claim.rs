//! A claim, the tables that it is held against, and how far these bear it out.

use std::path::{Path, PathBuf};
use topo_analysis::Warnings;

use serde::Serialize;
use topo_lab::Variant;
use topo_rod::Criterion;

use crate::data::{Cut, NematicSweep, Sweep};
use crate::error::ViewError;

/// How far a claim is borne out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// As claimed.
    Confirmed,
    /// In part, or only under some readings.
    Partly,
    /// Not as claimed.
    NotConfirmed,
    /// Left open: what the claim compares was not run.
    NotJudged,
}

impl Verdict {
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::Partly => "partly",
            Self::NotConfirmed => "not confirmed",
            Self::NotJudged => "not judged",
        }
    }

    /// Confirmed when it holds, else not.
    pub(crate) fn when(holds: bool) -> Self {
        if holds {
            Self::Confirmed
        } else {
            Self::NotConfirmed
        }
    }

    /// Confirmed when all hold, in part when one does.
    pub(crate) fn both(a: bool, b: bool) -> Self {
        match (a, b) {
            (true, true) => Self::Confirmed,
            (false, false) => Self::NotConfirmed,
            _ => Self::Partly,
        }
    }

    /// Confirmed when it holds for all of `n`, in part when for some.
    pub(crate) fn of_all(n_holding: usize, n: usize) -> Self {
        match n_holding {
            0 => Self::NotConfirmed,
            some if some < n => Self::Partly,
            _ => Self::Confirmed,
        }
    }

    /// Runs that are in doubt confirm nothing, at most in part.
    pub(crate) fn doubted(self, in_doubt: bool) -> Self {
        match self {
            Self::Confirmed if in_doubt => Self::Partly,
            other => other,
        }
    }
}

/// What the tables say.
pub(crate) type Said = Option<(String, Verdict)>;

/// One claim.
pub(crate) struct Claim {
    /// In our words.
    pub(crate) text: &'static str,
    /// Where it is made.
    pub(crate) published: &'static str,
    /// Our figure that shows it.
    pub(crate) figure: &'static str,
    /// What the outcome depends on.
    pub(crate) depends: &'static str,
    /// The rule that decides the outcome, in words: what `look` does, so that both change together.
    pub(crate) rule: &'static str,
    /// What the tables say; `None` where they lack what is needed.
    pub(crate) look: fn(&Tables) -> Said,
    /// The same claim under another reading of the experiment; it is reported, the outcome is that of `look`.
    pub(crate) other: Option<Other>,
    /// What speaks against the runs that the claim rests on; it is then confirmed in part at most.
    pub(crate) doubt: fn(&Tables) -> Option<String>,
}

/// Another reading of a claim.
pub(crate) struct Other {
    /// What is done differently.
    pub(crate) reading: &'static str,
    /// What the tables say then.
    pub(crate) look: fn(&Tables) -> Said,
}

/// Says how many of the runs, given by their warnings, are flagged; `None` if none is.
pub(crate) fn flagged<'a>(warnings: impl IntoIterator<Item = &'a Warnings>) -> Option<String> {
    let (mut all, mut with) = (0, 0);
    for text in warnings {
        all += 1;
        with += usize::from(!text.is_empty());
    }
    (with > 0).then(|| format!("{with} of {all} runs carry warnings"))
}

/// What is looked at.
pub(crate) struct Tables {
    pub(crate) results: PathBuf,
    pub(crate) elastic: Option<Sweep>,
    /// Untwisted states under other choices of friction and reading.
    pub(crate) choices: Vec<Side>,
    /// Untwisted states cut where each criterion of breaking is largest.
    pub(crate) criteria: Vec<ByCriterion>,
    /// Discharges followed until the slowest mode is left.
    pub(crate) last: Option<Side>,
    pub(crate) nematic: Option<NematicSweep>,
}

/// A sweep beside the published one.
pub(crate) struct Side {
    /// What is chosen differently.
    pub(crate) name: String,
    /// Where its cases lie.
    pub(crate) folder: PathBuf,
    pub(crate) sweep: Sweep,
}

impl Side {
    /// The sweep of a variant; `None` where it was not run.
    pub(crate) fn read(results: &Path, variant: Variant) -> Result<Option<Self>, ViewError> {
        let folder = results.join(&variant.scene.folder);
        let sweep = there(Sweep::of_folder(&folder))?;
        Ok(sweep.map(|sweep| Self {
            name: variant.name,
            folder,
            sweep,
        }))
    }
}

/// Untwisted states, each cut once: where the measure of a criterion is largest.
pub(crate) struct ByCriterion {
    pub(crate) criterion: Criterion,
    pub(crate) sweep: Sweep,
}

impl ByCriterion {
    /// The cuts of a variant by the criteria that chose them; none where it was not run.
    pub(crate) fn read(results: &Path, variant: Variant) -> Result<Vec<Self>, ViewError> {
        let side = Side::read(results, variant)?;
        Ok(side.map_or_else(Vec::new, |side| Self::of(&side.sweep)))
    }

    /// The cuts of a sweep by the criteria that chose them.
    pub(crate) fn of(sweep: &Sweep) -> Vec<Self> {
        let of = |criterion: Criterion| {
            let chose = |cut: &&Cut| cut.cut_by.split(';').any(|by| by == criterion.name());
            let cuts = sweep.cases.iter().flat_map(|case| &case.cuts).filter(chose);
            let sweep = Sweep::of_rows(cuts.cloned().collect())?;
            Some(Self { criterion, sweep })
        };
        Criterion::ALL.into_iter().filter_map(of).collect()
    }
}

/// Tables that were not computed are none, damaged ones an error.
pub(crate) fn there<T>(table: Result<T, ViewError>) -> Result<Option<T>, ViewError> {
    match table {
        Err(ViewError::Missing { .. }) => Ok(None),
        other => other.map(Some),
    }
}
