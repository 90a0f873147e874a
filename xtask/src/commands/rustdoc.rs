//! The pages of rustdoc with typeset equations.

use super::cargo::cargo;
use crate::workspace::{at, workspace};
use std::path::Path;
use std::process::Command;
use topo_cli::CliError;

/// The header of every page, and KaTeX in a folder beside it; from the root of the workspace.
const ASSETS: &str = "xtask/rustdoc";

/// The command that builds the pages of all crates into `target/doc`; a warning is an error.
///
/// The header has its full path: one in `build.rustdocflags` of a configuration would be sought from the folder of
/// every dependency that `cargo doc` documents too. Encoded flags may have spaces.
pub fn command() -> Command {
    let header = workspace().join(ASSETS).join("header.html");
    let header = header.display().to_string();
    let flags = ["-D", "warnings", "--html-in-header", &header].join("\u{1f}");
    let mut docs = cargo(&["doc", "--release", "--workspace", "--no-deps", "--quiet"]);
    docs.env("CARGO_ENCODED_RUSTDOCFLAGS", flags);
    docs
}

/// Puts KaTeX where the header looks for it: beside the pages in `target/doc`.
pub fn place_katex(target: &Path) -> Result<(), CliError> {
    let folder = target.join("doc/katex");
    std::fs::create_dir_all(&folder).map_err(at(&folder))?;
    for name in ["katex.min.js", "katex.min.css", "LICENSE"] {
        let from = workspace().join(ASSETS).join("katex").join(name);
        std::fs::copy(&from, folder.join(name)).map_err(at(&from))?;
    }
    Ok(())
}
