//! `topo scene schema`: what scene files may hold, for editors.

use serde_json::{Value, json};

use crate::batteries::Batteries;

/// The JSON schema of the scenes of these batteries.
pub fn schema(batteries: &Batteries<'_>) -> Value {
    let scenes: Vec<Value> = batteries
        .iter()
        .filter_map(|battery| {
            let mut scene = battery.keys()?.schema().clone();
            let head = scene.as_object_mut()?;
            head.remove("$schema");
            head.insert(
                "title".to_owned(),
                json!(format!("scene of {}", battery.what())),
            );
            Some(scene)
        })
        .collect();
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "topo scene",
        "oneOf": scenes,
    })
}

/// The same as text.
pub fn schema_text(batteries: &Batteries<'_>) -> String {
    format!("{:#}\n", schema(batteries))
}
