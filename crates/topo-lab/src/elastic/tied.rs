//! What the fibres of a case are tied to: a knot of the table, or what a scene describes by names of links, a word or a file.

use std::borrow::Cow;

use serde::{Serialize, Serializer};
use topo_core::Polyline;
use topo_knots::{
    Chirality, KnotEntry, KnotError, KnotTable, LinkEntry, LinkTable, TightKnot, TightLink, V,
    identify, identify_link, identify_open,
};

use super::case::ElasticCase;
use crate::LabError;

/// Passes of the binomial filter over curves that fibres are laid along, as [`TightKnot::centreline`] has them.
pub(super) const PASSES: usize = 2;

/// What is known of a knot or a link.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(crate) enum Entry {
    /// Of a knot.
    Knot(KnotEntry),
    /// Of a link.
    Link(LinkEntry),
}

impl Entry {
    pub(super) fn name(&self) -> &str {
        match self {
            Self::Knot(knot) => &knot.name,
            Self::Link(link) => &link.name,
        }
    }

    pub(super) fn crossing_number(&self) -> u32 {
        match self {
            Self::Knot(knot) => knot.crossing_number,
            Self::Link(link) => link.crossing_number,
        }
    }

    pub(super) fn n_components(&self) -> usize {
        match self {
            Self::Knot(_) => 1,
            Self::Link(link) => link.n_components(),
        }
    }

    pub(super) fn is_mirror_image(&self) -> bool {
        match self {
            Self::Knot(knot) => knot.is_mirror_image(),
            Self::Link(link) => link.is_mirror_image(),
        }
    }

    /// Whether it is a knot that equals its mirror image.
    pub(super) fn is_amphichiral_knot(&self) -> bool {
        matches!(self, Self::Knot(knot) if knot.chirality == Chirality::Amphichiral)
    }

    /// The curves that tightening starts from.
    pub(super) fn start_curves(&self) -> Result<Vec<Polyline>, KnotError> {
        match self {
            Self::Knot(knot) => Ok(vec![knot.start_curve()?]),
            Self::Link(link) => link.start_curves(),
        }
    }

    /// The same without curves to start from.
    pub(super) fn without_start(mut self) -> Self {
        match &mut self {
            Self::Knot(knot) => knot.start = None,
            Self::Link(link) => link.start = None,
        }
        self
    }

    /// Refuses curves of another type.
    pub(super) fn verify(&self, curves: &[Polyline]) -> Result<(), KnotError> {
        match (self, curves) {
            (Self::Knot(knot), [only]) => knot.verify(only).map(drop),
            (Self::Knot(_), several) => Err(KnotError::Link {
                n_components: several.len(),
            }),
            (Self::Link(link), curves) => link.verify(curves).map(drop),
        }
    }

    /// The type that most of `n_closures` of an open curve have, where it is another; none is sought without closures.
    pub(super) fn open_mismatch(
        &self,
        curve: &Polyline,
        n_closures: usize,
        seed: u64,
        table: &KnotTable,
    ) -> Result<Option<String>, KnotError> {
        let Self::Knot(knot) = self else {
            return Ok(None);
        };
        if n_closures == 0 {
            return Ok(None);
        }
        let found = identify_open(curve.vertices(), n_closures, seed, table)?;
        let fits = found
            .types
            .first()
            .is_some_and(|most| most.fits(&knot.name));
        Ok((!fits).then(|| found.dominant().to_owned()))
    }
}

/// Name of the closed curves: that of the table, else what fits.
pub(super) fn label(curves: &[Polyline], table: &KnotTable) -> Result<String, KnotError> {
    match curves {
        [only] => Ok(identify(only.vertices(), table)?.label()),
        several => {
            let vertices: Vec<&[V]> = several.iter().map(Polyline::vertices).collect();
            Ok(identify_link(&vertices, LinkTable::builtin())?.label())
        }
    }
}

/// What fibres are tied to where it is no tight knot by name.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tied {
    /// Its name.
    pub(super) name: String,
    /// What tells it from the tight knot or link of that name; empty: nothing.
    pub(super) word: String,
    /// Identity of the coordinates of the curves, where they are not made here.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) coordinates: Option<String>,
    #[serde(skip)]
    pub(super) entry: Entry,
    /// Centrelines of the fibres and their length over radius; none: they are to be tightened.
    #[serde(skip)]
    pub(super) laid: Option<Laid>,
}

/// Curves that are not tightened, smoothed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Laid {
    pub centrelines: Vec<Polyline>,
    pub length_over_radius: f64,
}

impl ElasticCase {
    /// What is known of the knot or link of the case.
    pub(crate) fn entry<'a>(&'a self, table: &KnotTable) -> Result<Cow<'a, Entry>, LabError> {
        Ok(match &self.tied {
            Some(tied) => Cow::Borrowed(&tied.entry),
            None => Cow::Owned(Entry::Knot(table.get(&self.knot)?.into_owned())),
        })
    }

    /// Number of fibres.
    pub fn n_components(&self) -> usize {
        self.tied
            .as_ref()
            .map_or(1, |tied| tied.entry.n_components())
    }

    /// Name of what it starts from, of no other start in its scene.
    pub(super) fn start_name(&self) -> String {
        match &self.tied {
            Some(tied) => format!("{} {}", tied.name, tied.word),
            None => self.knot.clone(),
        }
    }

    /// Whether the start is tightened.
    pub(super) fn is_tightened(&self) -> bool {
        self.tied.as_ref().is_none_or(|tied| tied.laid.is_none())
    }
}

/// What is tied, in the JSON of a case.
pub(super) fn of_case<S: Serializer>(
    tied: &Option<std::sync::Arc<Tied>>,
    to: S,
) -> Result<S::Ok, S::Error> {
    tied.as_deref().serialize(to)
}

/// A start that was made.
pub enum Made {
    /// A tight knot.
    Knot(Box<TightKnot>),
    /// A tight link.
    Link(Box<TightLink>),
    /// What the case itself holds.
    Own,
}

/// What a case starts from.
#[derive(Clone, Copy)]
pub(crate) enum Start<'a> {
    /// A tight knot.
    Knot(&'a TightKnot),
    /// A tight link.
    Link(&'a TightLink),
    /// Curves as they are.
    Laid(&'a Laid),
}

impl<'a> Start<'a> {
    /// That of a case, if it is there.
    pub(super) fn of(made: &'a Made, case: &'a ElasticCase) -> Option<Self> {
        match made {
            Made::Knot(tight) => Some(Self::Knot(tight)),
            Made::Link(tight) => Some(Self::Link(tight)),
            Made::Own => case.tied.as_ref()?.laid.as_ref().map(Self::Laid),
        }
    }

    pub(super) fn centrelines(self) -> Result<Vec<Polyline>, KnotError> {
        match self {
            Self::Knot(tight) => Ok(vec![tight.centreline()?]),
            Self::Link(tight) => tight.centrelines(),
            Self::Laid(laid) => Ok(laid.centrelines.clone()),
        }
    }

    pub(super) fn length_over_radius(self) -> f64 {
        match self {
            Self::Knot(tight) => tight.length_over_radius,
            Self::Link(tight) => tight.length_over_radius,
            Self::Laid(laid) => laid.length_over_radius,
        }
    }
}

impl<'a> From<&'a TightKnot> for Start<'a> {
    fn from(tight: &'a TightKnot) -> Self {
        Self::Knot(tight)
    }
}
