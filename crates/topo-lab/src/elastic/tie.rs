//! What a scene ties fibres to instead of the tight knots of its list: links, a braid word, or curves of a file.

use std::collections::HashSet;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::Polyline;
use topo_knots::{
    CurveComponent, KnotEntry, KnotTable, LinkEntry, LinkTable, n_components, parse_braid,
    read_components,
};
use topo_rod::{Accuracy, Guards, RodBattery, RodParameters};

use super::scene::ElasticScene;
use super::tied::{Entry, Laid, PASSES, Tied, label};
use crate::LabError;
use crate::folder::identity;
use crate::scene::SceneFault;

/// A braid word: its letters, or a text of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum Word {
    /// Letters.
    Letters(Vec<i64>),
    /// A text such as `1 1`.
    Text(String),
}

/// What fibres are tied to, and whether that is tightened first.
#[derive(Debug, Clone, Serialize)]
pub struct Tie {
    pub(super) what: What,
    pub(super) tighten: bool,
    /// Whether the curve is open and its ends are pulled.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    is_pulled: bool,
    /// What it comes to, once it has been made.
    #[serde(skip)]
    made: Arc<OnceLock<Vec<Arc<Tied>>>>,
}

/// Which key says it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum What {
    /// The knots of the scene.
    Knots,
    /// Names of links.
    Links(Vec<String>),
    /// A braid word.
    Braid(Vec<i32>),
    /// A file of curves, as the scene has it, relative to the folder of the scene's file.
    Curve {
        written: String,
        #[serde(skip)]
        beside: PathBuf,
    },
}

/// What was made before is no part of it.
impl PartialEq for Tie {
    fn eq(&self, other: &Self) -> bool {
        (&self.what, self.tighten, self.is_pulled) == (&other.what, other.tighten, other.is_pulled)
    }
}

/// Vertices of a component above which it is resampled to so many.
const MOST_VERTICES: usize = 4000;
/// Edges with which room for the fibre is measured, at least and a component.
const MEASURED: [usize; 2] = [200, 8];
/// Share of a length by which roundings of a file may make it miss.
const ROUNDING: f64 = 1e-9;

/// The refusal of a key's value.
pub(super) fn wrong(key: &str, value: impl Display, remedy: impl Display) -> LabError {
    let fault = SceneFault::of_file(
        Path::new("the scene"),
        value.to_string(),
        remedy.to_string(),
    );
    fault.key(key).into()
}

impl Tie {
    /// What is tied, tightened if `tighten` or the usual choice says so; nothing where it is tight knots by name.
    pub(super) fn of(what: What, tighten: Option<bool>) -> Option<Self> {
        let usual = !matches!(what, What::Curve { .. });
        let tie = Self {
            tighten: tighten.unwrap_or(usual),
            what,
            is_pulled: false,
            made: Arc::default(),
        };
        (tie.what != What::Knots || !tie.tighten).then_some(tie)
    }

    /// The same of an open curve whose ends are pulled, or of closed ones.
    pub(super) fn pulled(self, is_pulled: bool) -> Self {
        Self { is_pulled, ..self }
    }

    /// What a file says of `tighten`, if it is not the usual choice.
    pub(super) fn unusual(&self) -> Option<bool> {
        let usual = !matches!(self.what, What::Curve { .. });
        (self.tighten != usual).then_some(self.tighten)
    }

    /// Whether it is the knots of the scene.
    pub(super) fn is_of_knots(&self) -> bool {
        self.what == What::Knots
    }

    /// Key of what is tied.
    fn key(&self) -> &'static str {
        match self.what {
            What::Knots => "rod.knot",
            What::Links(_) => "rod.link",
            What::Braid(_) => "rod.braid",
            What::Curve { .. } => "rod.curve",
        }
    }

    /// Number of knots and links, those of `knots` where they are meant.
    pub(super) fn n(&self, knots: usize) -> usize {
        match &self.what {
            What::Knots => knots,
            What::Links(names) => names.len(),
            What::Braid(_) | What::Curve { .. } => 1,
        }
    }

    /// The same with the file named so that it is found from anywhere.
    pub(super) fn found_from_anywhere(&self) -> Self {
        let mut tie = self.clone();
        if let What::Curve { written, beside } = &mut tie.what {
            let path = beside.join(&*written);
            let path = std::path::absolute(&path).unwrap_or(path);
            (*written, *beside) = (path.display().to_string(), PathBuf::new());
        }
        tie
    }

    /// What is tied, read or made once.
    ///
    /// # Errors
    /// An unknown name, a word that cannot be closed, or a file without usable closed curves, with the key.
    pub(super) fn made(
        &self,
        knots: &[String],
        table: &KnotTable,
    ) -> Result<&[Arc<Tied>], LabError> {
        if let Some(made) = self.made.get() {
            return Ok(made);
        }
        let made = match &self.what {
            What::Knots => self.of_names(knots, |name| {
                let entry = table.get(name).map_err(|e| e.to_string())?;
                Ok(Entry::Knot(entry.into_owned()))
            })?,
            What::Links(names) => self.of_names(names, |name| {
                let entry = LinkTable::builtin().get(name).map_err(|e| e.to_string())?;
                Ok(Entry::Link(entry.into_owned()))
            })?,
            What::Braid(word) => vec![self.of_braid(word, table)?],
            What::Curve { written, beside } => {
                let tied = self.of_file(&beside.join(written), table);
                vec![tied.map_err(|remedy| wrong(self.key(), quoted(written), remedy))?]
            }
        };
        let made = made.into_iter().map(Arc::new).collect();
        Ok(self.made.get_or_init(|| made))
    }

    fn of_names(
        &self,
        names: &[String],
        entry: impl Fn(&str) -> Result<Entry, String>,
    ) -> Result<Vec<Tied>, LabError> {
        let mut seen = HashSet::new();
        let one = |name: &String| {
            let refused = |remedy: String| wrong(self.key(), quoted(name), remedy);
            let entry = entry(name).map_err(refused)?;
            if !seen.insert(entry.name().to_owned()) {
                let twice = format!("{} is there already: name each once", entry.name());
                return Err(refused(twice));
            }
            let (name, word) = (entry.name().to_owned(), String::new());
            self.tied(name, word, entry).map_err(refused)
        };
        if names.is_empty() {
            return Err(wrong(self.key(), "[]", "name at least one link"));
        }
        names.iter().map(one).collect()
    }

    fn of_braid(&self, word: &[i32], table: &KnotTable) -> Result<Tied, LabError> {
        let entry = || match n_components(word)? {
            1 => KnotEntry::of_braid(word, table).map(Entry::Knot),
            _ => LinkEntry::of_braid(word, LinkTable::builtin()).map(Entry::Link),
        };
        let letters: Vec<String> = word.iter().map(i32::to_string).collect();
        let tied = || {
            let entry = entry().map_err(|e| e.to_string())?;
            let curves = topo_knots::braid_closure(word).map_err(|e| e.to_string())?;
            let word = format!("braid-{}", digits(&identity(&serde_json::json!(word))));
            let name = named(&entry, &curves, table)?;
            match self.tighten {
                true => self.tied(name, word, entry),
                false => laid(name, word, None, entry, curves),
            }
        };
        tied().map_err(|remedy| wrong(self.key(), format!("[{}]", letters.join(", ")), remedy))
    }

    fn of_file(&self, path: &Path, table: &KnotTable) -> Result<Tied, String> {
        let components = read_components(path).map_err(|e| e.to_string())?;
        if self.is_pulled && components.len() > 1 {
            return Err(format!(
                "it has {} components: one fibre is pulled, give the curve of one",
                components.len()
            ));
        }
        let mut vertices = Vec::new();
        for (k, component) in components.iter().enumerate() {
            self.fits(component)
                .map_err(|problem| match components.len() {
                    1 => format!("the curve {problem}"),
                    _ => format!("component {} {problem}", k + 1),
                })?;
            vertices.push(component.vertices.clone());
        }
        let entry = match &vertices[..] {
            [only] => KnotEntry::of_curve(only, table).map(Entry::Knot),
            several => LinkEntry::of_curves(several, LinkTable::builtin()).map(Entry::Link),
        };
        let entry = entry.map_err(|e| e.to_string())?;
        let coordinates = identity(&serde_json::json!(vertices));
        let word = format!("curve-{}", digits(&coordinates));
        let curves = vertices.into_iter().map(|x| {
            let curve = Polyline::new(x, !self.is_pulled)?;
            match curve.n_vertices() > MOST_VERTICES {
                true => curve.resampled(MOST_VERTICES),
                false => Ok(curve),
            }
        });
        let curves = curves.collect::<Result<Vec<_>, topo_core::CurveError>>();
        let curves = curves.map_err(|e| e.to_string())?;
        let name = named(&entry, &curves, table)?;
        match self.tighten {
            true => {
                let mut tied = self.tied(name, format!("tight-{word}"), entry)?;
                tied.coordinates = Some(coordinates);
                Ok(tied)
            }
            false => laid(name, word, Some(coordinates), entry.without_start(), curves),
        }
    }

    /// Refuses a component that is not closed, or of a pulled curve one that is not open.
    fn fits(&self, component: &CurveComponent) -> Result<(), String> {
        match (self.is_pulled, component.is_closed()) {
            (true, true) => Err("is closed and has no ends to pull: give an open curve, or leave the table [pull] out".to_owned()),
            (true, false) => Ok(()),
            (false, _) => closed(component),
        }
    }

    /// The start from an entry: to be tightened, or its own start curves.
    fn tied(&self, name: String, word: String, entry: Entry) -> Result<Tied, String> {
        if self.tighten {
            return Ok(Tied {
                name,
                word,
                coordinates: None,
                entry,
                laid: None,
            });
        }
        let curves = entry.start_curves().map_err(|e| e.to_string())?;
        laid(name, "loose".to_owned(), None, entry, curves)
    }
}

/// Digits of an identity that a name has.
pub(super) fn digits(identity: &str) -> &str {
    identity.get(..10).unwrap_or(identity)
}

pub(super) fn quoted(name: &str) -> String {
    format!("\"{name}\"")
}

/// Name of an entry; of one that no table has, what is known of its curves.
fn named(entry: &Entry, curves: &[Polyline], table: &KnotTable) -> Result<String, String> {
    match entry.name() {
        "unnamed" => label(curves, table).map_err(|e| e.to_string()),
        name => Ok(name.to_owned()),
    }
}

/// Refuses a component that is no closed polygon.
fn closed(component: &CurveComponent) -> Result<(), String> {
    if component.is_closed() {
        return Ok(());
    }
    Err(format!(
        "is open, its ends {:.1} times its longest edge apart; a fibre is fused before it is charged: give a closed curve (in a VECT file a negative number of vertices, else the first vertex again at the end), or say how its ends are pulled in a table [pull]",
        component.gap_over_longest_edge()
    ))
}

/// Curves as they are, smoothed, with the room for a fibre around them.
fn laid(
    name: String,
    word: String,
    coordinates: Option<String>,
    entry: Entry,
    curves: Vec<Polyline>,
) -> Result<Tied, String> {
    let smooth = curves.iter().map(|curve| curve.smoothed(PASSES));
    let centrelines = smooth.collect::<Result<Vec<_>, _>>();
    let centrelines = centrelines.map_err(|e| e.to_string())?;
    entry.verify(&centrelines).map_err(|e| {
        format!("it has too few vertices: smoothed it would be something else ({e}); give more vertices along it, or write tighten = true")
    })?;
    let rod = RodParameters {
        n_edges: MEASURED[0].max(MEASURED[1] * centrelines.len()),
        ..RodParameters::default()
    };
    let (accuracy, guards) = (Accuracy::default(), Guards::default());
    let battery = match &centrelines[..] {
        [open] if !open.is_closed() => RodBattery::open(&rod, &accuracy, guards, open),
        closed => RodBattery::link(&rod, &accuracy, guards, closed),
    };
    let length_over_radius = battery.map_err(|e| e.to_string())?.ropelength();
    let word = match &coordinates {
        Some(_) => word,
        None if word == "loose" => word,
        None => format!("{word}-loose"),
    };
    Ok(Tied {
        name,
        word,
        coordinates,
        entry,
        laid: Some(Laid {
            centrelines,
            length_over_radius,
        }),
    })
}

impl ElasticScene {
    /// Refuses curves as they are that leave no room for a fibre of the slenderness asked for, where its radius and length are
    /// literal.
    pub(super) fn check_room(&self, cases: &[super::case::ElasticCase]) -> Result<(), LabError> {
        use topo_rod::Reading;
        for case in cases {
            let (rod, tied) = (&case.rod, case.tied.as_deref());
            let Some(room) = tied.and_then(|tied| tied.laid.as_ref()) else {
                continue;
            };
            let needed = room.length_over_radius;
            let is_literal = matches!(rod.reading, Reading::Shrunk | Reading::Hard);
            if is_literal && rod.slenderness < needed * (1.0 - ROUNDING) {
                let least = (needed * 100.0).ceil() / 100.0;
                return Err(wrong(
                    "rod.slenderness",
                    rod.slenderness,
                    format!(
                        "the fibre would overlap itself: along {} as given its radius may be L/{needed:.2} at most, and this one is {:.1} % thicker; use {least} or more, `tighten = true`, or the reading `own-length` (or `tight`: thinner contact)",
                        case.knot,
                        100.0 * (needed / rod.slenderness - 1.0),
                    ),
                ));
            }
        }
        Ok(())
    }
}

/// Letters of a braid word.
///
/// # Errors
/// What is no letter.
pub(super) fn letters(word: &Word) -> Result<Vec<i32>, String> {
    match word {
        Word::Text(text) => parse_braid(text).map_err(|e| e.to_string()),
        Word::Letters(letters) => {
            let letter = |g: &i64| {
                i32::try_from(*g)
                    .map_err(|_| format!("{g} is no generator: a braid has few strands"))
            };
            letters.iter().map(letter).collect()
        }
    }
}

#[cfg(test)]
mod tests;
