//! `cargo xtask ci`: what must pass before a change lands.

use super::cargo::{cargo, step, target};
use super::{dependencies, packages, rustdoc, test};
use topo_cli::CliError;
use topo_cli::{note, say};

pub fn run() -> Result<(), CliError> {
    let mut failed: Vec<String> = Vec::new();
    let mut check = |name: &str, command| -> Result<(), CliError> {
        if !step(name, command, |_| {})? {
            failed.push(name.to_owned());
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
    check("doc", rustdoc::command())?;
    rustdoc::place_katex(&target())?;
    check(
        "package",
        cargo(&["package", "--workspace", "--no-verify", "--quiet"]),
    )?;
    check("packages build", packages::check(&target())?)?;
    if let Some(command) = dependencies::declared_rust()? {
        check("declared Rust version", command)?;
    }
    match dependencies::spelling() {
        Some(command) => check("spelling", command)?,
        None => note!("spelling: skipped, typos is not there (pip install typos)"),
    }
    let refused = dependencies::refused()?;
    for line in &refused {
        note!("{line}");
    }
    if !refused.is_empty() {
        failed.push("dependencies".to_owned());
    }
    let report = test::all(false)?;
    if !report.ok {
        failed.push("tests".to_owned());
    }
    let verdict = if failed.is_empty() {
        "all steps passed".to_owned()
    } else {
        format!("failed: {}", failed.join(", "))
    };
    say!("ci: {verdict}");
    say!("{report}");
    if failed.is_empty() {
        Ok(())
    } else {
        Err(CliError::Step(format!("ci {verdict}")))
    }
}
