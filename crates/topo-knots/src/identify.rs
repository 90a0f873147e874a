//! Which knot of the table a closed or an open curve is.

mod boxes;
mod known;
mod open;
mod reduce;

use serde::{Deserialize, Serialize};

use crate::exact::segments_meet;
use crate::invariant::{Diagram, kauffman, kauffman_of_name, least_crossing, usable_vertices};
use crate::name::{self, KnotName, UNKNOT};
use crate::{Invariants, Jones, KnotError, KnotTable, V};
use known::{Candidate, Found, candidates};
use reduce::Reducer;

pub use open::{OpenKnotType, identify_open};

/// Directions tried for a projection with few crossings; a reduced polygon has few anyway.
const N_PROJECTIONS: usize = 8;
/// Times that a curve is looked at again where the diagram keeps more crossings than a certain name may have.
const N_MORE_LOOKS: u64 = 6;
/// Most crossings of a diagram for which that is worth a try.
const MOST_LOOKED_AT_AGAIN: usize = 20;
/// Pass moves tried at random on each diagram then.
const N_SHUFFLES: usize = 300;
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

/// Type of a closed curve as far as Alexander polynomial, determinant, signature, Jones and Kauffman polynomial tell.
///
/// These separate all knots of at most ten crossings, sums included, from each other and their mirror images, but for the hand of
/// 10_71. Beyond, a name means that nothing contradicts it: see [`is_certain`](Self::is_certain).
///
/// # Validation
/// `all_types_to_ten_crossings_are_told_apart`, `names_the_table_and_its_mirrors`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub struct KnotType {
    /// What fits; empty if nothing known does.
    candidates: Vec<Candidate>,
    /// Which of the knot and its mirror image it is; undecided if several types fit, or none.
    pub handedness: Handedness,
    /// The invariants found.
    pub invariants: Invariants,
    /// Jones polynomial, if it was needed to decide and its diagram was not too wide.
    pub jones: Option<Jones>,
    /// Crossings of the simplest diagram that was found.
    pub n_crossings: usize,
    /// Crossing number up to which every type was compared.
    certain_to: u32,
}

impl KnotType {
    fn unknot(n_crossings: usize) -> Self {
        let name = || KnotName::parse(UNKNOT);
        Self {
            candidates: vec![Candidate {
                name: name(),
                mirror: name(),
            }],
            handedness: Handedness::Amphichiral,
            invariants: Invariants::unknot(),
            jones: None,
            n_crossings,
            certain_to: LEAST_TRIVIAL_ALEXANDER as u32 - 1,
        }
    }

    /// The names that fit, each with its hand written out: `m3_1` is the mirror image of `3_1`, `0_1` the unknot; none if nothing known
    /// fits.
    pub fn candidates(&self) -> impl Iterator<Item = &KnotName> {
        self.candidates.iter().map(|candidate| &candidate.name)
    }

    /// The name with its hand, if only one fits.
    pub fn name(&self) -> Option<&KnotName> {
        match &self.candidates[..] {
            [only] => Some(&only.name),
            _ => None,
        }
    }

    /// The types that fit, a type and its mirror image under one name.
    pub fn types(&self) -> Vec<&KnotName> {
        let mut types: Vec<&KnotName> = Vec::new();
        for candidate in &self.candidates {
            if !types.contains(&candidate.unsided()) {
                types.push(candidate.unsided());
            }
        }
        types
    }

    /// Whether the curve was found to be the unknot.
    pub fn is_unknot(&self) -> bool {
        self.candidates().any(|name| name.to_string() == UNKNOT)
    }

    /// Whether the type is proved: only one fits, and the diagram has so few crossings that every type it could be was compared. The
    /// hand is too, unless [`handedness`](Self::handedness) is undecided, as that of 10_71.
    pub fn is_certain(&self) -> bool {
        self.types().len() == 1 && self.is_exhaustive()
    }

    /// Crossing number up to which every type was compared: with a diagram of no more crossings, a name that is the only one is certain.
    pub fn certain_to(&self) -> u32 {
        self.certain_to
    }

    fn is_exhaustive(&self) -> bool {
        self.n_crossings <= self.certain_to as usize
    }

    /// The name with its hand, `m3_1` for the mirror image of `3_1`; several that fit, separated by `|`; `unknown(...)` with the
    /// Alexander polynomial if none fits.
    ///
    /// # Validation
    /// `names_the_table_and_its_mirrors`
    pub fn label(&self) -> String {
        if self.candidates.is_empty() {
            return format!("{UNKNOWN}{})", self.invariants.alexander_text());
        }
        self.joined("|")
    }

    fn joined(&self, joint: &str) -> String {
        let names: Vec<String> = self.candidates().map(KnotName::to_string).collect();
        names.join(joint)
    }

    /// Whether the curve may be the knot `name`, its hand included: nothing that was found contradicts it.
    pub fn fits(&self, name: &str) -> bool {
        let is_amphichiral = |knot: &str| {
            let alone = |name: &KnotName| !name.is_sum() && name.to_string() == knot;
            let known = |c: &Candidate| c.name == c.mirror && alone(&c.name);
            name::is_amphichiral(knot) || self.candidates.iter().any(known)
        };
        let name = KnotName::parse_with(name, &is_amphichiral);
        self.candidates().any(|own| *own == name)
    }

    /// The finding as a sentence: a name with its hand and `(certain)`, `consistent with ...` where the diagram was too large for that,
    /// `one of 8_21, 3_1#4_1` where several fit, or `unknown` with the invariants.
    pub fn describe(&self) -> String {
        let types = self.types();
        let what = match (&types[..], self.handedness) {
            ([], _) => {
                let jones = self.jones.as_ref().map_or_else(String::new, |jones| {
                    format!(", Jones polynomial {}", jones.text())
                });
                return format!(
                    "unknown: no knot of the table nor sum of two or three has Alexander polynomial {}, signature {}{jones}",
                    self.invariants.alexander_text(),
                    self.invariants.signature
                );
            }
            ([name], _) if self.is_unknot() => format!("{name}, the unknot"),
            ([name], Handedness::Tabulated) => format!("{name}, as in the table"),
            ([name], Handedness::Mirrored) => {
                format!("{}, the mirror image of {name}", self.label())
            }
            ([name], Handedness::Amphichiral) => format!("{name}, equal to its mirror image"),
            ([name], Handedness::Undecided) => {
                format!("{name} or its mirror image, handedness unknown")
            }
            _ => self.joined(", "),
        };
        match (self.is_exhaustive(), types.len()) {
            (true, 1) => format!("{what} (certain)"),
            (true, _) => format!("one of {what}"),
            (false, 1) => format!("consistent with {what}"),
            (false, _) => format!("consistent with each of {what}"),
        }
    }
}

/// How the label of a knot begins that has no name.
pub(crate) const UNKNOWN: &str = "unknown(";

/// The knot type of the closed polygon through `vertices`.
///
/// Vertices are removed while the triangle with their neighbours is free; what is left is projected and simplified,
/// and its invariants are looked up among the knots known and the sums of two or three of them.
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
    match diagram(reducer, table.complete_up_to() as usize)? {
        Some(diagram) => classify_diagram(&diagram, table, care),
        None => Ok(KnotType::unknot(0)),
    }
}

/// The type of a diagram.
fn classify_diagram(
    diagram: &Diagram,
    table: &KnotTable,
    care: Care,
) -> Result<KnotType, KnotError> {
    let n_crossings = diagram.n_crossings();
    let invariants = Invariants::of_diagram(diagram)?;
    if invariants.alexander == [1] && n_crossings < LEAST_TRIVIAL_ALEXANDER {
        return Ok(KnotType::unknot(n_crossings));
    }
    let look_up = |jones: Option<&Jones>| {
        let found = Found {
            invariants: &invariants,
            jones,
            n_crossings,
        };
        candidates(&found, table)
    };
    let mut list = look_up(None);
    let mut jones = None;
    if care == Care::Handed || list.len() > 1 {
        jones = Invariants::jones_of(diagram);
        if jones.is_some() {
            list = look_up(jones.as_ref());
        }
        if list.len() > 1
            && let Some(found) = kauffman(diagram)
        {
            list.retain(|c| kauffman_of_name(&c.name).is_none_or(|own| own == found));
        }
    }
    if invariants.alexander == [1] && jones.as_ref().is_none_or(|jones| *jones == Jones::one()) {
        return Ok(KnotType {
            jones,
            ..KnotType::unknot(n_crossings)
        });
    }
    Ok(KnotType {
        handedness: handedness(&list),
        candidates: list,
        invariants,
        jones,
        n_crossings,
        certain_to: table.complete_up_to(),
    })
}

/// The hand that all candidates have in common, if they are of one type.
fn handedness(list: &[Candidate]) -> Handedness {
    match list {
        [only] if only.name == only.mirror => Handedness::Amphichiral,
        [only] if only.name < only.mirror => Handedness::Tabulated,
        [_] => Handedness::Mirrored,
        _ => Handedness::Undecided,
    }
}

/// A small diagram of the closed chain in `reducer`, with more effort if it has more than `enough` crossings; none if it is seen to
/// be the unknot.
fn diagram(reducer: &mut Reducer, enough: usize) -> Result<Option<Diagram>, KnotError> {
    reducer.reduce(true, &[]);
    if reducer.x.len() < 6 {
        return match touches_itself(&reducer.x) {
            true => Err(KnotError::Degenerate),
            false => Ok(None),
        };
    }
    let mut diagram = least_crossing(&reducer.x, N_PROJECTIONS, 0)?;
    diagram.shuffle(enough, N_SHUFFLES);
    for seed in 1..=N_MORE_LOOKS {
        if diagram.n_crossings() <= enough || diagram.n_crossings() > MOST_LOOKED_AT_AGAIN {
            break;
        }
        let mut other = least_crossing(&reducer.x, N_PROJECTIONS, seed)?;
        other.shuffle(enough, N_SHUFFLES);
        if other.n_crossings() < diagram.n_crossings() {
            diagram = other;
        }
    }
    Ok((diagram.n_crossings() >= 3).then_some(diagram))
}

/// Whether two edges of a closed polygon of few vertices meet that are no neighbours.
fn touches_itself(x: &[V]) -> bool {
    let n = x.len();
    let meet = |i: usize, j: usize| segments_meet(&x[i], &x[i + 1], &x[j], &x[(j + 1) % n]);
    (0..n).any(|i| (i + 2..n).any(|j| (i > 0 || j + 1 < n) && meet(i, j)))
}

#[cfg(test)]
mod census_tests;
#[cfg(test)]
mod tests;
