//! Folders of results: whether they can be written, and which case they hold.

use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::AnalysisError;

/// Makes a folder and those above it.
pub(crate) fn make_folder(folder: &Path) -> Result<(), AnalysisError> {
    std::fs::create_dir_all(folder).map_err(|source| AnalysisError::Output {
        path: folder.to_owned(),
        source,
    })
}

/// Makes sure that a folder can be written to.
///
/// # Errors
/// The folder and what to do.
pub fn writable(folder: &Path) -> Result<(), AnalysisError> {
    let wrong = |source| AnalysisError::Output {
        path: folder.to_owned(),
        source,
    };
    make_folder(folder)?;
    tempfile::tempfile_in(folder).map(drop).map_err(wrong)
}

/// What a later run needs to know of a finished case.
#[derive(Deserialize)]
#[serde(bound = "T: DeserializeOwned")]
struct CaseSummary<T> {
    fingerprint: String,
    rows: Vec<T>,
}

/// Short hash of everything that the numbers of a case depend on.
pub(crate) fn identity(all: &serde_json::Value) -> String {
    blake3::hash(all.to_string().as_bytes()).to_hex()[..16].to_owned()
}

/// Rows of the finished case in `folder`, if it is there and of the same identity.
pub(crate) fn finished<T: DeserializeOwned>(folder: &Path, fingerprint: &str) -> Option<Vec<T>> {
    let text = std::fs::read_to_string(folder.join("run.json")).ok()?;
    let summary: CaseSummary<T> = match serde_json::from_str(&text) {
        Ok(summary) => summary,
        Err(error) => {
            tracing::warn!(folder = %folder.display(), %error, "run.json is not readable: the case is computed again");
            return None;
        }
    };
    if summary.fingerprint != fingerprint {
        tracing::info!(folder = %folder.display(), "the case was computed with other settings: it is computed again");
        return None;
    }
    Some(summary.rows)
}
