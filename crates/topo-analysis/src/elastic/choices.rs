//! Choices that a scene makes: numbers, names, cuts, presets.

use serde::{Deserialize, Serialize};
use topo_knots::TightenSettings;
use topo_rod::Accuracy;

/// One value, a list of them, or evenly spaced numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Numbers {
    /// One number.
    One(f64),
    /// A list.
    List(Vec<f64>),
    /// `n` numbers from `from` to `to`, both included.
    Range {
        /// First.
        from: f64,
        /// Last.
        to: f64,
        /// How many.
        n: usize,
    },
}

impl Numbers {
    /// The numbers meant.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::One(x) => vec![*x],
            Self::List(list) => list.clone(),
            Self::Range { from, n: 1, .. } => vec![*from],
            // halves and quarters come out exactly
            Self::Range { from, to, n } => (0..*n)
                .map(|k| from + (to - from) * k as f64 / (*n - 1) as f64)
                .collect(),
        }
    }
}

/// One knot name or a list; "all" stands for the fourteen prime knots of up to seven crossings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Names {
    /// One name.
    One(String),
    /// A list.
    List(Vec<String>),
}

/// Which sites are cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Cuts {
    /// The maximum of the smoothed energy density.
    #[default]
    Argmax,
    /// Every local maximum within 3 % of the largest.
    NearTies,
    /// K evenly spaced sites.
    All(usize),
}

impl TryFrom<String> for Cuts {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let all = |k: &str| {
            k.parse()
                .ok()
                .filter(|k| (1..=10_000).contains(k))
                .map(Self::All)
        };
        match text.as_str() {
            "argmax" => Ok(Self::Argmax),
            "near-ties" => Ok(Self::NearTies),
            other => other
                .strip_prefix("all:")
                .and_then(all)
                .ok_or_else(|| format!("`{text}` is not a choice of cuts: write \"argmax\", \"near-ties\" or \"all:K\" with K from 1 to 10000")),
        }
    }
}

impl From<Cuts> for String {
    fn from(cuts: Cuts) -> Self {
        match cuts {
            Cuts::Argmax => "argmax".into(),
            Cuts::NearTies => "near-ties".into(),
            Cuts::All(k) => format!("all:{k}"),
        }
    }
}

/// Share of the largest density within which a local maximum counts as a near tie.
pub const NEAR_TIE: f64 = 0.03;

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

    /// Edges N of a rod.
    pub fn edges(self) -> usize {
        match self {
            Self::Draft | Self::Standard => 200,
            Self::Paper | Self::Reference => 400,
        }
    }

    /// Local error aimed at, in h.
    pub fn tolerance(self) -> f64 {
        match self {
            Self::Draft => 1e-3,
            Self::Standard => 5e-4,
            Self::Paper => 2e-4,
            Self::Reference => 1e-4,
        }
    }

    /// Integrator and tolerance.
    pub fn accuracy(self) -> Accuracy {
        let usual = Accuracy {
            tolerance: self.tolerance(),
            ..Accuracy::default()
        };
        if self == Self::Reference {
            Accuracy { reuse: 1, ..usual }
        } else {
            usual
        }
    }

    /// Cuts made where the scene does not say.
    pub fn cuts(self) -> Cuts {
        if self == Self::Draft {
            Cuts::Argmax
        } else {
            Cuts::NearTies
        }
    }

    /// How knots are tightened.
    pub fn tighten(self) -> TightenSettings {
        match self {
            Self::Draft => TightenSettings::draft(),
            Self::Standard => TightenSettings::standard(),
            Self::Paper | Self::Reference => TightenSettings::fine(),
        }
    }
}

#[cfg(test)]
mod tests {
    use topo_rod::cut_candidates;

    use super::*;

    /// Maxima within 3 % of the largest count as ties, as the published densities of 7_4 (1.5 %) do.
    #[test]
    fn val_near_ties_are_within_three_per_cent() {
        let mut density = vec![1.0; 200];
        for (vertex, height) in [(20, 3.0), (60, 2.92), (100, 2.955), (140, 2.9), (180, 2.2)] {
            density[vertex] = height;
        }
        let ties = cut_candidates(&density, 0.25, NEAR_TIE);
        let vertices: Vec<usize> = ties.iter().map(|c| c.vertex).collect();
        assert_eq!(vertices, [20, 100, 60]);
    }

    #[test]
    fn choices_of_cuts_are_read_and_written() {
        for (text, cuts) in [
            ("argmax", Cuts::Argmax),
            ("near-ties", Cuts::NearTies),
            ("all:12", Cuts::All(12)),
        ] {
            assert_eq!(Cuts::try_from(text.to_owned()), Ok(cuts));
            assert_eq!(String::from(cuts), text);
        }
        for text in ["", "all", "all:0", "all:10001", "ties"] {
            assert!(Cuts::try_from(text.to_owned()).is_err(), "{text}");
        }
    }
}
