//! A scene file against the keys of its battery: what does not fit, each with its place and the forms that do.

use std::ops::Range;
use std::path::Path;

use serde_json::Value;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::document::Document;
use super::fault::{LEFT_OUT, SceneFault};
use super::keys::{Keys, alternatives, is, properties, property};
use super::words::{forms, is_table, listed, required, sample, words_of};
use crate::LabError;

/// Least likeness of words that may be meant for each other.
const ALIKE: f64 = 0.85;

impl Keys {
    /// Refuses a file with unknown keys or values of another form.
    ///
    /// # Errors
    /// The first of [`faults`](Self::faults).
    pub fn check(&self, document: &Document<'_>) -> Result<(), LabError> {
        let first = self.faults(document).into_iter().next();
        first.map_or(Ok(()), |fault| Err(fault.into()))
    }

    /// All that is wrong with the text of a file: it is no TOML, its keys, or `of_values` of what they say together.
    pub fn faults_of_text(
        &self,
        text: &str,
        path: &Path,
        of_values: impl FnOnce(&Document<'_>) -> Vec<LabError>,
    ) -> Vec<SceneFault> {
        let document = match Document::read_tables(text, path) {
            Ok(document) => document,
            Err(faults) => return faults,
        };
        let mut faults = self.faults(&document);
        if faults.is_empty() {
            let of_values = of_values(&document).into_iter();
            faults.extend(of_values.map(|e| e.into_fault(path)));
            faults.sort_by_key(SceneFault::place);
        }
        faults
    }

    /// Unknown keys, missing ones and values of another form, in the order of the file.
    ///
    /// # Validation
    /// `wrong_scenes_are_answered_in_the_words_of_scenes`
    pub fn faults(&self, document: &Document<'_>) -> Vec<SceneFault> {
        let mut walk = Walk {
            document,
            schema: self.schema(),
            faults: Vec::new(),
        };
        walk.table("", self.schema(), document.spans(), &(0..0));
        walk.faults.sort_by_key(SceneFault::place);
        walk.faults
    }
}

struct Walk<'a> {
    document: &'a Document<'a>,
    schema: &'a Value,
    faults: Vec<SceneFault>,
}

impl Walk<'_> {
    fn add(&mut self, key: &str, found: &str, expected: String, place: &Range<usize>) {
        let fault = self.document.fault(key, found, expected, Some(place));
        self.faults.push(fault);
    }

    /// A table of settings, whose keys are looked at one by one.
    fn table(&mut self, key: &str, node: &Value, table: &DeTable<'_>, place: &Range<usize>) {
        for (name, value) in table {
            let inner = below(key, name.get_ref());
            match property(node, name.get_ref()) {
                Some(node) => self.value(&inner, node, name.span(), value),
                None => {
                    let found = match self.document.source(&value.span()) {
                        head if head.starts_with('[') && value.get_ref().is_table() => {
                            "a table".to_owned()
                        }
                        found => found,
                    };
                    let expected = self.unknown(key, name.get_ref(), node);
                    self.add(&inner, &found, expected, &name.span());
                }
            }
        }
        for name in missing(node, table) {
            let example = property(node, name).map(sample).unwrap_or_default();
            let expected = format!("write {name} = {example}");
            self.add(&below(key, name), LEFT_OUT, expected, place);
        }
    }

    /// A table that is one of the forms of a value; it is right or wrong as a whole.
    fn form(
        &mut self,
        key: &str,
        whole: &Value,
        kind: &Value,
        table: &DeTable<'_>,
        place: &Range<usize>,
    ) {
        let mut wrong = Vec::new();
        for (name, value) in table {
            match property(kind, name.get_ref()) {
                Some(node) => {
                    let inner = below(key, name.get_ref());
                    match value.get_ref() {
                        DeValue::Table(table) if is(node, "object") => {
                            self.form(&inner, node, node, table, &value.span());
                        }
                        _ => self.value(&inner, node, name.span(), value),
                    }
                }
                None => wrong.push(format!("`{}` is not known", name.get_ref())),
            }
        }
        wrong.extend(missing(kind, table).map(|name| format!("`{name}` is missing")));
        if !wrong.is_empty() {
            let found = self.document.source(place);
            let expected = format!("{}; write {}", listed(&wrong, "and"), forms(whole));
            self.add(key, &found, expected, place);
        }
    }

    fn value(&mut self, key: &str, node: &Value, name: Range<usize>, value: &Spanned<DeValue<'_>>) {
        let kinds = alternatives(node);
        let number = whole_number(value.get_ref());
        let fits = match value.get_ref() {
            DeValue::Table(table) => {
                let kind = meant(&kinds, table, is_table(node));
                match kind {
                    Some(kind) if is_table(node) => return self.table(key, kind, table, &name),
                    Some(kind) => return self.form(key, node, kind, table, &value.span()),
                    None => false,
                }
            }
            DeValue::Array(list) => match kinds.iter().find(|kind| is(kind, "array")) {
                Some(kind) if has_length(kind, list.len()) => {
                    let items = kind.get("items").unwrap_or(&Value::Null);
                    for item in list {
                        self.value(key, items, item.span(), item);
                    }
                    return;
                }
                _ => false,
            },
            DeValue::String(text) => kinds.iter().any(|kind| is_word(kind, text)),
            DeValue::Integer(_) => {
                let fits = |kind: &&Value| is(kind, "number") || is_within(kind, number);
                kinds.iter().any(fits)
            }
            DeValue::Float(_) => kinds.iter().any(|kind| is(kind, "number")),
            DeValue::Boolean(_) => kinds.iter().any(|kind| is(kind, "boolean")),
            DeValue::Datetime(_) => false,
        };
        if !fits {
            let found = self.document.source(&value.span());
            let hint = hint(key, node, value.get_ref(), &found);
            let expected = match hint {
                Some(hint) => format!("{hint}; possible is {}", forms(node)),
                None => format!("write {}", forms(node)),
            };
            self.add(key, &found, expected, &value.span());
        }
    }

    /// What is said of a key that no table of this name has.
    fn unknown(&self, table: &str, name: &str, node: &Value) -> String {
        let names: Vec<&str> = properties(node).map(|(known, _)| known).collect();
        let place = match table {
            "" => "there is no such key".to_owned(),
            table => format!("[{table}] has no such key"),
        };
        let quoted: Vec<String> = names.iter().map(|known| format!("`{known}`")).collect();
        let known = listed(&quoted, "and");
        let meant = nearest(name, &names).map(str::to_owned);
        match meant.or_else(|| elsewhere(self.schema, "", name)) {
            Some(meant) => format!("{place}; did you mean `{meant}`? Possible are {known}"),
            None => format!("{place}; possible are {known}"),
        }
    }
}

fn below(table: &str, name: &str) -> String {
    match table {
        "" => name.to_owned(),
        table => format!("{table}.{name}"),
    }
}

/// Keys that a table must have and has not.
fn missing<'a>(node: &'a Value, table: &DeTable<'_>) -> impl Iterator<Item = &'a str> {
    let has = |name: &str| table.iter().any(|(known, _)| known.get_ref() == name);
    required(node).into_iter().filter(move |name| !has(name))
}

/// The kind of table that is meant: one with a key that is there, or the table of settings.
fn meant<'a>(kinds: &[&'a Value], table: &DeTable<'_>, is_settings: bool) -> Option<&'a Value> {
    let has = |kind: &&Value| {
        table
            .iter()
            .any(|(name, _)| property(kind, name.get_ref()).is_some())
    };
    let tables = || kinds.iter().copied().filter(|kind| is(kind, "object"));
    tables()
        .find(has)
        .or_else(|| tables().next().filter(|_| is_settings))
}

fn has_length(kind: &Value, n: usize) -> bool {
    let limit = |name: &str| kind.get(name).and_then(Value::as_u64);
    limit("minItems").is_none_or(|least| n as u64 >= least)
        && limit("maxItems").is_none_or(|most| n as u64 <= most)
}

/// Whether a text is one of the words; texts without a list of them are looked at by who reads them.
fn is_word(kind: &Value, text: &str) -> bool {
    let words = words_of(kind);
    words.contains(&text) || (words.is_empty() && is(kind, "string"))
}

fn whole_number(value: &DeValue<'_>) -> Option<i64> {
    let number = value.as_integer()?;
    i64::from_str_radix(number.as_str(), number.radix()).ok()
}

/// Whether a type can hold a whole number: one without a sign, or one of few digits. Other bounds are looked at by who checks values.
fn is_within(kind: &Value, number: Option<i64>) -> bool {
    let bound = |name: &str| kind.get(name).and_then(Value::as_f64);
    let is_in = |n: i64| match (bound("minimum"), bound("maximum")) {
        (Some(least), Some(most)) if least < 0.0 => (least..=most).contains(&(n as f64)),
        (Some(_), _) => n >= 0,
        _ => true,
    };
    is(kind, "integer") && number.is_some_and(is_in)
}

/// What may be meant by a value that does not fit.
fn hint(key: &str, node: &Value, value: &DeValue<'_>, found: &str) -> Option<String> {
    let kinds = alternatives(node);
    let takes = |kind: &str| kinds.iter().any(|k| is(k, kind));
    let numeric = takes("number") || takes("integer");
    let of_numbers = |kind: &&Value| kind.pointer("/items/type").is_some_and(|t| t == "number");
    let is_list_of_numbers = !numeric && kinds.iter().any(of_numbers);
    let words: Vec<&str> = kinds.iter().flat_map(|kind| words_of(kind)).collect();
    match value {
        DeValue::String(text) => {
            let form = kinds.iter().find(|kind| property(kind, text).is_some());
            if numeric && text.trim().parse::<f64>().is_ok() {
                return Some(format!("numbers stand without quotes: {}", text.trim()));
            }
            if takes("boolean") && ["true", "false"].contains(&&**text) {
                return Some(format!("{text} stands without quotes"));
            }
            if let Some(form) = form.filter(|_| !is_table(node)) {
                return Some(format!("`{text}` stands with its value: {}", sample(form)));
            }
            nearest(text, &words).map(|word| format!("did you mean \"{word}\"?"))
        }
        DeValue::Table(table) => {
            let word = words
                .iter()
                .find(|word| table.iter().any(|(k, _)| k.get_ref() == **word));
            word.map(|word| format!("`{word}` stands alone: \"{word}\""))
        }
        DeValue::Boolean(false) if is_table(node) => {
            Some("leave the table out, and it is not modelled".to_owned())
        }
        _ if is(node, "object") => Some(format!(
            "the table begins with [{key}] on a line of its own"
        )),
        DeValue::Float(_) if takes("integer") => {
            let whole = found
                .parse::<f64>()
                .ok()
                .filter(|x| x.fract() == 0.0 && x.abs() < 1e15);
            whole.map(|x| format!("write {x:.0} without a point"))
        }
        DeValue::Integer(_) | DeValue::Float(_) if is_list_of_numbers => {
            Some(format!("a list stands in brackets: [{found}]"))
        }
        DeValue::Array(list) if list.is_empty() && takes("array") => {
            Some("give one value or more, or leave the key out".to_owned())
        }
        _ => None,
    }
}

/// The most alike of some words.
pub(crate) fn nearest<'a>(word: &str, words: &[&'a str]) -> Option<&'a str> {
    let word = word.to_lowercase();
    let alike = words
        .iter()
        .map(|known| (strsim::jaro_winkler(&word, known), *known));
    let best = alike.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 >= ALIKE).then_some(best.1)
}

/// Where a key of this name stands in another table.
fn elsewhere(node: &Value, table: &str, name: &str) -> Option<String> {
    properties(node).find_map(|(known, inner)| {
        let key = below(table, known);
        if known == name {
            return Some(key);
        }
        let kinds = alternatives(inner);
        let kind = kinds
            .into_iter()
            .find(|kind| is(kind, "object") && is_table(inner))?;
        elsewhere(kind, &key, name)
    })
}

#[cfg(test)]
mod tests;
