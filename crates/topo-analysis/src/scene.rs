//! A scene file of either battery, told by its tables.

mod axis;
mod beside;
mod document;
mod folder;
mod numbers;

use std::path::Path;

pub(crate) use axis::{Access, SweptKey, axes, check_count, product, put_axes, remove};
pub use axis::{Axis, AxisValue};
pub(crate) use beside::BesideQ;
pub(crate) use document::Document;
pub(crate) use folder::folder_of;
pub(crate) use numbers::{numbers, repeated, repeated_number};

use crate::{AnalysisError, ElasticScene, NematicScene};

/// What a scene file describes.
#[derive(Debug, Clone, PartialEq)]
pub enum Scene {
    /// A file with a table `[rod]`.
    Elastic(Box<ElasticScene>),
    /// A file with a table `[nematic]`.
    Nematic(Box<NematicScene>),
}

impl Scene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// File, line, key and what would be right.
    pub fn read(path: &Path) -> Result<Self, AnalysisError> {
        Self::parse(&read_text(path)?, path)
    }

    /// Reads a scene from a text; `path` names it in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, AnalysisError> {
        let wrong = |message| AnalysisError::Scene {
            path: path.to_owned(),
            message,
        };
        let tables: toml::Table = toml::from_str(text).map_err(|e| wrong(e.to_string()))?;
        match (tables.contains_key("rod"), tables.contains_key("nematic")) {
            (true, false) => Ok(Self::Elastic(Box::new(ElasticScene::parse(text, path)?))),
            (false, true) => Ok(Self::Nematic(Box::new(NematicScene::parse(text, path)?))),
            (true, true) => Err(wrong(
                "the tables [rod] and [nematic] are both there: keep one, a scene is one battery"
                    .to_owned(),
            )),
            (false, false) => Err(wrong(
                "no table [rod] (a knotted fibre) or [nematic] (a colloid): write one".to_owned(),
            )),
        }
    }
}

/// The text of a scene file.
pub(crate) fn read_text(path: &Path) -> Result<String, AnalysisError> {
    std::fs::read_to_string(path).map_err(|source| AnalysisError::Unreadable {
        path: path.to_owned(),
        source,
    })
}

/// The dotted keys of all numbers and lists of numbers in a file.
#[cfg(test)]
pub(crate) fn numbers_written(file: &toml::Table) -> Vec<String> {
    fn is_numeric(value: &toml::Value) -> bool {
        match value {
            toml::Value::Integer(_) | toml::Value::Float(_) => true,
            toml::Value::Array(list) => list.iter().any(is_numeric),
            toml::Value::Table(table) => table.values().any(is_numeric),
            _ => false,
        }
    }
    let mut keys = Vec::new();
    for (name, value) in file {
        match value {
            toml::Value::Table(table) => {
                let inner = numbers_written(table);
                keys.extend(inner.iter().map(|key| format!("{name}.{key}")));
            }
            value if is_numeric(value) => keys.push(name.clone()),
            _ => {}
        }
    }
    keys
}
