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
//! until_released = 0.9995
//! [flow]                               # leave the table out: no velocity is modelled
//! [accuracy]
//! tolerance = 3e-5
//! ```
//!
//! Every number of particle, plates, material and field, and patterns, anchorings and boundary may be a list, numbers also a range: the
//! cases are the product.
//!
//! Instead of the spacing and the table `[accuracy]`, the first line may say `accuracy = 0.02` (relative error of t99.9) or
//! `budget = "10 min"`.

use std::path::Path;
use std::sync::OnceLock;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;
use topo_nematic::{
    ChargeSettings, DischargeSettings, FlowParameters, Material, NematicAccuracy,
    NematicParameters, SwitchSettings,
};

use super::case::NematicCase;
use super::check;
use super::keys::{COLLOID_KEYS, SPACING};
use super::scene::NematicScene;
use crate::LabError;
use crate::goal::{Goal, GoalOr, budget};
use crate::scene::{
    BesideQ, Document, Keys, SceneFault, axes, folder_of, numbers, numbers_node, put_axes,
    read_text, remove,
};

/// A scene of colloids; its windings left out: those of the colloid, and those that have flow besides all without.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct File {
    /// The colloid.
    nematic: BesideQ<NematicParameters>,
    /// The nematic liquid.
    material: Option<Material>,
    /// The charge: relaxation with the anchoring.
    #[serde(default)]
    charge: ChargeSettings,
    /// The switch of the anchoring.
    #[serde(default)]
    switch: SwitchSettings,
    /// The discharge after the switch.
    #[serde(default)]
    discharge: DischargeSettings,
    /// The flow; without the table none is modelled.
    flow: Option<BesideQ<FlowParameters>>,
    /// Largest relative error of t99.9, instead of the spacing and the table [accuracy].
    #[serde(default)]
    #[schemars(extend("x-unit" = "1", "x-default" = "settings"))]
    accuracy: GoalOr<NematicAccuracy>,
    /// Time that all cases may take, instead of the spacing and the table [accuracy].
    #[schemars(extend("x-default" = "none"), example = "10 min")]
    budget: Option<String>,
}

/// The keys of these files.
pub(super) fn keys() -> &'static Keys {
    static KEYS: OnceLock<Keys> = OnceLock::new();
    KEYS.get_or_init(|| {
        let windings = |about: &str, default: &str, example: u32| {
            let node = numbers_node(json!({ "type": "number", "minimum": 1, "maximum": MOST_TURNS, "x-form": format!("a whole number from 1 to {MOST_TURNS}") }));
            let mut node = node.to_value();
            node["description"] = json!(about);
            node["x-unit"] = json!("1");
            node["x-default"] = json!(default);
            node["examples"] = json!([example]);
            node
        };
        let q = "Topological charges q of the particle, instead of a pattern.";
        let flowing = "Charges whose cases are computed with flow, besides all without.";
        Keys::of::<File>()
            .with("nematic.q", windings(q, "the pattern", 5))
            .with("flow.q", windings(flowing, "all cases flow", 2))
            .with_several(&COLLOID_KEYS)
    })
}

impl File {
    /// The case that the file describes, without a winding.
    fn case(self) -> NematicCase {
        let BesideQ(mut nematic) = self.nematic;
        if let Some(material) = self.material {
            nematic.material = material;
        }
        NematicCase {
            q: 0,
            nematic,
            flow: None,
        }
    }
}

/// Windings: whole numbers from 1 on.
fn windings(document: &Document<'_>, key: &str) -> Result<Option<Vec<u32>>, LabError> {
    let whole = |q: f64| {
        if q.fract() == 0.0 && (1.0..=MOST_TURNS).contains(&q) {
            Ok(q as u32)
        } else {
            let remedy = format!("whole numbers from 1 to {MOST_TURNS} are needed");
            Err(document.wrong(key, q, remedy))
        }
    };
    let values = numbers(document, key)?;
    values
        .map(|values| values.into_iter().map(whole).collect())
        .transpose()
}

/// Largest winding: beyond it no grid that fits in memory would show it.
const MOST_TURNS: f64 = 10_000.0;

impl NematicScene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// File, line, key and what would be right.
    pub fn read(path: &Path) -> Result<Self, LabError> {
        Self::parse(&read_text(path)?, path)
    }

    /// Reads a scene from a text; `path` names it in messages, and its results.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str, path: &Path) -> Result<Self, LabError> {
        let document = Document::new(text, path)?;
        document.idle("knots", "a colloid has no knots: leave it out")?;
        keys().check(&document)?;
        let (scene, faults) = Self::described(&document)?;
        faults.into_iter().next().map_or(Ok(scene), Err)
    }

    /// The scene of a file whose keys have values of the right form, and what is refused of it.
    fn described(document: &Document<'_>) -> Result<(Self, Vec<LabError>), LabError> {
        let both = |one: &str, other: &str, remedy: &str| match document.has(other) {
            true => document.idle(one, remedy),
            false => Ok(()),
        };
        both("nematic.pattern", "nematic.q", "keep either q or pattern")?;
        let remedy = "[material] is there too: keep one of them";
        both("nematic.material", "material", remedy)?;
        let (plain, axes) = axes(document, &COLLOID_KEYS, |text| {
            Ok(document.read::<File>(text)?.case())
        })?;
        let charges = windings(document, "nematic.q")?;
        let flowing = windings(document, "flow.q")?;
        let mut file: File = document.read(&plain)?;
        let flow = file.flow.take().map(|BesideQ(flow)| flow);
        let (accuracy, goal) = std::mem::take(&mut file.accuracy)
            .with_budget(file.budget.as_deref())
            .map_err(|(key, text, remedy)| document.wrong(key, text, remedy))?;
        let scene = Self {
            folder: folder_of(document.path())?,
            charges: charges.unwrap_or_default(),
            flowing,
            charge: file.charge.clone(),
            switch: file.switch.clone(),
            discharge: file.discharge.clone(),
            flow,
            accuracy,
            axes,
            fitted: None,
            goal,
            nematic: file.case().nematic,
        };
        let faults = check::faults(&scene, document);
        Ok((scene, faults))
    }

    /// All that is wrong with a text, as far as it can be seen without a run.
    pub(super) fn faults(text: &str, path: &Path) -> Vec<SceneFault> {
        keys().faults_of_text(text, path, |document| {
            Self::described(document).map_or_else(|e| vec![e], |(_, faults)| faults)
        })
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
        match self.goal {
            Some(Goal::Accuracy(error)) => {
                file.insert("accuracy".to_owned(), toml::Value::Float(error));
            }
            _ => put("accuracy", table_of(&self.accuracy)),
        }
        if let Some(text) = budget(self.goal) {
            file.insert("budget".to_owned(), toml::Value::String(text));
        }
        for (key, _) in check::idle(self) {
            remove(key, &mut file);
        }
        let has_goal = self.goal.is_some();
        let axes = self.axes.iter();
        let kept = axes.filter(|axis| !(has_goal && axis.key() == SPACING));
        put_axes(kept, &mut file);
        // Tables of numbers and names always have a text.
        toml::to_string(&file).unwrap_or_default()
    }
}

/// Settings as a table.
fn table_of<T: Serialize>(settings: &T) -> toml::Table {
    // Structures of numbers, names and lists always have one.
    toml::Table::try_from(settings).unwrap_or_default()
}

#[cfg(test)]
mod tests;
