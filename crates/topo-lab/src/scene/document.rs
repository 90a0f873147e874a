//! The text of a scene file: where its keys stand, and messages that say so.

use std::fmt::Display;
use std::ops::Range;
use std::path::Path;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::fault::{LEFT_OUT, SceneFault};
use super::syntax;
use crate::LabError;

/// Longest value that a message repeats.
const SHOWN: usize = 60;

/// A scene file, read as far as its tables: it knows where each key stands, for messages.
pub struct Document<'a> {
    text: &'a str,
    path: &'a Path,
    spans: DeTable<'a>,
    values: toml::Table,
}

/// A value of a file and its place.
pub(crate) struct Found<'a> {
    /// Bytes of the key and of the value.
    pub key: Range<usize>,
    pub value: Range<usize>,
    pub parsed: &'a toml::Value,
    /// Bytes of the elements of a list.
    pub elements: Vec<Range<usize>>,
}

impl<'a> Document<'a> {
    /// Reads the tables of a text; `path` names it in messages.
    ///
    /// # Errors
    /// A text that is not TOML, with the place.
    pub fn new(text: &'a str, path: &'a Path) -> Result<Self, LabError> {
        Self::read_tables(text, path).map_err(|faults| {
            let first = faults.into_iter().next();
            first.map_or_else(|| syntax::unreadable(path).into(), LabError::from)
        })
    }

    /// Reads the tables of a text, or says all that is no TOML in it.
    pub(crate) fn read_tables(text: &'a str, path: &'a Path) -> Result<Self, Vec<SceneFault>> {
        let (spans, errors) = DeTable::parse_recoverable(text);
        if !errors.is_empty() {
            let faults = errors.iter().map(|e| syntax::fault(text, path, e));
            let mut faults: Vec<SceneFault> = faults.collect();
            faults.sort_by_key(SceneFault::place);
            return Err(faults);
        }
        let spans = spans.into_inner();
        match toml::from_str(text) {
            Ok(values) => Ok(Self {
                text,
                path,
                spans,
                values,
            }),
            Err(e) => {
                let place = e.span().unwrap_or_default();
                let key = key_at(&spans, &place).unwrap_or_default();
                let found = short(text.get(place.clone()).unwrap_or_default());
                Err(vec![
                    syntax::too_large(path, found).key(key).at(text, &place),
                ])
            }
        }
    }

    /// The file's name.
    pub fn path(&self) -> &Path {
        self.path
    }

    /// The text.
    pub fn text(&self) -> &str {
        self.text
    }

    /// The value of a dotted key, if the file has it; what belongs to `material` may stand in `nematic.material` too.
    pub(crate) fn find(&self, key: &str) -> Option<Found<'_>> {
        let inside = || {
            key.starts_with("material.")
                .then(|| format!("nematic.{key}"))
        };
        self.find_exactly(key)
            .or_else(|| self.find_exactly(&inside()?))
    }

    /// The tables with their places.
    pub(crate) fn spans(&self) -> &DeTable<'a> {
        &self.spans
    }

    fn find_exactly(&self, key: &str) -> Option<Found<'_>> {
        let (mut spans, mut values) = (&self.spans, &self.values);
        let mut parts = key.split('.').peekable();
        while let Some(part) = parts.next() {
            let (name, value): (&Spanned<_>, &Spanned<DeValue<'_>>) =
                spans.iter().find(|(k, _)| k.get_ref() == part)?;
            let parsed = values.get(part)?;
            if parts.peek().is_none() {
                let elements = value.get_ref().as_array().map_or_else(Vec::new, |list| {
                    list.iter().map(|element| element.span()).collect()
                });
                return Some(Found {
                    key: name.span(),
                    value: value.span(),
                    parsed,
                    elements,
                });
            }
            (spans, values) = (value.get_ref().as_table()?, parsed.as_table()?);
        }
        None
    }

    /// Whether the file has a dotted key.
    pub fn has(&self, key: &str) -> bool {
        self.find(key).is_some()
    }

    /// Where a dotted key stands, or the nearest table around it that the file has.
    fn around(&self, key: &str) -> Option<Range<usize>> {
        let mut key = key;
        loop {
            match self.find(key) {
                Some(found) => return Some(found.key),
                None => key = key.rsplit_once('.')?.0,
            }
        }
    }

    /// The line of a dotted key, or of the nearest table around it that the file has.
    pub fn line(&self, key: &str) -> Option<usize> {
        let before = self.text.get(..self.around(key)?.start)?;
        Some(1 + before.matches('\n').count())
    }

    /// What is written after a key, on one line and not too long.
    pub fn written(&self, key: &str) -> String {
        match self.find(key) {
            Some(found) => self.source(&found.value),
            None => LEFT_OUT.to_owned(),
        }
    }

    /// What is written at a place, on one line and not too long.
    pub(crate) fn source(&self, place: &Range<usize>) -> String {
        short(self.text.get(place.clone()).unwrap_or_default())
    }

    /// The error for a value that cannot be; of a list, the element is marked.
    pub fn wrong(&self, key: &str, value: impl Display, remedy: impl Into<String>) -> LabError {
        let value = value.to_string();
        let place = self.find(key).map(|found| {
            let is_it = |place: &&Range<usize>| is_same(&self.source(place), &value);
            let element = found.elements.iter().find(is_it).cloned();
            element.unwrap_or(found.value)
        });
        self.fault(key, &value, remedy.into(), place.as_ref())
            .into()
    }

    /// A fault of a value at a place, or of the table around its key where it has none.
    pub(crate) fn fault(
        &self,
        key: &str,
        found: &str,
        expected: String,
        place: Option<&Range<usize>>,
    ) -> SceneFault {
        let fault = SceneFault::of_file(self.path, short(found), expected).key(key);
        match place.cloned().or_else(|| self.around(key)) {
            Some(place) => fault.at(self.text, &place),
            None => fault,
        }
    }

    /// Refuses a key that the file has where it changes nothing.
    ///
    /// # Errors
    /// The key, with the reason.
    pub fn idle(&self, key: &str, reason: &str) -> Result<(), LabError> {
        if self.has(key) {
            return Err(self.wrong(key, self.written(key), reason));
        }
        Ok(())
    }

    /// Reads this text or one made of it, with the same keys on the same lines.
    ///
    /// # Errors
    /// What the type refuses, with the place; what does not fit the [`Keys`](crate::Keys) of the file is better refused by them.
    pub fn read<T: DeserializeOwned>(&self, text: &str) -> Result<T, LabError> {
        toml::from_str(text).map_err(|e| {
            let tables = DeTable::parse_recoverable(text).0.into_inner();
            let key = e.span().and_then(|place| key_at(&tables, &place));
            match key {
                Some(key) => self.wrong(&key, self.written(&key), e.message()),
                None => SceneFault::of_file(self.path, "the scene", e.message()).into(),
            }
        })
    }
}

/// Whether a value is the one written.
fn is_same(written: &str, value: &str) -> bool {
    let number = |text: &str| text.parse::<f64>().ok();
    match (number(written), number(value)) {
        (Some(x), Some(y)) => x == y || (x.is_nan() && y.is_nan()),
        _ => written.trim_matches('"') == value.trim_matches('"'),
    }
}

/// The dotted key at a place or, of a value, the innermost around it.
fn key_at(table: &DeTable<'_>, place: &Range<usize>) -> Option<String> {
    let holds = |span: &Range<usize>| span.start <= place.start && place.end <= span.end;
    table.iter().find_map(|(name, value)| {
        let inside = value.get_ref().as_table();
        match inside.and_then(|table| key_at(table, place)) {
            Some(inner) => Some(format!("{}.{inner}", name.get_ref())),
            None => {
                (holds(&name.span()) || holds(&value.span())).then(|| name.get_ref().to_string())
            }
        }
    })
}

fn short(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    let line = words.join(" ");
    match line.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{} ...", &line[..end]),
        None => line,
    }
}

/// The text of a scene file.
pub(crate) fn read_text(path: &Path) -> Result<String, LabError> {
    let bytes = std::fs::read(path).map_err(|source| LabError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    String::from_utf8(bytes).map_err(|e| syntax::no_text(path, &e).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_found_where_they_stand() {
        let text = "budget = \"1h\"\n\n[nematic]\nfield.anisotropy = 2\nanchoring = { weak = [1,\n 2.5] }\n[nematic.material]\na = 3\n";
        let document = Document::new(text, Path::new("s.toml")).unwrap();
        for (key, line) in [
            ("budget", Some(1)),
            ("nematic", Some(3)),
            ("nematic.field.anisotropy", Some(4)),
            ("nematic.anchoring.weak", Some(5)),
            ("material.a", Some(8)),
            ("nematic.material.b", Some(7)),
            ("nematic.radius", Some(3)),
            ("switch.ramp", None),
        ] {
            assert_eq!(document.line(key), line, "{key}");
        }
        let weak = document.find("nematic.anchoring.weak").unwrap();
        let elements: Vec<_> = weak.elements.iter().map(|e| &text[e.clone()]).collect();
        assert_eq!(elements, ["1", "2.5"]);
        assert_eq!(document.written("nematic.anchoring.weak"), "[1, 2.5]");
        assert!(!document.has("nematic.anchoring.strong"));
        let message = document
            .wrong("nematic.radius", -1, "be positive")
            .to_string();
        assert_eq!(
            message,
            "s.toml, line 3: nematic.radius = -1 is not possible: be positive\n --> s.toml:3:2\n  |\n3 | [nematic]\n  |  ^^^^^^^"
        );
        // of a list, the element
        let message = document
            .wrong("nematic.anchoring.weak", 2.5, "be")
            .to_string();
        assert!(message.contains("--> s.toml:6:2\n"), "{message}");
    }
}
