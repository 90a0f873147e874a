//! Scene files: TOML that reads like the experiment.
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
//!
//! Instead of the table `[accuracy]`, the first line may say `accuracy = 0.02` (relative error of t99) or `budget = "10 min"`.

use std::path::Path;

use serde::{Deserialize, Serialize};
use topo_rod::{
    Accuracy, ChargeSettings, ContactParameters, DischargeSettings, Ends, FrictionParameters,
    IntegratorKind, Reading, RodParameters,
};

use super::choices::{Cuts, Names, Numbers, Preset};
use super::scene::ElasticScene;
use crate::AnalysisError;
use crate::scene::read_text;
use crate::timeline::TimelineSettings;
use crate::wish::{Wish, WishOr, budget};

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

pub(super) mod defaults {
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
    accuracy: WishOr<AccuracyTable>,
    budget: Option<String>,
}

impl ElasticScene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// File, line, key and what would be right.
    pub fn read(path: &Path) -> Result<Self, AnalysisError> {
        Self::parse(&read_text(path)?, path)
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
        let rod = file.rod;
        let value = |key: &str, value: String, remedy: &str| AnalysisError::SceneValue {
            path: path.to_owned(),
            key: key.to_owned(),
            value,
            remedy: remedy.to_owned(),
        };
        let (asked, wish) = file
            .accuracy
            .with_budget(file.budget.as_deref())
            .map_err(|(key, text, remedy)| value(key, text, &remedy))?;
        let preset = asked.preset;
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
            tolerance: asked.tolerance.unwrap_or(standard.accuracy.tolerance),
            gamma: asked.gamma.unwrap_or(standard.accuracy.gamma),
            integrator: asked.integrator.unwrap_or_default(),
            reuse: asked.reuse.unwrap_or(standard.accuracy.reuse),
            max_steps: asked.max_steps.unwrap_or(standard.accuracy.max_steps),
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
                n_edges: asked.edges.unwrap_or(preset.edges()),
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
            wish,
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

    /// The scene as the text of a file with every value written out; [`parse`](Self::parse) gives the same scene back.
    ///
    /// A file cannot say the folder of the tables, fixed cuts, nor what only presets set: those must be a file's own.
    ///
    /// # Validation
    /// `elastic_scenes_come_back_as_written`, `poisson_ratios_come_back`
    pub fn text(&self) -> String {
        let rod = &self.rod;
        let mut file = File {
            rod: RodTable {
                knot: Names::List(self.knots.clone()),
                slenderness: rod.slenderness,
                reading: rod.reading,
                twist: (!self.twists.is_empty()).then(|| Numbers::List(self.twists.clone())),
                poisson_ratio: poisson_ratio(rod.twist_ratio),
                stretch_ratio: rod.stretch_ratio,
                contact: rod.contact,
                friction: rod.friction,
                imperfection: self.imperfection,
                seed: self.seed,
            },
            charge: ChargeTable {
                duration: Some(self.charge.duration),
            },
            discharge: DischargeTable {
                cuts: Some(self.cuts),
                until_released: Some(self.discharge.until_released),
                longest: Some(self.discharge.longest),
                closures: Some(self.timeline.closures),
                ends: self.discharge.ends,
            },
            accuracy: WishOr::Settings(AccuracyTable {
                preset: self.preset,
                edges: Some(rod.n_edges),
                tolerance: Some(self.accuracy.tolerance),
                gamma: Some(self.accuracy.gamma),
                integrator: Some(self.accuracy.integrator),
                reuse: Some(self.accuracy.reuse),
                max_steps: Some(self.accuracy.max_steps),
            }),
            budget: budget(self.wish),
        };
        if let Some(Wish::Accuracy(error)) = self.wish {
            file.accuracy = WishOr::Wish(error);
        }
        // Tables of numbers and names always have a text.
        toml::to_string(&file).unwrap_or_default()
    }
}

/// Poisson's ratio whose twist ratio 1/(1 + ν) is the one given, to the bit where there is one.
fn poisson_ratio(twist_ratio: f64) -> f64 {
    let near = 1.0 / twist_ratio - 1.0;
    // 1 + ν is a multiple of this: its neighbours are all that rounding can have meant.
    let spacing = 0.5 * f64::EPSILON;
    (0..16)
        .flat_map(|k| [near + f64::from(k) * spacing, near - f64::from(k) * spacing])
        .find(|ratio| 1.0 / (1.0 + ratio) == twist_ratio)
        .unwrap_or(near)
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
            cases.iter().map(|c| c.knot.as_str()).collect::<Vec<_>>(),
            ["3_1", "4_1"]
        );
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
