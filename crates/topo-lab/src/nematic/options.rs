//! What a command line says above a nematic scene.

use super::scene::NematicScene;
use crate::LabError;
use crate::battery::{Options, Scene, Sweep};

impl Scene for NematicScene {
    fn change(&mut self, options: &Options<'_>) -> Result<(), LabError> {
        options.no_knots("a colloid has no knot; leave it out")?;
        options.no_cuts("a nematic scene has nothing to cut; leave it out")?;
        self.goal = options.goal.or(self.goal);
        Ok(())
    }

    fn experiment(self: Box<Self>) -> Result<Box<dyn Sweep>, LabError> {
        Ok(self)
    }
}
