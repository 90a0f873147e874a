//! `cargo xtask fuzz`: every parser fed with generated files, and a table of how long and with what outcome.

use super::cargo::{cargo, step};
use super::record::record;
use crate::cli::FuzzArgs;
use crate::workspace::workspace;
use serde::Serialize;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use topo_analysis::write_table;
use topo_cli::CliError;
use topo_cli::{note, say};
use topo_view::data;

/// Most memory of a target, in MB, and most seconds for one input.
const LIMITS: [&str; 2] = ["-rss_limit_mb=2048", "-timeout=60"];

/// What a target went through.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
struct Row {
    target: String,
    minutes: f64,
    executions: u64,
    executions_per_second: u64,
    /// Inputs that reach code no other reaches.
    corpus: u64,
    findings: u64,
}

pub fn run(args: &FuzzArgs) -> Result<(), CliError> {
    if !(args.minutes > 0.0 && args.minutes <= 1e4) {
        return Err(CliError::Argument {
            key: "--minutes",
            value: args.minutes.to_string(),
            remedy: "give minutes for each target, up to 10000".to_owned(),
        });
    }
    let folder = workspace().join("fuzz");
    let all = targets(&folder)?;
    if let Some(name) = args.targets.iter().find(|name| !all.contains(name)) {
        return Err(CliError::Argument {
            key: "TARGET",
            value: name.clone(),
            remedy: format!("targets are {}", all.join(", ")),
        });
    }
    let results = args.out.join("fuzz");
    if !args.report {
        installed()?;
        build(&folder)?;
        for name in &all {
            if args.targets.is_empty() || args.targets.contains(name) {
                fuzz(&folder, name, args.minutes, &results)?;
            }
        }
    }
    let mut rows = Vec::new();
    for name in &all {
        let path = results.join(format!("{name}.log"));
        if let Ok(log) = std::fs::read(&path) {
            rows.push(Row::of(name, &String::from_utf8_lossy(&log)));
        }
    }
    write_table(&results.join("fuzz.csv"), &rows)?;
    data::write(&results.join("fuzz.md"), text(&rows).as_bytes())?;
    say!("{}", text(&rows));
    if args.record {
        record("fuzzing.md", &text(&rows))?;
    }
    let n_findings: u64 = rows.iter().map(|row| row.findings).sum();
    if n_findings > 0 {
        return Err(CliError::Step(format!(
            "{n_findings} findings in {}: mend the parser and move them to {}",
            folder.join("artifacts").display(),
            folder.join("corpus-findings").display()
        )));
    }
    Ok(())
}

/// Says what to install where cargo-fuzz is missing.
fn installed() -> Result<(), CliError> {
    let mut command = cargo(&["fuzz", "--version"]);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        _ => Err(CliError::Input(
            "cargo-fuzz is not installed: `cargo install cargo-fuzz` brings it (a C++ compiler is needed as well)"
                .to_owned(),
        )),
    }
}

/// Builds all targets: runs that follow are not touched by later changes of the code.
fn build(folder: &Path) -> Result<(), CliError> {
    // Nothing here is unsafe, so that no sanitizer is needed, and with none the stable compiler does.
    let mut command = cargo(&["fuzz", "build", "--sanitizer", "none", "--fuzz-dir"]);
    command.arg(folder).arg("--target-dir").arg(built());
    if step("fuzz targets", command, |_| {})? {
        Ok(())
    } else {
        Err(CliError::Step("the fuzz targets do not build".to_owned()))
    }
}

/// The program of a target.
fn program(name: &str) -> Result<PathBuf, CliError> {
    // cargo-fuzz names a folder after the kind of machine.
    let kinds = std::fs::read_dir(built()).into_iter().flatten().flatten();
    let mut programs = kinds.map(|kind| kind.path().join("release").join(name));
    programs.find(|program| program.exists()).ok_or_else(|| {
        CliError::Step(format!(
            "the fuzz target {name} is not in {}",
            built().display()
        ))
    })
}

/// Names of the targets, as their manifest lists them.
fn targets(folder: &Path) -> Result<Vec<String>, CliError> {
    let path = folder.join("Cargo.toml");
    let wrong = |e: toml::de::Error| CliError::Input(format!("{}: {e}", path.display()));
    let text = std::fs::read_to_string(&path).map_err(|source| CliError::File {
        path: path.clone(),
        source,
    })?;
    let manifest: toml::Table = toml::from_str(&text).map_err(wrong)?;
    let bins = manifest.get("bin").and_then(toml::Value::as_array);
    let names = bins
        .into_iter()
        .flatten()
        .filter_map(|bin| bin.get("name")?.as_str());
    Ok(names.map(str::to_owned).collect())
}

/// Where the targets are built: not among the other builds, whose flags differ.
fn built() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR");
    target
        .map_or_else(|| workspace().join("target"), PathBuf::from)
        .join("fuzz")
}

/// Runs a target and keeps what it prints.
fn fuzz(folder: &Path, name: &str, minutes: f64, results: &Path) -> Result<(), CliError> {
    note!("== {name}");
    let fail = |e: std::io::Error| CliError::Step(format!("fuzz {name}: {e}"));
    let (corpus, artifacts) = (
        folder.join("corpus").join(name),
        folder.join("artifacts").join(name),
    );
    for place in [&corpus, &artifacts] {
        std::fs::create_dir_all(place).map_err(fail)?;
    }
    let mut command = Command::new(program(name)?);
    command.arg(&corpus).arg(folder.join("seeds").join(name));
    let seconds = (60.0 * minutes).ceil();
    command.args(LIMITS).args([
        "-print_final_stats=1".to_owned(),
        format!("-max_total_time={seconds}"),
        format!("-artifact_prefix={}/", artifacts.display()),
    ]);
    let mut child = command.stderr(Stdio::piped()).spawn().map_err(fail)?;
    let mut log = Vec::new();
    if let Some(output) = child.stderr.take() {
        for line in BufReader::new(output).split(b'\n') {
            let line = line.map_err(fail)?;
            if !line.starts_with(b"#") {
                note!("{}", String::from_utf8_lossy(&line));
            }
            log.extend_from_slice(&line);
            log.push(b'\n');
        }
    }
    let ended_well = child.wait().map_err(fail)?.success();
    data::write(&results.join(format!("{name}.log")), &log)?;
    let row = Row::of(name, &String::from_utf8_lossy(&log));
    if !ended_well && row.findings == 0 {
        return Err(CliError::Step(format!(
            "fuzz {name} stopped before it could find anything"
        )));
    }
    Ok(())
}

impl Row {
    /// Numbers that libfuzzer prints; one that found something ends at once.
    fn of(target: &str, log: &str) -> Self {
        let number = |text: &str| text.trim().parse::<u64>().unwrap_or(0);
        let (mut seconds, mut row) = (0, Self::default());
        row.target = target.to_owned();
        for line in log.lines() {
            if let Some(n) = line.strip_prefix("stat::number_of_executed_units:") {
                row.executions = number(n);
            } else if let Some((_, rest)) = line.split_once(" runs in ") {
                seconds = rest.split_whitespace().next().map_or(0, number);
            } else if let Some((_, rest)) = line.split_once(" corp: ") {
                row.corpus = rest.split('/').next().map_or(0, number);
            } else if line.contains("ERROR: libFuzzer") {
                row.findings += 1;
            }
        }
        row.minutes = (seconds as f64 / 6.0).round() / 10.0;
        row.executions_per_second = row.executions / seconds.max(1);
        row
    }
}

/// The table as Markdown.
fn text(rows: &[Row]) -> String {
    let mut text = "| target | minutes | executions | a second | corpus | findings |\n|---|---:|---:|---:|---:|---:|\n".to_owned();
    for row in rows {
        text += &format!(
            "| `{}` | {:.1} | {} | {} | {} | {} |\n",
            row.target,
            row.minutes,
            row.executions,
            row.executions_per_second,
            row.corpus,
            row.findings
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_the_fuzzer_are_read() {
        let row = Row::of(
            "vect",
            "#16384\tpulse  cov: 1432 ft: 5127 corp: 312/9041b lim: 163 exec/s: 8192 rss: 61Mb\n\
             ==7== ERROR: libFuzzer: deadly signal\n\
             Done 245760 runs in 31 second(s)\n\
             stat::number_of_executed_units: 245760\n\
             stat::average_exec_per_sec:     7927\n",
        );
        let expected = Row {
            target: "vect".to_owned(),
            minutes: 0.5,
            executions: 245_760,
            executions_per_second: 7927,
            corpus: 312,
            findings: 1,
        };
        assert_eq!(row, expected);
        assert!(text(&[row]).contains("| `vect` | 0.5 | 245760 | 7927 | 312 | 1 |"));
    }

    #[test]
    fn every_target_has_seeds() {
        let folder = workspace().join("fuzz");
        let names = targets(&folder).unwrap();
        assert!(names.len() >= 9);
        for name in names {
            let seeds = std::fs::read_dir(folder.join("seeds").join(&name));
            assert!(
                seeds.is_ok_and(|mut seeds| seeds.next().is_some()),
                "{name}"
            );
        }
    }
}
