//! `cargo xtask test`: tests, doc tests and examples, with their counts.

use super::cargo::{CHECKED, cargo, step};
use crate::cli::TestArgs;
use crate::error::XtaskError;
use crate::provenance::workspace;
use std::path::{Path, PathBuf};
use std::process::Command;

/// How many tests passed, failed and were left out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    passed: usize,
    failed: usize,
    skipped: usize,
}

impl Counts {
    /// Adds a closing line of the test harness, if `line` is one.
    fn add(&mut self, line: &str) {
        let Some(rest) = line.trim().strip_prefix("test result:") else {
            return;
        };
        for part in rest.split([';', '.']) {
            let mut words = part.split_whitespace();
            let (Some(n), Some(what)) = (
                words.next().and_then(|w| w.parse::<usize>().ok()),
                words.next(),
            ) else {
                continue;
            };
            match what {
                "passed" => self.passed += n,
                "failed" => self.failed += n,
                "ignored" => self.skipped += n,
                _ => {}
            }
        }
    }

    fn outcome(&mut self, ok: bool) {
        if ok {
            self.passed += 1
        } else {
            self.failed += 1
        }
    }
}

impl std::fmt::Display for Counts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} passed, {} failed, {} skipped",
            self.passed, self.failed, self.skipped
        )
    }
}

pub fn run(args: &TestArgs) -> Result<(), XtaskError> {
    let (counts, ok) = all(args.long)?;
    println!("{counts}");
    if ok {
        Ok(())
    } else {
        Err(XtaskError::Step("tests failed".to_owned()))
    }
}

/// Runs everything and returns the counts and whether all went well.
pub fn all(long: bool) -> Result<(Counts, bool), XtaskError> {
    let base = [
        "test",
        "--release",
        "--workspace",
        "--exclude",
        "topo-bench",
    ];
    let mut counts = Counts::default();
    let mut ok = true;
    let mut command = cargo(&base);
    command.args(CHECKED).arg("--no-fail-fast");
    ok &= step("tests", command, |line| counts.add(line))?;
    if long {
        let mut command = cargo(&base);
        command
            .args(CHECKED)
            .args(["--no-fail-fast", "--lib", "--bins", "--tests", "--"]);
        command.args(["--ignored", "long_"]);
        let mut extra = Counts::default();
        ok &= step("long tests", command, |line| extra.add(line))?;
        counts.passed += extra.passed;
        counts.failed += extra.failed;
        counts.skipped = counts.skipped.saturating_sub(extra.passed + extra.failed);
    }
    for (package, example) in examples(&workspace()) {
        // The tests' build has made them; `cargo run` for one package would build its dependencies with other features again.
        let mut command = Command::new(built_example(&example)?);
        command.current_dir(workspace());
        let went = step(&format!("example {package}/{example}"), command, |_| {})?;
        counts.outcome(went);
        ok &= went;
    }
    // A build that fails leaves no closing line of its own.
    if !ok && counts.failed == 0 {
        counts.failed = 1;
    }
    Ok((counts, ok))
}

/// Where cargo puts an example: beside this program.
fn built_example(name: &str) -> Result<PathBuf, XtaskError> {
    let failed = |e: std::io::Error| XtaskError::Step(format!("cannot find the examples: {e}"));
    let program = std::env::current_exe().map_err(failed)?;
    let folder = program.parent().unwrap_or(Path::new(".")).join("examples");
    Ok(folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX)))
}

/// Packages and names of the programs in `crates/*/examples`, in order.
fn examples(root: &Path) -> Vec<(String, String)> {
    let list = |folder: &Path| -> Vec<std::path::PathBuf> {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut paths: Vec<_> = entries.map(|e| e.path()).collect();
        paths.sort();
        paths
    };
    let name = |path: &Path| path.file_stem().map(|n| n.to_string_lossy().into_owned());
    let mut found = Vec::new();
    for package in list(&root.join("crates")) {
        for file in list(&package.join("examples")) {
            let program = file.extension().is_some_and(|e| e == "rs");
            if let (true, Some(p), Some(e)) = (program, name(&package), name(&file)) {
                found.push((p, e));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closing_lines_are_added_up() {
        let mut counts = Counts::default();
        counts.add("running 3 tests");
        counts.add("test result: ok. 12 passed; 0 failed; 2 ignored; 0 measured; 1 filtered out; finished in 0.31s");
        counts.add("test result: FAILED. 3 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.20s");
        assert_eq!(
            counts,
            Counts {
                passed: 15,
                failed: 1,
                skipped: 2
            }
        );
        assert_eq!(counts.to_string(), "15 passed, 1 failed, 2 skipped");
    }

    #[test]
    fn examples_are_found_by_package() {
        let dir = tempfile::tempdir().unwrap();
        for file in [
            "crates/b/examples/two.rs",
            "crates/a/examples/one.rs",
            "crates/a/examples/data.csv",
        ] {
            crate::data::write(&dir.path().join(file), b"").unwrap();
        }
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        assert_eq!(examples(dir.path()), [pair("a", "one"), pair("b", "two")]);
    }
}
