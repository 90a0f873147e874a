//! What `knot identify` finds, in the form that `--json` writes; docs/output.md explains each key.

use serde::Serialize;
use topo_knots::{CurveFrame, Handedness, KnotName, KnotType, LinkJones, LinkType, OpenKnotType};

/// What a file holds.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    /// The file as it was named.
    pub file: String,
    /// The frame that was named, if the file holds several.
    pub frame: Option<Frame>,
    /// The finding for the only component, or for the link of several.
    #[serde(flatten)]
    pub finding: Finding,
    /// How several closed components are linked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub link: Option<LinkFinding>,
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

/// How components are linked.
#[derive(Debug, Serialize)]
pub(super) struct LinkFinding {
    /// Whether it falls into parts that can be moved apart.
    pub split: bool,
    /// Linking number of each component with each other, oriented as in the file.
    pub linking_numbers: Vec<Vec<i32>>,
    /// Each part by itself.
    pub parts: Vec<Part>,
}

/// A part of a link.
#[derive(Debug, Serialize)]
pub(super) struct Part {
    /// Numbers of its components, from 1.
    pub components: Vec<usize>,
    /// Names that fit.
    pub candidates: Vec<String>,
    pub certain: bool,
    pub crossings: usize,
}

impl From<&LinkType> for LinkFinding {
    fn from(found: &LinkType) -> Self {
        let n = found.components.len();
        let row = |a: usize| (0..n).map(move |b| found.invariants.linking_number(a, b));
        let part = |part: &topo_knots::LinkPart| Part {
            components: part.components.iter().map(|k| k + 1).collect(),
            candidates: part.candidates.clone(),
            certain: part.certain,
            crossings: part.n_crossings,
        };
        Self {
            split: found.is_split(),
            linking_numbers: (0..n).map(|a| row(a).collect()).collect(),
            parts: found.parts.iter().map(part).collect(),
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

    /// What is known of several components together; of open ones nothing but whether each is certain.
    pub(super) fn link(components: &[Component], link: Option<&LinkType>) -> Self {
        let Some(found) = link else {
            return Self {
                certain: components.iter().all(|c| c.finding.certain),
                ..Self::default()
            };
        };
        let has_one_name = found.parts.iter().all(|part| part.candidates.len() == 1);
        let candidates = match &found.parts[..] {
            [part] => part.candidates.clone(),
            _ => Vec::from_iter(has_one_name.then(|| found.label())),
        };
        Self {
            name: has_one_name.then(|| found.label()),
            candidates,
            certain: found.is_certain(),
            certain_to: Some(LinkType::CERTAIN_TO),
            crossings: Some(found.n_crossings()),
            jones: found
                .invariants
                .oriented_jones()
                .as_ref()
                .map(LinkJones::text),
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
