//! Accuracy by wish: a scene says how far off its discharge times may be, or how long it may take, and the measured table
//! says which settings do that.

mod choice;
mod difference;
mod errors;
mod grant;
mod holds;
mod pair;
mod record;
mod setting;
mod table;

pub(crate) use choice::{Load, grant};
pub(crate) use difference::extrapolated;
pub use errors::{errors_of_colloids, errors_of_rods};
pub use grant::{ErrorRow, Grant, Point};
pub use holds::{CheckRow, Cover, check_estimates, factor_of_estimates};
pub use record::{Factor, Measured, Record, Stamp, table_hash};
pub use table::points;

use std::fmt;
use std::marker::PhantomData;

use serde::de::{self, MapAccess, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer, Serialize};

/// What a scene asks for instead of settings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Wish {
    /// Largest relative error of the last discharge time listed: t99 of a rod, t99.9 of a colloid.
    Accuracy(f64),
    /// Seconds that the cases may take together.
    Budget(f64),
}

impl Wish {
    /// A wish for an accuracy.
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

    /// A wish for a budget of time, such as `10 min`.
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

impl fmt::Display for Wish {
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

/// The key `budget` of a scene with this wish.
pub(crate) fn budget(wish: Option<Wish>) -> Option<String> {
    match wish {
        Some(Wish::Budget(seconds)) => Some(duration(seconds)),
        _ => None,
    }
}

/// The key `accuracy` of a scene: a number, or a table of settings.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum WishOr<T> {
    /// A relative error.
    Wish(f64),
    /// Settings.
    Settings(T),
}

impl<T: Default> Default for WishOr<T> {
    fn default() -> Self {
        Self::Settings(T::default())
    }
}

// A derived untagged enum would lose the line and the key of what is wrong.
impl<'de, T: Deserialize<'de>> Deserialize<'de> for WishOr<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Either<T> {
            type Value = WishOr<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a relative error such as 0.02, or a table [accuracy]")
            }

            fn visit_f64<E: de::Error>(self, x: f64) -> Result<Self::Value, E> {
                Ok(WishOr::Wish(x))
            }

            fn visit_i64<E: de::Error>(self, x: i64) -> Result<Self::Value, E> {
                Ok(WishOr::Wish(x as f64))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(WishOr::Settings)
            }
        }
        deserializer.deserialize_any(Either(PhantomData))
    }
}

impl<T: Default + PartialEq> WishOr<T> {
    /// The settings and the wish of a scene with this key and the key `budget`, or the key at fault, its value and what would
    /// be right.
    pub(crate) fn with_budget(
        self,
        budget: Option<&str>,
    ) -> Result<(T, Option<Wish>), (&'static str, String, String)> {
        match (self, budget) {
            (Self::Wish(error), None) => Wish::accuracy(error)
                .map(|wish| (T::default(), Some(wish)))
                .map_err(|remedy| ("accuracy", error.to_string(), remedy)),
            (Self::Wish(error), Some(_)) => Err((
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
            (Self::Settings(_), Some(text)) => Wish::budget(text)
                .map(|wish| (T::default(), Some(wish)))
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
        accuracy: WishOr<Settings>,
        budget: Option<String>,
    }

    fn parse(text: &str) -> Result<(Settings, Option<Wish>), String> {
        let file: File = toml::from_str(text).map_err(|e| e.to_string())?;
        file.accuracy
            .with_budget(file.budget.as_deref())
            .map_err(|(key, value, remedy)| format!("{key} = {value}: {remedy}"))
    }

    #[test]
    fn a_number_is_a_wish_and_a_table_is_settings() {
        assert_eq!(
            parse("accuracy = 0.02").unwrap().1,
            Some(Wish::Accuracy(0.02))
        );
        assert_eq!(parse("accuracy = 1").unwrap().1, Some(Wish::Accuracy(1.0)));
        assert_eq!(
            parse("budget = \"10 min\"").unwrap().1,
            Some(Wish::Budget(600.0))
        );
        let (settings, wish) = parse("[accuracy]\nedges = 120").unwrap();
        assert_eq!((settings.edges, wish), (Some(120), None));
        assert_eq!(parse("").unwrap(), (Settings::default(), None));
    }

    #[test]
    fn bad_wishes_are_refused_with_what_would_be_right() {
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
    fn wishes_are_told_as_they_are_written() {
        assert_eq!(Wish::Accuracy(0.02).to_string(), "accuracy = 0.02");
        assert_eq!(Wish::Budget(600.0).to_string(), "budget = \"10m\"");
    }
}
