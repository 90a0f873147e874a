//! Names of case folders: short and readable where numbers are round, with a fingerprint where they are not.

use serde::Serialize;
use serde_json::Value;

use crate::folder::identity;

/// Most settings that a name spells out; where more differ from the usual ones, the fingerprint says the rest.
const MOST_WORDS: usize = 4;
/// Longest number that a name spells out.
const LONGEST_NUMBER: usize = 8;
/// Hexadecimal digits of the fingerprint in a name.
const DIGITS: usize = 10;

/// The name of a case while it is put together.
///
/// Two cases have the same name only if all their settings agree: whatever the words do not say exactly adds a fingerprint of
/// everything that the numbers of the case depend on.
///
/// # Validation
/// `names_tell_cases_apart`, `elastic_names_are_injective`, `nematic_names_are_injective`
#[derive(Debug)]
pub struct CaseName {
    text: String,
    says_all: bool,
}

impl CaseName {
    /// A name that begins with a word.
    pub fn of(first: &str) -> Self {
        let name = Self {
            text: String::new(),
            says_all: true,
        };
        name.word(first)
    }

    /// Adds a word; what does not belong into the name of a folder is replaced.
    pub fn word(mut self, word: &str) -> Self {
        if !self.text.is_empty() {
            self.text.push('_');
        }
        for c in word.chars() {
            let is_plain = c.is_ascii_alphanumeric() || "_-+.#".contains(c);
            self.says_all &= is_plain;
            self.text.push(if is_plain { c } else { '-' });
        }
        self
    }

    /// Adds a number after its label.
    pub fn number(self, label: &str, x: f64) -> Self {
        let (text, is_exact) = number(x);
        let mut name = self.word(&format!("{label}{text}"));
        name.says_all &= is_exact;
        name
    }

    /// Adds a number with its sign and at least two decimals.
    pub fn signed(self, label: &str, x: f64) -> Self {
        let (text, is_exact) = [format!("{x:+.2}"), format!("{x:+}")]
            .into_iter()
            .find(|text| text.len() <= LONGEST_NUMBER && is_exactly(text, x))
            .map_or_else(|| (format!("{x:+.4}"), false), |text| (text, true));
        let mut name = self.word(&format!("{label}{text}"));
        name.says_all &= is_exact;
        name
    }

    /// Adds what differs from the usual settings; keys that begin with one of `but` are said elsewhere.
    pub fn changes(mut self, settings: &Value, usual: &Value, but: &[&str]) -> Self {
        let mut changed: Vec<(String, Option<Value>)> = Vec::new();
        differences("", Some(settings), Some(usual), &mut changed);
        changed.retain(|(key, _)| !but.iter().any(|b| key.starts_with(b)));
        self.says_all &= changed.len() <= MOST_WORDS;
        for (key, value) in changed.iter().take(MOST_WORDS) {
            let key = key.replace(['.', '_'], "-");
            self = match value {
                None | Some(Value::Null) => self.word(&format!("no-{key}")),
                Some(value) => match brief(value) {
                    Some(text) => self.word(&format!("{key}{text}")),
                    None => {
                        self.says_all = false;
                        self.word(&key)
                    }
                },
            };
        }
        self
    }

    /// Notes settings that a name never spells out.
    pub fn unsaid(mut self, settings: &Value, usual: &Value) -> Self {
        self.says_all &= settings == usual;
        self
    }

    /// Notes a setting that the words do not say.
    pub fn unsaid_if(mut self, is_unsaid: bool) -> Self {
        self.says_all &= !is_unsaid;
        self
    }

    /// The name; `all` is everything that the numbers of the case depend on.
    pub fn finish(self, all: impl FnOnce() -> Value) -> String {
        if self.says_all {
            return self.text;
        }
        format!("{}-{}", self.text, &identity(&all())[..DIGITS])
    }
}

/// Settings as JSON; structures of numbers, names and lists always have one.
pub(crate) fn value<T: Serialize>(settings: &T) -> Value {
    serde_json::to_value(settings).unwrap_or(Value::Null)
}

/// A number as short as it is read back exactly; rounded where that is long.
fn number(x: f64) -> (String, bool) {
    let text = format!("{x}");
    if text.len() <= LONGEST_NUMBER {
        return (text, true);
    }
    let text = format!("{x:e}");
    if text.len() <= LONGEST_NUMBER {
        return (text, true);
    }
    (format!("{x:.3e}"), false)
}

fn is_exactly(text: &str, x: f64) -> bool {
    text.parse::<f64>()
        .is_ok_and(|y| y.to_bits() == x.to_bits())
}

/// A short value in one word; none where it would be long.
fn brief(value: &Value) -> Option<String> {
    let exact = |value: &Value| match value {
        Value::Number(x) => Some(number(x.as_f64()?)).filter(|n| n.1).map(|n| n.0),
        _ => None,
    };
    match value {
        Value::Bool(true) => Some(String::new()),
        Value::Bool(false) => Some("-off".to_owned()),
        Value::String(text) => Some(format!("-{text}")),
        Value::Number(_) => exact(value),
        Value::Array(all) if all.len() <= 3 => {
            let all: Option<Vec<String>> = all.iter().map(exact).collect();
            Some(all?.join("x"))
        }
        _ => None,
    }
}

/// The leaves in which two tables differ, with what the first has there.
pub(crate) fn differences(
    key: &str,
    a: Option<&Value>,
    b: Option<&Value>,
    found: &mut Vec<(String, Option<Value>)>,
) {
    let (Some(Value::Object(a)), Some(Value::Object(b))) = (a, b) else {
        if a != b {
            found.push((key.to_owned(), a.cloned()));
        }
        return;
    };
    let mut keys: Vec<&String> = a.keys().chain(b.keys()).collect();
    keys.sort();
    keys.dedup();
    for inner in keys {
        let dotted = if key.is_empty() {
            inner.clone()
        } else {
            format!("{key}.{inner}")
        };
        differences(&dotted, a.get(inner), b.get(inner), found);
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn name(twist: f64, settings: &Value) -> String {
        CaseName::of("3_1")
            .signed("twist", twist)
            .changes(
                settings,
                &json!({"contact": {"stiffness": 20.0}, "slenderness": 50.0}),
                &[],
            )
            .finish(|| json!([twist.to_bits(), settings]))
    }

    #[test]
    fn round_numbers_are_spelled_out() {
        let usual = json!({"contact": {"stiffness": 20.0}, "slenderness": 50.0});
        assert_eq!(name(0.0, &usual), "3_1_twist+0.00");
        assert_eq!(name(-1.75, &usual), "3_1_twist-1.75");
        assert_eq!(name(1.004, &usual), "3_1_twist+1.004");
        assert_eq!(name(-0.0025, &usual), "3_1_twist-0.0025");
        let other = json!({"contact": {"stiffness": 5.0}, "slenderness": 60.5});
        assert_eq!(
            name(1.0, &other),
            "3_1_twist+1.00_contact-stiffness5_slenderness60.5"
        );
        let none = json!({"contact": null, "slenderness": 50.0});
        assert_eq!(name(1.0, &none), "3_1_twist+1.00_no-contact");
    }

    #[test]
    fn names_tell_cases_apart() {
        let usual = json!({"contact": {"stiffness": 20.0}, "slenderness": 50.0});
        let third: f64 = 1.0 / 3.0;
        let near = f64::from_bits(third.to_bits() + 1);
        assert!(name(third, &usual).starts_with("3_1_twist+0.3333-"));
        assert_ne!(name(third, &usual), name(near, &usual));
        assert_ne!(name(0.0, &usual), name(-0.0, &usual));
        let settings = |k: f64| json!({"contact": {"stiffness": k}, "slenderness": 50.0});
        assert_ne!(
            name(0.0, &settings(20.0 * third)),
            name(0.0, &settings(20.0 * near))
        );
        // what is no part of a folder's name is replaced, and kept distinct all the same
        let odd = |knot: &str| CaseName::of(knot).finish(|| json!(knot));
        assert_ne!(odd("a/b"), odd("a-b"));
        assert!(!odd("../a b").contains(['/', ' ']));
    }
}
