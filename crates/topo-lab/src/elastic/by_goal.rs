//! Scenes whose settings are picked for an accuracy or a budget.

use std::collections::{BTreeMap, HashMap};

use topo_analysis::SweepRow;
use topo_knots::KnotTable;

use super::breaking::is_broken;
use super::cost::weight;
use super::keys::EDGES;
use super::scene::ElasticScene;
use crate::cost::threads;
use crate::error::LabError;
use crate::goal::{Choice, Load, Measured, choose};

impl ElasticScene {
    /// The scene with the settings that meets its goal, and which these are; as it is without a goal.
    ///
    /// # Errors
    /// A goal that no measured setting meets, with what is possible, or an unknown knot.
    pub fn with_chosen_settings(
        &self,
        table: &KnotTable,
        jobs: usize,
    ) -> Result<(Self, Option<Choice>), LabError> {
        let Some(goal) = self.goal else {
            return Ok((self.clone(), None));
        };
        let load = Load {
            cases: self.without(EDGES).cases(table)?.len() as f64 * weight(self),
            threads: threads(jobs),
        };
        let choice = choose(Measured::Rod, goal, load).map_err(|reason| LabError::Goal {
            goal: goal.to_string(),
            reason,
        })?;
        let point = &choice.point;
        Ok((self.at(point.resolution, point.tolerance), Some(choice)))
    }

    /// The coarser scene whose difference to the runs `rows` of this one tells their error: the same states and cuts.
    ///
    /// # Errors
    /// As [`cases`](Self::cases).
    pub fn check_of(
        &self,
        table: &KnotTable,
        choice: &Choice,
        rows: &[SweepRow],
    ) -> Result<Self, LabError> {
        let cases = self.cases(table)?;
        let states: HashMap<String, String> = cases
            .iter()
            .map(|c| (self.case_name(c), c.state()))
            .collect();
        let mut cuts: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for row in rows {
            // what did not break by itself was not cut
            let is_cut = self.charge.breaking.is_none() || is_broken(row);
            if let Some(state) = states.get(&row.case).filter(|_| is_cut) {
                cuts.entry(state.clone()).or_default().push(row.cut);
            }
        }
        let point = &choice.point;
        Ok(Self {
            folder: format!("{}-check", self.folder),
            fixed_cuts: Some(cuts),
            ..self.at(point.check_resolution, point.check_tolerance)
        })
    }

    fn at(&self, edges: f64, tolerance: f64) -> Self {
        let mut scene = self.without(EDGES);
        scene.rod.n_edges = edges as usize;
        scene.accuracy.tolerance = tolerance;
        scene
    }

    /// The scene with one value of a key that may have several.
    fn without(&self, key: &str) -> Self {
        let mut scene = self.clone();
        scene.axes.retain(|axis| axis.key() != key);
        scene
    }
}
