//! An elastic experiment and the cases it stands for.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Serialize;
use topo_knots::TightenSettings;
use topo_rod::{Accuracy, ChargeSettings, DischargeSettings, RodParameters};

use super::choices::{Cuts, Numbers, Preset};
use super::cost::weight;
use super::file::defaults;
use crate::AnalysisError;
use crate::table::SweepRow;
use crate::timeline::TimelineSettings;
use crate::wish::{Grant, Load, Measured, Wish, grant};

/// An elastic experiment: which knots, how twisted, how cut, how accurately.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ElasticScene {
    /// Folder of its tables below the output folder.
    pub folder: String,
    /// Knot names; "all" stands for the fourteen prime knots of up to seven crossings.
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
    /// What was asked for instead of settings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wish: Option<Wish>,
    /// Places of the cuts by [`ElasticCase::state`], instead of `cuts`: those of another run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fixed_cuts: Option<BTreeMap<String, Vec<f64>>>,
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

    /// The charged state, whatever the resolution.
    pub fn state(&self) -> String {
        state(&self.knot, self.rod.twist.unwrap_or(0.0))
    }
}

fn state(knot: &str, twist: f64) -> String {
    format!("{knot} {twist}")
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
            accuracy: preset.accuracy(),
            preset,
            tighten: preset.tighten(),
            wish: None,
            fixed_cuts: None,
        }
    }

    /// The cases of the scene, knots in the order given, twists inside.
    pub fn cases(&self, table: &topo_knots::KnotTable) -> Result<Vec<ElasticCase>, AnalysisError> {
        let mut names = Vec::new();
        for name in &self.knots {
            if name == "all" {
                names.extend(table.primes_up_to(7).map(|knot| knot.name.clone()));
            } else {
                names.push(table.get(name)?.name.clone());
            }
        }
        let twists: Vec<Option<f64>> = if self.twists.is_empty() {
            vec![None]
        } else {
            self.twists.iter().copied().map(Some).collect()
        };
        Ok(names
            .iter()
            .flat_map(|knot| twists.iter().map(move |t| self.case(knot, *t)))
            .collect())
    }

    /// The case of one knot at one twist; without a twist, none is modelled.
    pub(crate) fn case(&self, knot: &str, twist: Option<f64>) -> ElasticCase {
        ElasticCase {
            knot: knot.to_owned(),
            rod: RodParameters {
                twist,
                ..self.rod.clone()
            },
        }
    }

    /// The scene with the settings that grant its wish, and which these are; as it is without a wish.
    ///
    /// # Errors
    /// A wish that no measured setting grants, with what can be had, or an unknown knot.
    pub fn granted(
        &self,
        table: &topo_knots::KnotTable,
        jobs: usize,
    ) -> Result<(Self, Option<Grant>), AnalysisError> {
        let Some(wish) = self.wish else {
            return Ok((self.clone(), None));
        };
        let load = Load {
            cases: self.cases(table)?.len() as f64 * weight(self),
            threads: crate::cost::threads(jobs),
        };
        let grant = grant(Measured::Rod, wish, load).map_err(|reason| AnalysisError::Wish {
            wish: wish.to_string(),
            reason,
        })?;
        let point = &grant.point;
        Ok((self.at(point.resolution, point.tolerance), Some(grant)))
    }

    /// The coarser scene whose difference to the runs `rows` tells their error: the same states and cuts.
    pub fn check_of(&self, grant: &Grant, rows: &[SweepRow]) -> Self {
        let mut cuts: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for row in rows {
            let at = cuts.entry(state(&row.knot, row.twist)).or_default();
            at.push(row.cut);
        }
        let point = &grant.point;
        Self {
            folder: format!("{}-check", self.folder),
            fixed_cuts: Some(cuts),
            ..self.at(point.check_resolution, point.check_tolerance)
        }
    }

    fn at(&self, edges: f64, tolerance: f64) -> Self {
        let mut scene = self.clone();
        scene.rod.n_edges = edges as usize;
        scene.accuracy.tolerance = tolerance;
        scene
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
        let cases = ElasticScene::published(Preset::Draft)
            .cases(&topo_knots::KnotTable::builtin())
            .unwrap();
        assert_eq!(cases.len(), 238);
        assert_eq!(cases[8].name(), "3_1_twist+0.00_shrunk_n200");
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
