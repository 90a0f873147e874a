//! Rows of numbers into components, and into frames where the rows hold several.

use std::collections::HashSet;
use std::path::Path;

use super::cells::{NumberFault, is_missing, number, split};
use super::columns::Columns;
use super::fault::{fault_at, quoted};
use super::{CurveComponent, FrameOf};
use crate::{KnotError, V};

/// A line of a table; an empty one ends a component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line<'a> {
    pub number: usize,
    pub text: &'a str,
}

impl Line<'_> {
    /// Whether the line ends a component: blank, or a mark that programs write between chains.
    pub(super) fn is_break(&self) -> bool {
        matches!(self.text, "" | "X" | "TER" | "&" | ">")
    }
}

/// Reads the frames in a table whose columns are known or to be found from the rows.
pub(super) fn frames(
    path: &Path,
    lines: &[Line],
    header: Option<Columns>,
    label: Option<String>,
    notes: &mut Vec<String>,
) -> Result<Vec<FrameOf>, KnotError> {
    let rows = Rows::new(lines);
    let Some(first) = rows.lines.first() else {
        return Ok(Vec::new());
    };
    let mut columns = match header {
        Some(columns) => columns,
        None => Columns::nameless(&rows.cells).map_err(|problem| {
            let problem = decimal_comma(first.text, 3).unwrap_or(problem);
            fault_at(path, first.number, &problem)
        })?,
    };
    rows.check_count(path, columns.n)?;
    rows.drop_parameters(&mut columns);
    rows.refuse_hidden_components(path, &columns)?;
    notes.extend(columns.note.take());
    if !columns.further.is_empty() && !columns.names.is_empty() {
        let names: Vec<String> = columns.further.iter().map(|k| columns.name(*k)).collect();
        notes.push(format!(
            "besides x, y, z there are {}, which move no vertex",
            names.join(", ")
        ));
    }
    rows.group(path, &columns, label)
}

/// The rows of a table, cut into cells.
struct Rows<'a> {
    lines: Vec<Line<'a>>,
    cells: Vec<Vec<&'a str>>,
    /// Whether a row is the first after a break.
    starts: Vec<bool>,
}

impl<'a> Rows<'a> {
    fn new(lines: &[Line<'a>]) -> Self {
        let mut rows = Self {
            lines: Vec::new(),
            cells: Vec::new(),
            starts: Vec::new(),
        };
        let mut buffer = Vec::new();
        let mut start = true;
        for line in lines {
            if line.is_break() {
                start = true;
                continue;
            }
            split(line.text, &mut buffer);
            if buffer.iter().all(|cell| is_missing(cell)) {
                start = true;
                continue;
            }
            rows.lines.push(*line);
            rows.cells.push(buffer.clone());
            rows.starts.push(start);
            start = false;
        }
        rows
    }

    fn check_count(&self, path: &Path, n: usize) -> Result<(), KnotError> {
        let mut rows = self.lines.iter().zip(&self.cells);
        let Some((line, cells)) = rows.find(|(_, cells)| cells.len() != n) else {
            return Ok(());
        };
        let problem = decimal_comma(line.text, n).unwrap_or_else(|| {
            format!(
                "{} columns instead of {n}: {}",
                cells.len(),
                quoted(line.text)
            )
        });
        Err(fault_at(path, line.number, &problem))
    }

    /// Takes columns for frames or components whose value is another in every row for what they are: parameters along the curve.
    fn drop_parameters(&self, columns: &mut Columns) {
        let repeats = |column: &usize| {
            self.cells
                .windows(2)
                .any(|pair| pair[0][*column] == pair[1][*column])
        };
        let told = columns.frames.iter().copied().chain(columns.component);
        let parameters: Vec<usize> = told.filter(|column| !repeats(column)).collect();
        columns.frames.retain(|column| !parameters.contains(column));
        columns.component = columns
            .component
            .filter(|column| !parameters.contains(column));
        columns.further.extend(parameters);
        columns.further.sort_unstable();
    }

    /// Refuses a further column that divides the rows into few blocks as a component would, under a name that does not tell.
    fn refuse_hidden_components(&self, path: &Path, columns: &Columns) -> Result<(), KnotError> {
        for &column in &columns.further {
            if let Some(row) = self.second_block(column) {
                let (name, value) = (columns.name(column), quoted(self.cells[row][column]));
                return Err(fault_at(
                    path,
                    self.lines[row].number,
                    &format!(
                        "column {name} turns to {value} here: if it tells components name it `component`, if it tells times `frame`, else leave it out"
                    ),
                ));
            }
        }
        Ok(())
    }

    /// The row where the second block of equal cells begins, if the column is made of such blocks, each of three rows or more and of
    /// another value.
    fn second_block(&self, column: usize) -> Option<usize> {
        let cell = |row: usize| self.cells[row][column];
        let mut values = HashSet::new();
        let (mut start, mut second) = (0, None);
        for row in 1..=self.cells.len() {
            if row < self.cells.len() && cell(row) == cell(start) {
                continue;
            }
            if row - start < 3 || !values.insert(cell(start)) {
                return None;
            }
            start = row;
            second = second.or((row < self.cells.len()).then_some(row));
        }
        second
    }

    fn group(
        &self,
        path: &Path,
        columns: &Columns,
        label: Option<String>,
    ) -> Result<Vec<FrameOf>, KnotError> {
        let mut frames: Vec<(Vec<&str>, FrameOf)> = Vec::new();
        let mut names: Vec<&str> = Vec::new();
        let mut broken = true;
        for (row, line) in self.lines.iter().enumerate() {
            let cells = &self.cells[row];
            let Some(vertex) = vertex(path, *line, cells, columns)? else {
                broken = true;
                continue;
            };
            let key: Vec<&str> = columns.frames.iter().map(|k| cells[*k]).collect();
            if frames.last().is_none_or(|(own, _)| *own != key) {
                self.refuse_return(
                    path,
                    row,
                    frames.iter().any(|(own, _)| *own == key),
                    "frame",
                )?;
                let label = frame_label(columns, &key).or_else(|| label.clone());
                frames.push((
                    key,
                    FrameOf {
                        label,
                        components: Vec::new(),
                    },
                ));
                names.clear();
                broken = true;
            }
            let name = columns.component.map_or("", |k| cells[k]);
            let is_new = names.last().is_none_or(|own| *own != name);
            if is_new {
                self.refuse_return(path, row, names.contains(&name), "component")?;
                names.push(name);
            }
            let closed = closed(path, *line, cells, columns)?;
            let Some((_, frame)) = frames.last_mut() else {
                continue;
            };
            if is_new || broken || self.starts[row] {
                frame
                    .components
                    .push(CurveComponent::new(Vec::new(), closed));
            }
            broken = false;
            if let Some(component) = frame.components.last_mut() {
                if component.closed != closed {
                    return Err(fault_at(
                        path,
                        line.number,
                        "`closed` changes within a component",
                    ));
                }
                component.vertices.push(vertex);
            }
        }
        Ok(frames.into_iter().map(|(_, frame)| frame).collect())
    }

    /// Refuses rows of a frame or component that ended before: joined to it they would make another curve.
    fn refuse_return(
        &self,
        path: &Path,
        row: usize,
        known: bool,
        what: &str,
    ) -> Result<(), KnotError> {
        if !known {
            return Ok(());
        }
        let problem = format!("a {what} goes on here that ended before; sort the rows by {what}");
        Err(fault_at(path, self.lines[row].number, &problem))
    }
}

/// The vertex of a row; none for a row of three missing numbers, which ends a component.
fn vertex(
    path: &Path,
    line: Line,
    cells: &[&str],
    columns: &Columns,
) -> Result<Option<V>, KnotError> {
    let mut x = V::zeros();
    for (k, column) in columns.xyz.iter().enumerate() {
        match number(cells[*column]) {
            Ok(value) => x[k] = value,
            Err(_) if columns.xyz.iter().all(|k| is_missing(cells[*k])) => return Ok(None),
            Err(problem) => {
                let problem = format!(
                    "{}: {}",
                    ["x", "y", "z"][k],
                    problem.message(cells[*column])
                );
                return Err(fault_at(path, line.number, &problem));
            }
        }
    }
    Ok(Some(x))
}

fn closed(
    path: &Path,
    line: Line,
    cells: &[&str],
    columns: &Columns,
) -> Result<Option<bool>, KnotError> {
    let Some(column) = columns.closed else {
        return Ok(None);
    };
    match cells[column].to_ascii_lowercase().as_str() {
        "true" | "1" => Ok(Some(true)),
        "false" | "0" => Ok(Some(false)),
        "" => Ok(None),
        _ => Err(fault_at(
            path,
            line.number,
            &format!("`closed` is {}; give true or false", quoted(cells[column])),
        )),
    }
}

fn frame_label(columns: &Columns, key: &[&str]) -> Option<String> {
    let name = |k: usize| columns.names.get(k).map_or("frame", String::as_str);
    let parts: Vec<String> = columns
        .frames
        .iter()
        .zip(key)
        .map(|(k, value)| {
            let value = if value.is_empty() { "(empty)" } else { *value };
            format!("{} {value}", name(*k))
        })
        .collect();
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// What to say of a row of `n` numbers whose commas are decimal marks.
fn decimal_comma(row: &str, n: usize) -> Option<String> {
    let words: Vec<&str> = row.split_whitespace().collect();
    let is_number =
        |word: &&str| word.contains(',') && word.replacen(',', ".", 1).parse::<f64>().is_ok();
    let parted_by_blanks = words.len() >= n && words.iter().all(|word| is_number(&word));
    let cells = row.split(',').count();
    if parted_by_blanks {
        return Some(NumberFault::DecimalComma.message(words[0]));
    }
    (!row.contains(';') && words.len() == 1 && cells == 2 * n).then(|| {
        format!("{cells} columns instead of {n}: {}; if the commas are decimal marks, write decimal points", quoted(row))
    })
}
