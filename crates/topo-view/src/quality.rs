//! How much is computed.

use serde::Serialize;
use topo_lab::Preset;

/// How much is computed, and how it is said on the face of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Quality {
    /// 14 knots at 17 twists, one cut each: minutes.
    Draft,
    /// The same with every near-tied cut.
    Standard,
    /// Twice the resolution, all readings of the zero-twist row.
    Paper,
}

impl std::fmt::Display for Quality {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Draft => "Draft",
            Self::Standard => "Standard",
            Self::Paper => "Paper",
        })
    }
}

impl Quality {
    /// The preset of its scenes.
    pub fn preset(self) -> Preset {
        match self {
            Self::Draft => Preset::Draft,
            Self::Standard => Preset::Standard,
            Self::Paper => Preset::Paper,
        }
    }
}
