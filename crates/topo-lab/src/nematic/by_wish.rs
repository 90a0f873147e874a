//! Scenes whose settings are picked for an accuracy or a budget.

use super::cost::weight;
use super::keys::SPACING;
use super::scene::{NematicScene, fit};
use crate::cost::threads;
use crate::error::LabError;
use crate::wish::{Grant, Load, Measured, grant};

impl NematicScene {
    /// The scene with the settings that grant its wish, and which these are; as it is without a wish.
    ///
    /// # Errors
    /// A wish that no measured setting grants, with what can be had, or parameters that make no sense.
    pub fn granted(&self, jobs: usize) -> Result<(Self, Option<Grant>), LabError> {
        let Some(wish) = self.wish else {
            return Ok((self.clone(), None));
        };
        let load = Load {
            cases: weight(&self.without(SPACING))?,
            threads: threads(jobs),
        };
        let grant = grant(Measured::Nematic, wish, load).map_err(|reason| LabError::Wish {
            wish: wish.to_string(),
            reason,
        })?;
        let point = &grant.point;
        Ok((self.at(point.resolution, point.tolerance), Some(grant)))
    }

    /// The coarser scene whose difference to a granted one tells its error.
    pub fn check_of(&self, grant: &Grant) -> Self {
        let point = &grant.point;
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
