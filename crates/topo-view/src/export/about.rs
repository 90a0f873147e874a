//! What a file says of itself besides its points: parameters, units and sizes, so that it can be read without its case.

use serde_json::{Map, Value};

/// One thing said: numbers or words.
#[derive(Debug, Clone, PartialEq)]
pub enum Fact {
    /// A number or a few.
    Numbers(Vec<f64>),
    /// A name, a unit, a choice.
    Words(String),
}

impl From<f64> for Fact {
    fn from(value: f64) -> Self {
        Self::Numbers(vec![value])
    }
}

impl From<&str> for Fact {
    fn from(value: &str) -> Self {
        Self::Words(value.to_owned())
    }
}

/// All that is said, by name: field data of VTK, arrays of an archive.
#[derive(Debug, Clone, Default)]
pub struct About {
    facts: Vec<(String, Fact)>,
}

/// What of a scene holds for all of its cases.
const OF_SCENE: [&str; 6] = [
    "charge",
    "switch",
    "discharge",
    "accuracy",
    "imperfection",
    "seed",
];

impl About {
    /// What `run.json` of a case says: its `case` by the keys it has there, such as `rod.slenderness`, what holds for all cases
    /// of the scene, such as `discharge.until_released`, versions, and units.
    pub fn of(run: &Value) -> Self {
        let mut about = Self::default();
        about.add_table("", &run["case"]);
        for key in OF_SCENE {
            about.add(key, &run["scene"][key]);
        }
        about.add("versions", &run["versions"]);
        about.add("units", &run["units"]);
        about
    }

    /// The same with one fact more. What is said already stays.
    pub fn with(mut self, name: &str, fact: impl Into<Fact>) -> Self {
        self.put(name, fact.into());
        self
    }

    /// The same of one frame: the charged state, which has no time, or one of a discharge.
    ///
    /// `TimeValue` is the name by which VTK knows the time of a file.
    pub fn at(&self, time: Option<f64>) -> Self {
        let about = self.clone();
        match time {
            None => about.with("state", "charged"),
            Some(t) => about.with("state", "discharging").with("TimeValue", t),
        }
    }

    /// Everything, in the order in which it was said.
    pub fn facts(&self) -> impl Iterator<Item = (&str, &Fact)> {
        self.facts.iter().map(|(name, fact)| (name.as_str(), fact))
    }

    fn put(&mut self, name: &str, fact: Fact) {
        if self.facts.iter().all(|(known, _)| known != name) {
            self.facts.push((name.to_owned(), fact));
        }
    }

    /// Adds what JSON says. `null` is what is not modelled, and is left out.
    pub fn add(&mut self, name: &str, value: &Value) {
        match value {
            Value::Null => {}
            Value::Bool(b) => self.put(name, f64::from(u8::from(*b)).into()),
            Value::Number(_) => self.put(name, Fact::Numbers(numbers(value).unwrap_or_default())),
            Value::String(words) => self.put(name, words.as_str().into()),
            Value::Object(_) => self.add_table(&format!("{name}."), value),
            Value::Array(items) => match numbers(value) {
                Some(all) if all.is_empty() => {}
                Some(all) => self.put(name, Fact::Numbers(all)),
                None => {
                    for (k, item) in items.iter().enumerate() {
                        self.add(&format!("{name}.{k}"), item);
                    }
                }
            },
        }
    }

    /// Adds what a table says, its keys behind `lead`.
    pub fn add_table(&mut self, lead: &str, table: &Value) {
        for (key, value) in table.as_object().unwrap_or(&Map::new()) {
            self.add(&format!("{lead}{key}"), value);
        }
    }
}

/// The numbers of a number or of lists of nothing else.
fn numbers(value: &Value) -> Option<Vec<f64>> {
    match value {
        Value::Number(n) => n.as_f64().map(|x| vec![x]),
        Value::Array(items) => {
            let all: Option<Vec<_>> = items.iter().map(numbers).collect();
            all.map(|lists| lists.concat())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn parameters_keep_their_keys_and_what_is_not_modelled_is_left_out() {
        let run = json!({
            "case": { "knot": "3_1", "rod": { "slenderness": 50.0, "friction": null, "seed": 4 }, "seed": 7 },
            "scene": {
                "seed": 1, "knots": ["3_1"], "charge": { "coarse_start": true },
                "discharge": { "ends": { "conditions": ["free", "held"], "motions": [{ "velocity": [[0.0, 1.0], [2.0, 3.0]] }] } },
            },
            "units": { "length": "h" },
        });
        let about = About::of(&run).at(Some(0.5)).with("knot", "4_1");
        let facts: Vec<(&str, Fact)> = about.facts().map(|(n, f)| (n, f.clone())).collect();
        let expected: Vec<(&str, Fact)> = vec![
            ("knot", "3_1".into()),
            ("rod.slenderness", 50.0.into()),
            ("rod.seed", 4.0.into()),
            // what the case says goes before what the scene says
            ("seed", 7.0.into()),
            ("charge.coarse_start", 1.0.into()),
            ("discharge.ends.conditions.0", "free".into()),
            ("discharge.ends.conditions.1", "held".into()),
            (
                "discharge.ends.motions.0.velocity",
                Fact::Numbers(vec![0.0, 1.0, 2.0, 3.0]),
            ),
            ("units.length", "h".into()),
            ("state", "discharging".into()),
            ("TimeValue", 0.5.into()),
        ];
        assert_eq!(facts, expected);
    }
}
