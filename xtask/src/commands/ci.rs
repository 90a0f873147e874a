//! `cargo xtask ci`: what must pass before a change lands.

use super::cargo::{cargo, step};
use super::test;
use crate::error::XtaskError;
use crate::provenance::workspace;
use std::path::PathBuf;

pub fn run() -> Result<(), XtaskError> {
    let mut failed: Vec<&str> = Vec::new();
    let mut check = |name: &'static str, command| -> Result<(), XtaskError> {
        if !step(name, command, |_| {})? {
            failed.push(name);
        }
        Ok(())
    };
    check("fmt", cargo(&["fmt", "--all", "--check"]))?;
    // Release like everything else, so that build scripts and macros are built once.
    let lint = [
        "clippy",
        "--release",
        "--workspace",
        "--all-targets",
        "--quiet",
        "--",
        "-D",
        "warnings",
    ];
    check("clippy", cargo(&lint))?;
    let mut docs = cargo(&["doc", "--release", "--workspace", "--no-deps", "--quiet"]);
    docs.env("RUSTDOCFLAGS", "-D warnings");
    check("doc", docs)?;
    check(
        "package",
        cargo(&["package", "--workspace", "--no-verify", "--quiet"]),
    )?;
    check("packages build", package()?)?;
    let (counts, ok) = test::all(false)?;
    if !ok {
        failed.push("tests");
    }
    let verdict = if failed.is_empty() {
        "all steps passed".to_owned()
    } else {
        format!("failed: {}", failed.join(", "))
    };
    println!("ci: {verdict}");
    println!("{counts}");
    if failed.is_empty() {
        Ok(())
    } else {
        Err(XtaskError::Step(format!("ci {verdict}")))
    }
}

/// Builds every crate that can be published from its package, as a stranger would.
///
/// Cargo takes a package of a given version for unchanging and could build against what an
/// earlier run left; so the workspace's own crates are forgotten first, in a folder of their
/// own. It only counts whether they build, not how fast they run.
fn package() -> Result<std::process::Command, XtaskError> {
    let target = target().join("package-check");
    let kept = std::fs::read_dir(target.join("debug/.fingerprint"))
        .into_iter()
        .flatten()
        .flatten();
    for old in kept.filter(|e| e.file_name().to_string_lossy().starts_with("topo-")) {
        std::fs::remove_dir_all(old.path()).map_err(|source| XtaskError::File {
            path: old.path(),
            source,
        })?;
    }
    let mut package = cargo(&["package", "--workspace", "--quiet"]);
    for private in ["xtask", "topo-tests", "topo-bench"] {
        package.args(["--exclude", private]);
    }
    package.env("CARGO_TARGET_DIR", target);
    package
        .env("CARGO_PROFILE_DEV_DEBUG", "false")
        .env("CARGO_PROFILE_DEV_OPT_LEVEL", "0");
    Ok(package)
}

/// Cargo's target folder.
fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace().join("target"), PathBuf::from)
}
