//! Scenes whose settings are picked for an accuracy or a budget.

use super::cost::weight;
use super::keys::SPACING;
use super::scene::{NematicScene, fit};
use crate::cost::threads;
use crate::error::LabError;
use crate::goal::{Choice, Load, Measured, choose};

impl NematicScene {
    /// The scene with the settings that meets its goal, and which these are; as it is without a goal.
    ///
    /// # Errors
    /// A goal that no measured setting meets, with what is possible, or parameters that make no sense.
    pub fn with_chosen_settings(&self, jobs: usize) -> Result<(Self, Option<Choice>), LabError> {
        let Some(goal) = self.goal else {
            return Ok((self.clone(), None));
        };
        let load = Load {
            cases: weight(&self.without(SPACING))?,
            threads: threads(jobs),
        };
        let choice = choose(Measured::Nematic, goal, load).map_err(|reason| LabError::Goal {
            goal: goal.to_string(),
            reason,
        })?;
        let point = &choice.point;
        Ok((self.at(point.resolution, point.tolerance), Some(choice)))
    }

    /// The coarser scene whose difference to a chosen one tells its error.
    pub fn check_of(&self, choice: &Choice) -> Self {
        let point = &choice.point;
        Self {
            folder: format!("{}-check", self.folder),
            ..self.at(point.check_resolution, point.check_tolerance)
        }
    }

    fn at(&self, spacing: f64, tolerance: f64) -> Self {
        let mut scene = self.without(SPACING);
        if scene.axes.is_empty() {
            fit(&mut scene.nematic, spacing);
        } else {
            scene.fitted = Some(spacing);
        }
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
