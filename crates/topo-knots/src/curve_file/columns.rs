//! Which columns of a table are the coordinates, and what the others are.

use std::path::Path;

use super::cells::{number, split};
use super::fault::{fault_at, quoted};
use super::rows::Rows;
use crate::KnotError;

/// Names of columns that are the same all along a curve at one time.
const FRAMES: [&str; 6] = ["frame", "time", "step", "timestep", "snapshot", "cut"];
/// Names of columns that mark the components of a link.
const COMPONENTS: [&str; 12] = [
    "component",
    "line",
    "curve",
    "chain",
    "chainid",
    "chain_id",
    "strand",
    "molecule",
    "mol",
    "polymer",
    "loop",
    "filament",
];
/// Most columns that are tried for an index; beyond, names are asked for.
const WITH_INDEX: usize = 4;

/// The columns of a table.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Columns {
    /// How many there are.
    pub n: usize,
    /// Where x, y and z are.
    pub xyz: [usize; 3],
    /// Columns that mark frames.
    pub frames: Vec<usize>,
    /// The column that marks components.
    pub component: Option<usize>,
    /// The column that says whether a component is closed.
    pub closed: Option<usize>,
    /// The others, none of which moves a vertex.
    pub further: Vec<usize>,
    /// Names, as many as columns; empty if the file gives none.
    pub names: Vec<String>,
    /// What was concluded about columns without names.
    pub note: Option<String>,
}

impl Columns {
    /// Treats columns for frames or components whose value changes in every row as what they are: parameters along the curve.
    pub(super) fn drop_parameters(&mut self, rows: &Rows) {
        let repeats = |column: usize| {
            rows.column(column)
                .zip(rows.column(column).skip(1))
                .any(|(a, b)| a == b)
        };
        let named = self.frames.iter().copied().chain(self.component);
        let parameters: Vec<usize> = named.filter(|column| !repeats(*column)).collect();
        let stays = |column: &usize| !parameters.contains(column);
        self.frames.retain(stays);
        self.component = self.component.filter(stays);
        self.further.extend(parameters);
        self.further.sort_unstable();
    }

    /// Refuses a further column that divides the rows into few blocks, as a component would, if its name does not explain it.
    pub(super) fn refuse_hidden_components(
        &self,
        path: &Path,
        rows: &Rows,
    ) -> Result<(), KnotError> {
        for &column in &self.further {
            let Some(row) = rows.second_block(column) else {
                continue;
            };
            let name = self.name(column);
            let value = rows
                .column(column)
                .nth(row)
                .map_or_else(String::new, quoted);
            let number = rows.iter().nth(row).map_or(0, |line| line.number);
            let problem = format!(
                "column {name} turns to {value} here: if it tells components name it `component`, if it tells times `frame`, else leave it out"
            );
            return Err(fault_at(path, number, &problem));
        }
        Ok(())
    }

    /// The name of a column, or its number from 1.
    pub(super) fn name(&self, column: usize) -> String {
        let name = self.names.get(column).filter(|name| !name.is_empty());
        name.map_or_else(|| format!("{}", column + 1), |name| quoted(name))
    }

    /// The columns that a header names; none if it names neither x nor y nor z.
    ///
    /// # Errors
    /// Some of the three names are missing or there twice.
    pub(super) fn named(names: Vec<String>) -> Result<Option<Self>, String> {
        let places =
            |name: &str| -> Vec<usize> { (0..names.len()).filter(|k| names[*k] == name).collect() };
        let found = ["x", "y", "z"].map(places);
        if found.iter().all(Vec::is_empty) {
            return Ok(None);
        }
        let [[x], [y], [z]] = [&found[0][..], &found[1][..], &found[2][..]] else {
            return Err(format!(
                "the header must name the columns x, y and z, each once; it is {}",
                quoted(&names.join(","))
            ));
        };
        let is = |known: &[&str], k: &usize| known.contains(&names[*k].as_str());
        let component = (0..names.len()).find(|k| is(&COMPONENTS, k));
        let closed = (0..names.len()).find(|k| is(&["closed"], k));
        let frames = (0..names.len())
            .filter(|k| is(&FRAMES, k))
            .collect::<Vec<_>>();
        let taken = [*x, *y, *z].into_iter().chain(component).chain(closed);
        let taken: Vec<usize> = taken.chain(frames.iter().copied()).collect();
        Ok(Some(Self {
            n: names.len(),
            xyz: [*x, *y, *z],
            component,
            closed,
            further: (0..names.len()).filter(|k| !taken.contains(k)).collect(),
            frames,
            names,
            note: None,
        }))
    }

    /// The columns of a table without names, from its rows.
    ///
    /// Three are the coordinates; four are, if one of them counts the rows; after a first column of names, as in molecular files, the next three are.
    ///
    /// # Errors
    /// It is unclear which are the coordinates.
    pub(super) fn nameless(first: &str, rows: &Rows) -> Result<Self, String> {
        let mut cells = Vec::new();
        split(first, &mut cells);
        let n = cells.len();
        // A line of text has at least one cell.
        let start = cells.first().copied().unwrap_or("");
        let columns = |start: usize, note: Option<String>| Self {
            n,
            xyz: [start, start + 1, start + 2],
            further: (0..n).filter(|k| !(start..start + 3).contains(k)).collect(),
            note,
            ..Self::default()
        };
        let is_text = number(start).is_err() && start.starts_with(char::is_alphabetic);
        let remedy =
            "give three columns, or name the columns in a first line such as `# x y z energy`";
        match n {
            0..3 => Err(format!("{n} numbers instead of 3; {remedy}")),
            3 => Ok(columns(0, None)),
            _ if is_text && !rows.counts(1) => {
                let note = format!(
                    "columns 5 to {n} have no name and were taken for values, not coordinates"
                );
                Ok(columns(1, (n > 4).then_some(note)))
            }
            WITH_INDEX if !is_text => match [rows.counts(0), rows.counts(n - 1)] {
                [true, false] => Ok(columns(
                    1,
                    Some("column 1 counts the vertices and was taken for their index".to_owned()),
                )),
                [false, true] => Ok(columns(
                    0,
                    Some("column 4 counts the vertices and was taken for their index".to_owned()),
                )),
                _ => Err(format!(
                    "{n} numbers instead of 3, and no name tells which are x, y and z; {remedy}"
                )),
            },
            _ => Err(format!(
                "{n} columns instead of 3, and no name tells which are x, y and z; {remedy}"
            )),
        }
    }
}

/// The names in a header: lower case, without quotes and units in brackets.
pub(super) fn header_names(header: &str) -> Vec<String> {
    let mut cells = Vec::new();
    split(header, &mut cells);
    // Between blanks a unit is a cell of its own.
    let is_unit = |cell: &&&str| cell.starts_with(['[', '(']);
    cells
        .iter()
        .filter(|cell| !is_unit(cell))
        .map(|cell| name(cell))
        .collect()
}

fn name(cell: &str) -> String {
    let end = cell.find(['[', '(']).unwrap_or(cell.len());
    cell[..end].trim().to_ascii_lowercase()
}

/// The names that the title of an extended XYZ file gives with `Properties=species:S:1:pos:R:3`.
pub(super) fn extended_names(title: &str) -> Option<Vec<String>> {
    let start = title.find("Properties=")? + "Properties=".len();
    let list = title[start..].trim_start_matches('"');
    let list = list.split(|c: char| c.is_whitespace() || c == '"').next()?;
    let parts: Vec<&str> = list.split(':').collect();
    let (triples, rest) = parts.as_chunks::<3>();
    let mut names = Vec::new();
    for [name, _, n] in triples {
        // More columns than a line of text has letters are none.
        let n: usize = n.parse().ok().filter(|n| *n <= title.len())?;
        if *name == "pos" && n == 3 {
            names.extend(["x", "y", "z"].map(str::to_owned));
        } else {
            names.extend((1..=n).map(|k| format!("{name}_{k}")));
        }
    }
    (rest.is_empty() && !names.is_empty()).then_some(names)
}
