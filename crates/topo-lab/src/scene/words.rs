//! What a key of a scene may be, in words and as it is written.

use serde_json::Value;

use super::keys::{alternatives, is, properties, property};

/// The forms that a value may have: `a number, a list of numbers or { from = 1.0, to = 2.0, n = 3 }`.
pub(crate) fn forms(node: &Value) -> String {
    forms_of_kinds(node, alternatives(node))
}

/// The forms of one value, where a key may have several.
pub(crate) fn forms_of_one(node: &Value) -> String {
    let kinds = alternatives(node).into_iter();
    forms_of_kinds(node, kinds.filter(|kind| !is_several(kind)))
}

/// Whether a kind holds the values of several cases.
pub(crate) fn is_several(kind: &Value) -> bool {
    kind.get("x-several").is_some()
}

fn forms_of_kinds<'a>(node: &Value, kinds: impl IntoIterator<Item = &'a Value>) -> String {
    let mut words: Vec<String> = Vec::new();
    for kind in kinds {
        let is_text =
            is(kind, "string") && words_of(kind).is_empty() && kind.get("x-form").is_none();
        let example = node
            .pointer("/examples/0")
            .filter(|e| is_text && e.is_string());
        let such = example.map_or(String::new(), |example| format!(" such as {example}"));
        for form in forms_of(kind) {
            let form = format!("{form}{such}");
            if !words.contains(&form) {
                words.push(form);
            }
        }
    }
    listed(&words, "or")
}

fn forms_of(kind: &Value) -> Vec<String> {
    if let Some(form) = kind.get("x-form").and_then(Value::as_str) {
        return vec![form.to_owned()];
    }
    let words = words_of(kind);
    if !words.is_empty() {
        return words.iter().map(|word| format!("\"{word}\"")).collect();
    }
    vec![match kind.get("type").and_then(Value::as_str) {
        Some("number") => format!("a number{}", bounds(kind)),
        Some("integer") => format!("a whole number{}", bounds(kind)),
        Some("boolean") => return vec!["true".to_owned(), "false".to_owned()],
        Some("string") => "a text in quotes".to_owned(),
        Some("array") => list(kind),
        Some("object") => table(kind),
        _ => "a value".to_owned(),
    }]
}

/// Words that a value may be.
pub(crate) fn words_of(kind: &Value) -> Vec<&str> {
    let one = kind.get("const").and_then(Value::as_str);
    let several = kind.get("enum").and_then(Value::as_array);
    let several = several.into_iter().flatten().filter_map(Value::as_str);
    one.into_iter().chain(several).collect()
}

fn list(kind: &Value) -> String {
    let items = kind.get("items").unwrap_or(&Value::Null);
    let length = |name: &str| kind.get(name).and_then(Value::as_u64);
    let plural = match items.get("type").and_then(Value::as_str) {
        Some("number") => "numbers",
        Some("integer") => "whole numbers",
        Some("array") => "lists",
        Some("string") if words_of(items).is_empty() => "texts in quotes",
        _ => "such",
    };
    match (length("minItems"), length("maxItems")) {
        (Some(n), Some(m)) if n == m => {
            let of = match plural {
                "such" => format!(", each {}", forms(items)),
                plural => format!(" {plural}"),
            };
            format!("a list of {n}{of}, such as {}", sample(kind))
        }
        _ => format!("a list of {plural}"),
    }
}

fn table(kind: &Value) -> String {
    let is_needed = !required(kind).is_empty();
    let names: Vec<String> = properties(kind)
        .map(|(name, _)| format!("`{name}`"))
        .collect();
    match is_needed {
        true => sample(kind),
        false => {
            let first = properties(kind).next().map_or("", |(name, _)| name);
            let first = property(kind, first).map(|node| sample_with(kind, first, &sample(node)));
            let first = first.unwrap_or_default();
            format!(
                "a table such as {first}, with any of {}",
                listed(&names, "and")
            )
        }
    }
}

/// Keys that a table must have.
pub(crate) fn required(kind: &Value) -> Vec<&str> {
    let list = kind.get("required").and_then(Value::as_array);
    list.into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect()
}

/// Numbers allowed, such as ` above zero`; nothing where all are.
pub(crate) fn bounds(kind: &Value) -> String {
    let number = |name: &str| kind.get(name).filter(|x| x.is_number()).map(short);
    let least = number("minimum");
    let above = number("exclusiveMinimum");
    let most = number("maximum").map(|x| format!("up to {x}"));
    let below = number("exclusiveMaximum").map(|x| format!("to below {x}"));
    let end = most.or(below);
    match (least, above, end) {
        (Some(least), _, Some(end)) => format!(" from {least} {}", end.replace("up to", "to")),
        (_, Some(above), Some(end)) => format!(" above {above} and {end}"),
        (Some(least), _, None) => format!(" from {least} on"),
        (_, Some(above), None) => format!(" above {above}"),
        (None, None, Some(end)) => format!(" {end}"),
        (None, None, None) => String::new(),
    }
}

fn short(x: &Value) -> String {
    match x.as_f64() {
        Some(x) if x != 0.0 && (x.abs() >= 1e6 || x.abs() < 1e-3) => format!("{x:e}"),
        Some(x) => x.to_string(),
        None => x.to_string(),
    }
}

/// A value of the kind, as a scene may have it.
pub(crate) fn sample(node: &Value) -> String {
    let example = node.get("examples").and_then(|list| list.get(0));
    if let Some(example) = example {
        return written(example);
    }
    let Some(kind) = alternatives(node).into_iter().next() else {
        return String::new();
    };
    if let Some(word) = words_of(kind).first() {
        return format!("\"{word}\"");
    }
    match kind.get("type").and_then(Value::as_str) {
        Some("number") => "1.0".to_owned(),
        Some("integer") => "2".to_owned(),
        Some("boolean") => "true".to_owned(),
        Some("array") => {
            let one = kind.get("items").map(sample).unwrap_or_default();
            let n = kind.get("minItems").and_then(Value::as_u64).unwrap_or(1);
            format!("[{}]", vec![one; n as usize].join(", "))
        }
        Some("object") => sample_with(kind, "", ""),
        _ => "\"...\"".to_owned(),
    }
}

/// A table of the kind with a value for one of its keys.
pub(crate) fn sample_with(kind: &Value, key: &str, value: &str) -> String {
    let needed = required(kind);
    let chosen = properties(kind).filter(|(name, _)| needed.contains(name) || *name == key);
    let keys: Vec<String> = chosen
        .map(|(name, node)| match name == key {
            true => format!("{name} = {value}"),
            false => format!("{name} = {}", sample(node)),
        })
        .collect();
    match keys.is_empty() {
        true => "{}".to_owned(),
        false => format!("{{ {} }}", keys.join(", ")),
    }
}

/// A value as TOML writes it on one line.
pub(crate) fn written(value: &Value) -> String {
    match value {
        Value::Number(x) if x.is_f64() => format!("{:?}", x.as_f64().unwrap_or_default()),
        Value::Array(list) => {
            let list: Vec<String> = list.iter().map(written).collect();
            format!("[{}]", list.join(", "))
        }
        Value::Object(map) if map.is_empty() => "{}".to_owned(),
        Value::Object(map) => {
            let keys: Vec<String> = map
                .iter()
                .map(|(k, v)| format!("{k} = {}", written(v)))
                .collect();
            format!("{{ {} }}", keys.join(", "))
        }
        other => other.to_string(),
    }
}

/// Words with commas between them, and a last one.
pub(crate) fn listed<S: AsRef<str>>(words: &[S], last: &str) -> String {
    match words {
        [first @ .., end] if !first.is_empty() => {
            let first: Vec<&str> = first.iter().map(AsRef::as_ref).collect();
            format!("{} {last} {}", first.join(", "), end.as_ref())
        }
        words => words.iter().map(AsRef::as_ref).collect(),
    }
}

/// Whether values of this kind are tables of settings rather than one of several choices.
pub(crate) fn is_table(node: &Value) -> bool {
    is(node, "object") || node.get("x-table").is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_read_as_sentences() {
        let list = |n: usize| {
            let words = ["a", "b", "c"][..n].iter().map(ToString::to_string);
            listed(&words.collect::<Vec<String>>(), "or")
        };
        assert_eq!([list(0), list(1)], ["", "a"]);
        assert_eq!([list(2), list(3)], ["a or b", "a, b or c"]);
    }
}
