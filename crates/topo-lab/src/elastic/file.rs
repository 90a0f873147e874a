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
//! cuts = "near-ties"        # "argmax", "near-ties", "all:K", a place s/L or a list of places
//! until_released = 0.999
//! [accuracy]
//! preset = "standard"
//! ```
//!
//! Every number of the rod, its reading and its friction range, and `edges` may be a list, numbers also a range: the cases are the
//! product. `knots = "my-knots"` as a first line names a folder of knot files, beside the scene's file.
//!
//! Instead of the table `[accuracy]`, the first line may say `accuracy = 0.02` (relative error of t99) or `budget = "10 min"`.

use std::path::Path;

use serde::{Deserialize, Serialize};
use topo_rod::{
    Accuracy, ChargeSettings, ContactParameters, DischargeSettings, Ends, FrictionParameters,
    IntegratorKind, Reading, RodParameters,
};

use super::case::ElasticCase;
use super::check;
use super::choices::{Cuts, Names};
use super::defaults::{self, poisson_ratio_of};
use super::keys::{EDGES, ROD_KEYS};
use super::scene::{ElasticScene, OwnKnots};
use crate::LabError;
use crate::goal::{Goal, GoalOr, budget};
use crate::preset::Preset;
use crate::scene::{
    Axis, Document, Numbers, axes, folder_of, numbers, put_axes, read_text, remove,
};
use topo_analysis::TimelineSettings;

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
    accuracy: GoalOr<AccuracyTable>,
    budget: Option<String>,
    knots: Option<String>,
}

impl File {
    fn asked(&self) -> AccuracyTable {
        match &self.accuracy {
            GoalOr::Settings(asked) => asked.clone(),
            GoalOr::Goal(_) => AccuracyTable::default(),
        }
    }

    /// The case that the file describes, its knot and twist left out.
    fn case(&self) -> ElasticCase {
        let (rod, asked) = (&self.rod, self.asked());
        ElasticCase {
            knot: String::new(),
            rod: RodParameters {
                slenderness: rod.slenderness,
                reading: rod.reading,
                n_edges: asked.edges.unwrap_or(asked.preset.edges()),
                twist_ratio: 1.0 / (1.0 + rod.poisson_ratio),
                stretch_ratio: rod.stretch_ratio,
                twist: None,
                contact: rod.contact,
                friction: rod.friction,
            },
            imperfection: rod.imperfection,
            seed: rod.seed,
        }
    }

    fn scene(
        self,
        document: &Document<'_>,
        axes: Vec<Axis>,
        twists: Vec<f64>,
    ) -> Result<ElasticScene, LabError> {
        let ElasticCase {
            rod,
            imperfection,
            seed,
            ..
        } = self.case();
        let path = document.path();
        let (asked, goal) = self
            .accuracy
            .with_budget(self.budget.as_deref())
            .map_err(|(key, text, remedy)| document.wrong(key, text, remedy))?;
        let standard = ElasticScene::published(asked.preset);
        let (accuracy, discharge) = (standard.accuracy, standard.discharge);
        let run = self.discharge;
        let beside = path.parent().unwrap_or(Path::new("")).to_owned();
        Ok(ElasticScene {
            folder: folder_of(path)?,
            knots: match self.rod.knot {
                Names::One(name) => vec![name],
                Names::List(names) => names,
            },
            twists,
            rod,
            imperfection,
            seed,
            charge: ChargeSettings {
                duration: self.charge.duration.unwrap_or(standard.charge.duration),
                ..standard.charge
            },
            cuts: run.cuts.unwrap_or(standard.cuts),
            discharge: DischargeSettings {
                until_released: run.until_released.unwrap_or(discharge.until_released),
                longest: run.longest.unwrap_or(discharge.longest),
                ends: run.ends,
                ..discharge
            },
            timeline: TimelineSettings {
                closures: run.closures.unwrap_or(standard.timeline.closures),
                ..standard.timeline
            },
            accuracy: Accuracy {
                tolerance: asked.tolerance.unwrap_or(accuracy.tolerance),
                gamma: asked.gamma.unwrap_or(accuracy.gamma),
                integrator: asked.integrator.unwrap_or_default(),
                reuse: asked.reuse.unwrap_or(accuracy.reuse),
                max_steps: asked.max_steps.unwrap_or(accuracy.max_steps),
                ..accuracy
            },
            axes,
            own_knots: self.knots.map(|written| OwnKnots { written, beside }),
            goal,
            ..standard
        })
    }
}

impl ElasticScene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// File, line, key and what would be right.
    pub fn read(path: &Path) -> Result<Self, LabError> {
        Self::parse(&read_text(path)?, path)
    }

    /// Reads a scene from a text; `path` names it in messages, and its results.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, LabError> {
        let document = Document::new(text, path)?;
        let (plain, axes) = axes(&document, &ROD_KEYS, |text| {
            Ok(document.read::<File>(text)?.case())
        })?;
        let twists = numbers(&document, "rod.twist")?.unwrap_or_default();
        let file: File = document.read(&plain)?;
        let poisson_ratio = file.rod.poisson_ratio;
        let scene = file.scene(&document, axes, twists)?;
        check::check(&scene, poisson_ratio, &document)?;
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
                poisson_ratio: poisson_ratio_of(rod.twist_ratio),
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
                cuts: Some(self.cuts.clone()),
                until_released: Some(self.discharge.until_released),
                longest: Some(self.discharge.longest),
                closures: Some(self.timeline.closures),
                ends: self.discharge.ends,
            },
            accuracy: GoalOr::Settings(AccuracyTable {
                preset: self.preset,
                edges: Some(rod.n_edges),
                tolerance: Some(self.accuracy.tolerance),
                gamma: Some(self.accuracy.gamma),
                integrator: Some(self.accuracy.integrator),
                reuse: Some(self.accuracy.reuse),
                max_steps: Some(self.accuracy.max_steps),
            }),
            budget: budget(self.goal),
            knots: self.own_knots.as_ref().map(|own| own.written.clone()),
        };
        if let Some(Goal::Accuracy(error)) = self.goal {
            file.accuracy = GoalOr::Goal(error);
        }
        // Tables of numbers and names always have a text.
        let mut file = toml::Table::try_from(&file).unwrap_or_default();
        if budget(self.goal).is_some() {
            file.remove("accuracy");
        }
        for (key, _) in check::idle(self) {
            remove(key, &mut file);
        }
        let has_goal = self.goal.is_some();
        let axes = self.axes.iter();
        let kept = axes.filter(|axis| !(has_goal && axis.key() == EDGES));
        put_axes(kept, &mut file);
        toml::to_string(&file).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests;
