//! What a command line says above an elastic scene.

use super::choices::Cuts;
use super::scene::{ElasticScene, OwnKnots};
use super::sweep::Rods;
use crate::LabError;
use crate::battery::{Options, Scene, Sweep, refused};

impl Scene for ElasticScene {
    fn change(&mut self, options: &Options<'_>) -> Result<(), LabError> {
        options.no_fields("a fibre has no field to keep; leave it out")?;
        self.goal = options.goal.or(self.goal);
        if let Some(folder) = options.knots {
            self.own_knots = Some(OwnKnots::at(folder));
        }
        if let Some(text) = options.cuts {
            let cuts = Cuts::try_from(text.to_owned());
            let changed = cuts.and_then(|cuts| self.clone().with_cuts(cuts));
            *self = changed.map_err(|remedy| refused("--cuts", text, &remedy))?;
        }
        Ok(())
    }

    fn experiment(self: Box<Self>) -> Result<Box<dyn Sweep>, LabError> {
        let table = self.knot_table()?;
        Ok(Box::new(Rods::owned(*self, table)))
    }
}
