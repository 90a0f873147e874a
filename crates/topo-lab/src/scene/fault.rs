//! A fault of a scene file: where it is, what stands there, and what would be right.

use std::fmt;
use std::ops::Range;
use std::path::Path;

use serde::Serialize;

/// Longest part of a line that is shown, in characters.
const SHOWN: usize = 100;

/// What is found where a key is missing.
pub(crate) const LEFT_OUT: &str = "(left out)";

/// A fault of a scene file, as `topo scene check` lists it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct SceneFault {
    /// The file, or a name for a text.
    pub file: String,
    /// Line of the value or, where it is left out, of the table around it, counted from 1.
    pub line: Option<usize>,
    /// Character of that line, counted from 1.
    pub column: Option<usize>,
    /// Key with its table; empty where the text is no TOML or the file as a whole is meant.
    pub key: String,
    /// What was written.
    pub found: String,
    /// What would be right.
    pub expected: String,
    /// The line, with marks under the place; empty without a line.
    #[serde(skip)]
    pub excerpt: String,
}

impl SceneFault {
    /// A fault of a file as a whole.
    pub(crate) fn of_file(
        path: &Path,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self {
            file: path.display().to_string(),
            line: None,
            column: None,
            key: String::new(),
            found: found.into(),
            expected: expected.into(),
            excerpt: String::new(),
        }
    }

    /// The fault at these bytes of the text of its file.
    pub(crate) fn at(mut self, text: &str, place: &Range<usize>) -> Self {
        let place = Place::of(text, place);
        (self.line, self.column) = (Some(place.line), Some(place.column));
        self.excerpt = place.excerpt(&self.file);
        self
    }

    /// Line and column, to put faults in the order of the file.
    pub(crate) fn place(&self) -> (Option<usize>, Option<usize>) {
        (self.line, self.column)
    }

    pub(crate) fn key(mut self, key: impl Into<String>) -> Self {
        self.key = key.into();
        self
    }
}

impl fmt::Display for SceneFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        match (self.key.as_str(), self.found.as_str()) {
            ("", found) => write!(f, ": {found}: ")?,
            (key, LEFT_OUT) => write!(f, ": {key} is missing: ")?,
            (key, found) => write!(f, ": {key} = {found} is not possible: ")?,
        }
        f.write_str(&self.expected)?;
        if !self.excerpt.is_empty() {
            write!(f, "\n{}", self.excerpt)?;
        }
        Ok(())
    }
}

/// A place in a text.
struct Place<'a> {
    line: usize,
    column: usize,
    /// The text of the line.
    shown: &'a str,
    /// Characters marked.
    length: usize,
}

impl<'a> Place<'a> {
    fn of(text: &'a str, place: &Range<usize>) -> Self {
        // places of the parser are on boundaries of characters
        let before = text.get(..place.start).unwrap_or(text);
        let begin = before.rfind('\n').map_or(0, |k| k + 1);
        let shown = text[begin..].lines().next().unwrap_or("");
        let marked = text.get(place.clone()).unwrap_or("");
        let marked = marked.lines().next().unwrap_or("").trim_end();
        Self {
            line: 1 + before.matches('\n').count(),
            column: 1 + before[begin..].chars().count(),
            shown,
            length: marked.chars().count().max(1),
        }
    }

    /// The line with its number, and marks below it, as compilers show it.
    fn excerpt(&self, file: &str) -> String {
        let Self { line, column, .. } = self;
        let number = line.to_string();
        let margin = " ".repeat(number.len());
        // of a long line, what is around the place
        let first = if *column > SHOWN {
            column - SHOWN / 2
        } else {
            0
        };
        let part = self.shown.chars().skip(first).take(SHOWN);
        let part: String = part.map(|c| if c.is_control() { ' ' } else { c }).collect();
        let indent = " ".repeat(column - 1 - first);
        let marks = "^".repeat(self.length.min(SHOWN - indent.len().min(SHOWN - 1)));
        format!(
            "{margin}--> {file}:{line}:{column}\n{margin} |\n{number} | {}\n{margin} | {indent}{marks}",
            part.trim_end()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_is_underlined() {
        let text = "[nematic]\nanchoring = 0.5 # weak\nr = \"ξξ\"\n";
        let start = text.find("0.5").unwrap();
        let fault = SceneFault::of_file(Path::new("s.toml"), "0.5", "write \"strong\"")
            .key("nematic.anchoring")
            .at(text, &(start..start + 3));
        assert_eq!(
            fault.to_string(),
            "s.toml, line 2: nematic.anchoring = 0.5 is not possible: write \"strong\"\n --> s.toml:2:13\n  |\n2 | anchoring = 0.5 # weak\n  |             ^^^"
        );
        let start = text.find("ξ\"").unwrap();
        let fault = fault.at(text, &(start..start + 3));
        assert_eq!((fault.line, fault.column), (Some(3), Some(7)));
        assert!(
            fault.excerpt.ends_with("3 | r = \"ξξ\"\n  |       ^^"),
            "{}",
            fault.excerpt
        );
    }

    #[test]
    fn long_lines_and_ends_of_files_have_marks_too() {
        let text = format!("a = [{}]", "1.0, ".repeat(500));
        for place in [0..1, 300..303, 2504..2505, 2505..2505, 4..2505] {
            let fault = SceneFault::of_file(Path::new("s"), "x", "y").at(&text, &place);
            let lines: Vec<&str> = fault.excerpt.lines().collect();
            assert_eq!(lines.len(), 4);
            assert!(lines.iter().all(|l| l.chars().count() < 120), "{place:?}");
            assert!(lines[3].contains('^'));
        }
        assert!(
            SceneFault::of_file(Path::new("s"), "x", "y")
                .at("", &(0..0))
                .excerpt
                .ends_with("| ^")
        );
    }
}
