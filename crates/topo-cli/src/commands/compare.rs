//! `topo compare DIR DIR`: whether two results folders hold the same numbers, to the byte.

use crate::cli::CompareArgs;
use crate::duration::count;
use crate::error::CliError;
use crate::output;
use crate::progress::waiting;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use topo_view::ViewError;

/// Columns and keys of times and memory, not of results.
pub const DROPPED: [&str; 3] = ["cpu_seconds", "peak_bytes", "timings"];
/// Files about the making of the results, and pictures of them.
const SKIPPED: [&str; 2] = ["provenance.json", "index.html"];
/// Most differences listed one by one.
const LISTED: usize = 20;

pub(super) fn run(args: &CompareArgs) -> Result<(), CliError> {
    let differences = waiting("comparing", || {
        differences(&args.first, &args.second, &DROPPED)
    })?;
    output::data("differences", &differences);
    for line in differences.iter().take(LISTED) {
        say!("{line}");
    }
    if differences.len() > LISTED {
        say!("and {} more", differences.len() - LISTED);
    }
    if differences.is_empty() {
        say!(
            "the same: {} and {}, but for {}",
            args.first.display(),
            args.second.display(),
            DROPPED.join(", ")
        );
        Ok(())
    } else {
        let n = differences.len();
        let verb = if n == 1 { "differs" } else { "differ" };
        Err(CliError::Step(format!("{} {verb}", count(n, "file"))))
    }
}

/// A line for each file that is not the same in both folders, but for the columns and keys `dropped`.
pub fn differences(first: &Path, second: &Path, dropped: &[&str]) -> Result<Vec<String>, CliError> {
    let (a, b) = (files(first)?, files(second)?);
    let mut lines = Vec::new();
    for name in a.union(&b) {
        let file = name.display();
        match (a.contains(name), b.contains(name)) {
            (true, false) => lines.push(format!("{file}: only in {}", first.display())),
            (false, true) => lines.push(format!("{file}: only in {}", second.display())),
            _ => {
                let essence = |folder: &Path| essence(&folder.join(name), dropped);
                let (x, y) = (essence(first)?, essence(second)?);
                if x != y {
                    let place = x.iter().zip(&y).position(|(p, q)| p != q);
                    let line = place.map_or(x.len().min(y.len()), |k| k) + 1;
                    lines.push(format!("{file}: differs from line {line} on"));
                }
            }
        }
    }
    Ok(lines)
}

/// Paths of the files below a folder, relative to it; what a command left unfinished is not among them.
pub fn files(folder: &Path) -> Result<BTreeSet<PathBuf>, CliError> {
    let mut found = BTreeSet::new();
    let mut open = vec![PathBuf::new()];
    while let Some(inner) = open.pop() {
        let place = folder.join(&inner);
        let fail = |source| CliError::File {
            path: place.clone(),
            source,
        };
        for entry in std::fs::read_dir(&place).map_err(fail)? {
            let entry = entry.map_err(fail)?;
            let (name, path) = (entry.file_name(), inner.join(entry.file_name()));
            if entry.file_type().map_err(fail)?.is_dir() {
                open.push(path);
            } else if SKIPPED.iter().all(|s| name != *s)
                && path.extension().is_some_and(|e| e == "csv" || e == "json")
            {
                found.insert(path);
            }
        }
    }
    Ok(found)
}

/// Lines of a file without what may differ between two runs of the same numbers.
fn essence(path: &Path, dropped: &[&str]) -> Result<Vec<String>, CliError> {
    let wrong = |reason: String| {
        CliError::View(ViewError::Table {
            path: path.to_owned(),
            reason,
        })
    };
    let text = std::fs::read_to_string(path).map_err(|source| CliError::File {
        path: path.to_owned(),
        source,
    })?;
    if path.extension().is_some_and(|e| e == "json") {
        let mut value = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
        drop_keys(&mut value, dropped);
        let text = serde_json::to_string_pretty(&value).map_err(|e| wrong(e.to_string()))?;
        return Ok(text.lines().map(str::to_owned).collect());
    }
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(text.as_bytes());
    let rows: Vec<csv::StringRecord> = reader
        .records()
        .collect::<Result<_, _>>()
        .map_err(|e| wrong(e.to_string()))?;
    let kept: Vec<usize> = rows.first().map_or(Vec::new(), |header| {
        (0..header.len())
            .filter(|&k| !dropped.contains(&&header[k]))
            .collect()
    });
    let line = |row: &csv::StringRecord| {
        let cells: Vec<&str> = kept.iter().filter_map(|&k| row.get(k)).collect();
        cells.join(",")
    };
    Ok(rows.iter().map(line).collect())
}

fn drop_keys(value: &mut serde_json::Value, dropped: &[&str]) {
    match value {
        serde_json::Value::Object(map) => {
            map.retain(|key, _| !dropped.contains(&key.as_str()));
            map.values_mut().for_each(|v| drop_keys(v, dropped));
        }
        serde_json::Value::Array(items) => items.iter_mut().for_each(|v| drop_keys(v, dropped)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(seconds: &str, energy: &str) -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        let put = |name: &str, text: String| {
            let path = dir.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        };
        put(
            "elastic/sweep.csv",
            format!("knot,energy,cpu_seconds,warnings\n3_1,{energy},{seconds},\n"),
        );
        put(
            "elastic/a/run.json",
            format!(
                "{{\"rows\":[{{\"energy\":{energy},\"cpu_seconds\":{seconds}}}],\"timings\":{{\"x\":{seconds}}}}}"
            ),
        );
        put("provenance.json", seconds.to_owned());
        dir
    }

    #[test]
    fn times_may_differ_and_numbers_may_not() {
        let (a, b, c) = (
            folder("1.5", "0.25"),
            folder("9", "0.25"),
            folder("9", "0.250"),
        );
        let lines_of = |x: &tempfile::TempDir, y: &tempfile::TempDir| {
            differences(x.path(), y.path(), &DROPPED)
        };
        assert_eq!(lines_of(&a, &b).unwrap(), Vec::<String>::new());
        assert_eq!(
            lines_of(&a, &c).unwrap(),
            ["elastic/sweep.csv: differs from line 2 on"]
        );
        let without_energy = differences(a.path(), c.path(), &["energy", "cpu_seconds", "timings"]);
        assert_eq!(without_energy.unwrap(), Vec::<String>::new());
        std::fs::remove_file(b.path().join("elastic/a/run.json")).unwrap();
        let lines = lines_of(&a, &b).unwrap();
        assert!(lines.len() == 1 && lines[0].contains("only in"));
        std::fs::write(c.path().join("elastic/a/run.json"), "{").unwrap();
        assert!(lines_of(&a, &c).is_err());
        assert_eq!(
            differences(a.path(), &a.path().join("nowhere"), &DROPPED)
                .unwrap_err()
                .exit_code(),
            2
        );
    }
}
