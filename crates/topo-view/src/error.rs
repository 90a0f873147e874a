//! What can go wrong with a picture, a page or an export.

use std::path::PathBuf;

use thiserror::Error;
use topo_core::Interrupt;

use crate::program::program;

/// Something cannot be drawn or exported.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// A results file is missing.
    #[error("{}: not found; run `{} figures` to compute it, or name the folder by --out", path.display(), program())]
    Missing {
        /// The file.
        path: PathBuf,
    },
    /// A file could not be read or written.
    #[error("{}: {source}; check that the folder exists, is writable and the disk is not full", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A table has a row that does not fit its header.
    #[error("{}: {reason}; delete the file and run `{} figures` again", path.display(), program())]
    Table {
        /// The file.
        path: PathBuf,
        /// Which row or column.
        reason: String,
    },
    /// A choice names nothing that there is.
    #[error("{key} = {value}: {remedy}")]
    Argument {
        /// The option.
        key: &'static str,
        /// Its value.
        value: String,
        /// What to give instead.
        remedy: String,
    },
    /// A case has no such files, or they do not fit each other.
    #[error("{}: {reason}", path.display())]
    Case {
        /// The file or the case's folder.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A picture could not be drawn.
    #[error("drawing failed: {reason}")]
    Drawing {
        /// Why.
        reason: String,
    },
    /// A scene behind a picture was refused.
    #[error(transparent)]
    Lab(#[from] topo_lab::LabError),
    /// A table was refused.
    #[error(transparent)]
    Analysis(#[from] topo_analysis::AnalysisError),
    /// It was asked to stop.
    #[error("interrupted; finished cases are kept, the same command goes on from them")]
    Interrupted,
}

/// An error once a stop was asked for.
pub(crate) fn check(interrupt: &Interrupt) -> Result<(), ViewError> {
    if interrupt.is_requested() {
        Err(ViewError::Interrupted)
    } else {
        Ok(())
    }
}
