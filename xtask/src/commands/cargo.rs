//! Running cargo: steps that share one target folder and profile.

use crate::workspace::workspace;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Instant;
use topo_cli::CliError;
use topo_cli::{note, say};

/// Assertions for the workspace's own crates; the dependencies' builds stay shared.
pub const CHECKED: [&str; 4] = [
    "--config",
    "profile.release.debug-assertions=true",
    "--config",
    "profile.release.overflow-checks=true",
];

/// A cargo command in the workspace's folder.
pub fn cargo(arguments: &[&str]) -> Command {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(program);
    command.args(arguments).current_dir(workspace());
    command
}

/// Cargo's target folder.
pub fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace().join("target"), PathBuf::from)
}

/// Runs a step to its end and hands every line of its output to `line` after printing it.
pub fn step(
    name: &str,
    mut command: Command,
    mut line: impl FnMut(&str),
) -> Result<bool, CliError> {
    let start = Instant::now();
    note!("== {name}");
    let fail = |e: std::io::Error| CliError::Step(format!("{name}: {e}"));
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(fail)?;
    if let Some(out) = child.stdout.take() {
        for text in BufReader::new(out).lines() {
            let text = text.map_err(fail)?;
            line(&text);
            say!("{text}");
        }
    }
    let ok = child.wait().map_err(fail)?.success();
    let word = if ok { "ok" } else { "FAILED" };
    note!("== {name}: {word}, {:.0} s", start.elapsed().as_secs_f64());
    Ok(ok)
}
