//! What a folder of results holds: the rows of its table, and which settings are swept in them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::data::read_csv;
use crate::error::ViewError;
use crate::guide::{Guide, Kind, Setting};
use crate::plot::text::significant;
use topo_lab::FailedCase;

/// A row of `sweep.csv`, by column.
#[derive(Debug, Clone, Default)]
pub struct Row(BTreeMap<String, String>);

impl Row {
    /// What stands in a column; empty where there is nothing.
    pub fn text(&self, column: &str) -> &str {
        self.0.get(column).map_or("", String::as_str)
    }

    /// The number in a column, where there is one.
    pub fn number(&self, column: &str) -> Option<f64> {
        let value: f64 = self.text(column).parse().ok()?;
        value.is_finite().then_some(value)
    }

    /// Its case: the folder beside the table.
    pub fn case(&self) -> &str {
        self.text("case")
    }
}

/// The cases of one sweep.
#[derive(Debug)]
pub struct Cases {
    /// Folder of the sweep.
    pub folder: PathBuf,
    /// What its columns are.
    pub guide: Guide,
    /// Rows of all finished cases.
    pub rows: Vec<Row>,
    /// The settings that take several values, in the order of the guide.
    pub swept: Vec<Swept>,
    /// Cases that failed, and why.
    pub failed: Vec<FailedCase>,
    /// Cases that were begun and are not finished.
    pub unfinished: Vec<String>,
    /// Cases of the table whose folders are gone.
    pub lost: Vec<String>,
}

/// A setting that takes several values.
#[derive(Debug, Clone)]
pub struct Swept {
    /// Which.
    pub setting: Setting,
    /// Its values: numbers by size, names in the order of the table.
    pub values: Vec<String>,
    /// Whether all of them are numbers that belong on an axis.
    pub is_numeric: bool,
}

impl Swept {
    /// A value as legends write it, with its symbol.
    pub fn say(&self, value: &str) -> String {
        say(&self.setting, value)
    }

    /// Place of a row's value among the values.
    pub fn place(&self, row: &Row) -> Option<usize> {
        let value = canonical(row.text(self.setting.column));
        self.values.iter().position(|v| *v == value)
    }
}

/// A value of a setting as legends write it.
fn say(setting: &Setting, value: &str) -> String {
    match (setting.kind, value.parse::<f64>()) {
        (_, _) if value.is_empty() => format!("no {}", setting.label),
        (Kind::Number, Ok(x)) => format!("{} = {}", setting.symbol, significant(x, 4)),
        (Kind::Number, Err(_)) => format!("{} = {value}", setting.symbol),
        (Kind::Name(words), _) => words(value),
    }
}

/// One spelling for each number.
fn canonical(text: &str) -> String {
    text.parse::<f64>()
        .map_or_else(|_| text.to_owned(), |x| x.to_string())
}

impl Cases {
    /// Reads a folder: its table, and what finished cases say that are not in it, as while a run is in progress.
    ///
    /// # Errors
    /// A table that cannot be read.
    pub fn read(folder: &Path, guide: Guide) -> Result<Self, ViewError> {
        let table = folder.join("sweep.csv");
        let mut rows = if table.exists() {
            let read: Vec<BTreeMap<String, String>> = read_csv(&table)?;
            read.into_iter().map(Row).collect()
        } else {
            Vec::new()
        };
        let known: BTreeSet<String> = rows.iter().map(|r: &Row| r.case().to_owned()).collect();
        let mut unfinished = Vec::new();
        for place in folders(folder) {
            let name = file_name(&place);
            let is_begun = place.join("run.json").exists();
            if !is_begun && !has_checkpoint(&place) {
                continue;
            }
            if known.contains(&name) {
                continue;
            }
            match rows_of(&place) {
                Some(found) => rows.extend(found),
                None => unfinished.push(name),
            }
        }
        let failed = folder.join("failed.csv");
        let failed: Vec<FailedCase> = if failed.exists() {
            read_csv(&failed)?
        } else {
            Vec::new()
        };
        let is_lost = |name: &String| !folder.join(name).is_dir();
        let lost = known.into_iter().filter(is_lost).collect();
        let swept = swept(&guide, &rows);
        Ok(Self {
            folder: folder.to_owned(),
            guide,
            rows,
            swept,
            failed,
            unfinished,
            lost,
        })
    }

    /// Folder of a row's case.
    pub fn case_folder(&self, row: &Row) -> PathBuf {
        self.folder.join(row.case())
    }

    /// What tells a row from the others, as legends write it.
    pub fn label(&self, row: &Row) -> String {
        let words = self.swept.iter().filter(|s| !s.values.is_empty());
        let words: Vec<String> = words.map(|s| s.say(row.text(s.setting.column))).collect();
        words.join(", ")
    }

    /// The rows with the first of each case only.
    pub fn first_rows(&self) -> Vec<&Row> {
        let mut seen = BTreeSet::new();
        self.rows.iter().filter(|r| seen.insert(r.case())).collect()
    }

    /// The settings that all cases share, as sentences say them: those of the guide that are there and not swept.
    pub fn shared(&self) -> Vec<String> {
        let Some(first) = self.rows.first() else {
            return Vec::new();
        };
        let is_swept = |s: &&Setting| self.swept.iter().all(|w| w.setting.column != s.column);
        let settings = self.guide.settings.iter().filter(|s| !s.follows);
        settings
            .filter(is_swept)
            .filter(|s| !first.text(s.column).is_empty())
            .map(|s| say(s, first.text(s.column)))
            .collect()
    }
}

/// Folders below a folder, by name.
pub(crate) fn folders(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<PathBuf> = entries.map(|e| e.path()).filter(|p| p.is_dir()).collect();
    found.sort();
    found
}

/// Whether a case was begun and can be gone on with.
pub(crate) fn has_checkpoint(case: &Path) -> bool {
    let entries = std::fs::read_dir(case).into_iter().flatten().flatten();
    let mut paths = entries.map(|e| e.path());
    paths.any(|p| p.extension().is_some_and(|e| e == "checkpoint"))
}

pub(crate) fn file_name(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |n| n.to_string_lossy().into_owned())
}

/// The rows that a finished case says it has.
fn rows_of(case: &Path) -> Option<Vec<Row>> {
    let text = std::fs::read_to_string(case.join("run.json")).ok()?;
    let run: Value = serde_json::from_str(&text).ok()?;
    let rows = run["rows"].as_array().filter(|rows| !rows.is_empty())?;
    let cell = |value: &Value| match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let row = |value: &Value| {
        let cells = value.as_object()?.iter();
        let mut cells: BTreeMap<String, String> =
            cells.map(|(k, v)| (k.clone(), cell(v))).collect();
        cells.insert("case".to_owned(), file_name(case));
        Some(Row(cells))
    };
    rows.iter().map(row).collect()
}

/// The settings that take several values.
fn swept(guide: &Guide, rows: &[Row]) -> Vec<Swept> {
    let mut found: Vec<Swept> = Vec::new();
    let (leading, following): (Vec<Setting>, Vec<Setting>) =
        guide.settings.iter().partition(|s| !s.follows);
    for setting in leading.into_iter().chain(following) {
        let Some(values) = values(&setting, rows) else {
            continue;
        };
        if setting.follows && !found.is_empty() && !is_grid(&setting, &found, rows) {
            continue;
        }
        let is_numeric =
            matches!(setting.kind, Kind::Number) && values.iter().all(|v| v.parse::<f64>().is_ok());
        found.push(Swept {
            setting,
            values,
            is_numeric,
        });
    }
    found
}

/// The values of a setting, if there are several.
fn values(setting: &Setting, rows: &[Row]) -> Option<Vec<String>> {
    let mut values: Vec<String> = Vec::new();
    for row in rows {
        let value = canonical(row.text(setting.column));
        if !values.contains(&value) {
            values.push(value);
        }
    }
    if matches!(setting.kind, Kind::Number) {
        let number = |v: &String| v.parse::<f64>().unwrap_or(f64::NEG_INFINITY);
        values.sort_by(|a, b| number(a).total_cmp(&number(b)));
    }
    (values.len() > 1).then_some(values)
}

/// Whether a setting takes the same several values whatever the other settings are.
fn is_grid(setting: &Setting, others: &[Swept], rows: &[Row]) -> bool {
    let mut by_others: BTreeMap<Vec<Option<usize>>, BTreeSet<String>> = BTreeMap::new();
    for row in rows {
        let key = others.iter().map(|s| s.place(row)).collect();
        let value = canonical(row.text(setting.column));
        by_others.entry(key).or_default().insert(value);
    }
    let mut sets = by_others.values();
    sets.next()
        .is_some_and(|first| first.len() > 1 && sets.all(|set| set == first))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guide::{Curve, name};

    const SETTINGS: [Setting; 4] = [
        Setting::name("kind", "Kind", name),
        Setting::number("load", "*F*", "Load *F*"),
        Setting::number("size", "*R*", "Size *R*"),
        Setting::number("place", "*s*", "Place *s*").following(),
    ];

    fn swept_of(text: &str) -> Vec<(String, Vec<String>, bool)> {
        let curve = Curve {
            file: "series.csv",
            time: "time",
            time_label: "Time",
            energy: "energy",
            full: "energy",
            empty: None,
            of: None,
        };
        let guide = Guide {
            settings: &SETTINGS,
            results: &[],
            curve,
            parts: &[],
        };
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let rows: Vec<Row> = reader.deserialize().map(|r| Row(r.unwrap())).collect();
        let found = swept(&guide, &rows).into_iter();
        found
            .map(|s| (s.setting.column.to_owned(), s.values, s.is_numeric))
            .collect()
    }

    fn columns(text: &str) -> Vec<String> {
        swept_of(text).into_iter().map(|s| s.0).collect()
    }

    #[test]
    fn settings_with_several_values_are_swept() {
        let found = swept_of("kind,load,size\na,10,1\nb,9.5,1\na,9.50,1.0\n");
        let strings = |list: &[&str]| list.iter().map(|s| (*s).to_owned()).collect::<Vec<_>>();
        assert_eq!(
            found,
            [
                ("kind".to_owned(), strings(&["a", "b"]), false),
                // by size, each number once however it is written
                ("load".to_owned(), strings(&["9.5", "10"]), true),
            ]
        );
    }

    #[test]
    fn what_follows_from_other_settings_is_not_swept() {
        // a place for each load, and two for one of them
        assert_eq!(columns("load,place\n1,0.1\n2,0.2\n2,0.3\n"), ["load"]);
        // the same places for each load, and places alone
        let grid = "load,place\n1,0.1\n1,0.2\n2,0.1\n2,0.2\n";
        assert_eq!(columns(grid), ["load", "place"]);
        assert_eq!(columns("load,place\n1,0.1\n1,0.2\n"), ["place"]);
    }
}
