//! Whether all crates build from their packages alone, as a stranger gets them.

use super::cargo::cargo;
use crate::workspace::{at, workspace};
use std::path::Path;
use std::process::Command;
use topo_cli::CliError;

/// A check of all packages that `cargo package` left in `target`.
///
/// They are unpacked beside each other into a workspace of their own, and checked together: one by one, each would have its
/// dependencies with other features and check them again. `cargo package`
/// can build them itself, but through a cache outside the target folder that takes a package
/// of a given version for unchanging: it may build against what an earlier run left there.
pub fn check(target: &Path) -> Result<Command, CliError> {
    let root = target.join("package-check");
    if root.exists() {
        std::fs::remove_dir_all(&root).map_err(at(&root))?;
    }
    std::fs::create_dir_all(&root).map_err(at(&root))?;
    let version = env!("CARGO_PKG_VERSION");
    let names = names()?;
    let mut manifest =
        "[workspace]\nresolver = \"3\"\nmembers = [\"topo-*\"]\n\n[patch.crates-io]\n".to_owned();
    for name in &names {
        let package = target.join(format!("package/{name}-{version}.crate"));
        let file = std::fs::File::open(&package).map_err(at(&package))?;
        tar::Archive::new(flate2::read::GzDecoder::new(file))
            .unpack(&root)
            .map_err(at(&package))?;
        manifest += &format!("{name} = {{ path = \"{name}-{version}\" }}\n");
    }
    let file = root.join("Cargo.toml");
    std::fs::write(&file, manifest).map_err(at(&file))?;
    let lock = root.join("Cargo.lock");
    std::fs::copy(workspace().join("Cargo.lock"), &lock).map_err(at(&lock))?;
    let mut command = cargo(&["check", "--release", "--quiet", "--workspace"]);
    command.current_dir(&root).env("CARGO_TARGET_DIR", target);
    Ok(command)
}

/// The crates to be published: every folder of `crates/`.
fn names() -> Result<Vec<String>, CliError> {
    let folder = workspace().join("crates");
    let mut names = Vec::new();
    for entry in std::fs::read_dir(&folder).map_err(at(&folder))? {
        let entry = entry.map_err(at(&folder))?;
        names.push(entry.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}
