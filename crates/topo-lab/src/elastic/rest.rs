//! The natural shape of a scene's fibres: curved or twisted at rest, all along or as a file says.

mod profile;

use std::fmt::Display;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize, Serializer};
use serde_json::{Value, json};
use topo_rod::{RodBattery, RodError};

pub use profile::RestProfile;

use super::tie::{digits, quoted, wrong};
use crate::LabError;
use crate::folder::identity;

/// The keys.
pub(super) const CURVATURE: &str = "rod.rest.curvature";
pub(super) const TWIST: &str = "rod.rest.twist";

/// Columns of a file of curvatures, after `s`.
const CURVATURES: [&str; 2] = ["curvature_1", "curvature_2"];
/// The same of twists.
const TWISTS: [&str; 1] = ["twist"];

/// A natural curvature of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
enum CurvatureKey {
    /// κ_1.
    One(f64),
    /// κ_1 and κ_2.
    Two([f64; 2]),
    /// A file.
    Along(String),
}

/// A natural twist of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
enum TwistKey {
    /// All along.
    One(f64),
    /// A file.
    Along(String),
}

/// How the fibre is curved and twisted where nothing bends or twists it; without the table it is straight.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct RestTable {
    /// Natural curvature: a number bends the fibre the way it is bent where its ends are fused, a pair is the curvature about the two
    /// directors across it; or a file beside the scene with columns `s,curvature_1,curvature_2`, s in s/L from 0 to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1/h", "x-default" = "straight"), example = 0.1)]
    curvature: Option<CurvatureKey>,
    /// Natural twist: a number, or a file beside the scene with columns `s,twist`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-unit" = "1/h", "x-default" = "untwisted"), example = 0.2)]
    twist: Option<TwistKey>,
}

/// What a scene says of the natural shape, and where its files are.
#[derive(Debug, Clone, Serialize)]
pub struct RestKeys {
    #[serde(flatten)]
    table: RestTable,
    /// Folder of the scene's file.
    #[serde(skip)]
    beside: PathBuf,
    /// What it comes to, once the files have been read.
    #[serde(skip)]
    made: Arc<OnceLock<Arc<Rest>>>,
}

/// What was read before is no part of it.
impl PartialEq for RestKeys {
    fn eq(&self, other: &Self) -> bool {
        self.table == other.table
    }
}

impl RestKeys {
    pub(super) fn new(table: RestTable, beside: PathBuf) -> Self {
        Self {
            table,
            beside,
            made: Arc::default(),
        }
    }

    /// The table of a scene's file.
    pub(super) fn table(&self) -> RestTable {
        self.table.clone()
    }

    /// Whether the table has no key.
    pub(super) fn is_empty(&self) -> bool {
        self.table == RestTable::default()
    }

    /// Whether files say some of it.
    pub(super) fn has_files(&self) -> bool {
        matches!(self.table.curvature, Some(CurvatureKey::Along(_)))
            || matches!(self.table.twist, Some(TwistKey::Along(_)))
    }

    /// The same with files named so that they are found from anywhere.
    pub(super) fn found_from_anywhere(&self) -> Self {
        let anywhere = |written: &mut String| {
            let path = self.beside.join(&*written);
            let path = std::path::absolute(&path).unwrap_or(path);
            *written = path.display().to_string();
        };
        let mut table = self.table.clone();
        if let Some(CurvatureKey::Along(written)) = &mut table.curvature {
            anywhere(written);
        }
        if let Some(TwistKey::Along(written)) = &mut table.twist {
            anywhere(written);
        }
        Self::new(table, PathBuf::new())
    }

    /// The shape, read once.
    ///
    /// # Errors
    /// Numbers that no fibre has, or a file that cannot be read or is no profile, with the key.
    pub(super) fn made(&self) -> Result<&Arc<Rest>, LabError> {
        if let Some(made) = self.made.get() {
            return Ok(made);
        }
        let curvature = match &self.table.curvature {
            None => None,
            Some(CurvatureKey::One(x)) => Some(Along::same(CURVATURE, [*x, 0.0], x)?),
            Some(CurvatureKey::Two(pair)) => {
                let [a, b] = pair;
                Some(Along::same(CURVATURE, *pair, format!("[{a}, {b}]"))?)
            }
            Some(CurvatureKey::Along(file)) => Some(self.read(CURVATURE, file, CURVATURES)?),
        };
        let twist = match &self.table.twist {
            None => None,
            Some(TwistKey::One(x)) => Some(Along::same(TWIST, [*x], x)?),
            Some(TwistKey::Along(file)) => Some(self.read(TWIST, file, TWISTS)?),
        };
        let rest = Rest { curvature, twist };
        rest.check(&self.table)?;
        Ok(self.made.get_or_init(|| Arc::new(rest)))
    }

    fn read<const N: usize>(
        &self,
        key: &str,
        written: &str,
        columns: [&str; N],
    ) -> Result<Along<N>, LabError> {
        let path = self.beside.join(written);
        let refused = |remedy: String| wrong(key, quoted(written), remedy);
        let text = std::fs::read_to_string(&path).map_err(|e| {
            let columns = columns.join(",");
            refused(format!(
                "{}: {e}; name a text file beside the scene with columns s,{columns}, or give a number",
                path.display()
            ))
        })?;
        let profile = RestProfile::parse(&text, columns);
        let profile = profile.map_err(|e| refused(format!("{}: {e}", path.display())))?;
        Ok(Along::Profile(profile))
    }
}

/// Numbers along a component.
#[derive(Debug, Clone, PartialEq)]
enum Along<const N: usize> {
    /// Everywhere the same.
    Same([f64; N]),
    /// Those of a file.
    Profile(RestProfile<N>),
}

impl<const N: usize> Along<N> {
    fn same(key: &str, values: [f64; N], written: impl Display) -> Result<Self, LabError> {
        if values.iter().all(|x| x.is_finite()) {
            return Ok(Self::Same(values));
        }
        let remedy = "a finite number is needed";
        Err(wrong(key, written, remedy))
    }

    /// The values at s/L.
    fn at(&self, s: f64) -> [f64; N] {
        match self {
            Self::Same(values) => *values,
            Self::Profile(profile) => profile.at(s),
        }
    }

    fn values(&self) -> Box<dyn Iterator<Item = [f64; N]> + '_> {
        match self {
            Self::Same(values) => Box::new(std::iter::once(*values)),
            Self::Profile(profile) => Box::new(profile.values()),
        }
    }

    /// The numbers, or the identity of those of a file.
    fn json(&self) -> Value {
        match self {
            Self::Same(values) => match &values[..] {
                [only] | [only, 0.0] => json!(only),
                several => json!(several),
            },
            Self::Profile(profile) => json!(identity(&profile.json())),
        }
    }
}

/// The natural shape of the fibres of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Rest {
    curvature: Option<Along<2>>,
    twist: Option<Along<1>>,
}

impl Serialize for Rest {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        self.json(|value| value).serialize(to)
    }
}

impl Rest {
    /// Largest natural curvature, in 1/h: a fibre of radius h that is bent to a radius below h runs through itself.
    const MOST_CURVATURE: f64 = 1.0;

    fn check(&self, table: &RestTable) -> Result<(), LabError> {
        let curvatures = self.curvature.iter().flat_map(Along::values);
        let most = curvatures.map(|[a, b]| a.hypot(b)).fold(0.0, f64::max);
        if most <= Self::MOST_CURVATURE {
            return Ok(());
        }
        let written = match &table.curvature {
            Some(CurvatureKey::Along(file)) => quoted(file),
            Some(CurvatureKey::Two([a, b])) => format!("[{a}, {b}]"),
            Some(CurvatureKey::One(x)) => x.to_string(),
            None => String::new(),
        };
        let remedy = format!(
            "a fibre of radius h cannot be bent more tightly than 1/h, and this one is at rest to {most}/h: give at most {}",
            Self::MOST_CURVATURE
        );
        Err(wrong(CURVATURE, written, remedy))
    }

    /// The battery of fibres with this shape.
    pub(super) fn of(&self, battery: RodBattery) -> Result<RodBattery, RodError> {
        let components = battery.start().components().iter();
        let lengths: Vec<f64> = components.map(|chain| chain.length()).collect();
        let curvature = |c: usize, s: f64| {
            let along = self.curvature.as_ref();
            along.map_or([0.0; 2], |along| along.at(s / lengths[c]))
        };
        let twist = |c: usize, s: f64| {
            let along = self.twist.as_ref();
            along.map_or(0.0, |along| along.at(s / lengths[c])[0])
        };
        battery.with_rest(curvature, twist)
    }

    /// Whether it is not that of its mirror image, (κ_1, −κ_2) and −θ'.
    pub(super) fn is_chiral(&self) -> bool {
        let mut curvatures = self.curvature.iter().flat_map(Along::values);
        let mut twists = self.twist.iter().flat_map(Along::values);
        curvatures.any(|[_, b]| b != 0.0) || twists.any(|[x]| x != 0.0)
    }

    /// What tells it from others, for a name.
    pub(super) fn said(&self) -> Value {
        self.json(|value| match value {
            Value::String(identity) => json!(digits(&identity)),
            numbers => numbers,
        })
    }

    fn json(&self, of: impl Fn(Value) -> Value) -> Value {
        let mut all = serde_json::Map::new();
        let mut put = |key: &str, value: Option<Value>| {
            if let Some(value) = value {
                all.insert(key.to_owned(), of(value));
            }
        };
        put("curvature", self.curvature.as_ref().map(Along::json));
        put("twist", self.twist.as_ref().map(Along::json));
        Value::Object(all)
    }
}

#[cfg(test)]
mod tests;
