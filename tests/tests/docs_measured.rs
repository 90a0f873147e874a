//! Measured tables of the documentation say what they were measured with, and are not silently behind the code.
//!
//! A line such as
//!
//! ```text
//! *Measured: commit 737adad, rods 5, nematics 6; `cargo xtask accuracy`.*
//! *Measured: commit e6683a2, rods 4; `cargo xtask accuracy`; older: unwritten fibres now count from before the cut.*
//! ```
//!
//! serves the tables of its section and of the sections below it; under the title it serves the page. A table is measured if a
//! column is named "measured" or "found", or a column but the first holds numbers in more than half of its rows. Tables of
//! settings have `<!-- settings -->` above them instead. A version behind the code needs `older:` with the reason, and `older:`
//! needs a version behind the code.

use std::fs;
use std::path::{Path, PathBuf};

/// Versions of results as the code has them.
const VERSIONS: [(&str, u32); 3] = [
    ("rods", topo_lab::RESULTS_VERSION),
    ("nematics", topo_lab::NEMATIC_RESULTS_VERSION),
    ("knots", topo_knots::METHOD_VERSION),
];
/// What a page may name instead of versions: the table depends on none.
const NO_RESULTS: &str = "no results";
const SETTINGS: &str = "<!-- settings -->";
/// Heading below all others.
const DEEPEST: usize = 7;

/// Pages of the documentation with their texts.
fn pages() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut paths = vec![root.join("README.md"), root.join("CONTRIBUTING.md")];
    let docs = fs::read_dir(root.join("docs")).unwrap();
    paths.extend(docs.map(|e| e.unwrap().path()));
    paths.retain(|p| p.extension().is_some_and(|e| e == "md"));
    paths.sort();
    let read = |p: PathBuf| {
        let text = fs::read_to_string(&p).unwrap();
        (p, text)
    };
    paths.into_iter().map(read).collect()
}

/// Whether a cell is a number, with or without sign, unit, percent or a second number after it.
fn is_number(cell: &str) -> bool {
    let bare = cell.trim_matches(|c: char| " *~≈<>≤≥+-−±×".contains(c));
    bare.starts_with(|c: char| c.is_ascii_digit()) && bare.split_whitespace().count() <= 3
}

/// The cells of a row of a table; escaped bars do not part them.
fn cells(row: &str) -> Vec<String> {
    let row = row.replace("\\|", "/");
    let row = row.trim().trim_start_matches('|').trim_end_matches('|');
    row.split('|').map(|c| c.trim().to_owned()).collect()
}

/// Whether a table, header first, holds what was measured.
fn is_measured(table: &[&str]) -> bool {
    let header = cells(table[0]);
    if header
        .iter()
        .any(|h| h.contains("measured") || h.contains("found"))
    {
        return true;
    }
    let rows: Vec<Vec<String>> = table[2..].iter().map(|r| cells(r)).collect();
    (1..header.len()).any(|column| {
        let numbers = rows
            .iter()
            .filter_map(|r| r.get(column))
            .filter(|c| is_number(c));
        2 * numbers.count() > rows.len()
    })
}

/// What is wrong with a line that says how something was measured.
fn fault(line: &str) -> Option<String> {
    let Some(said) = line
        .strip_prefix("*Measured: ")
        .and_then(|l| l.strip_suffix(".*"))
    else {
        return Some("it must read `*Measured: ... .*`".to_owned());
    };
    let (said, older) = match said.split_once("; older: ") {
        Some((said, reason)) => (said, Some(reason.trim())),
        None => (said, None),
    };
    let Some((origin, command)) = said.split_once("; ") else {
        return Some("the command is missing: `; ` before it".to_owned());
    };
    let mut facts = origin.split(", ");
    let commit = facts.next().and_then(|f| f.strip_prefix("commit "));
    let is_hash = |c: &str| c.len() >= 7 && c.chars().all(|c| c.is_ascii_hexdigit());
    if !commit.is_some_and(is_hash) {
        return Some("it must begin with the commit".to_owned());
    }
    if command.trim().len() < 5 || older.is_some_and(|reason| reason.len() < 10) {
        return Some("command or reason is empty".to_owned());
    }
    let (mut n, mut n_behind) = (0, 0);
    for fact in facts {
        n += 1;
        if fact == NO_RESULTS {
            continue;
        }
        let known = |(name, now): (&str, u32)| {
            let version: u32 = fact.strip_prefix(name)?.trim().parse().ok()?;
            (1..=now).contains(&version).then_some(version < now)
        };
        match VERSIONS.into_iter().find_map(known) {
            Some(behind) => n_behind += usize::from(behind),
            None => return Some(format!("`{fact}` is no version that there is or was")),
        }
    }
    match (n, n_behind, older) {
        (0, ..) => Some(format!(
            "it names no version of results, nor `{NO_RESULTS}`"
        )),
        (_, 0, Some(_)) => Some("it says `older:` of the present versions".to_owned()),
        (_, 1.., None) => {
            Some("the code has moved on: measure again, or say `older: why`".to_owned())
        }
        _ => None,
    }
}

/// Everything wrong with a page, and how many measured tables it has.
fn faults(page: &str) -> (Vec<String>, usize) {
    let lines: Vec<&str> = page.lines().collect();
    let (mut faults, mut n_tables) = (Vec::new(), 0);
    // Levels of the headings under which a line stands that serves what follows.
    let mut served: Vec<usize> = Vec::new();
    let (mut level, mut code) = (1, false);
    for (i, line) in lines.iter().enumerate() {
        code ^= line.starts_with("```");
        if code {
            continue;
        }
        let marks = line.chars().take_while(|c| *c == '#').count();
        if (1..DEEPEST).contains(&marks) && line[marks..].starts_with(' ') {
            level = marks;
            served.retain(|l| *l < level);
        }
        if line.starts_with("*Measured:") {
            served.push(level);
            faults.extend(fault(line).map(|f| format!("line {}: {f}", i + 1)));
        }
        let begins = line.starts_with('|') && (i == 0 || !lines[i - 1].starts_with('|'));
        if begins {
            let length = lines[i..].iter().take_while(|l| l.starts_with('|')).count();
            let above = lines[..i].iter().rev().find(|l| !l.trim().is_empty());
            if is_measured(&lines[i..i + length]) && above != Some(&SETTINGS) {
                n_tables += 1;
                if served.is_empty() {
                    faults.push(format!(
                        "line {}: a measured table without a line `*Measured: ...*`",
                        i + 1
                    ));
                }
            }
        }
    }
    (faults, n_tables)
}

#[test]
fn docs_say_what_tables_were_measured_with() {
    let (mut wrong, mut n_tables) = (Vec::new(), 0);
    for (path, text) in pages() {
        let (faults, n) = faults(&text);
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        wrong.extend(faults.into_iter().map(|f| format!("{name}, {f}")));
        n_tables += n;
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(n_tables > 30, "only {n_tables} measured tables found");
}

#[test]
fn stale_and_nameless_tables_are_found() {
    let [(_, rods), (_, nematics), _] = VERSIONS;
    let now = format!("*Measured: commit 737adad, rods {rods}; `cargo xtask accuracy`.*");
    let table = "| | t50 | t99 |\n|---|---|---|\n| 3_1 | 2.068 | +0.8 % |\n";
    let n_faults = |page: &str| faults(page).0.len();
    assert_eq!(
        faults(table),
        (
            vec!["line 1: a measured table without a line `*Measured: ...*`".to_owned()],
            1
        )
    );
    assert_eq!(n_faults(&format!("# A\n{now}\n## B\n{table}")), 0);
    assert_eq!(n_faults(&format!("# A\n## B\n{now}\n## C\n{table}")), 1);
    assert_eq!(n_faults(&format!("{SETTINGS}\n{table}")), 0);
    assert_eq!(faults("| a | b |\n|---|---|\n| x | y |\n"), (vec![], 0));
    let behind = format!(
        "*Measured: commit 737adad, rods {rods}, nematics {}; `cargo xtask figures`",
        nematics - 1
    );
    assert!(fault(&format!("{behind}.*")).unwrap().contains("moved on"));
    assert_eq!(
        fault(&format!("{behind}; older: the colloids are as they were.*")),
        None
    );
    assert!(
        fault(&now.replace(".*", "; older: for no reason.*"))
            .unwrap()
            .contains("older")
    );
    for broken in [
        now.replace("737adad", "today"),
        now.replace(&format!("rods {rods}"), &format!("rods {}", rods + 1)),
        now.replace(&format!(", rods {rods}"), ""),
        now.replace("`cargo xtask accuracy`", ""),
    ] {
        assert!(fault(&broken).is_some(), "{broken}");
    }
}
