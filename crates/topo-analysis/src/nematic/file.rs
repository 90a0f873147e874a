//! Scene files: TOML that reads like the experiment.
//!
//! ```toml
//! [nematic]
//! radius = 25                          # particle, in xi_N
//! q = { from = 1, to = 12, n = 12 }    # a number, a list, or a range; or pattern = "homeotropic", ...
//! spacing = 1.5                        # edge of a cell, in xi_N
//! [charge]
//! tolerance = 1e-8                     # rms of the molecular field
//! [switch]                             # the anchoring after it: free, unless said otherwise
//! [discharge]
//! until-released = 0.9995
//! [flow]                               # leave the table out: no velocity is modelled
//! [accuracy]
//! tolerance = 3e-5
//! ```
//!
//! Instead of the spacing and the table `[accuracy]`, the first line may say `accuracy = 0.02` (relative error of t99.9) or
//! `budget = "10 min"`.

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use topo_nematic::{
    ChargeSettings, DischargeSettings, FlowParameters, NematicAccuracy, NematicParameters,
    SwitchSettings,
};

use super::scene::NematicScene;
use crate::AnalysisError;
use crate::elastic::Numbers;
use crate::scene::read_text;
use crate::wish::{Wish, WishOr, budget};

/// The colloid and its windings.
#[derive(Debug, Deserialize)]
struct NematicTable {
    /// Windings; the pattern of the settings without.
    q: Option<Numbers>,
    #[serde(flatten)]
    settings: toml::Table,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    nematic: NematicTable,
    material: Option<toml::Value>,
    #[serde(default)]
    charge: ChargeSettings,
    #[serde(default)]
    switch: SwitchSettings,
    #[serde(default)]
    discharge: DischargeSettings,
    flow: Option<FlowTable>,
    #[serde(default)]
    accuracy: WishOr<NematicAccuracy>,
    budget: Option<String>,
}

/// Flow and the windings that have it.
#[derive(Debug, Deserialize)]
struct FlowTable {
    /// Only these, besides all without flow.
    q: Option<Numbers>,
    #[serde(flatten)]
    settings: toml::Table,
}

impl NematicScene {
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
        let wrong = |e: toml::de::Error| AnalysisError::Scene {
            path: path.to_owned(),
            message: e.to_string(),
        };
        let file: File = toml::from_str(text).map_err(wrong)?;
        let value = |key: &str, value: String, remedy: &str| AnalysisError::SceneValue {
            path: path.to_owned(),
            key: key.to_owned(),
            value,
            remedy: remedy.to_owned(),
        };
        let windings = |key: &str, numbers: &Numbers| {
            if let Numbers::Range { n, .. } = numbers
                && !(1..=10_000).contains(n)
            {
                return Err(value(
                    &format!("{key}.n"),
                    n.to_string(),
                    "ask for 1 to 10000 windings",
                ));
            }
            numbers
                .values()
                .into_iter()
                .map(|q| {
                    if q.fract() == 0.0 && (1.0..=10_000.0).contains(&q) {
                        Ok(q as u32)
                    } else {
                        Err(value(
                            key,
                            q.to_string(),
                            "whole numbers from 1 to 10000 are needed",
                        ))
                    }
                })
                .collect::<Result<Vec<u32>, _>>()
        };
        let (accuracy, wish) = file
            .accuracy
            .with_budget(file.budget.as_deref())
            .map_err(|(key, text, remedy)| value(key, text, &remedy))?;
        let n = file.nematic;
        let charges = match &n.q {
            Some(q) => windings("nematic.q", q)?,
            None => Vec::new(),
        };
        if n.q.is_some() && charges.is_empty() {
            return Err(value("nematic.q", "[]".into(), "name at least one q"));
        }
        let mut colloid = n.settings;
        if n.q.is_some() && colloid.contains_key("pattern") {
            return Err(value(
                "nematic.pattern",
                "given together with q".into(),
                "keep either q or pattern",
            ));
        }
        if file.material.is_some() && colloid.contains_key("material") {
            return Err(value(
                "nematic.material",
                "given together with [material]".into(),
                "keep one of them",
            ));
        }
        colloid.extend(file.material.map(|m| ("material".to_owned(), m)));
        let nematic: NematicParameters = settings("[nematic]", colloid, path)?;
        let (flow, flowing) = match file.flow {
            None => (None, None),
            Some(table) => {
                let flowing = table
                    .q
                    .as_ref()
                    .map(|q| windings("flow.q", q))
                    .transpose()?;
                let settings: FlowParameters = settings("[flow]", table.settings, path)?;
                (Some(settings), flowing)
            }
        };
        if file.discharge.flow.is_some() {
            return Err(value(
                "discharge.flow",
                "given".into(),
                "write the table [flow] instead",
            ));
        }
        let refuse = |source| AnalysisError::Nematic {
            case: path.display().to_string(),
            source,
        };
        nematic.clone().checked().map_err(refuse)?;
        let scene = Self {
            folder: "nematic".to_owned(),
            charges,
            flowing,
            nematic,
            charge: file.charge,
            switch: file.switch,
            discharge: file.discharge,
            flow,
            accuracy,
            wish,
        };
        scene.accuracy.checked().map_err(refuse)?;
        Ok(scene)
    }

    /// The scene as the text of a file with every value written out; [`parse`](Self::parse) gives the same scene back.
    ///
    /// A file cannot say the folder of the tables, nor a pattern besides windings.
    ///
    /// # Validation
    /// `nematic_scenes_come_back_as_written`
    pub fn text(&self) -> String {
        let numbers = |charges: &[u32]| {
            let list = charges.iter().map(|q| toml::Value::Float(f64::from(*q)));
            toml::Value::Array(list.collect())
        };
        let mut nematic = table_of(&self.nematic);
        let material = nematic.remove("material");
        if !self.charges.is_empty() {
            nematic.remove("pattern");
            nematic.insert("q".to_owned(), numbers(&self.charges));
        }
        let mut file = toml::Table::new();
        let mut put = |name: &str, value: toml::Table| {
            file.insert(name.to_owned(), toml::Value::Table(value));
        };
        put("nematic", nematic);
        if let Some(toml::Value::Table(material)) = material {
            put("material", material);
        }
        put("charge", table_of(&self.charge));
        put("switch", table_of(&self.switch));
        put("discharge", table_of(&self.discharge));
        if let Some(flow) = &self.flow {
            let mut flow = table_of(flow);
            if let Some(charges) = &self.flowing {
                flow.insert("q".to_owned(), numbers(charges));
            }
            put("flow", flow);
        }
        match self.wish {
            Some(Wish::Accuracy(error)) => {
                file.insert("accuracy".to_owned(), toml::Value::Float(error));
            }
            _ => put("accuracy", table_of(&self.accuracy)),
        }
        if let Some(text) = budget(self.wish) {
            file.insert("budget".to_owned(), toml::Value::String(text));
        }
        // Tables of numbers and names always have a text.
        toml::to_string(&file).unwrap_or_default()
    }
}

/// Settings as a table.
fn table_of<T: Serialize>(settings: &T) -> toml::Table {
    // Structures of numbers, names and lists always have one.
    toml::Table::try_from(settings).unwrap_or_default()
}

/// The settings of a table; keys that nobody knows are refused with the table's name.
fn settings<T: DeserializeOwned>(
    name: &str,
    table: toml::Table,
    path: &Path,
) -> Result<T, AnalysisError> {
    table
        .try_into()
        .map_err(|e: toml::de::Error| AnalysisError::Scene {
            path: path.to_owned(),
            message: format!("in {name}: {e}"),
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_nematic::SurfacePattern;

    fn parse(text: &str) -> Result<NematicScene, AnalysisError> {
        NematicScene::parse(text, Path::new("scene.toml"))
    }

    #[test]
    fn a_scene_says_what_is_modelled() {
        let scene =
            parse("[nematic]\nradius = 15\nq = [2, 5]\n[material]\nflow_alignment = 0.8").unwrap();
        assert_eq!(scene.charges, [2, 5]);
        assert!(scene.flow.is_none() && scene.nematic.material.flow_alignment == 0.8);
        let cases = scene.cases();
        assert_eq!(cases.len(), 2);
        assert_eq!(cases[1].nematic.pattern, SurfacePattern::Charge(5));
        let flowing = parse("[nematic]\nradius = 15\nq = [2, 5]\n[flow]\nq = 5").unwrap();
        let with = |scene: &NematicScene| {
            let cases = scene.cases();
            cases
                .iter()
                .map(|c| (c.q, c.flow.is_some()))
                .collect::<Vec<_>>()
        };
        assert_eq!(with(&flowing), [(2, false), (5, false), (5, true)]);
        let all =
            parse("[nematic]\nq = { from = 1, to = 3, n = 3 }\n[flow]\nboundary_residual = 0.1")
                .unwrap();
        assert_eq!(with(&all), [(1, true), (2, true), (3, true)]);
        assert_eq!(all.flow.unwrap().boundary_residual, 0.1);
        let plain = parse("[nematic]\npattern = \"homeotropic\"").unwrap();
        assert_eq!(with(&plain), [(0, false)]);
    }

    #[test]
    fn bad_scenes_are_refused_with_key_value_and_remedy() {
        for (text, words) in [
            (
                "[nematic]\nraduis = 2",
                vec!["scene.toml", "[nematic]", "raduis", "radius"],
            ),
            (
                "[nematic]\nq = 0",
                vec!["nematic.q", "0", "whole numbers from 1"],
            ),
            ("[nematic]\nq = -3", vec!["nematic.q", "-3"]),
            ("[nematic]\nq = 2.5", vec!["nematic.q", "2.5"]),
            ("[nematic]\nq = []", vec!["nematic.q"]),
            (
                "[nematic]\nq = 1\npattern = \"homeotropic\"",
                vec!["nematic.pattern", "either"],
            ),
            (
                "[nematic]\nq = 1\n[flow]\nevery = 2",
                vec!["[flow]", "every", "boundary_residual"],
            ),
            ("[nematic]\nq = 1\n[flow]\nq = 0", vec!["flow.q"]),
            (
                "[nematic]\nq = 1\n[accuracy]\ntolerance = -1",
                vec!["tolerance", "-1"],
            ),
            ("[nematic]\nq = \"two\"", vec!["scene.toml", "q"]),
        ] {
            let message = parse(text).unwrap_err().to_string();
            for word in words {
                assert!(
                    message.contains(word),
                    "{text:?} gives {message:?} without {word:?}"
                );
            }
        }
    }
}
