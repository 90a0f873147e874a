//! Messages about curve files: short whatever the file holds, naming file, line and remedy.

use std::path::Path;

use crate::KnotError;

/// Characters of a file that a message quotes at most.
const QUOTED: usize = 40;

/// The refusal of a file.
pub(super) fn fault(path: &Path, problem: impl Into<String>) -> KnotError {
    KnotError::CurveFile {
        path: path.to_owned(),
        problem: problem.into(),
    }
}

/// The refusal of a line.
pub(super) fn fault_at(path: &Path, line: usize, problem: &str) -> KnotError {
    fault(path, format!("line {line}: {problem}"))
}

/// The beginning of a cell, line or name for a message, control characters escaped.
pub(super) fn quoted(text: &str) -> String {
    let mut chars = text.trim().chars();
    let start: String = chars.by_ref().take(QUOTED).collect();
    let end = if chars.next().is_some() { "..." } else { "" };
    format!("`{}{end}`", start.escape_debug())
}
