//! Where the workspace lies.

use std::path::{Path, PathBuf};

/// Folder of the workspace: where cargo built this program from, or the current folder when
/// that has moved.
pub fn workspace() -> PathBuf {
    let built = Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap_or(Path::new("."));
    if built.join("Cargo.lock").exists() {
        built.to_owned()
    } else {
        PathBuf::from(".")
    }
}
