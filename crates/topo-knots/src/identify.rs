//! The knot type of a closed or an open curve.

mod entry;
mod kind;
mod known;
mod open;

use crate::exact::segments_meet;
use crate::invariant::{Diagram, kauffman, kauffman_of_name, least_crossing, usable_vertices};
use crate::reduce::Reducer;
use crate::{Invariants, Jones, KnotError, KnotTable, V};
use known::{Found, candidates};

use kind::LEAST_TRIVIAL_ALEXANDER;

pub use kind::{Handedness, KnotType};
pub(crate) use open::far_points;
pub use open::{OpenKnotType, identify_open};

/// Directions tried for a projection with few crossings; a reduced polygon has few anyway.
const N_PROJECTIONS: usize = 8;
/// Times that a curve is looked at again where the diagram keeps more crossings than a certain name may have.
const N_MORE_LOOKS: u64 = 6;
/// Most crossings of a diagram for which that is worth a try.
const MOST_LOOKED_AT_AGAIN: usize = 20;
/// Pass moves tried at random on each diagram then.
const N_SHUFFLES: usize = 300;

/// The knot type of the closed polygon through `vertices`.
///
/// Vertices are removed while the triangle with their neighbours is free; what is left is projected and simplified, and its
/// invariants are looked up among the known knots and the sums of two or three of them.
///
/// # Errors
/// [`KnotError::TooFewVertices`], [`KnotError::NotFinite`], [`KnotError::Degenerate`] for a curve that runs through itself, and
/// [`KnotError::TooComplicated`] for one with hundreds of crossings.
///
/// # Validation
/// `names_the_table_and_its_mirrors`, `a_curve_passed_through_itself_is_caught`, `composite_knots_multiply`.
///
/// # References
/// [koniaris1991]
///
/// [koniaris1991]: https://doi.org/10.1063/1.460889
pub fn identify(vertices: &[V], table: &KnotTable) -> Result<KnotType, KnotError> {
    let vertices = usable_vertices(vertices, true)?;
    let mut reducer = Reducer::default();
    reducer.load(&vertices, true);
    classify(&mut reducer, table, Care::Handed)
}

/// How far to go in distinguishing knots.
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
        handedness: Handedness::of(&list),
        candidates: list,
        invariants,
        jones,
        n_crossings,
        certain_to: table.complete_up_to(),
    })
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
