//! The keys that say what is tied: one of four.

use super::{Names, RodTable};
use crate::LabError;
use crate::elastic::scene::ElasticScene;
use crate::elastic::tie::{Tie, What, Word, letters};
use crate::scene::{Document, LEFT_OUT};

/// The keys, one of which must be there.
const KEYS: [&str; 4] = ["rod.knot", "rod.link", "rod.braid", "rod.curve"];

/// The parts of a table that say what is tied.
#[derive(Default)]
pub(super) struct TiedKeys {
    pub knot: Option<Names>,
    pub link: Option<Names>,
    pub braid: Option<Word>,
    pub curve: Option<String>,
    pub tighten: Option<bool>,
}

impl TiedKeys {
    pub(super) fn of(scene: &ElasticScene) -> Self {
        let list = |names: &Vec<String>| Some(Names::List(names.clone()));
        let Some(tie) = &scene.tie else {
            return Self {
                knot: list(&scene.knots),
                ..Self::default()
            };
        };
        let mut keys = Self {
            tighten: tie.unusual(),
            ..Self::default()
        };
        match &tie.what {
            What::Knots => keys.knot = list(&scene.knots),
            What::Links(names) => keys.link = list(names),
            What::Braid(word) => {
                let word = word.iter().map(|g| i64::from(*g)).collect();
                keys.braid = Some(Word::Letters(word));
            }
            What::Curve { written, .. } => keys.curve = Some(written.clone()),
        }
        keys
    }
}

impl RodTable {
    /// The knots of the scene, and what is tied instead of their tight shapes.
    ///
    /// # Errors
    /// None of the keys, or several, or a braid word with what is no letter.
    pub(super) fn tie(
        &self,
        document: &Document<'_>,
        is_pulled: bool,
    ) -> Result<(Vec<String>, Option<Tie>), LabError> {
        let there: Vec<&str> = KEYS.into_iter().filter(|key| document.has(key)).collect();
        if let [first, second, ..] = there[..] {
            let remedy = format!("{first} is there too: keep the one that says what is tied");
            return Err(document.wrong(second, document.written(second), remedy));
        }
        let list = |names: &Names| match names {
            Names::One(name) => vec![name.clone()],
            Names::List(names) => names.clone(),
        };
        if is_pulled && self.curve.is_none() {
            let remedy = "a closed fibre has no ends to pull: give an open curve as `rod.curve`, or leave the table out";
            return Err(document.wrong("pull", document.written("pull"), remedy));
        }
        if is_pulled && self.tighten == Some(true) {
            let remedy = "an open fibre that is pulled is taken as it is: leave it out";
            return Err(document.wrong("rod.tighten", true, remedy));
        }
        let tie = |what| Tie::of(what, self.tighten).map(|tie| tie.pulled(is_pulled));
        if let Some(names) = &self.knot {
            return Ok((list(names), tie(What::Knots)));
        }
        let what = if let Some(names) = &self.link {
            What::Links(list(names))
        } else if let Some(word) = &self.braid {
            let wrong = |remedy| document.wrong("rod.braid", document.written("rod.braid"), remedy);
            What::Braid(letters(word).map_err(wrong)?)
        } else if let Some(written) = &self.curve {
            let folder = document.path().parent();
            What::Curve {
                written: written.clone(),
                beside: folder.map_or_else(Default::default, Into::into),
            }
        } else {
            let remedy = "write knot = \"3_1\", or what is tied as `link`, `braid` or `curve`";
            let fault = document.fault("rod.knot", LEFT_OUT, remedy.to_owned(), None);
            return Err(fault.into());
        };
        Ok((Vec::new(), tie(what)))
    }
}
