//! How much is computed: one dial for scenes, figures, tight shapes, maps and trade-offs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How fine and how accurate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// Minutes for all: N = 200, tolerance 1e-3 h.
    #[default]
    Draft,
    /// N = 200, tolerance 5e-4 h, near-tied cuts.
    Standard,
    /// N = 400, tolerance 2e-4 h, near-tied cuts.
    Paper,
    /// What others are measured against: N = 400, tolerance 1e-4 h, a new Newton matrix every step.
    Reference,
}

impl Preset {
    /// Name used in scenes and on figures.
    pub fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Standard => "standard",
            Self::Paper => "paper",
            Self::Reference => "reference",
        }
    }
}

/// As it stands on the face of figures and reports.
impl std::fmt::Display for Preset {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Draft => "Draft",
            Self::Standard => "Standard",
            Self::Paper => "Paper",
            Self::Reference => "Reference",
        })
    }
}
