//! Which knot of the table a closed or an open curve is.

mod boxes;
mod open;
mod reduce;

use serde::{Deserialize, Serialize};

use crate::invariant::{Diagram, check_vertices, least_crossing};
use crate::{Chirality, Invariants, KnotEntry, KnotError, KnotTable, V};
use reduce::Reducer;

pub use open::{OpenKnotType, identify_open};

/// Directions tried for a projection with few crossings; a reduced polygon has few anyway.
const N_PROJECTIONS: usize = 8;
/// Further directions for the rare curve of which all of those are degenerate.
const N_MORE_PROJECTIONS: usize = 64;

/// Which of a knot and its mirror image a curve is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Handedness {
    /// As in the table; for the trefoil, right-handed.
    Tabulated,
    /// The mirror image of the knot in the table.
    Mirrored,
    /// The knot equals its mirror image.
    Amphichiral,
    /// The signature is zero although the knot is chiral, so that these invariants cannot tell.
    Undecided,
}

/// Type of a closed curve as far as Alexander polynomial, determinant and signature tell.
///
/// These separate the knots of the built-in table from each other and from the unknot, but not from every knot beyond it.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct KnotType {
    /// Names in the table that fit, mirror images under the same name; `0_1` is the unknot; empty if none fits.
    pub names: Vec<String>,
    /// Handedness with respect to the first name.
    pub handedness: Handedness,
    /// The invariants found.
    pub invariants: Invariants,
}

impl KnotType {
    fn unknot() -> Self {
        Self {
            names: vec!["0_1".to_owned()],
            handedness: Handedness::Amphichiral,
            invariants: Invariants {
                alexander: vec![1],
                determinant: 1,
                signature: 0,
            },
        }
    }

    /// Whether the curve has the invariants of the unknot.
    pub fn is_unknot(&self) -> bool {
        self.invariants.alexander == [1]
    }

    /// The names that fit, separated by `|`; `unknown(...)` with the Alexander polynomial if none does.
    pub fn label(&self) -> String {
        if self.names.is_empty() {
            format!("unknown({})", self.invariants.alexander_text())
        } else {
            self.names.join("|")
        }
    }
}

/// The knot type of the closed polygon through `vertices`.
///
/// Vertices are removed while the triangle with their neighbours is free; what is left is projected and simplified,
/// and its invariants are looked up in the table, then among the sums of two of its knots.
///
/// # Errors
/// [`KnotError::TooFewVertices`], [`KnotError::NotFinite`], and [`KnotError::Degenerate`] for a curve that runs through
/// itself.
///
/// # Validation
/// `names_the_table_and_its_mirrors`, `a_curve_passed_through_itself_is_caught`.
///
/// # References
/// `koniaris1991`
pub fn identify(vertices: &[V], table: &KnotTable) -> Result<KnotType, KnotError> {
    check_vertices(vertices, true)?;
    let mut reducer = Reducer::default();
    reducer.load(vertices, true);
    classify(&mut reducer, table)
}

/// The type of the closed chain in `reducer`, which is reduced on the way.
fn classify(reducer: &mut Reducer, table: &KnotTable) -> Result<KnotType, KnotError> {
    match diagram(reducer)? {
        None => Ok(KnotType::unknot()),
        Some(diagram) => {
            let found = Invariants::of_diagram(&diagram).ok_or(KnotError::Degenerate)?;
            Ok(look_up(found, table))
        }
    }
}

/// A small diagram of the closed chain in `reducer`; none if it is seen to be the unknot.
fn diagram(reducer: &mut Reducer) -> Result<Option<Diagram>, KnotError> {
    reducer.reduce(true, &[]);
    if reducer.x.len() < 6 {
        return Ok(None);
    }
    let mut diagram = least_crossing(&reducer.x, N_PROJECTIONS, 0)
        .or_else(|| least_crossing(&reducer.x, N_MORE_PROJECTIONS, 1))
        .ok_or(KnotError::Degenerate)?;
    diagram.simplify();
    Ok((diagram.n_crossings() >= 3).then_some(diagram))
}

fn look_up(found: Invariants, table: &KnotTable) -> KnotType {
    if found.alexander == [1] {
        return KnotType {
            invariants: found,
            ..KnotType::unknot()
        };
    }
    let mut names = Vec::new();
    let mut handedness = Handedness::Undecided;
    for knot in table.iter() {
        if let Some(sense) = compare(&found, knot) {
            if names.is_empty() {
                handedness = sense;
            }
            names.push(knot.name.clone());
        }
    }
    if names.is_empty() {
        sums(&found, table, &mut names);
    }
    KnotType {
        names,
        handedness,
        invariants: found,
    }
}

fn compare(found: &Invariants, knot: &KnotEntry) -> Option<Handedness> {
    let known = &knot.invariants;
    if found.alexander != known.alexander || found.signature.abs() != known.signature.abs() {
        return None;
    }
    Some(match (knot.chirality, known.signature) {
        (Chirality::Amphichiral, _) => Handedness::Amphichiral,
        (Chirality::Chiral, 0) => Handedness::Undecided,
        (Chirality::Chiral, s) if s == found.signature => Handedness::Tabulated,
        (Chirality::Chiral, _) => Handedness::Mirrored,
    })
}

/// Names such as `3_1#4_1` and `3_1#m3_1` of the sums of two knots that fit.
fn sums(found: &Invariants, table: &KnotTable, names: &mut Vec<String>) {
    for (k, a) in table.iter().enumerate() {
        for b in table.iter().skip(k) {
            if a.invariants.determinant * b.invariants.determinant != found.determinant {
                continue;
            }
            let alike = a.invariants.sum(&b.invariants);
            if alike.alexander != found.alexander {
                continue;
            }
            let unlike = a.invariants.sum(&b.invariants.mirror());
            let size = found.signature.abs();
            if alike.signature.abs() == size {
                names.push(format!("{}#{}", a.name, b.name));
            }
            if unlike.signature.abs() == size && unlike.signature != alike.signature {
                names.push(format!("{}#m{}", a.name, b.name));
            }
        }
    }
}

#[cfg(test)]
mod tests;
