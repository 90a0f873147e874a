//! `cargo xtask test`: tests, doc tests and examples, with their counts.

use super::cargo::{CHECKED, cargo, step, target};
use super::python::{self, Tested};
use crate::cli::TestArgs;
use crate::workspace::workspace;
use std::path::{Path, PathBuf};
use std::process::Command;
use topo_cli::CliError;
use topo_cli::{note, say};
use topo_view::Outside;

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

    /// Adds the closing line of pytest, such as `1 failed, 12 passed, 2 skipped in 3.21s`, if `line` is one.
    pub fn add_pytest(&mut self, line: &str) {
        let line = line.trim_matches(['=', ' ']);
        let Some((list, _)) = line.rsplit_once(" in ").filter(|(_, t)| t.contains('s')) else {
            return;
        };
        for part in list.split(", ") {
            match part
                .split_once(' ')
                .map(|(n, what)| (n.parse::<usize>(), what))
            {
                Some((Ok(n), "passed" | "xfailed")) => self.passed += n,
                Some((Ok(n), "failed" | "error" | "errors" | "xpassed")) => self.failed += n,
                Some((Ok(n), "skipped")) => self.skipped += n,
                _ => {}
            }
        }
    }

    fn add_all(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.skipped += other.skipped;
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

/// What all tests came to.
pub struct Report {
    counts: Counts,
    /// Whether every step went well; a build that fails counts no test.
    pub ok: bool,
    /// What was left out for want of a program, loud at the end.
    notes: Vec<String>,
}

impl std::fmt::Display for Report {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for note in &self.notes {
            writeln!(f, "{note}")?;
        }
        write!(f, "{}", self.counts)
    }
}

pub fn run(args: &TestArgs) -> Result<(), CliError> {
    let report = all(args.long)?;
    say!("{report}");
    if report.ok {
        Ok(())
    } else {
        Err(CliError::Step("tests failed".to_owned()))
    }
}

/// Runs everything: what needs Python or a browser where there is one.
pub fn all(long: bool) -> Result<Report, CliError> {
    let mut report = Report {
        counts: Counts::default(),
        ok: true,
        notes: Vec::new(),
    };
    let mut ignored = Vec::new();
    let mut command = harness();
    command.arg("--no-fail-fast");
    report.ok &= step("tests", command, |line| {
        report.counts.add(line);
        ignored.extend(ignored_test(line).map(str::to_owned));
    })?;
    if long {
        report.ignored_tests("long tests", "long_")?;
    }
    for outside in Outside::ALL {
        let prefix = outside.prefix();
        if outside.find().is_some() {
            report.ignored_tests(
                &format!("tests that a program outside serves, {prefix}"),
                prefix,
            )?;
        } else {
            let n = ignored.iter().filter(|t| t.starts_with(prefix)).count();
            report.notes.push(skipped(n, outside));
        }
    }
    for (package, example) in examples(&workspace()) {
        // The tests' build has made them; `cargo run` for one package would build its dependencies with other features again.
        let mut command = Command::new(built_example(&example)?);
        command.current_dir(workspace());
        let went = step(&format!("example {package}/{example}"), command, |_| {})?;
        report.counts.outcome(went);
        report.ok &= went;
    }
    // made by the tests' build, which may have replaced the file of this program
    let name = format!("topo{}", std::env::consts::EXE_SUFFIX);
    let program = std::env::current_exe()
        .unwrap_or_default()
        .with_file_name(name);
    match python::test(&target(), &program, long)? {
        Tested::Ran(counts, ok) => {
            report.counts.add_all(counts);
            report.ok &= ok;
        }
        Tested::Skipped(n, note) => {
            report.counts.skipped += n;
            report.notes.push(note);
        }
    }
    // A build that fails leaves no closing line of its own.
    if !report.ok && report.counts.failed == 0 {
        report.counts.failed = 1;
    }
    Ok(report)
}

impl Report {
    /// Runs the ignored tests whose names begin with `prefix`; that there is none is a failure.
    fn ignored_tests(&mut self, what: &str, prefix: &str) -> Result<(), CliError> {
        let mut command = harness();
        command.args(["--no-fail-fast", "--lib", "--bins", "--tests", "--"]);
        command.args(["--ignored", prefix]);
        let mut extra = Counts::default();
        let went = step(what, command, |line| extra.add(line))?;
        let n = extra.passed + extra.failed;
        if went && n == 0 {
            note!("== {what}: FAILED, no test is named {prefix}");
        }
        self.ok &= went && n > 0;
        self.counts.passed += extra.passed;
        self.counts.failed += extra.failed;
        self.counts.skipped = self.counts.skipped.saturating_sub(n);
        Ok(())
    }
}

/// The command that runs the workspace's tests.
fn harness() -> Command {
    let mut command = cargo(&[
        "test",
        "--release",
        "--workspace",
        "--exclude",
        "topo-bench",
        // without tests in Rust, and with features of its own
        "--exclude",
        "topo-py",
    ]);
    command.args(CHECKED);
    command
}

/// The name of an ignored test without its modules, if `line` of the test harness reports one.
fn ignored_test(line: &str) -> Option<&str> {
    let (name, outcome) = line.trim().strip_prefix("test ")?.split_once(" ... ")?;
    let name = name.rsplit("::").next().unwrap_or(name);
    outcome.starts_with("ignored").then_some(name)
}

/// What is said of `n` tests for which a program is not there.
fn skipped(n: usize, outside: Outside) -> String {
    let tests = if n == 1 { "test" } else { "tests" };
    format!(
        "SKIPPED: {n} {tests}, {}*: {}",
        outside.prefix(),
        outside.needs()
    )
}

/// Where cargo puts an example: beside this program.
fn built_example(name: &str) -> Result<PathBuf, CliError> {
    let failed = |e: std::io::Error| CliError::Step(format!("cannot find the examples: {e}"));
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
    fn closing_lines_of_pytest_are_added_up() {
        let mut counts = Counts::default();
        counts.add_pytest("12 passed, 2 skipped, 1 warning in 3.21s");
        counts.add_pytest("=== 1 failed, 3 passed, 1 error in 61.20s (0:01:01) ===");
        counts.add_pytest("12 cases in all");
        assert_eq!(counts.to_string(), "15 passed, 2 failed, 2 skipped");
    }

    #[test]
    fn tests_left_out_are_reported_at_the_end() {
        let line = "test export::tests::python_reads ... ignored, needs Python";
        assert_eq!(ignored_test(line), Some("python_reads"));
        assert_eq!(ignored_test("test long_one ... ignored"), Some("long_one"));
        assert_eq!(ignored_test("test export::tests::other ... ok"), None);
        let report = Report {
            counts: Counts {
                passed: 3,
                failed: 0,
                skipped: 2,
            },
            ok: true,
            notes: Outside::ALL.map(|o| skipped(1, o)).to_vec(),
        };
        let text = report.to_string();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].starts_with("SKIPPED: 1 test, python_*: needs Python"));
        assert!(lines[1].contains("TOPO_BROWSER"));
        assert_eq!(lines[2], "3 passed, 0 failed, 2 skipped");
    }

    #[test]
    fn examples_are_found_by_package() {
        let dir = tempfile::tempdir().unwrap();
        for file in [
            "crates/b/examples/two.rs",
            "crates/a/examples/one.rs",
            "crates/a/examples/data.csv",
        ] {
            topo_view::data::write(&dir.path().join(file), b"").unwrap();
        }
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        assert_eq!(examples(dir.path()), [pair("a", "one"), pair("b", "two")]);
    }
}
