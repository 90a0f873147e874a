//! How much an experiment computes.

use serde::{Deserialize, Serialize};

/// How fine and how accurate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
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
