//! An elastic experiment and the cases it stands for.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::Serialize;
use topo_knots::{KnotTable, TightenSettings};
use topo_rod::energy::EnergyTerm;
use topo_rod::{
    Accuracy, ChargeSettings, DischargeSettings, EndLoad, PullSettings, RodParameters, RodSample,
    RodState,
};

use super::case::ElasticCase;
use super::choices::Cuts;
use super::defaults;
use super::keys::{EDGES, ROD_KEYS};
use super::observable::Observable;
use super::own_term::OwnTerm;
use super::rest::RestKeys;
use super::si::Si;
use super::tie::Tie;
use super::tied::Tied;
use crate::LabError;
use crate::goal::Goal;
use crate::preset::Preset;
use crate::scene::{Axis, Numbers, SceneFault, product};
use topo_analysis::TimelineSettings;

/// An elastic experiment: which knots, how twisted, how cut, how accurately.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ElasticScene {
    /// Folder of its tables below the output folder.
    pub folder: String,
    /// Knot names; "all" stands for the fourteen prime knots of up to seven crossings.
    pub knots: Vec<String>,
    /// What is tied instead of the tight shapes of these knots.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tie: Option<Tie>,
    /// θ'h of the cases; empty: no twist is modelled.
    pub twists: Vec<f64>,
    /// Material, reading and resolution, its twist not yet set.
    pub rod: RodParameters,
    /// Natural shape of the fibres, if it is not straight and untwisted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rest: Option<RestKeys>,
    /// Size of the random perturbation of the start curve, in h: symmetric states that are unstable are left by it.
    pub imperfection: f64,
    /// Seed of that perturbation and of the closures.
    pub seed: u64,
    /// Relaxation of the closed rod.
    pub charge: ChargeSettings,
    /// Pulling of an open fibre, instead of the charge of a closed one and its cuts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pull: Option<PullSettings>,
    /// Sites cut.
    pub cuts: Cuts,
    /// Discharge of the open rod.
    pub discharge: DischargeSettings,
    /// What takes up the work of the discharge of a case that has no other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<EndLoad>,
    /// Knot types while open.
    pub timeline: TimelineSettings,
    /// Integrator and tolerance.
    pub accuracy: Accuracy,
    /// Keys with several values: the cases are their product, the last axis running fastest.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub axes: Vec<Axis>,
    /// What the fibre is in SI units; no number of a case depends on it.
    #[serde(skip)]
    pub si: Option<Si>,
    /// Folder of knots besides the built-in ones.
    #[serde(skip)]
    pub own_knots: Option<OwnKnots>,
    /// Preset that the numbers started from.
    pub preset: Preset,
    /// How the start shapes are tightened.
    pub tighten: TightenSettings,
    /// What was asked for instead of settings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal: Option<Goal>,
    /// Places of the cuts by [`ElasticCase::state`], instead of `cuts`: those of another run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fixed_cuts: Option<BTreeMap<String, Vec<f64>>>,
    /// Energy terms of the caller's own, which no file can say.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub own_terms: Vec<OwnTerm>,
    /// Quantities of the caller's own, which no file can say.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub observables: Vec<Observable>,
}

/// A folder of knot files that a scene names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnKnots {
    /// As the scene has it, relative to the scene's file.
    pub(super) written: String,
    /// Where the scene's file lies.
    pub(super) beside: PathBuf,
}

impl OwnKnots {
    /// A folder as a command line names it.
    pub fn at(folder: &Path) -> Self {
        Self {
            written: folder.display().to_string(),
            beside: PathBuf::new(),
        }
    }

    /// Where the folder is.
    pub fn path(&self) -> PathBuf {
        self.beside.join(&self.written)
    }
}

/// Why a fibre that breaks by itself has no cuts.
pub(super) const BREAKS: &str =
    "the fibre breaks by itself, as the table [charge.break] says: leave out one of the two";

impl ElasticCase {
    /// The charged state, whatever the resolution: knot, twist, and what is not as published.
    pub fn state(&self) -> String {
        let mut name = format!("{} {}", self.knot, self.rod.twist.unwrap_or(0.0));
        if let Some(tied) = &self.tied {
            name = format!("{name} {}", tied.word);
        }
        if let Some(rest) = &self.rest {
            name.push_str(&format!(" rest={}", rest.said()));
        }
        let published = ElasticScene::published(Preset::default()).case(&self.knot, None);
        for key in ROD_KEYS.iter().filter(|key| key.key != EDGES) {
            match key.read(self) {
                Some(value) if key.read(&published).as_ref() != Some(&value) => {
                    name.push_str(&format!(" {}={value}", key.key));
                }
                _ => {}
            }
        }
        name
    }
}

impl ElasticScene {
    /// The published sweep: 14 knots at 17 twists.
    pub fn published(preset: Preset) -> Self {
        Self {
            folder: "elastic".to_owned(),
            knots: vec!["all".to_owned()],
            tie: None,
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
            rest: None,
            imperfection: defaults::imperfection(),
            seed: defaults::seed(),
            charge: ChargeSettings::default(),
            pull: None,
            cuts: preset.cuts(),
            discharge: DischargeSettings::default(),
            load: None,
            timeline: TimelineSettings::default(),
            accuracy: preset.accuracy(),
            axes: Vec::new(),
            si: None,
            own_knots: None,
            preset,
            tighten: preset.tighten(),
            goal: None,
            fixed_cuts: None,
            own_terms: Vec::new(),
            observables: Vec::new(),
        }
    }

    /// The built-in knots with those of the folder that the scene names.
    ///
    /// # Errors
    /// A folder that cannot be read, or a file in it that is no knot.
    pub fn knot_table(&self) -> Result<KnotTable, LabError> {
        let folder = self.own_knots.as_ref().map(OwnKnots::path);
        Ok(KnotTable::builtin_and(folder.as_deref())?)
    }

    /// The cases of the scene: knots in the order given, twists inside, the values of the [axes](Self::axes) innermost.
    ///
    /// # Errors
    /// An unknown knot, or one that is there twice, be it by an alias or besides \"all\"; curves that cannot be read or leave no room
    /// for the fibre; a natural shape that cannot be read.
    pub fn cases(&self, table: &KnotTable) -> Result<Vec<ElasticCase>, LabError> {
        let mut names: Vec<String> = Vec::new();
        let mut seen = HashSet::new();
        for name in &self.knots {
            let meant = if name == "all" {
                let primes = table.primes_up_to(7);
                primes.map(|knot| knot.name.clone()).collect()
            } else {
                vec![table.get(name)?.name.clone()]
            };
            if let Some(twice) = meant.iter().find(|knot| !seen.insert((*knot).clone())) {
                let remedy = format!("{twice} is there already: name each knot once");
                let fault = SceneFault::of_file(Path::new(&self.folder), name, remedy);
                return Err(fault.key("rod.knot").into());
            }
            names.extend(meant);
        }
        let twists: Vec<Option<f64>> = if self.twists.is_empty() {
            vec![None]
        } else {
            self.twists.iter().copied().map(Some).collect()
        };
        let rest = self.rest.as_ref().map(RestKeys::made).transpose()?;
        let of = |knot: &str, tied: Option<&Arc<Tied>>| -> Vec<ElasticCase> {
            let case = |t: &Option<f64>| ElasticCase {
                tied: tied.cloned(),
                rest: rest.cloned(),
                ..self.case(knot, *t)
            };
            let twisted = twists.iter().map(case);
            twisted
                .flat_map(|case| product(&ROD_KEYS, &self.axes, case))
                .collect()
        };
        let Some(tie) = &self.tie else {
            return Ok(names.iter().flat_map(|knot| of(knot, None)).collect());
        };
        let made = tie.made(&names, table)?.iter();
        let cases: Vec<_> = made.flat_map(|tied| of(&tied.name, Some(tied))).collect();
        self.check_room(&cases)?;
        Ok(cases)
    }

    /// Knots of the cases, each once.
    ///
    /// # Errors
    /// As [`cases`](Self::cases).
    pub fn knots_used(&self, table: &KnotTable) -> Result<Vec<String>, LabError> {
        let mut names: Vec<String> = self.cases(table)?.into_iter().map(|c| c.knot).collect();
        names.dedup();
        Ok(names)
    }

    /// The case of one knot at one twist; without a twist, none is modelled.
    pub(crate) fn case(&self, knot: &str, twist: Option<f64>) -> ElasticCase {
        ElasticCase {
            knot: knot.to_owned(),
            tied: None,
            rod: RodParameters {
                twist,
                ..self.rod.clone()
            },
            rest: None,
            load: self.load,
            imperfection: self.imperfection,
            seed: self.seed,
        }
    }

    /// The scene with other cuts.
    ///
    /// # Errors
    /// Cuts that fall on one vertex of a rod, or cuts of a fibre that breaks by itself, and what would be right.
    pub fn with_cuts(mut self, cuts: Cuts) -> Result<Self, String> {
        if self.charge.breaking.is_some() {
            return Err(BREAKS.to_owned());
        }
        for case in product(&ROD_KEYS, &self.axes, self.case("", None)) {
            cuts.clash(case.rod.n_edges).map_or(Ok(()), Err)?;
        }
        self.cuts = cuts;
        Ok(self)
    }

    /// The scene with one more energy term, of the caller's own, in all its cases; see [`RodBattery::with`](topo_rod::RodBattery::with).
    ///
    /// `label` is a word for the term and all its numbers, such as `trap0.01`: it tells cases, their folders and their identity apart,
    /// so that a term with other numbers needs another label.
    ///
    /// # Validation
    /// `law_a_term_from_outside_is_found_everywhere`
    #[must_use]
    pub fn with_term(
        mut self,
        label: &str,
        make: impl Fn(&RodState) -> Box<dyn EnergyTerm> + Send + Sync + 'static,
    ) -> Self {
        self.own_terms.push(OwnTerm::new(label, make));
        self
    }

    /// The scene with a quantity of the caller's own, measured at every output time: a column `name` in `charge.csv` and `series.csv`, and
    /// in `sweep.csv` that of the charged rod.
    ///
    /// The name tells finished cases apart: a quantity that is measured otherwise needs another one.
    ///
    /// # Errors
    /// A name that is no column's, that a column of the tables has, or that is there twice.
    ///
    /// # Validation
    /// `law_an_observable_from_outside_is_found_in_every_table`
    pub fn with_observable(
        mut self,
        name: &str,
        measure: impl Fn(&RodSample) -> f64 + Send + Sync + 'static,
    ) -> Result<Self, LabError> {
        let observable = Observable::new(name, measure)?;
        if self.observables.contains(&observable) {
            return Err(LabError::Observable {
                name: name.to_owned(),
                reason: "it is there already".to_owned(),
            });
        }
        self.observables.push(observable);
        Ok(self)
    }

    /// Where files with the scene's tables lie below an output folder.
    pub fn results(&self, out: &Path) -> PathBuf {
        out.join(&self.folder)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_sweep_has_238_cases() {
        let scene = ElasticScene::published(Preset::Draft);
        let cases = scene.cases(&topo_knots::KnotTable::builtin()).unwrap();
        assert_eq!(cases.len(), 238);
        assert_eq!(scene.case_name(&cases[8]), "3_1_twist+0.00_shrunk_n200");
        // 14 knots at θ'h = −2, −1.75, ..., 2, of the published material
        let twists = cases.iter().map(|case| case.rod.twist.unwrap());
        let quarters = (0..238).map(|k| f64::from(k % 17 - 8) / 4.0);
        assert!(twists.eq(quarters));
        let published = |case: &ElasticCase| RodParameters {
            twist: case.rod.twist,
            ..RodParameters::default()
        };
        assert!(cases.iter().all(|case| case.rod == published(case)));
    }
}
