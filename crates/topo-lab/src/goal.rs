//! Accuracy as a goal: a scene says how far off its discharge times may be, or how long it may take, and the measured table
//! says which settings do that.

mod choice;
mod choose;
mod difference;
mod errors;
mod holds;
mod pair;
mod record;
mod setting;
mod table;

pub use choice::{Choice, ErrorKind, ErrorRow, Point};
pub(crate) use choose::{Load, choose};
pub(crate) use difference::extrapolated;
pub use errors::{errors_of_colloids, errors_of_rods};
pub use holds::{CheckRow, Cover, check_estimates, factor_of_estimates};
pub use record::{Factor, Measured, Record, Stamp, table_hash};
pub use table::points;

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, MapAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer, Serialize};

/// What a scene asks for instead of settings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Goal {
    /// Largest relative error of the last discharge time listed: t99 of a rod, t99.9 of a colloid.
    Accuracy(f64),
    /// Seconds that the cases may take together.
    Budget(f64),
}

impl Goal {
    /// A goal for an accuracy.
    ///
    /// # Errors
    /// What would be right.
    pub fn accuracy(error: f64) -> Result<Self, String> {
        if error > 0.0 && error <= 1.0 {
            Ok(Self::Accuracy(error))
        } else {
            Err("a relative error above 0 and up to 1 is needed, such as 0.02".to_owned())
        }
    }

    /// A goal for a budget of time, such as `10 min`.
    ///
    /// # Errors
    /// What would be right.
    pub fn budget(text: &str) -> Result<Self, String> {
        match humantime::parse_duration(text) {
            Ok(time) if !time.is_zero() => Ok(Self::Budget(time.as_secs_f64())),
            Ok(_) => Err("a time above zero is needed, such as \"10 min\"".to_owned()),
            Err(e) => Err(format!(
                "{e}; write a time such as \"10 min\" or \"2h 30min\""
            )),
        }
    }
}

impl fmt::Display for Goal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Accuracy(error) => write!(f, "accuracy = {error}"),
            Self::Budget(seconds) => {
                write!(f, "budget = \"{}\"", duration(*seconds))
            }
        }
    }
}

/// A time as scenes write it; what is beyond all ages is as long as can be written.
fn duration(seconds: f64) -> String {
    use std::time::Duration;
    let time = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
    humantime::format_duration(time).to_string()
}

/// The key `budget` of a scene with this goal.
pub(crate) fn budget(goal: Option<Goal>) -> Option<String> {
    match goal {
        Some(Goal::Budget(seconds)) => Some(duration(seconds)),
        _ => None,
    }
}

/// The key `accuracy` of a scene: a number, or a table of settings.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum GoalOr<T> {
    /// A relative error.
    Goal(f64),
    /// Settings.
    Settings(T),
}

impl<T: Default> Default for GoalOr<T> {
    fn default() -> Self {
        Self::Settings(T::default())
    }
}

// A derived untagged enum would lose the line and the key of what is wrong.
impl<'de, T: Deserialize<'de>> Deserialize<'de> for GoalOr<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Either<T> {
            type Value = GoalOr<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a relative error such as 0.02, or a table [accuracy]")
            }

            fn visit_f64<E: de::Error>(self, x: f64) -> Result<Self::Value, E> {
                Ok(GoalOr::Goal(x))
            }

            fn visit_i64<E: de::Error>(self, x: i64) -> Result<Self::Value, E> {
                Ok(GoalOr::Goal(x as f64))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(GoalOr::Settings)
            }
        }
        deserializer.deserialize_any(Either(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for GoalOr<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("GoalOr{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let error = json_schema!({ "type": "number", "exclusiveMinimum": 0, "maximum": 1 });
        let settings = generator.subschema_for::<T>();
        json_schema!({ "x-table": true, "anyOf": [error, settings], "examples": [0.02] })
    }
}

impl<T: Default + PartialEq> GoalOr<T> {
    /// The settings and the goal of a scene with this key and the key `budget`, or the key at fault, its value and what would
    /// be right.
    pub(crate) fn with_budget(
        self,
        budget: Option<&str>,
    ) -> Result<(T, Option<Goal>), (&'static str, String, String)> {
        match (self, budget) {
            (Self::Goal(error), None) => Goal::accuracy(error)
                .map(|goal| (T::default(), Some(goal)))
                .map_err(|remedy| ("accuracy", error.to_string(), remedy)),
            (Self::Goal(error), Some(_)) => Err((
                "accuracy",
                error.to_string(),
                "keep either accuracy or budget".to_owned(),
            )),
            (Self::Settings(settings), None) => Ok((settings, None)),
            (Self::Settings(settings), Some(text)) if settings != T::default() => Err((
                "budget",
                format!("\"{text}\""),
                "it stands instead of the table [accuracy]: keep one of the two".to_owned(),
            )),
            (Self::Settings(_), Some(text)) => Goal::budget(text)
                .map(|goal| (T::default(), Some(goal)))
                .map_err(|remedy| ("budget", format!("\"{text}\""), remedy)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Default, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields, default)]
    struct Settings {
        edges: Option<usize>,
    }

    #[derive(Debug, Deserialize)]
    struct File {
        #[serde(default)]
        accuracy: GoalOr<Settings>,
        budget: Option<String>,
    }

    fn parse(text: &str) -> Result<(Settings, Option<Goal>), String> {
        let file: File = toml::from_str(text).map_err(|e| e.to_string())?;
        file.accuracy
            .with_budget(file.budget.as_deref())
            .map_err(|(key, value, remedy)| format!("{key} = {value}: {remedy}"))
    }

    #[test]
    fn a_number_is_a_goal_and_a_table_is_settings() {
        assert_eq!(
            parse("accuracy = 0.02").unwrap().1,
            Some(Goal::Accuracy(0.02))
        );
        assert_eq!(parse("accuracy = 1").unwrap().1, Some(Goal::Accuracy(1.0)));
        assert_eq!(
            parse("budget = \"10 min\"").unwrap().1,
            Some(Goal::Budget(600.0))
        );
        let (settings, goal) = parse("[accuracy]\nedges = 120").unwrap();
        assert_eq!((settings.edges, goal), (Some(120), None));
        assert_eq!(parse("").unwrap(), (Settings::default(), None));
    }

    #[test]
    fn bad_goals_are_refused_with_what_would_be_right() {
        for (text, words) in [
            ("accuracy = 0.0", ["accuracy = 0", "0.02"]),
            ("accuracy = -1", ["accuracy = -1", "0.02"]),
            ("accuracy = nan", ["accuracy = NaN", "0.02"]),
            ("accuracy = 2.0", ["accuracy = 2", "up to 1"]),
            ("budget = \"soon\"", ["budget = \"soon\"", "10 min"]),
            ("budget = \"0\"", ["budget", "above zero"]),
            ("accuracy = 0.1\nbudget = \"1h\"", ["accuracy", "either"]),
            (
                "budget = \"1h\"\n[accuracy]\nedges = 90",
                ["budget", "instead"],
            ),
            ("accuracy = \"good\"", ["accuracy", "0.02"]),
            ("[accuracy]\nedgse = 3", ["edgse", "edges"]),
        ] {
            let message = parse(text).unwrap_err();
            for word in words {
                assert!(message.contains(word), "{text:?} gives {message:?}");
            }
        }
    }

    #[test]
    fn goals_are_printed_as_they_are_written() {
        assert_eq!(Goal::Accuracy(0.02).to_string(), "accuracy = 0.02");
        assert_eq!(Goal::Budget(600.0).to_string(), "budget = \"10m\"");
    }
}
