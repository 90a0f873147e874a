//! Choices that a scene of rods makes: names, cuts, what presets mean.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use topo_knots::TightenSettings;
use topo_rod::{Accuracy, Criterion};

use crate::preset::Preset;
use crate::scene::{listed, repeated_number};

/// One knot name or a list; "all" stands for the fourteen prime knots of up to seven crossings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Names {
    /// One name.
    One(String),
    /// A list.
    List(Vec<String>),
}

/// Which sites are cut.
#[derive(Debug, Clone, PartialEq)]
pub enum Cuts {
    /// Where the measure of a criterion, smoothed over π h, is largest.
    Largest(Criterion),
    /// Every local maximum of that measure within 3 % of the largest.
    NearTies(Criterion),
    /// The near ties of the energy density, the largest first, and the largest of each other criterion, sites on which several agree
    /// once.
    Criteria,
    /// K evenly spaced sites.
    All(usize),
    /// The vertices nearest to these places, s/L in [0, 1).
    At(Vec<f64>),
    /// None: an open fibre is let go.
    LetGo,
}

impl Default for Cuts {
    fn default() -> Self {
        Self::Largest(Criterion::Energy)
    }
}

/// Words of the choices; those of the energy have been there before the other criteria.
const ARGMAX: &str = "argmax";
const NEAR_TIES: &str = "near-ties";
const CRITERIA: &str = "criteria";
const LET_GO: &str = "let-go";

/// The criterion of a name.
fn criterion(name: &str) -> Option<Criterion> {
    Criterion::ALL.into_iter().find(|c| c.name() == name)
}

impl TryFrom<String> for Cuts {
    type Error = String;

    /// The choice that a text names; places are separated by commas.
    fn try_from(text: String) -> Result<Self, String> {
        let at: Result<Vec<f64>, _> = text.split(',').map(|x| x.trim().parse()).collect();
        if let Ok(at) = at {
            return Self::at(at);
        }
        let all = |k: &str| {
            k.parse()
                .ok()
                .filter(|k| (1..=10_000).contains(k))
                .map(Self::All)
        };
        let found = match text.as_str() {
            ARGMAX => Some(Self::Largest(Criterion::Energy)),
            NEAR_TIES => Some(Self::NearTies(Criterion::Energy)),
            CRITERIA => Some(Self::Criteria),
            LET_GO => Some(Self::LetGo),
            other => match other.split_once(':') {
                Some(("all", k)) => all(k),
                Some((NEAR_TIES, of)) => criterion(of).map(Self::NearTies),
                _ => criterion(other).map(Self::Largest),
            },
        };
        let names = Criterion::ALL.map(|c| format!("\"{c}\"")).join(", ");
        found.ok_or_else(|| format!("write {names}, \"argmax\" (of the energy), \"near-ties\", \"near-ties:tension\" and the like, \"criteria\", \"all:K\" with K from 1 to 10000, places s/L from 0 to below 1, or \"let-go\" of an open fibre"))
    }
}

impl From<Cuts> for String {
    fn from(cuts: Cuts) -> Self {
        match cuts {
            Cuts::Largest(Criterion::Energy) => ARGMAX.into(),
            Cuts::Largest(other) => other.name().into(),
            Cuts::NearTies(Criterion::Energy) => NEAR_TIES.into(),
            Cuts::NearTies(other) => format!("{NEAR_TIES}:{other}"),
            Cuts::Criteria => CRITERIA.into(),
            Cuts::LetGo => LET_GO.into(),
            Cuts::All(k) => format!("all:{k}"),
            Cuts::At(at) => at.iter().map(f64::to_string).collect::<Vec<_>>().join(","),
        }
    }
}

/// Most cuts of a case.
const MOST_CUTS: usize = 10_000;

impl Cuts {
    /// Cuts at given places s/L.
    ///
    /// # Errors
    /// None, too many, one that is not on the rod, or the same one twice: which, and what would be right.
    pub fn at(at: Vec<f64>) -> Result<Self, String> {
        if at.is_empty() || at.len() > MOST_CUTS {
            return Err(format!("give 1 to {MOST_CUTS} places s/L of cuts"));
        }
        if let Some(x) = at.iter().find(|x| !(0.0..1.0).contains(*x)) {
            return Err(format!(
                "{x} is not on the rod: places s/L go from 0 to below 1"
            ));
        }
        if let Some(x) = repeated_number(&at) {
            return Err(format!("{x} is there twice: give each place once"));
        }
        // no -0
        Ok(Self::At(at.into_iter().map(|x| x + 0.0).collect()))
    }

    /// Why these cuts cannot be made in a rod of `n_edges` edges, if they cannot: two fall on one vertex.
    pub(super) fn clash(&self, n_edges: usize) -> Option<String> {
        match self {
            Self::Largest(_) | Self::NearTies(_) | Self::Criteria | Self::LetGo => None,
            Self::All(k) => (*k > n_edges).then(|| {
                format!("a rod of {n_edges} edges has fewer vertices: ask for at most as many cuts")
            }),
            Self::At(at) => {
                let vertex = |x: f64| (x * n_edges as f64).round() as usize % n_edges.max(1);
                let mut cut: Vec<(usize, f64)> = at.iter().map(|x| (vertex(*x), *x)).collect();
                cut.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
                let same = cut.windows(2).find(|w| w[0].0 == w[1].0)?;
                Some(format!(
                    "{} and {} fall on the same vertex of {n_edges} edges: leave one out",
                    same[0].1, same[1].1
                ))
            }
        }
    }
}

impl Serialize for Cuts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::At(at) => at.serialize(serializer),
            named => String::from(named.clone()).serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Cuts {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Choice;
        impl<'de> Visitor<'de> for Choice {
            type Value = Cuts;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"argmax\", \"near-ties\", a criterion such as \"von-mises\", \"criteria\", \"all:K\", a place s/L, a list of places or \"let-go\"")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Cuts, E> {
                Cuts::try_from(text.to_owned()).map_err(E::custom)
            }

            fn visit_f64<E: de::Error>(self, x: f64) -> Result<Cuts, E> {
                Cuts::at(vec![x]).map_err(E::custom)
            }

            fn visit_i64<E: de::Error>(self, x: i64) -> Result<Cuts, E> {
                self.visit_f64(x as f64)
            }

            fn visit_u64<E: de::Error>(self, x: u64) -> Result<Cuts, E> {
                self.visit_f64(x as f64)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Cuts, A::Error> {
                let mut at = Vec::new();
                while let Some(x) = list.next_element()? {
                    at.push(x);
                }
                Cuts::at(at).map_err(de::Error::custom)
            }
        }
        deserializer.deserialize_any(Choice)
    }
}

impl JsonSchema for Cuts {
    fn schema_name() -> Cow<'static, str> {
        "Cuts".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let place = || json_schema!({ "type": "number", "minimum": 0, "exclusiveMaximum": 1 });
        json_schema!({ "anyOf": [
            { "const": ARGMAX, "description": "The maximum of the smoothed energy density." },
            { "const": NEAR_TIES, "description": "Every local maximum within 3 % of the largest." },
            { "const": "energy", "description": "As `\"argmax\"`." },
            { "const": "curvature", "description": "The maximum of the curvature." },
            { "const": "tension", "description": "Of the tension on the outer side of the bend, axial and of bending." },
            { "const": "von-mises", "description": "Of the von Mises stress there, of tension and twist." },
            { "type": "string", "pattern": "^near-ties:(energy|curvature|tension|von-mises)$", "x-form": "\"near-ties:tension\" and the like for the near ties of another criterion" },
            { "const": CRITERIA, "description": "The near ties of the energy density and the maxima of the three others, each site once." },
            { "type": "string", "pattern": "^all:[0-9]+$", "x-form": "\"all:K\" for K evenly spaced cuts" },
            { "const": LET_GO, "description": "No cut: an open fibre is let go." },
            place(),
            { "type": "array", "items": place(), "minItems": 1, "maxItems": MOST_CUTS },
        ] })
    }
}

/// What presets choose, in words: the draft, and those that differ from it.
pub(super) fn by_preset<T: PartialEq + fmt::Display>(value: impl Fn(Preset) -> T) -> String {
    let mut chosen: Vec<(T, Vec<&str>)> = Vec::new();
    for preset in [
        Preset::Draft,
        Preset::Standard,
        Preset::Paper,
        Preset::Reference,
    ] {
        let value = value(preset);
        match chosen.iter_mut().find(|(known, _)| *known == value) {
            Some((_, names)) => names.push(preset.name()),
            None => chosen.push((value, vec![preset.name()])),
        }
    }
    let words = chosen
        .iter()
        .enumerate()
        .map(|(k, (value, names))| match k {
            0 => value.to_string(),
            _ => format!("{value} with {}", listed(names, "and")),
        });
    words.collect::<Vec<String>>().join("; ")
}

/// Share of the largest density within which a local maximum counts as a near tie.
pub const NEAR_TIE: f64 = 0.03;

impl Preset {
    /// Edges N of a rod.
    pub fn edges(self) -> usize {
        match self {
            Self::Draft | Self::Standard => 200,
            Self::Paper | Self::Reference => 400,
        }
    }

    /// Local error aimed at, in h.
    pub fn tolerance(self) -> f64 {
        match self {
            Self::Draft => 1e-3,
            Self::Standard => 5e-4,
            Self::Paper => 2e-4,
            Self::Reference => 1e-4,
        }
    }

    /// Integrator and tolerance.
    pub fn accuracy(self) -> Accuracy {
        let usual = Accuracy {
            tolerance: self.tolerance(),
            ..Accuracy::default()
        };
        if self == Self::Reference {
            Accuracy { reuse: 1, ..usual }
        } else {
            usual
        }
    }

    /// Cuts made where the scene does not say.
    pub fn cuts(self) -> Cuts {
        if self == Self::Draft {
            Cuts::Largest(Criterion::Energy)
        } else {
            Cuts::NearTies(Criterion::Energy)
        }
    }

    /// How knots are tightened.
    pub fn tighten(self) -> TightenSettings {
        match self {
            Self::Draft => TightenSettings::draft(),
            Self::Standard => TightenSettings::standard(),
            Self::Paper | Self::Reference => TightenSettings::fine(),
        }
    }
}

#[cfg(test)]
mod tests {
    use topo_rod::cut_candidates;

    use super::*;

    /// Maxima within 3 % of the largest count as ties, as the published densities of 7_4 (1.5 %) do.
    #[test]
    fn val_near_ties_are_within_three_per_cent() {
        let mut density = vec![1.0; 200];
        for (vertex, height) in [(20, 3.0), (60, 2.92), (100, 2.955), (140, 2.9), (180, 2.2)] {
            density[vertex] = height;
        }
        let ties = cut_candidates(&density, 0.25, NEAR_TIE);
        let vertices: Vec<usize> = ties.iter().map(|c| c.vertex).collect();
        assert_eq!(vertices, [20, 100, 60]);
    }

    #[test]
    fn choices_of_cuts_are_read_and_written() {
        for (text, cuts) in [
            ("argmax", Cuts::Largest(Criterion::Energy)),
            ("near-ties", Cuts::NearTies(Criterion::Energy)),
            ("curvature", Cuts::Largest(Criterion::Curvature)),
            ("tension", Cuts::Largest(Criterion::Tension)),
            ("von-mises", Cuts::Largest(Criterion::VonMises)),
            ("near-ties:von-mises", Cuts::NearTies(Criterion::VonMises)),
            ("criteria", Cuts::Criteria),
            ("all:12", Cuts::All(12)),
            ("0.25", Cuts::At(vec![0.25])),
            ("0,0.5,0.125", Cuts::At(vec![0.0, 0.5, 0.125])),
        ] {
            assert_eq!(Cuts::try_from(text.to_owned()), Ok(cuts.clone()));
            assert_eq!(String::from(cuts.clone()), text);
            let json = serde_json::to_string(&cuts).unwrap();
            assert_eq!(serde_json::from_str::<Cuts>(&json).unwrap(), cuts);
        }
        assert_eq!(serde_json::to_string(&Cuts::All(12)).unwrap(), "\"all:12\"");
        assert_eq!(
            serde_json::to_string(&Cuts::At(vec![0.25])).unwrap(),
            "[0.25]"
        );
        // the present measure by its name
        assert_eq!(Cuts::try_from("energy".to_owned()), Ok(Cuts::default()));
        for text in [
            "",
            "stress",
            "near-ties:",
            "near-ties:stress",
            "all",
            "all:0",
            "all:10001",
            "ties",
            "1",
            "-0.1",
            "nan",
            "0.5,0.50",
        ] {
            assert!(Cuts::try_from(text.to_owned()).is_err(), "{text}");
        }
    }

    #[test]
    fn cuts_at_one_vertex_are_reported() {
        assert!(Cuts::All(8).clash(8).is_none() && Cuts::All(9).clash(8).is_some());
        let at = |list: &[f64]| Cuts::At(list.to_vec()).clash(100);
        assert_eq!(at(&[0.0, 0.01, 0.5]), None);
        let message = at(&[0.5, 0.0, 0.998]).unwrap();
        assert!(message.contains("0 and 0.998"), "{message}");
    }
}
