//! What the published work claims, and what the tables of a results folder say to each claim.

mod elastic;
mod friction;
mod nematic;
mod report;
#[cfg(test)]
mod tests;

use crate::data::{NematicSweep, Sweep};
use crate::error::XtaskError;
pub use report::{section, write};
use serde::Serialize;
use std::path::{Path, PathBuf};
use topo_lab::{ElasticScene, Preset, Purpose, Variant};

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
    fn words(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::Partly => "partly",
            Self::NotConfirmed => "not confirmed",
            Self::NotJudged => "not judged",
        }
    }

    /// Confirmed when it holds, else not.
    fn when(holds: bool) -> Self {
        if holds {
            Self::Confirmed
        } else {
            Self::NotConfirmed
        }
    }

    /// Confirmed when all hold, in part when one does.
    fn both(a: bool, b: bool) -> Self {
        match (a, b) {
            (true, true) => Self::Confirmed,
            (false, false) => Self::NotConfirmed,
            _ => Self::Partly,
        }
    }

    /// Confirmed when it holds for all of `n`, in part when for some.
    fn of_all(n_holding: usize, n: usize) -> Self {
        match n_holding {
            0 => Self::NotConfirmed,
            some if some < n => Self::Partly,
            _ => Self::Confirmed,
        }
    }

    /// Runs that are in doubt confirm nothing, at most in part.
    fn doubted(self, in_doubt: bool) -> Self {
        match self {
            Self::Confirmed if in_doubt => Self::Partly,
            other => other,
        }
    }
}

/// What the tables say.
type Said = Option<(String, Verdict)>;

/// One claim.
struct Claim {
    /// In our words.
    text: &'static str,
    /// Where it is made.
    published: &'static str,
    /// Our figure that shows it.
    figure: &'static str,
    /// What the outcome depends on.
    depends: &'static str,
    /// The rule that decides the outcome, in words: what `look` does, so that both change together.
    rule: &'static str,
    /// What the tables say; `None` where they lack what is needed.
    look: fn(&Tables) -> Said,
    /// The same claim under another reading of the experiment; it is told, the outcome is that of `look`.
    other: Option<Other>,
    /// What speaks against the runs that the claim rests on; it is then confirmed in part at most.
    doubt: fn(&Tables) -> Option<String>,
}

/// Another reading of a claim.
struct Other {
    /// What is done differently.
    reading: &'static str,
    /// What the tables say then.
    look: fn(&Tables) -> Said,
}

/// Says how many of the runs, given by their warnings, are flagged; `None` if none is.
fn flagged<'a>(warnings: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let (mut all, mut with) = (0, 0);
    for text in warnings {
        all += 1;
        with += usize::from(!text.is_empty());
    }
    (with > 0).then(|| format!("{with} of {all} runs carry warnings"))
}

/// What is looked at.
struct Tables {
    results: PathBuf,
    elastic: Option<Sweep>,
    /// Untwisted states under other choices of friction and reading.
    choices: Vec<Side>,
    /// Discharges followed until the slowest mode is left.
    last: Option<Side>,
    nematic: Option<NematicSweep>,
}

/// A sweep beside the published one.
struct Side {
    /// What is chosen differently.
    name: String,
    /// Where its cases lie.
    folder: PathBuf,
    sweep: Sweep,
}

impl Side {
    /// The sweep of a variant; `None` where it was not run.
    fn read(results: &Path, variant: Variant) -> Result<Option<Self>, XtaskError> {
        let folder = results.join(&variant.scene.folder);
        let sweep = there(Sweep::of_folder(&folder))?;
        Ok(sweep.map(|sweep| Self {
            name: variant.name,
            folder,
            sweep,
        }))
    }
}

/// Tables that were not computed are none, damaged ones an error.
fn there<T>(table: Result<T, XtaskError>) -> Result<Option<T>, XtaskError> {
    match table {
        Err(XtaskError::Missing { .. }) => Ok(None),
        other => other.map(Some),
    }
}

/// A claim with what was found.
#[derive(Debug, Serialize)]
pub struct Finding {
    /// Its place in the list of all claims, from 1 on.
    number: usize,
    claim: &'static str,
    published: &'static str,
    figure: &'static str,
    found: String,
    verdict: Verdict,
    rule: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    other_reading: Option<OtherFound>,
    #[serde(skip_serializing_if = "Option::is_none")]
    doubt: Option<String>,
    depends_on: &'static str,
}

/// What was found under another reading.
#[derive(Debug, Serialize)]
struct OtherFound {
    reading: &'static str,
    found: String,
    verdict: Verdict,
}

impl Claim {
    /// What the tables say to the claim; `None` where they lack what is needed.
    fn finding(&self, number: usize, tables: &Tables) -> Option<Finding> {
        let (found, verdict) = (self.look)(tables)?;
        let doubt = (self.doubt)(tables);
        let other_reading = self.other.as_ref().and_then(|other| {
            let (found, verdict) = (other.look)(tables)?;
            Some(OtherFound {
                reading: other.reading,
                found,
                verdict: verdict.doubted(doubt.is_some()),
            })
        });
        Some(Finding {
            number,
            claim: self.text,
            published: self.published,
            figure: self.figure,
            found,
            verdict: verdict.doubted(doubt.is_some()),
            rule: self.rule,
            other_reading,
            doubt,
            depends_on: self.depends,
        })
    }
}

/// All claims that the tables of a results folder can say something to.
pub fn findings(results: &Path) -> Result<Vec<Finding>, XtaskError> {
    let mut tables = Tables {
        results: results.to_owned(),
        elastic: there(Sweep::read(results))?,
        choices: Vec::new(),
        last: None,
        nematic: there(NematicSweep::read(results))?,
    };
    // what the finest preset runs, the others run in part
    for variant in ElasticScene::published(Preset::Paper).variants() {
        match variant.purpose {
            Purpose::Choice => tables.choices.extend(Side::read(results, variant)?),
            Purpose::End => tables.last = Side::read(results, variant)?,
            Purpose::Friction => {}
        }
    }
    let all = elastic::CLAIMS.iter().chain(&nematic::CLAIMS);
    let numbered = all.zip(1..);
    Ok(numbered
        .filter_map(|(claim, number)| claim.finding(number, &tables))
        .collect())
}
