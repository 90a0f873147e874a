//! What can go wrong between a scene and its tables.

use std::path::{Path, PathBuf};

use thiserror::Error;
use topo_knots::KnotError;

use crate::scene::{Document, SceneFault, read_text};

/// A scene, a case or a table cannot be made as asked; the message says what, where, and what would be right.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LabError {
    /// A scene file cannot be read.
    #[error("cannot read the scene {path}: {source}")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A scene is no TOML, has an unknown key or a value that cannot be.
    #[error("{0}")]
    Scene(Box<SceneFault>),
    /// The name of a scene's file names no folder for its results.
    #[error("{}: {reason}: rename the file, its results go to a folder of its name", .path.display())]
    SceneName {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// No measured setting meets what a scene asks for.
    #[error("{goal} is not possible: {reason}")]
    Goal {
        /// What was asked for.
        goal: String,
        /// What is possible.
        reason: String,
    },
    /// An option of the command line does not apply to a scene, or has a value that cannot be.
    #[error("{option} = {value}: {remedy}")]
    Option {
        /// The option.
        option: &'static str,
        /// Its value.
        value: String,
        /// What to do instead.
        remedy: String,
    },
    /// A case of any battery is refused; the others go on.
    #[error("{case}: {source}")]
    Case {
        /// Which case.
        case: String,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The rod refuses its parameters.
    #[error("{case}: {source}")]
    Rod {
        /// Which case, or the scene's file.
        case: String,
        /// Why.
        source: topo_rod::RodError,
    },
    /// The nematic refuses its parameters.
    #[error("{case}: {source}")]
    Nematic {
        /// Which case.
        case: String,
        /// Why.
        source: topo_nematic::NematicError,
    },
    /// A knot is unknown, or its shape cannot be found.
    #[error(transparent)]
    Knot(#[from] topo_knots::KnotError),
    /// A quantity of the caller's own cannot be a column.
    #[error("observable {name}: {reason}")]
    Observable {
        /// Its name.
        name: String,
        /// Why, or what would be right.
        reason: String,
    },
    /// A knot has no start shape.
    #[error("{knot} has no tight shape: {reason}")]
    Shape {
        /// The knot.
        knot: String,
        /// Why.
        reason: String,
    },
    /// A file cannot be written or read.
    #[error(transparent)]
    File(#[from] topo_core::FileError),
    /// A table cannot be written or read, or a curve has no knot type.
    #[error(transparent)]
    Analysis(#[from] topo_analysis::AnalysisError),
    /// The output folder cannot be used.
    #[error(
        "cannot write to the output folder {path}: {source}; choose another with --out or give permission"
    )]
    Output {
        /// The folder.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A folder holds the results of another scene.
    #[error(
        "{folder} holds the results of another scene: {why}; name another folder with --out, or delete this one"
    )]
    OtherScene {
        /// The folder.
        folder: PathBuf,
        /// What differs.
        why: String,
    },
    /// The threads cannot be started.
    #[error("cannot start {jobs} jobs: {reason}")]
    Jobs {
        /// How many were asked for.
        jobs: usize,
        /// Why.
        reason: String,
    },
}

impl From<SceneFault> for LabError {
    fn from(fault: SceneFault) -> Self {
        Self::Scene(Box::new(fault))
    }
}

impl LabError {
    /// The error as a fault of a scene's file.
    pub fn into_fault(self, path: &Path) -> SceneFault {
        match self {
            Self::Scene(fault) => *fault,
            other => SceneFault::of_file(path, "the scene", other.to_string()),
        }
    }

    /// The error with its place in a scene's file, if it is about a knot that the file names.
    pub fn in_file(self, path: &Path) -> Self {
        let Ok(text) = read_text(path) else {
            return self;
        };
        match Document::new(&text, path) {
            Ok(document) => self.placed(&document),
            Err(_) => self,
        }
    }

    /// The error with its place in a scene, if it names a key or a knot and has none.
    pub(crate) fn placed(self, document: &Document<'_>) -> Self {
        match &self {
            Self::Scene(fault) if fault.line.is_none() && !fault.key.is_empty() => {
                document.wrong(&fault.key, &fault.found, fault.expected.clone())
            }
            Self::Knot(KnotError::UnknownKnot { name, .. }) if document.has("rod.knot") => {
                document.wrong("rod.knot", format!("\"{name}\""), self.to_string())
            }
            _ => self,
        }
    }

    /// Whether a case is refused for what it is, so that others can go on.
    pub(crate) fn is_of_one_case(&self) -> bool {
        match self {
            Self::Case { .. } | Self::Knot(_) | Self::Shape { .. } => true,
            Self::Analysis(source) => matches!(source, topo_analysis::AnalysisError::Knot(_)),
            Self::Rod { .. } | Self::Nematic { .. } => self.file().is_none(),
            _ => false,
        }
    }

    /// Whether a checkpoint that cannot be used is the reason.
    pub(crate) fn is_unusable_checkpoint(&self) -> bool {
        self.file()
            .is_some_and(topo_core::FileError::is_unusable_checkpoint)
    }

    /// What was wrong with a file of a battery.
    fn file(&self) -> Option<&topo_core::FileError> {
        match self {
            Self::Nematic {
                source: topo_nematic::NematicError::File(error),
                ..
            }
            | Self::Rod {
                source: topo_rod::RodError::File(error),
                ..
            } => Some(error),
            _ => None,
        }
    }
}
