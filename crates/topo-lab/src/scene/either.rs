//! A scene file of either battery, told by its tables.

use std::path::Path;

use super::document::read_text;
use crate::elastic::ElasticScene;
use crate::error::LabError;
use crate::nematic::NematicScene;

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
    pub fn read(path: &Path) -> Result<Self, LabError> {
        Self::parse(&read_text(path)?, path)
    }

    /// Reads a scene from a text; `path` names it in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, LabError> {
        let wrong = |message| LabError::Scene {
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
