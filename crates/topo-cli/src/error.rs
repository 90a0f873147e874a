//! What can go wrong in a command, with its exit code.

use std::path::PathBuf;
use thiserror::Error;
use topo_view::ViewError;

/// Failure of a command.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CliError {
    /// A file could not be read or written.
    #[error("{}: {source}; check that the folder exists, is writable and the disk is not full", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
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
    /// A picture, a page or an export cannot be made.
    #[error(transparent)]
    View(#[from] ViewError),
    /// A scene, a case or a sweep was refused.
    #[error(transparent)]
    Lab(#[from] topo_lab::LabError),
    /// A table cannot be read or written.
    #[error(transparent)]
    Analysis(#[from] topo_analysis::AnalysisError),
    /// A knot or a curve was refused.
    #[error(transparent)]
    Knot(#[from] topo_knots::KnotError),
    /// What was asked for is not possible; the text says why.
    #[error("{0}")]
    Input(String),
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

impl CliError {
    /// Exit code of the process: 1 if a case or a step failed, 2 for what the user can mend, 130 after Ctrl-C.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Interrupted | Self::View(ViewError::Interrupted) => 130,
            Self::View(ViewError::Drawing { .. }) | Self::Step(_) | Self::Failed { .. } => 1,
            _ => 2,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_pictures_have_exit_codes() {
        let path = PathBuf::from("sweep.csv");
        let reason = "line: 2".to_owned();
        for (error, code) in [
            (
                ViewError::Case {
                    path: path.clone(),
                    reason: reason.clone(),
                },
                2,
            ),
            (
                ViewError::Argument {
                    key: "--only",
                    value: reason.clone(),
                    remedy: reason.clone(),
                },
                2,
            ),
            (ViewError::Table { path, reason }, 2),
            (
                ViewError::Drawing {
                    reason: String::new(),
                },
                1,
            ),
            (ViewError::Interrupted, 130),
        ] {
            assert_eq!(CliError::from(error).exit_code(), code);
        }
    }
}
