//! What `knot identify` finds, in the form that `--json` writes; docs/output.md explains each key.

use serde::Serialize;
use topo_knots::{CurveFrame, Handedness, KnotName, KnotType, OpenKnotType};

/// What a file holds.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    /// The file as it was named.
    pub file: String,
    /// The frame that was named, if the file holds several.
    pub frame: Option<Frame>,
    /// The finding for the only component; without a name if there are several.
    #[serde(flatten)]
    pub finding: Finding,
    /// A finding for each component.
    pub components: Vec<Component>,
    /// How the file was taken, and what the finding does not tell.
    pub warnings: Vec<String>,
}

/// A frame of a file.
#[derive(Debug, Serialize)]
pub(super) struct Frame {
    pub number: usize,
    pub of: usize,
    pub label: Option<String>,
}

impl From<&CurveFrame> for Frame {
    fn from(frame: &CurveFrame) -> Self {
        Self {
            number: frame.number,
            of: frame.n_frames,
            label: frame.label.clone(),
        }
    }
}

/// A component with its finding.
#[derive(Debug, Serialize)]
pub(super) struct Component {
    /// Whether it was taken for closed.
    pub closed: bool,
    /// Its number of vertices.
    pub vertices: usize,
    #[serde(flatten)]
    pub finding: Finding,
}

/// The type of a curve, and how sure it is.
#[derive(Debug, Clone, Default, Serialize)]
pub(super) struct Finding {
    /// The only name that fits, of an open curve the type of most closures; nothing if several fit or none.
    pub name: Option<String>,
    /// All names that fit, with their hands; of an open curve those of all closures.
    pub candidates: Vec<String>,
    /// Whether the name is proved; of an open curve, whether it is in every closure.
    pub certain: bool,
    /// Crossing number up to which every type was compared.
    pub certain_to: Option<u32>,
    /// `tabulated`, `mirrored`, `amphichiral` or `unknown`.
    pub handedness: Option<&'static str>,
    /// Crossings of the simplest diagram found.
    pub crossings: Option<usize>,
    /// Types of the closures of an open curve, most frequent first.
    pub closures: Vec<Closure>,
    pub determinant: Option<u64>,
    pub signature: Option<i32>,
    pub alexander: Option<String>,
    pub jones: Option<String>,
}

/// A type among the closures of an open curve.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Closure {
    pub name: String,
    pub share: f64,
}

impl Finding {
    /// The finding for a closed curve.
    pub(super) fn closed(kind: &KnotType) -> Self {
        let name = match (kind.name(), &kind.types()[..]) {
            (Some(name), _) => Some(name.to_string()),
            (None, [only]) => Some(only.to_string()),
            _ => None,
        };
        Self {
            name,
            candidates: kind.candidates().map(KnotName::to_string).collect(),
            certain: kind.is_certain(),
            certain_to: Some(kind.certain_to()),
            handedness: Some(hand(kind.handedness)),
            crossings: Some(kind.n_crossings),
            closures: Vec::new(),
            determinant: Some(kind.invariants.determinant),
            signature: Some(kind.invariants.signature),
            alexander: Some(kind.invariants.alexander_text()),
            jones: kind.jones.as_ref().map(topo_knots::Jones::text),
        }
    }

    /// The finding for an open curve: that for its most frequent type, which is its name if more than half of the closures have it.
    pub(super) fn open(found: &OpenKnotType) -> Self {
        let closures: Vec<Closure> = found
            .distribution
            .iter()
            .map(|(name, share)| Closure {
                name: name.clone(),
                share: *share,
            })
            .collect();
        let mut candidates: Vec<String> = Vec::new();
        for kind in &found.types {
            for name in kind.candidates().map(KnotName::to_string) {
                if !candidates.contains(&name) {
                    candidates.push(name);
                }
            }
        }
        let most = found.types.first().map(Self::closed).unwrap_or_default();
        let share = closures.first().map_or(0.0, |c| c.share);
        Self {
            name: most.name.filter(|_| share > 0.5),
            certain: most.certain && closures.len() == 1,
            candidates,
            closures,
            ..most
        }
    }

    /// What is known of several components together: nothing but whether each is certain.
    pub(super) fn link(components: &[Component]) -> Self {
        Self {
            certain: components.iter().all(|c| c.finding.certain),
            ..Self::default()
        }
    }
}

fn hand(handedness: Handedness) -> &'static str {
    match handedness {
        Handedness::Tabulated => "tabulated",
        Handedness::Mirrored => "mirrored",
        Handedness::Amphichiral => "amphichiral",
        _ => "unknown",
    }
}
