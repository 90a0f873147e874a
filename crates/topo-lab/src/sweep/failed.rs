//! The table of cases that failed.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::LabError;
use crate::folder::forget_file;
use topo_analysis::write_table;

/// A case without a result, or whose run did not finish.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FailedCase {
    /// Its folder.
    pub case: String,
    /// Why.
    pub reason: String,
}

/// Writes `failed.csv`; none is there where nothing failed.
pub(super) fn write(folder: &Path, failed: &[FailedCase]) -> Result<(), LabError> {
    let path = folder.join("failed.csv");
    if failed.is_empty() {
        return forget_file(&path);
    }
    Ok(write_table(&path, failed)?)
}
