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
//! cuts = "near-ties"        # "argmax", "near-ties", "curvature", "tension", "von-mises", "criteria", "all:K", a place s/L or a list
//! until_released = 0.999
//! [accuracy]
//! preset = "standard"
//! ```
//!
//! Every number of the rod, its reading and its friction range, and `edges` may be a list, numbers also a range: the cases are the
//! product. `knots = "my-knots"` as a first line names a folder of knot files, beside the scene's file.
//!
//! `[charge.break]` instead of `cuts` lets the fibre break by itself; `[si]` adds tables in seconds and joules.
//!
//! Instead of the table `[accuracy]`, the first line may say `accuracy = 0.02` (relative error of t99) or `budget = "10 min"`.

mod tied;

use std::path::Path;
use std::sync::OnceLock;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_rod::{
    Accuracy, Breaking, ChargeSettings, ContactParameters, DischargeSettings, EndLoad, Ends,
    FrictionParameters, Grip, IntegratorKind, PullSettings, Reading, RodParameters, Twisting,
};

use super::case::ElasticCase;
use super::check;
use super::choices::{Cuts, Names, by_preset};
use super::defaults::{self, poisson_ratio_of};
use super::keys::{EDGES, ROD_KEYS};
use super::rest::{RestKeys, RestTable};
use super::scene::{ElasticScene, OwnKnots};
use super::si::Si;
use super::tie::Word;
use tied::TiedKeys;

use crate::LabError;
use crate::goal::{Goal, GoalOr, budget};
use crate::preset::Preset;
use crate::scene::{
    Axis, Document, Keys, Numbers, SceneFault, axes, folder_of, numbers, put_axes, read_text,
    remove,
};
use topo_analysis::TimelineSettings;

/// The fibre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RodTable {
    /// Name of a knot, a list of names, or `"all"` for the 14 prime knots to seven crossings.
    #[schemars(example = "3_1", extend("x-default" = "one of `knot`, `link`, `braid` and `curve` must be there"))]
    knot: Option<Names>,
    /// Name of a link, such as `"hopf"` or `"L6a4"`, or a list of names; instead of `knot`.
    #[schemars(example = &"hopf", extend("x-default" = "none"))]
    link: Option<Names>,
    /// Braid word whose closure is tied, a list of letters or a text of them; instead of `knot`.
    #[schemars(example = &"1 1", extend("x-unit" = "1", "x-default" = "none"))]
    braid: Option<Word>,
    /// File beside the scene with one closed curve or several, in CSV, XYZ or VECT; instead of `knot`.
    #[schemars(example = &"my.vect", extend("x-default" = "none"))]
    curve: Option<String>,
    /// Whether what is tied is tightened first; else it is the curve as it is, smoothed.
    #[schemars(example = false, extend("x-default" = "true, of a `curve` false"))]
    tighten: Option<bool>,
    /// L/h, length over radius.
    #[serde(default = "defaults::slenderness")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0), example = 40.0)]
    slenderness: f64,
    /// How L/h is read for a knot whose ropelength is another.
    #[serde(default)]
    #[schemars(example = Reading::Hard)]
    reading: Reading,
    /// θ'h tied in before the ends are fused.
    #[schemars(extend("x-unit" = "1", "x-default" = "no twist is modelled"), example = 1.5)]
    twist: Option<Numbers>,
    /// ν, which sets the ratio of twist to bending stiffness, 1/(1 + ν).
    #[serde(default = "defaults::poisson_ratio")]
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = -1), range(max = 0.5), example = 0.5)]
    poisson_ratio: f64,
    /// γ = E/E_b, stretch over bending stiffness.
    #[serde(default = "defaults::stretch_ratio")]
    #[schemars(range(min = 1e-3, max = 1e6), extend("x-unit" = "1"), example = 10.0)]
    stretch_ratio: f64,
    /// Contact between strands; without the table they pass through each other.
    contact: Option<ContactParameters>,
    /// Friction between strands; without the table none is modelled.
    friction: Option<FrictionParameters>,
    /// Natural shape of the fibre; without the table it is straight and untwisted at rest.
    rest: Option<RestTable>,
    /// Largest random displacement of the start curve.
    #[serde(default = "defaults::imperfection")]
    #[schemars(range(min = 0, max = 0.5), extend("x-unit" = "h"), example = 0.01)]
    imperfection: f64,
    /// Seed of the imperfection and of the closures.
    #[serde(default = "defaults::seed")]
    #[schemars(extend("x-unit" = "1"), example = 2)]
    seed: u64,
}

/// The discharge of the cut fibre.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct DischargeTable {
    /// Where the fibre is cut: places s/L, or a rule that finds them. One that is open and pulled is let go unless this is given.
    #[schemars(extend("x-unit" = "s/L", "x-default" = by_preset(|p| String::from(p.cuts()))), example = "all:8")]
    cuts: Option<Cuts>,
    /// Share of the elastic energy whose release ends the run.
    #[schemars(range(min = 1e-6, max = 0.999_999_999), extend("x-unit" = "1", "default" = DischargeSettings::default().until_released), example = 0.99)]
    until_released: Option<f64>,
    /// Longest time followed.
    #[schemars(extend("x-unit" = "T_0", "default" = DischargeSettings::default().longest, "exclusiveMinimum" = 0), example = 100.0)]
    longest: Option<f64>,
    /// Directions along which the open fibre is closed to find its knot type; 0: it is not looked for.
    #[schemars(range(max = check::MOST_CLOSURES), extend("x-unit" = "1", "default" = TimelineSettings::default().closures), example = 64)]
    closures: Option<usize>,
    /// What holds, moves or loads the ends of the open fibre.
    ends: Ends,
    /// What takes up the work of the open fibre; without the table nothing does.
    load: Option<EndLoad>,
}

/// How accurately a fibre is followed.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct AccuracyTable {
    /// Where the other keys have their values from.
    #[schemars(example = Preset::Standard)]
    preset: Preset,
    /// Edges N of the fibre.
    #[schemars(range(min = RodParameters::LEAST_EDGES), extend("x-unit" = "1", "x-default" = by_preset(Preset::edges)), example = 120)]
    edges: Option<usize>,
    /// Local error aimed at.
    #[schemars(range(min = 1e-10, max = 1), extend("x-unit" = "h", "x-default" = by_preset(Preset::tolerance)), example = 1e-4)]
    tolerance: Option<f64>,
    /// Coefficient of the integrator `"ros2w"`: 1 + 1/√2 for loose, 1 - 1/√2 for tight tolerances.
    #[schemars(range(min = 0.25, max = 4), extend("x-unit" = "1", "default" = Accuracy::default().gamma), example = 0.3)]
    gamma: Option<f64>,
    /// Which integrator advances the fibre.
    #[schemars(extend("default" = IntegratorKind::default()), example = IntegratorKind::Rkc2)]
    integrator: Option<IntegratorKind>,
    /// Steps that one factorised Newton matrix may serve.
    #[schemars(range(min = 1, max = 1_000_000_000), extend("x-unit" = "steps", "x-default" = by_preset(|p| p.accuracy().reuse)), example = 4)]
    reuse: Option<usize>,
    /// Most steps of a phase.
    #[schemars(range(min = 1, max = 1_000_000_000_000_000_u64), extend("x-unit" = "steps", "default" = Accuracy::default().max_steps), example = 10_000)]
    max_steps: Option<u64>,
}

/// The charge of the closed fibre.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct ChargeTable {
    /// Duration of the relaxation.
    #[schemars(extend("x-unit" = "T_0", "default" = ChargeSettings::default().duration, "exclusiveMinimum" = 0), example = 1.0)]
    duration: Option<f64>,
    /// The fibre breaks by itself, instead of being cut after the charge.
    #[serde(rename = "break")]
    breaking: Option<Breaking>,
    /// Twisting in time between two relaxations; without the table the twist is tied in at once.
    twisting: Option<Twisting>,
}

/// The pulling of an open fibre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct PullTable {
    /// How its first and last end are held, moved and loaded in time.
    #[schemars(extend("examples" = [[{ "condition": "clamped" }, { "condition": "clamped", "displacement": [{ "to": 20.0, "over": 50.0 }, 0.0, 0.0] }]]))]
    grips: [Grip; 2],
    /// Duration.
    #[schemars(extend("x-unit" = "T_0", "exclusiveMinimum" = 0), example = 60.0)]
    duration: f64,
    /// Output times, evenly spaced.
    #[serde(default = "defaults::outputs")]
    #[schemars(range(min = 1, max = 100_000), extend("x-unit" = "1"), example = 50)]
    outputs: usize,
}

/// A scene of knotted fibres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct File {
    rod: RodTable,
    #[serde(default)]
    charge: ChargeTable,
    /// Pulling of a fibre that is open, instead of charge and cut; without the table its ends are fused.
    pull: Option<PullTable>,
    #[serde(default)]
    discharge: DischargeTable,
    /// What the fibre is made of, for tables in SI units; no result depends on it.
    si: Option<Si>,
    /// Largest relative error of t99, instead of the table [accuracy].
    #[serde(default)]
    #[schemars(extend("x-unit" = "1", "x-default" = "settings"))]
    accuracy: GoalOr<AccuracyTable>,
    /// Time that all cases may take, instead of the table [accuracy].
    #[schemars(extend("x-default" = "none"), example = "10 min")]
    budget: Option<String>,
    /// Folder beside the scene with knots of your own.
    #[schemars(extend("x-default" = "the built-in knots"), example = "my-knots")]
    knots: Option<String>,
}

/// The keys of these files.
pub(super) fn keys() -> &'static Keys {
    static KEYS: OnceLock<Keys> = OnceLock::new();
    KEYS.get_or_init(|| Keys::of::<File>().with_several(&ROD_KEYS))
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
            tied: None,
            rod: RodParameters {
                slenderness: rod.slenderness,
                reading: rod.reading,
                n_edges: asked.edges.unwrap_or(asked.preset.edges()),
                twist_ratio: 1.0 / (1.0 + rod.poisson_ratio),
                stretch_ratio: rod.stretch_ratio,
                twist: None,
                contact: rod.contact,
                friction: rod.friction,
                ..RodParameters::default()
            },
            rest: None,
            load: self.discharge.load,
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
            load,
            imperfection,
            seed,
            ..
        } = self.case();
        let path = document.path();
        let (knots, tie) = self.rod.tie(document, self.pull.is_some())?;
        let (asked, goal) = self
            .accuracy
            .with_budget(self.budget.as_deref())
            .map_err(|(key, text, remedy)| document.wrong(key, text, remedy))?;
        let standard = ElasticScene::published(asked.preset);
        let (accuracy, discharge) = (standard.accuracy, standard.discharge);
        let run = self.discharge;
        let beside = path.parent().unwrap_or(Path::new("")).to_owned();
        let rest = self
            .rod
            .rest
            .map(|table| RestKeys::new(table, beside.clone()));
        let is_pulled = self.pull.is_some();
        Ok(ElasticScene {
            folder: folder_of(path)?,
            knots,
            tie,
            twists,
            rod,
            rest,
            imperfection,
            seed,
            charge: ChargeSettings {
                duration: self.charge.duration.unwrap_or(standard.charge.duration),
                breaking: self.charge.breaking,
                twisting: self.charge.twisting,
                ..standard.charge
            },
            pull: self.pull.map(|pull| PullSettings {
                grips: pull.grips,
                duration: pull.duration,
                outputs: pull.outputs,
            }),
            cuts: run.cuts.unwrap_or(if is_pulled {
                Cuts::LetGo
            } else {
                standard.cuts
            }),
            discharge: DischargeSettings {
                until_released: run.until_released.unwrap_or(discharge.until_released),
                longest: run.longest.unwrap_or(discharge.longest),
                ends: run.ends,
                ..discharge
            },
            load,
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
            si: self.si,
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
        keys().check(&document)?;
        let (scene, faults) = Self::described(&document)?;
        faults.into_iter().next().map_or(Ok(scene), Err)
    }

    /// The scene of a file whose keys have values of the right form, and what is refused of it.
    fn described(document: &Document<'_>) -> Result<(Self, Vec<LabError>), LabError> {
        let (plain, axes) = axes(document, &ROD_KEYS, |text| {
            Ok(document.read::<File>(text)?.case())
        })?;
        let twists = numbers(document, "rod.twist")?.unwrap_or_default();
        let file: File = document.read(&plain)?;
        let poisson_ratio = file.rod.poisson_ratio;
        let scene = file.scene(document, axes, twists)?;
        let faults = check::faults(&scene, poisson_ratio, document);
        Ok((scene, faults))
    }

    /// All that is wrong with a text, as far as it can be seen without a run.
    pub(super) fn faults(text: &str, path: &Path) -> Vec<SceneFault> {
        keys().faults_of_text(text, path, |document| match Self::described(document) {
            Ok((scene, mut faults)) => {
                faults.extend(check::unknown_knots(&scene, document));
                if faults.is_empty() {
                    faults.extend(check::untied(&scene, document));
                    faults.extend(check::unrested(&scene, document));
                }
                faults
            }
            Err(e) => vec![e],
        })
    }

    /// The scene as the text of a file with every value written out; [`parse`](Self::parse) gives the same scene back.
    ///
    /// A file cannot say the folder of the tables, fixed cuts, nor what only presets set: those must be a file's own.
    ///
    /// # Validation
    /// `elastic_scenes_come_back_as_written`, `poisson_ratios_come_back`
    pub fn text(&self) -> String {
        let rod = &self.rod;
        let tied = TiedKeys::of(self);
        let mut file = File {
            rod: RodTable {
                knot: tied.knot,
                link: tied.link,
                braid: tied.braid,
                curve: tied.curve,
                tighten: tied.tighten,
                slenderness: rod.slenderness,
                reading: rod.reading,
                twist: (!self.twists.is_empty()).then(|| Numbers::List(self.twists.clone())),
                poisson_ratio: poisson_ratio_of(rod.twist_ratio),
                stretch_ratio: rod.stretch_ratio,
                contact: rod.contact,
                friction: rod.friction,
                rest: self.rest.as_ref().map(RestKeys::table),
                imperfection: self.imperfection,
                seed: self.seed,
            },
            charge: ChargeTable {
                duration: Some(self.charge.duration),
                breaking: self.charge.breaking,
                twisting: self.charge.twisting.clone(),
            },
            pull: self.pull.clone().map(|pull| PullTable {
                grips: pull.grips,
                duration: pull.duration,
                outputs: pull.outputs,
            }),
            discharge: DischargeTable {
                cuts: Some(self.cuts.clone()),
                until_released: Some(self.discharge.until_released),
                longest: Some(self.discharge.longest),
                closures: Some(self.timeline.closures),
                ends: self.discharge.ends,
                load: self.load,
            },
            si: self.si,
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
