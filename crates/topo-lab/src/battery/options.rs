//! What a command line says above a scene.

use std::path::Path;

use crate::LabError;
use crate::goal::Goal;

/// What a command line says above a scene; a battery takes some of it and refuses the rest.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options<'a> {
    /// Where to cut.
    pub cuts: Option<&'a str>,
    /// Folder with knots of the user's own.
    pub knots: Option<&'a Path>,
    /// Keep whole fields at each time looked at: [`SweepSettings::keep_fields`](crate::SweepSettings::keep_fields).
    pub fields: bool,
    /// An accuracy or a budget instead of settings.
    pub goal: Option<Goal>,
}

/// What an option that has no value is called to have.
const GIVEN: &str = "given";

impl Options<'_> {
    /// Refuses all of them.
    ///
    /// # Errors
    /// An option that is given.
    pub fn nothing(&self) -> Result<(), LabError> {
        let remedy = "it means nothing to this battery; leave it out";
        self.no_fields(remedy)?;
        self.no_knots(remedy)?;
        self.no_cuts(remedy)?;
        self.no_goal(remedy)
    }

    /// Refuses `--cuts`; `remedy` says why and what to do.
    ///
    /// # Errors
    /// If it is given.
    pub fn no_cuts(&self, remedy: &str) -> Result<(), LabError> {
        let refused = |text: &str| refused("--cuts", text, remedy);
        self.cuts.map_or(Ok(()), |text| Err(refused(text)))
    }

    /// Refuses `--knots`.
    ///
    /// # Errors
    /// If it is given.
    pub fn no_knots(&self, remedy: &str) -> Result<(), LabError> {
        let refused = |_| Err(refused("--knots", GIVEN, remedy));
        self.knots.map_or(Ok(()), refused)
    }

    /// Refuses `--fields`.
    ///
    /// # Errors
    /// If it is given.
    pub fn no_fields(&self, remedy: &str) -> Result<(), LabError> {
        match self.fields {
            true => Err(refused("--fields", GIVEN, remedy)),
            false => Ok(()),
        }
    }

    /// Refuses `--accuracy` and `--budget`.
    ///
    /// # Errors
    /// If one is given.
    pub fn no_goal(&self, remedy: &str) -> Result<(), LabError> {
        match self.goal {
            Some(Goal::Accuracy(error)) => Err(refused("--accuracy", &error.to_string(), remedy)),
            Some(goal @ Goal::Budget(_)) => Err(refused("--budget", &goal.to_string(), remedy)),
            None => Ok(()),
        }
    }
}

/// The error for an option that cannot be.
pub(crate) fn refused(option: &'static str, value: &str, remedy: &str) -> LabError {
    LabError::Option {
        option,
        value: value.to_owned(),
        remedy: remedy.to_owned(),
    }
}
