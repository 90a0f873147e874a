//! Rows of numbers into components, and into frames where the rows hold several.

use std::path::Path;

use super::cells::{NumberFault, is_missing, number, split};
use super::columns::Columns;
use super::component::{CurveComponent, FrameOf};
use super::fault::{fault_at, quoted};
use super::rows::{Line, Rows};
use crate::{KnotError, V};

/// Reads the frames in a table whose columns are known or to be found from the rows.
pub(super) fn frames(
    path: &Path,
    lines: &[Line],
    header: Option<Columns>,
    label: Option<String>,
    notes: &mut Vec<String>,
) -> Result<Vec<FrameOf>, KnotError> {
    let rows = Rows(lines);
    let Some(first) = rows.iter().next() else {
        return Ok(Vec::new());
    };
    let mut columns = match header {
        Some(columns) => columns,
        None => Columns::nameless(first.text, &rows).map_err(|problem| {
            let problem = decimal_comma(first.text, 3).unwrap_or(problem);
            fault_at(path, first.number, &problem)
        })?,
    };
    columns.drop_parameters(&rows);
    columns.refuse_hidden_components(path, &rows)?;
    notes.extend(columns.note.take());
    if !columns.further.is_empty() && !columns.names.is_empty() {
        let names: Vec<String> = columns.further.iter().map(|k| columns.name(*k)).collect();
        notes.push(format!(
            "further columns, no coordinates: {}",
            names.join(", ")
        ));
    }
    let mut groups = Groups::new(path, &columns, label);
    let mut cells = Vec::new();
    for line in lines {
        groups.take(line, &mut cells)?;
    }
    Ok(groups.frames)
}

/// Frames and components as they grow row by row.
struct Groups<'a> {
    path: &'a Path,
    columns: &'a Columns,
    label: Option<String>,
    frames: Vec<FrameOf>,
    /// The cells that mark each frame.
    keys: Vec<Vec<&'a str>>,
    /// The cells that mark the components of the last frame.
    names: Vec<&'a str>,
    /// Whether the next row starts a component.
    starts: bool,
}

impl<'a> Groups<'a> {
    fn new(path: &'a Path, columns: &'a Columns, label: Option<String>) -> Self {
        Self {
            path,
            columns,
            label,
            frames: Vec::new(),
            keys: Vec::new(),
            names: Vec::new(),
            starts: true,
        }
    }

    /// Takes a line up; `cells` is kept between calls.
    fn take(&mut self, line: &Line<'a>, cells: &mut Vec<&'a str>) -> Result<(), KnotError> {
        if line.is_break() {
            self.starts = true;
            return Ok(());
        }
        let columns = self.columns;
        split(line.text, cells);
        if cells.len() != columns.n {
            let problem = decimal_comma(line.text, columns.n).unwrap_or_else(|| {
                let (found, n) = (cells.len(), columns.n);
                format!("{found} columns instead of {n}: {}", quoted(line.text))
            });
            return Err(self.fault(line, &problem));
        }
        let Some(vertex) = vertex(self.path, line, cells, columns)? else {
            self.starts = true;
            return Ok(());
        };
        self.enter_frame(line, cells)?;
        self.enter_component(line, cells)?;
        let closed = closed(self.path, line, cells, columns)?;
        let Some(frame) = self.frames.last_mut() else {
            return Ok(());
        };
        match frame.components.last_mut() {
            Some(component) if !self.starts => {
                if component.closed != closed {
                    return Err(self.fault(line, "`closed` changes within a component"));
                }
                component.vertices.push(vertex);
            }
            _ => frame
                .components
                .push(CurveComponent::new(vec![vertex], closed)),
        }
        self.starts = false;
        Ok(())
    }

    /// Starts a frame if the row is of another than the one before.
    fn enter_frame(&mut self, line: &Line<'a>, cells: &[&'a str]) -> Result<(), KnotError> {
        let columns = &self.columns.frames;
        let is_same = |key: &Vec<&str>| columns.iter().zip(key).all(|(k, own)| cells[*k] == *own);
        if self.keys.last().is_some_and(is_same) {
            return Ok(());
        }
        if self.keys.iter().any(is_same) {
            return Err(self.goes_on(line, "frame"));
        }
        let key: Vec<&str> = columns.iter().map(|k| cells[*k]).collect();
        let label = frame_label(self.columns, &key).or_else(|| self.label.clone());
        let components = Vec::new();
        self.frames.push(FrameOf { label, components });
        self.keys.push(key);
        self.names.clear();
        Ok(())
    }

    /// Starts a component if the row is of another than the one before.
    fn enter_component(&mut self, line: &Line<'a>, cells: &[&'a str]) -> Result<(), KnotError> {
        let name = self.columns.component.map_or("", |k| cells[k]);
        if self.names.last() == Some(&name) {
            return Ok(());
        }
        if self.names.contains(&name) {
            return Err(self.goes_on(line, "component"));
        }
        self.names.push(name);
        self.starts = true;
        Ok(())
    }

    /// Rows of a frame or component that ended before: joined to it they would make another curve.
    fn goes_on(&self, line: &Line, what: &str) -> KnotError {
        let problem = format!("a {what} goes on here that ended before; sort the rows by {what}");
        self.fault(line, &problem)
    }

    fn fault(&self, line: &Line, problem: &str) -> KnotError {
        fault_at(self.path, line.number, problem)
    }
}

/// The vertex of a row; none for a row of three missing numbers, which ends a component.
fn vertex(
    path: &Path,
    line: &Line,
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
    line: &Line,
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
    let parted_by_blanks = words.len() >= n && words.iter().all(is_number);
    let cells = row.split(',').count();
    if parted_by_blanks {
        return Some(NumberFault::DecimalComma.message(words[0]));
    }
    (!row.contains(';') && words.len() == 1 && cells == 2 * n).then(|| {
        format!("{cells} columns instead of {n}: {}; if the commas are decimal marks, write decimal points", quoted(row))
    })
}
