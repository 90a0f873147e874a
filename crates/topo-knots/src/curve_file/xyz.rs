//! Tables of numbers, with or without a header: comma-separated values, and XYZ plain or molecular.

use std::path::Path;

use super::cells::{is_missing, number, split};
use super::columns::{Columns, extended_names, header_names};
use super::component::FrameOf;
use super::fault::{fault_at, quoted};
use super::rows::Line;
use super::table::frames;
use super::text;
use crate::KnotError;

/// Characters of a title that are kept as the name of a frame.
const LONGEST_LABEL: usize = 60;

/// The frames of comma-separated values.
pub(super) fn csv(
    path: &Path,
    text: &str,
    notes: &mut Vec<String>,
) -> Result<Vec<FrameOf>, KnotError> {
    plain(path, trimmed(text), notes)
}

/// The frames of an XYZ file: molecular if it begins with a count, else plain.
pub(super) fn xyz(
    path: &Path,
    text: &str,
    notes: &mut Vec<String>,
) -> Result<Vec<FrameOf>, KnotError> {
    let lines = trimmed(text);
    let start = lines
        .iter()
        .position(|line| !is_comment(line) && !line.text.is_empty());
    match start {
        Some(start) if count(lines[start].text).is_some() => molecular(path, &lines, start, notes),
        _ => plain(path, lines, notes),
    }
}

/// All lines, without blanks and the end mark of old editors.
fn trimmed(text: &str) -> Vec<Line<'_>> {
    let trim = |line: &str| line.len() - line.trim_end_matches('\u{1a}').len();
    text::lines(text)
        .map(|(number, line)| Line {
            number,
            text: line[..line.len() - trim(line)].trim(),
        })
        .collect()
}

fn is_comment(line: &Line) -> bool {
    line.text.starts_with(['#', '%'])
}

fn count(text: &str) -> Option<usize> {
    text.parse().ok()
}

/// A row without the comment at its end.
fn uncommented<'a>(line: &Line<'a>) -> Line<'a> {
    let text = line.text.split('#').next().unwrap_or("").trim();
    Line { text, ..*line }
}

/// One table, with a header in a comment, in its first row, or none.
fn plain(
    path: &Path,
    mut lines: Vec<Line>,
    notes: &mut Vec<String>,
) -> Result<Vec<FrameOf>, KnotError> {
    let is_row = |line: &Line| !is_comment(line) && !line.is_break();
    let Some(first) = lines.iter().position(is_row) else {
        return Ok(Vec::new());
    };
    let row = uncommented(&lines[first]);
    let mut cells = Vec::new();
    split(row.text, &mut cells);
    // The index column of a written data frame has an empty name.
    let is_header = cells.iter().any(|cell| !is_missing(cell))
        && !cells.iter().any(|cell| number(cell).is_ok());
    let header = if is_header {
        let columns = Columns::named(header_names(row.text));
        let columns = columns.map_err(|problem| fault_at(path, row.number, &problem))?;
        Some(columns.ok_or_else(|| {
            let problem = format!(
                "a header that names the columns x, y and z, or three numbers, must stand here, not {}",
                quoted(row.text)
            );
            fault_at(path, row.number, &problem)
        })?)
    } else {
        commented_header(path, &lines[..first], cells.len())?
    };
    lines.drain(..first + usize::from(is_header));
    lines.retain(|line| !is_comment(line));
    for line in &mut lines {
        *line = uncommented(line);
    }
    frames(path, &lines, header, None, notes)
}

/// The columns that the comments before a table name: those of the last comment that does, with as many names as columns.
fn commented_header(path: &Path, lines: &[Line], n: usize) -> Result<Option<Columns>, KnotError> {
    for line in lines.iter().rev().filter(|line| is_comment(line)) {
        let names = header_names(line.text.trim_start_matches(['#', '%']));
        if names.len() == n {
            match Columns::named(names) {
                Ok(Some(columns)) => return Ok(Some(columns)),
                Ok(None) => (),
                Err(problem) => return Err(fault_at(path, line.number, &problem)),
            }
        }
    }
    Ok(None)
}

/// Counts, titles and rows, frame after frame.
fn molecular(
    path: &Path,
    lines: &[Line],
    start: usize,
    notes: &mut Vec<String>,
) -> Result<Vec<FrameOf>, KnotError> {
    let mut all = Vec::new();
    let mut at = start;
    while let Some(line) = lines.get(at) {
        if line.text.is_empty() || is_comment(line) {
            at += 1;
            continue;
        }
        let Some(n) = count(line.text) else {
            let problem = format!(
                "{} is left over: the count above announces fewer vertices; correct the count",
                quoted(line.text)
            );
            return Err(fault_at(path, line.number, &problem));
        };
        let (block, end) = block(path, lines, at, n)?;
        let label = block
            .title
            .map(|title| title.chars().take(LONGEST_LABEL).collect());
        let mut found = frames(path, &block.rows, block.columns(path)?, label, notes)?;
        if found.is_empty() {
            // A frame without vertices still counts, or the numbers of the others would be wrong.
            found.push(FrameOf {
                label: None,
                components: Vec::new(),
            });
        }
        all.append(&mut found);
        at = end;
    }
    Ok(all)
}

/// One frame of a molecular file.
struct Block<'a> {
    title: Option<&'a str>,
    title_line: usize,
    rows: Vec<Line<'a>>,
}

impl Block<'_> {
    /// The columns that the title names.
    fn columns(&self, path: &Path) -> Result<Option<Columns>, KnotError> {
        let Some(title) = self.title else {
            return Ok(None);
        };
        let fault = |problem: String| fault_at(path, self.title_line, &problem);
        if let Some(names) = extended_names(title) {
            return Columns::named(names).map_err(fault);
        }
        let names = header_names(title.trim_start_matches(['#', '%']));
        let mut cells = Vec::new();
        let row = self.rows.iter().find(|line| !line.is_break());
        split(row.map_or("", |line| line.text), &mut cells);
        let all = ["x", "y", "z"]
            .iter()
            .all(|name| names.iter().any(|own| own == name));
        if all && names.len() == cells.len() {
            Columns::named(names).map_err(fault)
        } else {
            Ok(None)
        }
    }
}

/// The block of `n` rows whose count is on line `at`, and where it ends.
///
/// A title follows the count; files of KymoKnot have none, which shows where the rows are one too few with it.
fn block<'a>(
    path: &Path,
    lines: &[Line<'a>],
    at: usize,
    n: usize,
) -> Result<(Block<'a>, usize), KnotError> {
    let (title, title_line) = lines
        .get(at + 1)
        .map_or(("", 0), |line| (line.text, line.number));
    let is_row = {
        let mut cells = Vec::new();
        split(title, &mut cells);
        cells.len() == 3 && cells.iter().all(|cell| number(cell).is_ok())
    };
    let ends = |end: usize| {
        let mut rest = lines[end.min(lines.len())..].iter();
        let next = rest.find(|line| !is_comment(line) && !line.is_break());
        next.is_none_or(|line| count(line.text).is_some())
    };
    let (rows, end) = take(lines, at + 2, n);
    let (bare, bare_end) = if is_row {
        take(lines, at + 1, n)
    } else {
        (Vec::new(), 0)
    };
    let fits =
        |rows: &[Line], end| rows.iter().filter(|line| !line.is_break()).count() == n && ends(end);
    match (fits(&rows, end), is_row && fits(&bare, bare_end)) {
        (true, _) if is_row => {
            let problem = format!(
                "{} stands where the title should: if it is a vertex correct the count above, if it is none write a title",
                quoted(title)
            );
            Err(fault_at(path, title_line, &problem))
        }
        (false, true) => Ok((
            Block {
                title: None,
                title_line,
                rows: bare,
            },
            bare_end,
        )),
        (true, _) => {
            let title = (!title.is_empty()).then_some(title);
            Ok((
                Block {
                    title,
                    title_line,
                    rows,
                },
                end,
            ))
        }
        (false, false) => Err(miscounted(path, lines[at].number, n, &rows, &lines[end..])),
    }
}

/// Why `rows`, with `rest` behind them, are not the `n` that the line number `announced` announces.
fn miscounted(path: &Path, announced: usize, n: usize, rows: &[Line], rest: &[Line]) -> KnotError {
    let found = rows.iter().filter(|line| !line.is_break()).count();
    if found < n {
        let problem = format!(
            "{n} vertices are announced, {found} follow the title; correct the count or complete the file"
        );
        return fault_at(path, announced, &problem);
    }
    let mut rest = rest.iter();
    let left = rest.find(|line| !is_comment(line) && !line.is_break());
    let (number, text) = left.map_or((announced, ""), |line| (line.number, line.text));
    let problem = format!(
        "{} is left over: line {announced} announces {n} vertices and there are more; correct the count",
        quoted(text)
    );
    fault_at(path, number, &problem)
}

/// The next `n` rows from line `at` on, with the breaks among them, and the line after the last.
fn take<'a>(lines: &[Line<'a>], at: usize, n: usize) -> (Vec<Line<'a>>, usize) {
    let mut rows = Vec::new();
    let mut found = 0;
    let mut end = at.min(lines.len());
    while found < n && end < lines.len() {
        let line = &lines[end];
        if count(line.text).is_some() {
            break;
        }
        end += 1;
        if is_comment(line) {
            continue;
        }
        let line = uncommented(line);
        found += usize::from(!line.is_break());
        rows.push(line);
    }
    (rows, end)
}
