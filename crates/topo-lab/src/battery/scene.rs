//! A scene as its file has it.

use std::fmt::Debug;

use super::{Options, Sweep};
use crate::LabError;

/// What a scene file describes, whatever its battery.
pub trait Scene: Debug {
    /// Changes what the command line says above the file; refuses what does not apply to the battery, which is everything where
    /// this is left out.
    ///
    /// # Errors
    /// The option and what would be right: see [`Options::nothing`] and its neighbours.
    fn change(&mut self, options: &Options<'_>) -> Result<(), LabError> {
        options.nothing()
    }

    /// What is run of it: mostly [`Experiment`](crate::Experiment) in a box. What the scene names beside its file is read here.
    ///
    /// # Errors
    /// What the scene names and cannot be read.
    fn experiment(self: Box<Self>) -> Result<Box<dyn Sweep>, LabError>;
}
