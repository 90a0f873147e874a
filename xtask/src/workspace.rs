//! Where the workspace lies, and files that cannot be read or written.

use std::path::{Path, PathBuf};
use topo_cli::CliError;

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

/// What a command returns when the file or folder `path` cannot be read or written.
pub fn at(path: &Path) -> impl Fn(std::io::Error) -> CliError {
    let path = path.to_owned();
    move |source| CliError::File {
        path: path.clone(),
        source,
    }
}
