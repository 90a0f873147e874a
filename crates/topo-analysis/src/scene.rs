//! Scenes: TOML files that read like the experiment, and the cases they stand for.
//!
//! ```toml
//! [rod]
//! knot = "7_4"              # one name, a list, or "all"
//! slenderness = 50          # L/h
//! twist = -2.0              # theta' h: a number, a list, or { from = -2, to = 2, n = 17 }; leave out: no twist is modelled
//! [rod.contact]             # leave the table out: strands pass through each other
//! [rod.friction]            # leave the table out: no friction is modelled
//! ratio = 0.1               # eta_f / eta
//! [discharge]
//! cuts = "near-ties"        # "argmax", "near-ties" or "all:K"
//! until_released = 0.999
//! [accuracy]
//! preset = "standard"
//! ```

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use topo_knots::TightenSettings;
use topo_rod::{
    Accuracy, ChargeSettings, ContactParameters, DischargeSettings, Ends, FrictionParameters,
    FrictionRange, IntegratorKind, Reading, RodParameters,
};

use crate::AnalysisError;
use crate::timeline::TimelineSettings;

/// One value, a list of them, or evenly spaced numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Numbers {
    /// One number.
    One(f64),
    /// A list.
    List(Vec<f64>),
    /// `n` numbers from `from` to `to`, both included.
    Range {
        /// First.
        from: f64,
        /// Last.
        to: f64,
        /// How many.
        n: usize,
    },
}

impl Numbers {
    /// The numbers meant.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::One(x) => vec![*x],
            Self::List(list) => list.clone(),
            Self::Range { from, n: 1, .. } => vec![*from],
            // halves and quarters come out exactly
            Self::Range { from, to, n } => (0..*n)
                .map(|k| from + (to - from) * k as f64 / (*n - 1) as f64)
                .collect(),
        }
    }
}

/// One knot name or a list; "all" stands for the whole table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Names {
    /// One name.
    One(String),
    /// A list.
    List(Vec<String>),
}

/// Which sites are cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Cuts {
    /// The maximum of the smoothed energy density.
    #[default]
    Argmax,
    /// Every local maximum within 3 % of the largest.
    NearTies,
    /// K evenly spaced sites.
    All(usize),
}

impl TryFrom<String> for Cuts {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let all = |k: &str| {
            k.parse()
                .ok()
                .filter(|k| (1..=10_000).contains(k))
                .map(Self::All)
        };
        match text.as_str() {
            "argmax" => Ok(Self::Argmax),
            "near-ties" => Ok(Self::NearTies),
            other => other
                .strip_prefix("all:")
                .and_then(all)
                .ok_or_else(|| format!("`{text}` is not a choice of cuts: write \"argmax\", \"near-ties\" or \"all:K\" with K from 1 to 10000")),
        }
    }
}

impl From<Cuts> for String {
    fn from(cuts: Cuts) -> Self {
        match cuts {
            Cuts::Argmax => "argmax".into(),
            Cuts::NearTies => "near-ties".into(),
            Cuts::All(k) => format!("all:{k}"),
        }
    }
}

/// Share of the largest density within which a local maximum counts as a near tie.
pub const NEAR_TIE: f64 = 0.03;

/// How fine and how accurate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// Minutes for all: N = 200, tolerance 1e-3 h.
    #[default]
    Draft,
    /// N = 200, tolerance 5e-4 h, near-tied cuts.
    Standard,
    /// N = 400, tolerance 2e-4 h, near-tied cuts.
    Paper,
}

impl Preset {
    /// Name used in scenes and on figures.
    pub fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Standard => "standard",
            Self::Paper => "paper",
        }
    }

    /// Edges N of a rod.
    pub fn edges(self) -> usize {
        if self == Self::Paper { 400 } else { 200 }
    }

    /// Local error aimed at, in h.
    pub fn tolerance(self) -> f64 {
        match self {
            Self::Draft => 1e-3,
            Self::Standard => 5e-4,
            Self::Paper => 2e-4,
        }
    }

    /// Cuts made where the scene does not say.
    pub fn cuts(self) -> Cuts {
        if self == Self::Draft {
            Cuts::Argmax
        } else {
            Cuts::NearTies
        }
    }

    /// How knots are tightened.
    pub fn tighten(self) -> TightenSettings {
        match self {
            Self::Draft => TightenSettings::draft(),
            Self::Standard => TightenSettings::standard(),
            Self::Paper => TightenSettings::fine(),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RodTable {
    knot: Names,
    #[serde(default = "defaults::slenderness")]
    slenderness: f64,
    #[serde(default)]
    reading: Reading,
    twist: Option<Numbers>,
    #[serde(default = "defaults::poisson_ratio")]
    poisson_ratio: f64,
    #[serde(default = "defaults::stretch_ratio")]
    stretch_ratio: f64,
    contact: Option<ContactParameters>,
    friction: Option<FrictionParameters>,
    #[serde(default = "defaults::imperfection")]
    imperfection: f64,
    #[serde(default = "defaults::seed")]
    seed: u64,
}

mod defaults {
    pub fn slenderness() -> f64 {
        50.0
    }
    pub fn poisson_ratio() -> f64 {
        0.3
    }
    pub fn stretch_ratio() -> f64 {
        5.0
    }
    pub fn imperfection() -> f64 {
        1e-3
    }
    pub fn seed() -> u64 {
        1
    }
}

#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct DischargeTable {
    cuts: Option<Cuts>,
    until_released: Option<f64>,
    longest: Option<f64>,
    closures: Option<usize>,
    ends: Ends,
}

#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct AccuracyTable {
    preset: Preset,
    edges: Option<usize>,
    tolerance: Option<f64>,
    gamma: Option<f64>,
    integrator: Option<IntegratorKind>,
    reuse: Option<usize>,
    max_steps: Option<u64>,
}

#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct ChargeTable {
    duration: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    rod: RodTable,
    #[serde(default)]
    charge: ChargeTable,
    #[serde(default)]
    discharge: DischargeTable,
    #[serde(default)]
    accuracy: AccuracyTable,
}

/// An elastic experiment: which knots, how twisted, how cut, how accurately.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ElasticScene {
    /// Folder of its tables below the output folder.
    pub folder: String,
    /// Knot names; "all" stands for the whole table.
    pub knots: Vec<String>,
    /// θ'h of the cases; empty: no twist is modelled.
    pub twists: Vec<f64>,
    /// Material, reading and resolution, its twist not yet set.
    pub rod: RodParameters,
    /// Size of the random perturbation of the start curve, in h: symmetric states that are unstable are left by it.
    pub imperfection: f64,
    /// Seed of that perturbation and of the closures.
    pub seed: u64,
    /// Relaxation of the closed rod.
    pub charge: ChargeSettings,
    /// Sites cut.
    pub cuts: Cuts,
    /// Discharge of the open rod.
    pub discharge: DischargeSettings,
    /// Knot types while open.
    pub timeline: TimelineSettings,
    /// Integrator and tolerance.
    pub accuracy: Accuracy,
    /// Preset that the numbers started from.
    pub preset: Preset,
    /// How the start shapes are tightened.
    pub tighten: TightenSettings,
}

/// One charge with its cuts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ElasticCase {
    /// Knot type.
    pub knot: String,
    /// Material, twist, reading and resolution.
    pub rod: RodParameters,
}

impl ElasticCase {
    /// Folder name, unique within a scene.
    pub fn name(&self) -> String {
        let twist = self
            .rod
            .twist
            .map_or("untwisted".to_owned(), |t| format!("twist{t:+.2}"));
        format!(
            "{}_{twist}_{}_n{}",
            self.knot,
            self.rod.reading.name(),
            self.rod.n_edges
        )
    }
}

impl ElasticScene {
    /// The published sweep: 14 knots at 17 twists.
    pub fn published(preset: Preset) -> Self {
        Self {
            folder: "elastic".to_owned(),
            knots: vec!["all".to_owned()],
            twists: Numbers::Range {
                from: -2.0,
                to: 2.0,
                n: 17,
            }
            .values(),
            rod: RodParameters {
                n_edges: preset.edges(),
                ..RodParameters::default()
            },
            imperfection: defaults::imperfection(),
            seed: defaults::seed(),
            charge: ChargeSettings::default(),
            cuts: preset.cuts(),
            discharge: DischargeSettings::default(),
            timeline: TimelineSettings::default(),
            accuracy: Accuracy {
                tolerance: preset.tolerance(),
                ..Accuracy::default()
            },
            preset,
            tighten: preset.tighten(),
        }
    }

    /// Reads a scene file.
    ///
    /// # Errors
    /// File, line, key and what would be right.
    pub fn read(path: &Path) -> Result<Self, AnalysisError> {
        let text = std::fs::read_to_string(path).map_err(|source| AnalysisError::Unreadable {
            path: path.to_owned(),
            source,
        })?;
        Self::parse(&text, path)
    }

    /// Reads a scene from a text; `path` names it in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, AnalysisError> {
        let file: File = toml::from_str(text).map_err(|e| AnalysisError::Scene {
            path: path.to_owned(),
            message: e.to_string(),
        })?;
        let (rod, preset) = (file.rod, file.accuracy.preset);
        let value = |key: &str, value: String, remedy: &str| AnalysisError::SceneValue {
            path: path.to_owned(),
            key: key.to_owned(),
            value,
            remedy: remedy.to_owned(),
        };
        let knots = match rod.knot {
            Names::One(name) => vec![name],
            Names::List(names) => names,
        };
        if knots.is_empty() {
            return Err(value(
                "rod.knot",
                "[]".into(),
                "name at least one knot, or write \"all\"",
            ));
        }
        if let Some(Numbers::Range { n, .. }) = rod.twist
            && !(1..=100_000).contains(&n)
        {
            return Err(value(
                "rod.twist.n",
                n.to_string(),
                "ask for 1 to 100000 twists",
            ));
        }
        let twists = rod.twist.as_ref().map_or(Vec::new(), Numbers::values);
        if rod.twist.is_some() && twists.is_empty() {
            return Err(value(
                "rod.twist",
                "[]".into(),
                "give at least one number, or leave the key out to model no twist",
            ));
        }
        if let Some(t) = twists.iter().find(|t| !t.is_finite()) {
            return Err(value(
                "rod.twist",
                t.to_string(),
                "a finite number is needed, such as 2.0",
            ));
        }
        if !(rod.poisson_ratio > -1.0 && rod.poisson_ratio <= 0.5) {
            return Err(value(
                "rod.poisson_ratio",
                rod.poisson_ratio.to_string(),
                "a number above -1 and up to 0.5 is needed",
            ));
        }
        if !(0.0..=0.5).contains(&rod.imperfection) {
            return Err(value(
                "rod.imperfection",
                rod.imperfection.to_string(),
                "a number from 0 to 0.5 (in h) is needed",
            ));
        }
        let standard = Self::published(preset);
        let accuracy = Accuracy {
            tolerance: file
                .accuracy
                .tolerance
                .unwrap_or(standard.accuracy.tolerance),
            gamma: file.accuracy.gamma.unwrap_or(standard.accuracy.gamma),
            integrator: file.accuracy.integrator.unwrap_or_default(),
            reuse: file.accuracy.reuse.unwrap_or(standard.accuracy.reuse),
            max_steps: file
                .accuracy
                .max_steps
                .unwrap_or(standard.accuracy.max_steps),
            ..standard.accuracy
        };
        let discharge = DischargeSettings {
            until_released: file
                .discharge
                .until_released
                .unwrap_or(standard.discharge.until_released),
            longest: file.discharge.longest.unwrap_or(standard.discharge.longest),
            ends: file.discharge.ends,
            ..standard.discharge
        };
        let scene = Self {
            knots,
            twists,
            rod: RodParameters {
                slenderness: rod.slenderness,
                reading: rod.reading,
                n_edges: file.accuracy.edges.unwrap_or(preset.edges()),
                twist_ratio: 1.0 / (1.0 + rod.poisson_ratio),
                stretch_ratio: rod.stretch_ratio,
                twist: None,
                contact: rod.contact,
                friction: rod.friction,
            },
            imperfection: rod.imperfection,
            seed: rod.seed,
            charge: ChargeSettings {
                duration: file.charge.duration.unwrap_or(standard.charge.duration),
                ..standard.charge
            },
            cuts: file.discharge.cuts.unwrap_or(standard.cuts),
            discharge,
            timeline: TimelineSettings {
                closures: file
                    .discharge
                    .closures
                    .unwrap_or(standard.timeline.closures),
                ..standard.timeline
            },
            accuracy,
            ..standard
        };
        let refuse = |source| AnalysisError::Rod {
            case: path.display().to_string(),
            source,
        };
        scene.rod.clone().checked().map_err(refuse)?;
        scene.accuracy.checked().map_err(refuse)?;
        scene
            .discharge
            .ends
            .checked(!scene.twists.is_empty())
            .map_err(refuse)?;
        topo_core::in_range(
            "discharge.until_released",
            scene.discharge.until_released,
            1e-6,
            1.0 - 1e-9,
        )
        .map_err(|e| refuse(e.into()))?;
        topo_core::positive("discharge.longest", scene.discharge.longest)
            .map_err(|e| refuse(e.into()))?;
        topo_core::positive("charge.duration", scene.charge.duration)
            .map_err(|e| refuse(e.into()))?;
        Ok(scene)
    }

    /// The cases of the scene, knots in the order given, twists inside.
    pub fn cases(&self, table: &topo_knots::KnotTable) -> Result<Vec<ElasticCase>, AnalysisError> {
        let mut names = Vec::new();
        for name in &self.knots {
            if name == "all" {
                names.extend(table.names().map(str::to_owned));
            } else {
                names.push(table.get(name)?.name.clone());
            }
        }
        let twists: Vec<Option<f64>> = if self.twists.is_empty() {
            vec![None]
        } else {
            self.twists.iter().copied().map(Some).collect()
        };
        let case = |knot: &String, twist| ElasticCase {
            knot: knot.clone(),
            rod: RodParameters {
                twist,
                ..self.rod.clone()
            },
        };
        Ok(names
            .iter()
            .flat_map(|knot| twists.iter().map(move |t| case(knot, *t)))
            .collect())
    }

    /// Where files with the scene's tables lie below an output folder.
    pub fn results(&self, out: &Path) -> PathBuf {
        out.join(&self.folder)
    }

    /// The untwisted cases under the two other choices that separate knot type from friction: friction range equal to the
    /// contact diameter, and the reading `tight`. Their tables lie in folders of their own.
    pub fn friction_variants(&self) -> [Self; 2] {
        let untwisted = Self {
            twists: vec![0.0],
            ..self.clone()
        };
        let mut contact = Self {
            folder: "elastic-contact-range".to_owned(),
            ..untwisted.clone()
        };
        if let Some(friction) = &mut contact.rod.friction {
            friction.range = FrictionRange::Contact;
        }
        let mut tight = Self {
            folder: "elastic-tight".to_owned(),
            ..untwisted
        };
        tight.rod.reading = Reading::Tight;
        [contact, tight]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<ElasticScene, AnalysisError> {
        ElasticScene::parse(text, Path::new("scene.toml"))
    }

    #[test]
    fn a_scene_says_what_is_modelled() {
        let scene = parse("[rod]\nknot = \"7_4\"\ntwist = -2.0\n[rod.contact]\n[rod.friction]\nratio = 0.2\n[discharge]\ncuts = \"all:8\"\n[accuracy]\npreset = \"standard\"\nedges = 120").unwrap();
        assert_eq!(scene.rod.friction.unwrap().ratio, 0.2);
        assert_eq!(scene.rod.contact.unwrap().stiffness, 20.0);
        assert_eq!(
            (scene.cuts, scene.rod.n_edges, scene.twists.as_slice()),
            (Cuts::All(8), 120, &[-2.0][..])
        );
        let bare = parse("[rod]\nknot = [\"3_1\", \"4_1\"]").unwrap();
        assert!(
            bare.rod.friction.is_none() && bare.rod.contact.is_none() && bare.twists.is_empty()
        );
        let cases = bare.cases(&topo_knots::KnotTable::builtin()).unwrap();
        assert_eq!(
            cases.iter().map(ElasticCase::name).collect::<Vec<_>>(),
            ["3_1_untwisted_shrunk_n200", "4_1_untwisted_shrunk_n200"]
        );
    }

    #[test]
    fn the_published_sweep_has_238_cases() {
        let cases = ElasticScene::published(Preset::Draft)
            .cases(&topo_knots::KnotTable::builtin())
            .unwrap();
        assert_eq!(cases.len(), 238);
        assert_eq!(cases[8].name(), "3_1_twist+0.00_shrunk_n200");
    }

    #[test]
    fn bad_scenes_are_refused_with_key_value_and_remedy() {
        for (text, words) in [
            (
                "[rod]\nknot = \"3_1\"\ntwits = 2",
                vec!["scene.toml", "twits", "twist"],
            ),
            (
                "[rod]\nknot = \"3_1\"\ntwist = nan",
                vec!["rod.twist", "NaN", "finite"],
            ),
            (
                "[rod]\nknot = \"3_1\"\nslenderness = -50",
                vec!["slenderness", "-50"],
            ),
            (
                "[rod]\nknot = \"3_1\"\n[accuracy]\nedges = 4",
                vec!["4 edges", "8"],
            ),
            (
                "[rod]\nknot = \"3_1\"\n[rod.friction]\nratio = -1",
                vec!["friction.ratio", "-1"],
            ),
            ("[rod]\nknot = 3", vec!["scene.toml", "knot"]),
            (
                "[rod]\nknot = \"3_1\"\n[discharge]\ncuts = \"all:0\"",
                vec!["all:0", "near-ties"],
            ),
            (
                "[rod]\nknot = \"3_1\"\npoisson_ratio = 0.9",
                vec!["rod.poisson_ratio", "0.9"],
            ),
            ("[rod]\nknot = []", vec!["rod.knot"]),
            ("knot = 1", vec!["scene.toml"]),
        ] {
            let message = parse(text).unwrap_err().to_string();
            for word in words {
                assert!(
                    message.contains(word),
                    "{text:?} gives {message:?} without {word:?}"
                );
            }
        }
        let unknown = parse("[rod]\nknot = \"3_7\"")
            .unwrap()
            .cases(&topo_knots::KnotTable::builtin())
            .unwrap_err()
            .to_string();
        assert!(
            unknown.contains("3_7") && unknown.contains("3_1"),
            "{unknown}"
        );
    }
}
