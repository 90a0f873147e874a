//! The keys of a battery's scenes, as the types of its file have them: what each may be, its unit, its default.
//!
//! One description serves messages ([`Keys::faults`]), the reference ([`Keys::rows`]), new scenes and the schema for editors.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value, json};

use super::axis::{Access, SweptKey};
use super::numbers::MOST_CASES;

/// What the keys of a scene may be: a JSON schema without references, in which a list or a range stands where cases may have
/// several values.
///
/// Besides the words of JSON Schema it has `x-unit`, `x-default` (a default in words), `x-form` (a form in words), `x-table` (a value or
/// a table), `x-several` (values of several cases), `x-optional` (a table that is not modelled where it is left out) and `x-as` (what is described elsewhere).
#[derive(Debug, Clone, PartialEq)]
pub struct Keys {
    schema: Value,
}

impl Keys {
    /// The keys of the type of a file; fields say their unit by `#[schemars(extend("x-unit" = "h"))]`.
    pub fn of<F: JsonSchema>() -> Self {
        let settings = SchemaSettings::draft07().with(|s| s.inline_subschemas = true);
        let mut schema = settings
            .into_generator()
            .into_root_schema_for::<F>()
            .to_value();
        plain(&mut schema);
        Self { schema }
    }

    /// With the keys of a list of those that may have several values.
    pub(crate) fn with_several<C>(mut self, keys: &[SweptKey<C>]) -> Self {
        for key in keys {
            // what belongs to the material may stand in the table of the colloid too
            let inside = format!("nematic.{}", key.key);
            let places = [
                Some(key.key),
                key.key.starts_with("material.").then_some(&*inside),
            ];
            for place in places.into_iter().flatten() {
                if let Some(node) = self.node_mut(place) {
                    several(node, matches!(key.access, Access::Choice(..)));
                }
            }
        }
        self
    }

    /// With one more key.
    pub(crate) fn with(mut self, key: &str, node: Value) -> Self {
        let (table, name) = key.rsplit_once('.').unwrap_or(("", key));
        if let Some(Value::Object(properties)) =
            self.node_mut(table).and_then(|n| n.get_mut("properties"))
        {
            // before the others
            let others = std::mem::take(properties);
            properties.insert(name.to_owned(), node);
            properties.extend(others);
        }
        self
    }

    /// The JSON schema of these scenes.
    pub fn schema(&self) -> &Value {
        &self.schema
    }

    fn node_mut(&mut self, key: &str) -> Option<&mut Value> {
        let mut node = &mut self.schema;
        for part in key.split('.').filter(|part| !part.is_empty()) {
            node = inner_mut(node, part)?;
        }
        Some(node)
    }
}

fn inner_mut<'a>(node: &'a mut Value, part: &str) -> Option<&'a mut Value> {
    if node
        .pointer("/properties")
        .is_some_and(|p| p.get(part).is_some())
    {
        return node.get_mut("properties")?.get_mut(part);
    }
    let list = match node.get("anyOf").is_some() {
        true => node.get_mut("anyOf"),
        false => node.get_mut("oneOf"),
    };
    let alternatives = list?.as_array_mut()?;
    alternatives.iter_mut().find_map(|a| inner_mut(a, part))
}

/// The values that a key may have, one kind each.
pub(crate) fn alternatives(node: &Value) -> Vec<&Value> {
    let list = ["anyOf", "oneOf"].iter().find_map(|name| node.get(name));
    match list.and_then(Value::as_array) {
        Some(list) => list.iter().flat_map(alternatives).collect(),
        None => vec![node],
    }
}

/// The keys of a table.
pub(crate) fn properties(node: &Value) -> impl Iterator<Item = (&str, &Value)> {
    let map = node.get("properties").and_then(Value::as_object);
    map.into_iter()
        .flatten()
        .map(|(name, node)| (name.as_str(), node))
}

/// The key of a table with a name.
pub(crate) fn property<'a>(node: &'a Value, name: &str) -> Option<&'a Value> {
    node.get("properties")?.get(name)
}

/// Whether a node is of a type, such as `number`.
pub(crate) fn is(node: &Value, kind: &str) -> bool {
    node.get("type").and_then(Value::as_str) == Some(kind)
}

/// Leaves what scenes can say: no null, no formats, no keys but those named.
fn plain(node: &mut Value) {
    match node {
        Value::Array(list) => list.iter_mut().for_each(plain),
        Value::Object(map) => {
            without_null(map);
            if map.get("type") == Some(&json!("object")) {
                map.insert("additionalProperties".to_owned(), json!(false));
            }
            // defaults and examples are values, not nodes
            for (name, inner) in map.iter_mut() {
                if !matches!(name.as_str(), "default" | "examples" | "enum") {
                    plain(inner);
                }
            }
        }
        _ => {}
    }
}

fn without_null(map: &mut Map<String, Value>) {
    map.remove("format");
    map.remove("title");
    let default = map.get("default");
    if default.is_some_and(|value| value.is_null() || is_settings(map)) {
        map.remove("default");
    }
    if let Some(Value::Array(types)) = map.get("type") {
        let one = types.iter().find(|t| *t != "null").cloned();
        map.insert("type".to_owned(), one.unwrap_or(Value::Null));
        if map.contains_key("properties") {
            map.insert("x-optional".to_owned(), json!(true));
        }
    }
    if let Some(Value::Array(list)) = map.get_mut("anyOf") {
        list.retain(|a| a.get("type") != Some(&json!("null")));
        if let [Value::Object(one)] = &list[..] {
            let one = one.clone();
            map.remove("anyOf");
            // what is said of the key goes before what is said of its type
            for (name, value) in one {
                map.entry(name).or_insert(value);
            }
        }
    }
    if let Some(Value::String(text)) = map.get_mut("description") {
        *text = sentence(text);
    }
}

/// Whether a node is a table of settings, whose keys have their own defaults.
fn is_settings(map: &Map<String, Value>) -> bool {
    map.contains_key("properties") || map.contains_key("x-table")
}

/// The first paragraph of a comment as one line, without the links of Rust.
fn sentence(text: &str) -> String {
    let first = text.split("\n\n").next().unwrap_or_default();
    let words: Vec<&str> = first.split_whitespace().collect();
    words.join(" ").replace("[`", "`").replace("`]", "`")
}

/// The node of a key that may have several numbers.
pub(crate) fn numbers(one: Value) -> Schema {
    let mut node = one;
    several(&mut node, false);
    Schema::try_from(node).unwrap_or_default()
}

/// Turns a node of one value into one of several: a list or, of numbers, a range.
fn several(node: &mut Value, is_choice: bool) {
    let Value::Object(map) = node else { return };
    let about = ["description", "default", "examples", "x-unit", "x-default"];
    let mut outer = Map::new();
    for name in about {
        outer.extend(map.remove(name).map(|value| (name.to_owned(), value)));
    }
    let one = Value::Object(std::mem::take(map));
    let list = json!({ "type": "array", "items": one.clone(), "minItems": 1, "x-several": true });
    let mut kinds: Vec<Value> = alternatives(&one).into_iter().cloned().collect();
    kinds.push(list);
    if !is_choice {
        kinds.push(range());
    }
    outer.insert("anyOf".to_owned(), Value::Array(kinds));
    *map = outer;
}

/// A range of numbers.
pub(crate) fn range() -> Value {
    json!({
        "type": "object",
        "properties": {
            "from": { "description": "First.", "type": "number", "examples": [1] },
            "to": { "description": "Last.", "type": "number", "examples": [2] },
            "n": { "description": "How many, both ends counted.", "type": "integer", "minimum": 1, "maximum": MOST_CASES, "examples": [3] }
        },
        "required": ["from", "to", "n"],
        "additionalProperties": false,
        "x-several": true
    })
}
