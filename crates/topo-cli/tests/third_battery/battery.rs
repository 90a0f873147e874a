//! The battery and its scene files.

use std::path::Path;

use serde::{Deserialize, Serialize};
use topo_lab::{Battery, Document, LabError, Numbers, Probe, Scene, Sweep, folder_of, numbers};

use crate::experiment::Experiment;
use crate::fibre;

/// Straight fibres that untwist.
#[derive(Debug)]
pub struct Unwinding;

static PROBE: Probe = Probe {
    name: "unwinding",
    reference_seconds: 0.05,
    run: || {
        let stop = topo_core::Interrupt::new();
        fibre::discharge([10.0, 1.0], 200, 1e-7, 0.9, &stop).ok()?;
        Some(())
    },
};

impl Battery for Unwinding {
    fn name(&self) -> &'static str {
        "unwinding"
    }

    fn table(&self) -> &'static str {
        "unwinding"
    }

    fn what(&self) -> &'static str {
        "a straight fibre"
    }

    fn schema(&self) -> &'static str {
        "topo-unwinding-case/1"
    }

    fn results(&self) -> u32 {
        1
    }

    fn probe(&self) -> &'static Probe {
        &PROBE
    }

    fn parse(&self, text: &str, path: &Path) -> Result<Box<dyn Scene>, LabError> {
        Ok(Box::new(Fibres::parse(text, path)?))
    }
}

/// Fibres of all lengths, turns and resolutions of a scene.
#[derive(Debug, Clone, Serialize)]
pub struct Fibres {
    #[serde(skip)]
    pub folder: String,
    /// In radii.
    pub lengths: Vec<f64>,
    /// Radians by which the free end is twisted.
    pub turns: Vec<f64>,
    /// Edges of the fibre.
    pub edges: Vec<f64>,
    /// Of an angle in a step, over the turn.
    pub tolerance: f64,
    /// Share of the energy after which a discharge ends.
    pub until_released: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    unwinding: Table,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    length: Numbers,
    turn: Numbers,
    #[serde(default = "edges")]
    edges: Numbers,
    #[serde(default = "tolerance")]
    tolerance: f64,
    #[serde(default = "until_released")]
    until_released: f64,
}

const EDGES: f64 = 100.0;

fn edges() -> Numbers {
    Numbers::One(EDGES)
}

fn tolerance() -> f64 {
    1e-4
}

fn until_released() -> f64 {
    0.999
}

impl Fibres {
    fn parse(text: &str, path: &Path) -> Result<Self, LabError> {
        let document = Document::new(text, path)?;
        let File { unwinding: table } = document.read(text)?;
        let list = |key: &str, usual: f64, is_right: fn(f64) -> bool, remedy: &str| {
            let values = numbers(&document, key)?.unwrap_or(vec![usual]);
            match values.iter().find(|x| !is_right(**x)) {
                Some(x) => Err(document.wrong(key, x, remedy)),
                None => Ok(values),
            }
        };
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let share = |x: f64| x > 0.0 && x < 1.0;
        let whole = |x: f64| x.fract() == 0.0 && (2.0..=1e6).contains(&x);
        let of_one = |key: &str, x: f64| match share(x) {
            true => Ok(x),
            false => Err(document.wrong(key, x, "a number between 0 and 1 is needed")),
        };
        Ok(Self {
            folder: folder_of(path)?,
            lengths: list("unwinding.length", 0.0, positive, "be longer than nothing")?,
            turns: list("unwinding.turn", 0.0, |x| x != 0.0, "twist it either way")?,
            edges: list(
                "unwinding.edges",
                EDGES,
                whole,
                "a whole number from 2 on is needed",
            )?,
            tolerance: of_one("unwinding.tolerance", table.tolerance)?,
            until_released: of_one("unwinding.until_released", table.until_released)?,
        })
    }

    /// The scene as the text of a file.
    pub fn text(&self) -> String {
        let list = |values: &[f64]| Numbers::List(values.to_vec());
        let unwinding = Table {
            length: list(&self.lengths),
            turn: list(&self.turns),
            edges: list(&self.edges),
            tolerance: self.tolerance,
            until_released: self.until_released,
        };
        toml::to_string(&File { unwinding }).unwrap_or_default()
    }
}

/// Nothing on the command line stands above such a scene.
impl Scene for Fibres {
    fn experiment(self: Box<Self>) -> Result<Box<dyn Sweep>, LabError> {
        Ok(Box::new(Experiment(*self)))
    }
}
