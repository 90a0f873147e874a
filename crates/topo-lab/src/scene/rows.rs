//! The keys of a battery's scenes, one by one, for the reference and for new scenes.

use serde_json::Value;

use super::keys::{Keys, alternatives, is, properties};
use super::words::{
    forms_of_one, is_several, is_table, required, sample, sample_with, words_of, written,
};

/// A key of a scene, as the reference has it.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct KeyRow {
    /// Its table; empty for keys above all tables.
    pub table: String,
    /// The key below the table; of a form with a name, such as `{ weak = 1.0 }`, with that name.
    pub name: String,
    /// What it means.
    pub meaning: String,
    /// Its unit; empty where it is no quantity.
    pub unit: String,
    /// Its value where it is left out, as it is written; words where no one value is meant.
    pub default: String,
    /// Whether `default` can be written.
    pub has_default: bool,
    /// What one value may be.
    pub forms: String,
    /// Whether it may have several values, for a case each.
    pub is_several: bool,
    /// The key with a value that it may have, as a line of its table.
    pub example: String,
    /// Words that it may be, with what they mean.
    pub words: Vec<(String, String)>,
    /// Whether a table must have it.
    pub is_required: bool,
}

impl KeyRow {
    /// The key with its table.
    pub fn key(&self) -> String {
        match self.table.as_str() {
            "" => self.name.clone(),
            table => format!("{table}.{}", self.name),
        }
    }
}

impl Keys {
    /// Every key of every table, those above the tables first.
    ///
    /// # Validation
    /// `examples_and_defaults_of_the_reference_are_what_it_says`
    pub fn rows(&self) -> Vec<KeyRow> {
        let mut rows = Vec::new();
        table_rows("", self.schema(), &mut rows);
        rows
    }

    /// What a table is for.
    pub fn about(&self, table: &str) -> &str {
        self.table(table)
            .map_or("", |node| text(node, "description"))
    }

    /// Whether what a table describes is not modelled where the table is left out.
    pub fn is_optional(&self, table: &str) -> bool {
        let ends = table.match_indices('.').map(|(k, _)| k);
        let around = ends
            .chain([table.len()])
            .filter_map(|k| self.table(&table[..k]));
        let mut optional = around.filter_map(|node| node.get("x-optional"));
        optional.next().is_some()
    }

    fn table(&self, table: &str) -> Option<&Value> {
        let mut parts = table.split('.').filter(|part| !part.is_empty());
        parts.try_fold(self.schema(), |node, part| {
            let inner = node.get("properties")?.get(part)?;
            alternatives(inner)
                .into_iter()
                .find(|kind| is(kind, "object"))
        })
    }

    /// A scene to begin with: the keys of `first` with their values, all others as comments with the values that they have anyway.
    ///
    /// # Validation
    /// `scenes_to_begin_with_say_what_they_leave_out`
    pub fn new_scene(&self, first: &[(&str, &str)]) -> String {
        let rows = self.rows();
        let mut text = String::new();
        let mut table = "";
        for row in rows.iter().filter(|row| !row.name.contains('.')) {
            let is_used = first
                .iter()
                .any(|(key, _)| key.starts_with(&format!("{}.", row.table)));
            let off = if self.is_optional(&row.table) && !is_used {
                "# "
            } else {
                ""
            };
            if row.table != table {
                table = &row.table;
                text += &format!(
                    "\n{off}[{table}] # {}\n",
                    self.about(table).trim_end_matches('.')
                );
            }
            let value = first.iter().find(|(key, _)| *key == row.key());
            let (off, value) = match value {
                Some((_, value)) => ("", *value),
                None if row.has_default => ("# ", &*row.default),
                None => (
                    "# ",
                    row.example.split_once(" = ").map_or("", |(_, value)| value),
                ),
            };
            let left_out = match (row.has_default, row.default.as_str()) {
                (false, default) if !default.is_empty() => format!("; left out: {default}"),
                _ => String::new(),
            };
            let unit = if row.unit.len() > 1 {
                format!(" [{}]", row.unit)
            } else {
                String::new()
            };
            text += &format!(
                "{off}{} = {value} # {}{unit}{left_out}\n",
                row.name,
                row.meaning.trim_end_matches('.')
            );
        }
        text
    }
}

fn text<'a>(node: &'a Value, name: &str) -> &'a str {
    node.get(name).and_then(Value::as_str).unwrap_or("")
}

fn table_rows(table: &str, node: &Value, rows: &mut Vec<KeyRow>) {
    let needed = required(node);
    let is_elsewhere = |node: &Value| node.get("x-as").is_some();
    let is_inner = |node: &Value| is_table(node) && alternatives(node).len() == 1;
    let is_value = |node: &Value| !is_inner(node) && !is_elsewhere(node);
    for (name, node) in properties(node).filter(|(_, node)| is_value(node)) {
        let written = |value: String| format!("{name} = {value}");
        value_rows([table, name], node, needed.contains(&name), &written, rows);
    }
    let is_here = |node: &Value| is_table(node) && !is_elsewhere(node);
    for (name, inner) in properties(node).filter(|(_, node)| is_here(node)) {
        let key = match table {
            "" => name.to_owned(),
            table => format!("{table}.{name}"),
        };
        let kinds = alternatives(inner);
        if let Some(kind) = kinds.into_iter().find(|kind| is(kind, "object")) {
            table_rows(&key, kind, rows);
        }
    }
}

/// A row for a key and those for what stands inside of its forms, such as `{ weak = W }`; `whole` puts a value into the forms around it.
fn value_rows(
    [table, name]: [&str; 2],
    node: &Value,
    is_required: bool,
    whole: &dyn Fn(String) -> String,
    rows: &mut Vec<KeyRow>,
) {
    let kinds = alternatives(node);
    let default = node.get("default").map(written);
    let words = kinds.iter().flat_map(|kind| {
        let about = text(kind, "description");
        let words = words_of(kind).into_iter();
        words.map(move |word| (word.to_owned(), about.to_owned()))
    });
    rows.push(KeyRow {
        table: table.to_owned(),
        name: name.to_owned(),
        meaning: text(node, "description").to_owned(),
        unit: text(node, "x-unit").to_owned(),
        has_default: default.is_some(),
        default: default.unwrap_or_else(|| text(node, "x-default").to_owned()),
        forms: forms_of_one(node),
        is_several: kinds.iter().any(|kind| is_several(kind)),
        example: whole(sample(node)),
        words: words.collect(),
        is_required,
    });
    let is_list = |kind: &&&Value| is(kind, "array") && !is_several(kind);
    let items = kinds
        .iter()
        .filter(is_list)
        .filter_map(|kind| kind.get("items"));
    for items in items.filter(|items| is(items, "object")) {
        // of the tables in a list, the first has the key
        for (key, inner) in properties(items) {
            let one = |value: String| whole(format!("[{}, {{}}]", sample_with(items, key, &value)));
            value_rows([table, &format!("{name}.{key}")], inner, false, &one, rows);
        }
    }
    let is_form = |kind: &&&Value| is(kind, "object") && !is_several(kind) && !is_table(node);
    for kind in kinds.iter().filter(is_form) {
        for (form, node) in properties(kind) {
            let name = format!("{name}.{form}");
            let inside = |value: String| whole(sample_with(kind, form, &value));
            let first = rows.len();
            if !is(node, "object") {
                value_rows([table, &name], node, false, &inside, rows);
                if rows[first].meaning.is_empty() {
                    rows[first].meaning = text(kind, "description").to_owned();
                }
                continue;
            }
            for (key, inner) in properties(node) {
                let beside = |value: String| inside(sample_with(node, key, &value));
                value_rows(
                    [table, &format!("{name}.{key}")],
                    inner,
                    false,
                    &beside,
                    rows,
                );
            }
        }
    }
}

#[cfg(test)]
mod tests;
