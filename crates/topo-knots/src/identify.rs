//! Which knot of the table a closed or an open curve is.

mod boxes;
mod known;
mod open;
mod reduce;

use serde::{Deserialize, Serialize};

use crate::invariant::{Diagram, least_crossing, usable_vertices};
use crate::{Invariants, Jones, KnotError, KnotTable, V, mirror_name};
use known::{Finding, matches};
use reduce::Reducer;

pub use open::{OpenKnotType, identify_open};

/// Directions tried for a projection with few crossings; a reduced polygon has few anyway.
const N_PROJECTIONS: usize = 8;
/// Further directions for the rare curve of which all of those are degenerate.
const N_MORE_PROJECTIONS: usize = 64;
/// Fewest crossings of a knot other than the unknot whose Alexander polynomial is 1.
const LEAST_TRIVIAL_ALEXANDER: usize = 11;

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
    /// The invariants at hand do not tell the knot from its mirror image.
    Undecided,
}

/// Type of a closed curve as far as Alexander polynomial, determinant, signature and Jones polynomial tell.
///
/// These separate all knots of at most eight crossings, sums included, from each other and their mirror images. Beyond, a name
/// means that nothing contradicts it: see [`is_certain`](Self::is_certain).
///
/// # Validation
/// `knots_of_eight_crossings_are_told_apart`, `names_the_table_and_its_mirrors`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct KnotType {
    /// Names that fit, of the table or sums of its knots, mirror images under the same name; `0_1` is the unknot; empty if none
    /// fits.
    pub names: Vec<String>,
    /// Handedness with respect to the first name.
    pub handedness: Handedness,
    /// The invariants found.
    pub invariants: Invariants,
    /// Jones polynomial, if it was needed to decide and its diagram was not too wide.
    pub jones: Option<Jones>,
    /// Crossings of the simplest diagram that was found.
    pub n_crossings: usize,
    /// Whether the diagram is so small that every knot it could be was compared.
    pub exhaustive: bool,
}

impl KnotType {
    fn unknot(n_crossings: usize) -> Self {
        Self {
            names: vec![UNKNOT.to_owned()],
            handedness: Handedness::Amphichiral,
            invariants: Invariants {
                alexander: vec![1],
                determinant: 1,
                signature: 0,
            },
            jones: None,
            n_crossings,
            exhaustive: n_crossings < LEAST_TRIVIAL_ALEXANDER,
        }
    }

    /// Whether the curve was found to be the unknot.
    pub fn is_unknot(&self) -> bool {
        self.names.iter().any(|name| name == UNKNOT)
    }

    /// Whether the name is proved: only one fits, and the diagram has no more crossings than the table is complete for.
    pub fn is_certain(&self) -> bool {
        self.names.len() == 1 && self.exhaustive
    }

    /// The name with its handedness, `m3_1` for the mirror image of `3_1`; several that fit, separated by `|`, those of another
    /// knot or of a mirror image that the invariants do not tell apart; `unknown(...)` with the Alexander polynomial if none fits.
    ///
    /// # Validation
    /// `names_the_table_and_its_mirrors`
    pub fn label(&self) -> String {
        match (&self.names[..], self.handedness) {
            ([], _) => format!("{UNKNOWN}{})", self.invariants.alexander_text()),
            ([name], Handedness::Mirrored) => mirror_name(name),
            ([name], Handedness::Undecided) => format!("{name}|{}", mirror_name(name)),
            (names, _) => names.join("|"),
        }
    }

    /// Whether the curve may be the knot `name`, its handedness included: nothing that was found contradicts it.
    pub fn fits(&self, name: &str) -> bool {
        let is = |own: &String| *own == *name;
        let is_mirror = |own: &String| mirror_name(own) == *name;
        match (&self.names[..], self.handedness) {
            ([own], Handedness::Tabulated) => is(own),
            ([own], Handedness::Mirrored) => is_mirror(own),
            (names, _) => names.iter().any(|own| is(own) || is_mirror(own)),
        }
    }

    /// The finding as a sentence: one name with its handedness, `ambiguous: 8_21 or 3_1#4_1`, or `unknown` with the invariants.
    pub fn describe(&self) -> String {
        match &self.names[..] {
            [] => {
                let jones = self.jones.as_ref().map_or_else(String::new, |jones| {
                    format!(", Jones polynomial {}", jones.text())
                });
                format!(
                    "unknown: no knot of the table nor sum of two has Alexander polynomial {}, signature {}{jones}",
                    self.invariants.alexander_text(),
                    self.invariants.signature
                )
            }
            [name] if self.is_unknot() => format!("{name}, the unknot"),
            [name] => match self.handedness {
                Handedness::Tabulated => format!("{name}, as in the table"),
                Handedness::Mirrored => {
                    format!("{}, the mirror image of {name}", mirror_name(name))
                }
                Handedness::Amphichiral => format!("{name}, equal to its mirror image"),
                Handedness::Undecided => format!("{name} or its mirror image"),
            },
            names => format!("ambiguous: {}", names.join(" or ")),
        }
    }
}

/// Name of the unknot.
const UNKNOT: &str = "0_1";
/// How the label of a knot begins that has no name.
pub(crate) const UNKNOWN: &str = "unknown(";

/// The knot type of the closed polygon through `vertices`.
///
/// Vertices are removed while the triangle with their neighbours is free; what is left is projected and simplified,
/// and its invariants are looked up in the table and among the sums of two of its knots.
///
/// # Errors
/// [`KnotError::TooFewVertices`], [`KnotError::NotFinite`], [`KnotError::Degenerate`] for a curve that runs through itself, and
/// [`KnotError::TooComplicated`] for one with hundreds of crossings.
///
/// # Validation
/// `names_the_table_and_its_mirrors`, `a_curve_passed_through_itself_is_caught`, `composite_knots_multiply`.
///
/// # References
/// `koniaris1991`
pub fn identify(vertices: &[V], table: &KnotTable) -> Result<KnotType, KnotError> {
    let vertices = usable_vertices(vertices, true)?;
    let mut reducer = Reducer::default();
    reducer.load(&vertices, true);
    classify(&mut reducer, table, Care::Handed)
}

/// A closed curve of the same type with as few vertices as removing them one by one leaves.
pub(crate) fn shortened(vertices: &[V]) -> Vec<V> {
    let mut reducer = Reducer::default();
    reducer.load(vertices, true);
    reducer.reduce(true, &[]);
    while reducer.x.len() < 3 {
        // What is left of an unknot, or of a single point.
        reducer.x.push(vertices[reducer.x.len()]);
    }
    reducer.x
}

/// How far to go in telling knots apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Care {
    /// The Jones polynomial only where several names, or a knot and its mirror image, fit without it.
    Name,
    /// The Jones polynomial of everything that is knotted, for the handedness too.
    Handed,
}

/// The type of the closed chain in `reducer`, which is reduced on the way.
fn classify(reducer: &mut Reducer, table: &KnotTable, care: Care) -> Result<KnotType, KnotError> {
    let diagram = match diagram(reducer)? {
        Some(diagram) => diagram,
        None => return Ok(KnotType::unknot(0)),
    };
    let n_crossings = diagram.n_crossings();
    let invariants = Invariants::of_diagram(&diagram)?;
    if invariants.alexander == [1] && n_crossings < LEAST_TRIVIAL_ALEXANDER {
        return Ok(KnotType::unknot(n_crossings));
    }
    let mut finding = matches(&invariants, None, table);
    let mut jones = None;
    let is_open = finding.names.len() > 1
        || !finding.names.is_empty() && finding.handedness == Handedness::Undecided;
    if care == Care::Handed || is_open {
        jones = Invariants::jones_of(&diagram);
        if jones.is_some() {
            finding = matches(&invariants, jones.as_ref(), table);
        }
    }
    if invariants.alexander == [1] && jones.as_ref().is_none_or(|jones| *jones == Jones::one()) {
        return Ok(KnotType {
            jones,
            ..KnotType::unknot(n_crossings)
        });
    }
    let Finding { names, handedness } = finding;
    Ok(KnotType {
        names,
        handedness,
        invariants,
        jones,
        n_crossings,
        exhaustive: n_crossings <= table.complete_up_to() as usize,
    })
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

#[cfg(test)]
mod tests;
