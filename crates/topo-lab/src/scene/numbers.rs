//! Lists and ranges of numbers in a scene file.

use std::borrow::Cow;
use std::fmt::Display;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::document::Document;
use super::keys;
use crate::LabError;

/// Most cases of a scene, and most values of a key.
pub(super) const MOST_CASES: usize = 100_000;

/// Whether a value is meant as a range.
pub(super) fn is_range(value: &toml::Value) -> bool {
    value.is_table()
}

/// One value, a list of them, or evenly spaced numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum Numbers {
    /// One number.
    One(f64),
    /// A list.
    List(Vec<f64>),
    /// `n` numbers from `from` to `to`, both included.
    Range {
        /// First.
        from: f64,
        /// Last.
        to: f64,
        /// How many.
        n: usize,
    },
}

impl Numbers {
    /// The numbers meant.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::One(x) => vec![*x],
            Self::List(list) => list.clone(),
            Self::Range { from, n: 1, .. } => vec![*from],
            Self::Range { from, to, n } => {
                let scale = from.abs().max(to.abs());
                let at = |k: usize| from + (to - from) * k as f64 / (*n - 1) as f64;
                (0..*n).map(|k| rounded(at(k), scale)).collect()
            }
        }
    }
}

impl JsonSchema for Numbers {
    fn schema_name() -> Cow<'static, str> {
        "Numbers".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        keys::numbers(json!({ "type": "number" }))
    }
}

/// A number as short as rounding has left it: 0.3 for 0.30000000000000004, of numbers up to `scale`.
fn rounded(x: f64, scale: f64) -> f64 {
    let short = format!("{x:.12e}").parse().unwrap_or(x);
    if (short - x).abs() <= 4.0 * f64::EPSILON * scale {
        short
    } else {
        x
    }
}

impl Numbers {
    /// The numbers that a value of a file means.
    pub(super) fn of(
        document: &Document<'_>,
        key: &str,
        value: &toml::Value,
    ) -> Result<Self, LabError> {
        Self::deserialize(value.clone()).map_err(|_| {
            let remedy = "write a number, a list of numbers or { from = 1, to = 2, n = 3 }";
            document.wrong(key, document.written(key), remedy)
        })
    }
}

/// The values of a key that may be a number, a list or a range, if the file has it.
///
/// # Errors
/// Something else; no value, too many, one that is not finite, or the same one twice.
pub fn numbers(document: &Document<'_>, key: &str) -> Result<Option<Vec<f64>>, LabError> {
    let Some(found) = document.find(key) else {
        return Ok(None);
    };
    let numbers = Numbers::of(document, key, found.parsed)?;
    checked_numbers(document, key, &numbers).map(Some)
}

/// The values of a key: at least one, all finite and different.
pub(super) fn checked_numbers(
    document: &Document<'_>,
    key: &str,
    numbers: &Numbers,
) -> Result<Vec<f64>, LabError> {
    if let Numbers::Range { n, .. } = numbers
        && !(1..=MOST_CASES).contains(n)
    {
        let remedy = format!("ask for 1 to {MOST_CASES} values");
        return Err(document.wrong(&format!("{key}.n"), n, remedy));
    }
    let values = numbers.values();
    if values.is_empty() || values.len() > MOST_CASES {
        let remedy = format!("give 1 to {MOST_CASES} numbers, or leave the key out");
        return Err(document.wrong(key, document.written(key), remedy));
    }
    if let Some(x) = values.iter().find(|x| !x.is_finite()) {
        return Err(document.wrong(key, x, "a finite number is needed, such as 2.0"));
    }
    match repeated_number(&values) {
        Some(x) => Err(repeated(document, key, x)),
        None => Ok(values),
    }
}

/// A number that is there twice; 0 and -0 are one.
pub(crate) fn repeated_number(values: &[f64]) -> Option<f64> {
    let mut order: Vec<f64> = values.iter().map(|x| x + 0.0).collect();
    order.sort_by(f64::total_cmp);
    order.windows(2).find(|w| w[0] == w[1]).map(|w| w[1])
}

/// The error for a value that is there twice.
pub(crate) fn repeated(document: &Document<'_>, key: &str, value: impl Display) -> LabError {
    document.wrong(
        key,
        value,
        "it is there twice, in a list or as two numbers of a range that coincide: give each value once",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_of_round_numbers_are_round() {
        let range = |from, to, n| Numbers::Range { from, to, n }.values();
        assert_eq!(range(0.1, 0.4, 4), [0.1, 0.2, 0.3, 0.4]);
        assert_eq!(
            range(-0.01, 0.01, 9)[..4],
            [-0.01, -0.0075, -0.005, -0.0025]
        );
        assert_eq!(range(-0.01, 0.01, 9)[4].to_bits(), 0);
        // what is no short number stays as it is
        assert_eq!(range(0.0, 1.0, 4)[1], 1.0 / 3.0);
    }
}
