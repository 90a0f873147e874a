//! The text of a scene file: where its keys stand, and messages that say so.

use std::fmt::Display;
use std::ops::Range;
use std::path::Path;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

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
    /// A text that is not TOML, with line and column.
    pub fn new(text: &'a str, path: &'a Path) -> Result<Self, LabError> {
        let wrong = |e: toml::de::Error| not_a_scene(path, &e);
        Ok(Self {
            text,
            path,
            spans: DeTable::parse(text).map_err(wrong)?.into_inner(),
            values: toml::from_str(text).map_err(wrong)?,
        })
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

    /// The line of a dotted key, or of the nearest table around it that the file has.
    pub fn line(&self, key: &str) -> Option<usize> {
        let mut key = key;
        loop {
            if let Some(found) = self.find(key) {
                let before = self.text.get(..found.key.start)?;
                return Some(1 + before.matches('\n').count());
            }
            key = key.rsplit_once('.')?.0;
        }
    }

    /// What is written after a key, on one line and not too long.
    pub fn written(&self, key: &str) -> String {
        let found = self.find(key).and_then(|f| self.text.get(f.value));
        short(found.unwrap_or("(left out)"))
    }

    /// The error for a value that cannot be.
    pub fn wrong(&self, key: &str, value: impl Display, remedy: impl Into<String>) -> LabError {
        LabError::SceneValue {
            path: self.path.to_owned(),
            line: self.line(key),
            key: key.to_owned(),
            value: short(&value.to_string()),
            remedy: remedy.into(),
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

    /// Reads this text or one made of it.
    ///
    /// # Errors
    /// An unknown key or a value of the wrong type, with line and column.
    pub fn read<T: DeserializeOwned>(&self, text: &str) -> Result<T, LabError> {
        toml::from_str(text).map_err(|e| not_a_scene(self.path, &e))
    }
}

fn not_a_scene(path: &Path, error: &toml::de::Error) -> LabError {
    LabError::Scene {
        path: path.to_owned(),
        message: error.to_string(),
    }
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
    std::fs::read_to_string(path).map_err(|source| LabError::Unreadable {
        path: path.to_owned(),
        source,
    })
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
            "s.toml, line 3: nematic.radius = -1 is not possible: be positive"
        );
    }
}
