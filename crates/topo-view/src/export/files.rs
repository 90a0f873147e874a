//! The files of a case that are read, and those that are made of it.

use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::vtk;
use crate::data;
use crate::error::ViewError;

/// Which files.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// VTK XML.
    pub vtk: bool,
    /// Archives for numpy.
    pub npz: bool,
    /// Fields for nemaktis: micrometres that a correlation length stands for.
    pub nemaktis: Option<f64>,
}

/// The files of an export, noted as they are made.
#[derive(Debug)]
pub struct Files<'a> {
    pub(super) folder: &'a Path,
    pub(super) made: Vec<PathBuf>,
    /// What the user should know.
    pub notes: Vec<String>,
}

impl Files<'_> {
    /// Place of a file, noted.
    pub fn place(&mut self, name: &str) -> PathBuf {
        let path = self.folder.join(name);
        self.made.push(path.clone());
        path
    }

    /// Writes the times of files, if there are any.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn series(&mut self, what: &str, files: &[(f64, String)]) -> Result<(), ViewError> {
        if files.is_empty() {
            return Ok(());
        }
        vtk::series(&self.place(&format!("{what}.pvd")), files)
    }
}

/// Rows of a table of the case.
pub(super) fn table<T: DeserializeOwned>(case: &Path, name: &str) -> Result<Vec<T>, ViewError> {
    data::read_csv(&case.join(name)).map_err(|e| as_damage(case, name, e))
}

/// What to say of a case whose table cannot be read.
pub(super) fn as_damage(case: &Path, name: &str, error: ViewError) -> ViewError {
    match error {
        ViewError::Missing { .. } => damaged(case, name, "not found"),
        ViewError::Table { reason, .. } => damaged(case, name, &reason),
        other => other,
    }
}

pub(super) fn damaged(case: &Path, name: &str, reason: &str) -> ViewError {
    refusal(
        &case.join(name),
        &format!("{reason}; the case is damaged: run its scene again, which computes it again"),
    )
}

pub(crate) fn refusal(path: &Path, reason: &str) -> ViewError {
    ViewError::Case {
        path: path.to_owned(),
        reason: reason.to_owned(),
    }
}
