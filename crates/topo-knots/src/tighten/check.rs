//! Whether a curve is still the knot that it was.

use topo_core::Polyline;

use crate::{Invariants, KnotError};

/// Refuses a curve whose invariants are not `kind`.
pub(super) fn check_type(
    name: &str,
    curve: &Polyline,
    kind: &Invariants,
    stage: &'static str,
) -> Result<(), KnotError> {
    let found = Invariants::of(curve.vertices())?;
    if found == *kind {
        return Ok(());
    }
    let found = format!(
        "Alexander polynomial {}, signature {}",
        found.alexander_text(),
        found.signature
    );
    Err(KnotError::PassedThroughItself {
        knot: name.to_owned(),
        stage,
        found,
    })
}
