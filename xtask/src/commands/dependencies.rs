//! What the workspace is built from: licences, versions of one crate beside each other, the declared Rust version, spelling.

use super::cargo::cargo;
use crate::workspace::workspace;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;
use topo_cli::CliError;
use topo_cli::note;

/// What `cargo metadata` says.
#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    license: Option<String>,
    rust_version: Option<String>,
    source: Option<String>,
}

/// What `deny.toml` allows.
#[derive(Deserialize)]
struct Policy {
    licenses: Licenses,
    bans: Bans,
}

#[derive(Deserialize)]
struct Licenses {
    allow: BTreeSet<String>,
}

#[derive(Deserialize)]
struct Bans {
    skip: BTreeSet<String>,
}

/// What `deny.toml` does not allow, a line each.
///
/// # Errors
/// `cargo metadata` that fails, or a `deny.toml` that cannot be read.
pub fn refused() -> Result<Vec<String>, CliError> {
    let path = workspace().join("deny.toml");
    let text = std::fs::read_to_string(&path).map_err(|source| CliError::File {
        path: path.clone(),
        source,
    })?;
    let policy: Policy =
        toml::from_str(&text).map_err(|e| CliError::Step(format!("{}: {e}", path.display())))?;
    Ok(against(&policy, &metadata()?))
}

fn metadata() -> Result<Metadata, CliError> {
    let fail = |reason: String| CliError::Step(format!("cargo metadata: {reason}"));
    let found = cargo(&["metadata", "--format-version", "1", "--locked"]).output();
    let found = found.map_err(|e| fail(e.to_string()))?;
    if !found.status.success() {
        return Err(fail(String::from_utf8_lossy(&found.stderr).into_owned()));
    }
    serde_json::from_slice(&found.stdout).map_err(|e| fail(e.to_string()))
}

fn against(policy: &Policy, found: &Metadata) -> Vec<String> {
    let mut lines = Vec::new();
    let mut versions: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for p in &found.packages {
        versions.entry(&p.name).or_default().insert(&p.version);
        let license = p.license.as_deref().unwrap_or("none");
        if !is_allowed(license, &policy.licenses.allow) {
            lines.push(format!(
                "{} {}: licence {license} is not among those of deny.toml",
                p.name, p.version
            ));
        }
    }
    for (name, versions) in &versions {
        if versions.len() > 1 && !policy.bans.skip.contains(*name) {
            let all: Vec<&str> = versions.iter().copied().collect();
            lines.push(format!(
                "{name} is built in versions {}: settle on one, or name it under skip in deny.toml and say who wants it",
                all.join(" and ")
            ));
        }
    }
    for name in &policy.bans.skip {
        if versions.get(name.as_str()).is_none_or(|v| v.len() < 2) {
            lines.push(format!(
                "{name} is built in one version: take it out of skip in deny.toml"
            ));
        }
    }
    lines
}

/// Whether an expression of licences can be met by those allowed: one of each OR, all of each AND.
fn is_allowed(expression: &str, allowed: &BTreeSet<String>) -> bool {
    let all_of = |part: &str| {
        let words = part.split(" AND ").map(|w| w.trim_matches(['(', ')', ' ']));
        words.into_iter().all(|w| allowed.contains(w))
    };
    // brackets hold alternatives only, as in (A OR B) AND C
    match expression.split_once(") AND ") {
        Some((left, right)) => {
            is_allowed(&format!("{left})"), allowed) && is_allowed(right, allowed)
        }
        None => expression.replace('/', " OR ").split(" OR ").any(all_of),
    }
}

/// A check of the workspace by the Rust version that it declares; `None` if the running one is it, and has compiled everything.
///
/// # Errors
/// `cargo metadata` that fails.
pub fn declared_rust() -> Result<Option<Command>, CliError> {
    let found = metadata()?;
    let own = found.packages.iter().find(|p| p.source.is_none());
    let declared = own.and_then(|p| p.rust_version.clone()).unwrap_or_default();
    let running = Command::new("rustc").arg("--version").output();
    let running = running.map_or(String::new(), |o| {
        String::from_utf8_lossy(&o.stdout).into_owned()
    });
    if running.starts_with(&format!("rustc {declared}.")) {
        note!("declared Rust version {declared}: it is the one that runs");
        return Ok(None);
    }
    let toolchain = format!("+{declared}");
    let mut command = Command::new("cargo");
    command
        .args([&toolchain, "check", "--release", "--quiet", "--workspace"])
        .env_remove("CARGO")
        .env("CARGO_TARGET_DIR", workspace().join("target/declared-rust"))
        .current_dir(workspace());
    Ok(Some(command))
}

/// The command that looks for misspelt words, where it is: on the path, or beside the Python of the tests.
pub fn spelling() -> Option<Command> {
    let beside = std::env::var_os("TOPO_PYTHON")
        .map(|python| std::path::Path::new(&python).with_file_name("typos"));
    let places = [Some("typos".into()), beside].into_iter().flatten();
    let runs = |program: &std::path::PathBuf| {
        let tried = Command::new(program).arg("--version").output();
        tried.is_ok_and(|o| o.status.success())
    };
    let mut command = Command::new(places.into_iter().find(runs)?);
    command.current_dir(workspace());
    Some(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(packages: &[(&str, &str, Option<&str>)]) -> Metadata {
        let package = |(name, version, license): &(&str, &str, Option<&str>)| Package {
            name: (*name).to_owned(),
            version: (*version).to_owned(),
            license: license.map(str::to_owned),
            rust_version: None,
            source: None,
        };
        Metadata {
            packages: packages.iter().map(package).collect(),
        }
    }

    #[test]
    fn what_is_not_allowed_is_named() {
        let policy: Policy = toml::from_str(
            "[licenses]\nallow = [\"MIT\", \"Unicode-3.0\"]\n[bans]\nskip = [\"old\", \"gone\"]\n",
        )
        .unwrap();
        let lines = against(
            &policy,
            &found(&[
                ("a", "1.0.0", Some("(MIT OR Apache-2.0) AND Unicode-3.0")),
                ("b", "1.0.0", Some("Apache-2.0/MIT")),
                ("c", "1.0.0", Some("GPL-3.0")),
                ("d", "1.0.0", None),
                ("e", "1.0.0", Some("MIT AND GPL-3.0")),
                ("old", "1.0.0", Some("MIT")),
                ("old", "2.0.0", Some("MIT")),
                ("twice", "1.0.0", Some("MIT")),
                ("twice", "2.0.0", Some("MIT")),
            ]),
        );
        let begins: Vec<&str> = lines
            .iter()
            .filter_map(|l| l.split([':', ' ']).next())
            .collect();
        assert_eq!(begins, ["c", "d", "e", "twice", "gone"], "{lines:?}");
    }

    #[test]
    fn the_workspace_is_built_from_what_it_allows() {
        assert_eq!(refused().unwrap(), Vec::<String>::new());
    }
}
