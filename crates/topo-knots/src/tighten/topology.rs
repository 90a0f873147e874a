//! What kind of knot or link curves are, and whether they still are.

use crate::curves::Curves;
use crate::{Invariants, KnotError, LinkInvariants};

/// Invariants by which the type is recognised while curves are deformed.
#[derive(Debug, Clone)]
pub(crate) enum Topology {
    /// Of a single curve.
    Knot(Invariants),
    /// Of several.
    Link(LinkInvariants),
}

impl Topology {
    pub fn of(curves: &Curves) -> Result<Self, KnotError> {
        match curves.parts() {
            [only] => Ok(Self::Knot(Invariants::of(only.vertices())?)),
            _ => Ok(Self::Link(LinkInvariants::of_curves(curves)?)),
        }
    }

    fn fits(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Knot(a), Self::Knot(b)) => a == b,
            (Self::Link(a), Self::Link(b)) => a.fits(b),
            _ => false,
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Knot(found) => format!(
                "Alexander polynomial {}, signature {}",
                found.alexander_text(),
                found.signature
            ),
            Self::Link(found) => found.text(),
        }
    }
}

/// Refuses curves whose type is not `kind`.
pub(super) fn check_type(
    name: &str,
    curves: &Curves,
    kind: &Topology,
    stage: &'static str,
) -> Result<(), KnotError> {
    let found = Topology::of(curves)?;
    if found.fits(kind) {
        return Ok(());
    }
    Err(KnotError::PassedThroughItself {
        knot: name.to_owned(),
        stage,
        found: found.text(),
    })
}
