//! What the published work claims, and what the tables of a results folder say to each claim.

mod claim;
mod elastic;
mod friction;
mod nematic;
mod report;
#[cfg(test)]
mod tests;

use crate::data::{NematicSweep, Sweep};
use crate::error::ViewError;
pub(crate) use claim::ByCriterion;
pub use claim::Verdict;
use claim::{Claim, Side, Tables, there};
pub(crate) use elastic::{SLOW, words};
pub use report::{section, write};
use serde::Serialize;
use std::path::Path;
use topo_lab::{ElasticScene, Preset, Purpose};

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
pub fn findings(results: &Path) -> Result<Vec<Finding>, ViewError> {
    let mut tables = Tables {
        results: results.to_owned(),
        elastic: there(Sweep::read(results))?,
        choices: Vec::new(),
        criteria: Vec::new(),
        last: None,
        nematic: there(NematicSweep::read(results))?,
    };
    // what the finest preset runs, the others run in part
    for variant in ElasticScene::published(Preset::Paper).variants() {
        match variant.purpose {
            Purpose::Choice => tables.choices.extend(Side::read(results, variant)?),
            Purpose::End => tables.last = Side::read(results, variant)?,
            Purpose::Breaking => tables.criteria = ByCriterion::read(results, variant)?,
            Purpose::Friction | Purpose::Work => {}
        }
    }
    let all = elastic::CLAIMS.iter().chain(&nematic::CLAIMS);
    let numbered = all.zip(1..);
    Ok(numbered
        .filter_map(|(claim, number)| claim.finding(number, &tables))
        .collect())
}
