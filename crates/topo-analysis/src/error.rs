//! What can go wrong with tables and timelines.

use std::path::PathBuf;

use thiserror::Error;

/// A table cannot be written or read, or a curve has no knot type.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AnalysisError {
    /// A curve has no knot type.
    #[error(transparent)]
    Knot(#[from] topo_knots::KnotError),
    /// A file cannot be written.
    #[error(transparent)]
    File(#[from] topo_core::FileError),
    /// A table cannot be written or read.
    #[error("table {path}: {source}")]
    Table {
        /// The file.
        path: PathBuf,
        /// Where and why.
        source: csv::Error,
    },
}
