//! What can go wrong in a command, with its exit code.

use std::path::PathBuf;
use thiserror::Error;

/// Failure of a command.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum XtaskError {
    /// A results file is missing.
    #[error("{}: not found; {remedy}", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// What to do.
        remedy: &'static str,
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
    #[error("{}: {reason}; delete the file and run `cargo xtask figures` again", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// Which row or column.
        reason: String,
    },
    /// An argument has a value that cannot be used.
    #[error("{key} = {value}: {remedy}")]
    Argument {
        /// The option.
        key: &'static str,
        /// Its value.
        value: String,
        /// What to give instead.
        remedy: String,
    },
    /// The user's input was refused by the simulation.
    #[error("{0}")]
    Input(String),
    /// A picture could not be drawn.
    #[error("drawing failed: {reason}")]
    Drawing {
        /// Why.
        reason: String,
    },
    /// A tool that a command runs failed.
    #[error("{0}")]
    Step(String),
    /// Cases of a sweep failed; the others are done.
    #[error("{n} of the cases failed: {}", path.display())]
    Failed {
        /// How many.
        n: usize,
        /// Table that says which and why.
        path: PathBuf,
    },
    /// Ctrl-C.
    #[error("interrupted; finished cases are kept, the same command goes on from them")]
    Interrupted,
}

impl XtaskError {
    /// Exit code of the process: 1 if a case or a step failed, 2 for what the user can mend, 130 after Ctrl-C.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Interrupted => 130,
            Self::Drawing { .. } | Self::Step(_) | Self::Failed { .. } => 1,
            _ => 2,
        }
    }
}
