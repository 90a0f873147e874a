//! Scenes whose settings are picked for an accuracy or a budget.

use std::collections::{BTreeMap, HashMap};

use topo_analysis::SweepRow;
use topo_knots::KnotTable;

use super::cost::weight;
use super::keys::EDGES;
use super::scene::ElasticScene;
use crate::cost::threads;
use crate::error::LabError;
use crate::wish::{Grant, Load, Measured, grant};

impl ElasticScene {
    /// The scene with the settings that grant its wish, and which these are; as it is without a wish.
    ///
    /// # Errors
    /// A wish that no measured setting grants, with what can be had, or an unknown knot.
    pub fn granted(
        &self,
        table: &KnotTable,
        jobs: usize,
    ) -> Result<(Self, Option<Grant>), LabError> {
        let Some(wish) = self.wish else {
            return Ok((self.clone(), None));
        };
        let load = Load {
            cases: self.without(EDGES).cases(table)?.len() as f64 * weight(self),
            threads: threads(jobs),
        };
        let grant = grant(Measured::Rod, wish, load).map_err(|reason| LabError::Wish {
            wish: wish.to_string(),
            reason,
        })?;
        let point = &grant.point;
        Ok((self.at(point.resolution, point.tolerance), Some(grant)))
    }

    /// The coarser scene whose difference to the runs `rows` of this one tells their error: the same states and cuts.
    ///
    /// # Errors
    /// As [`cases`](Self::cases).
    pub fn check_of(
        &self,
        table: &KnotTable,
        grant: &Grant,
        rows: &[SweepRow],
    ) -> Result<Self, LabError> {
        let cases = self.cases(table)?;
        let states: HashMap<String, String> = cases
            .iter()
            .map(|c| (self.case_name(c), c.state()))
            .collect();
        let mut cuts: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for row in rows {
            if let Some(state) = states.get(&row.case) {
                cuts.entry(state.clone()).or_default().push(row.cut);
            }
        }
        let point = &grant.point;
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
