//! Knot types of an open curve: closed along many directions, with the probability of each type.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::{Care, KnotType, classify};
use crate::invariant::{fibonacci_directions, usable_vertices};
use crate::reduce::{Ray, Reducer};
use crate::{KnotError, KnotTable, V};

/// Radius of the sphere of closing points, in units of the radius of the curve.
const FAR: f64 = 50.0;

/// Knot types of an open curve under closures in all directions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OpenKnotType {
    /// Label and share of each type met, most frequent first, then by label.
    pub distribution: Vec<(String, f64)>,
    /// What was found for each entry of `distribution`, in the closure whose diagram had the most crossings.
    pub types: Vec<KnotType>,
    /// Number of closures.
    pub n_closures: usize,
}

impl OpenKnotType {
    /// The most frequent type.
    pub fn dominant(&self) -> &str {
        self.distribution.first().map_or("", |(label, _)| label)
    }

    /// Share of the closures that have the given label.
    pub fn probability(&self, label: &str) -> f64 {
        self.distribution
            .iter()
            .find(|(known, _)| known == label)
            .map_or(0.0, |(_, share)| *share)
    }
}

/// The knot types of an open curve, both ends joined to each of `n_closures` far points spread over the sphere.
///
/// The chain is first reduced in a way that keeps its type under every one of the closures, so that the work for each
/// of them is small. `seed` turns the directions.
///
/// # Errors
/// As [`identify`](crate::identify), and [`KnotError::Setting`] for no closure at all.
///
/// # Validation
/// `common_reduction_changes_no_closure`, `an_open_knot_is_dominated_by_its_type`.
///
/// # References
/// [tubiana2011], [dabrowski2021]
///
/// [tubiana2011]: https://doi.org/10.1143/PTPS.191.192
/// [dabrowski2021]: https://doi.org/10.1093/bib/bbaa196
pub fn identify_open(
    vertices: &[V],
    n_closures: usize,
    seed: u64,
    table: &KnotTable,
) -> Result<OpenKnotType, KnotError> {
    let vertices = &*usable_vertices(vertices, false)?;
    let far = far_points(vertices, n_closures, seed)?;
    let mut reducer = Reducer::default();
    reducer.load(vertices, false);
    if let [first, .., last] = reducer.x[..] {
        let rays: Vec<Ray> = far
            .iter()
            .flat_map(|p| [Ray::new(first, *p), Ray::new(last, *p)])
            .collect();
        reducer.reduce(false, &rays);
    }
    let chain = std::mem::take(&mut reducer.x);
    let mut found: Vec<(String, KnotType, usize)> = Vec::new();
    for point in far {
        let kind = close(&chain, point, &mut reducer, table)?;
        let label = kind.label();
        match found.iter_mut().find(|(known, ..)| *known == label) {
            Some((_, widest, count)) => {
                *count += 1;
                if kind.n_crossings > widest.n_crossings {
                    *widest = kind;
                }
            }
            None => found.push((label, kind, 1)),
        }
    }
    found.sort_by(|a, b| b.2.cmp(&a.2).then_with(|| a.0.cmp(&b.0)));
    let share = |count| count as f64 / n_closures as f64;
    let (distribution, types) = found
        .into_iter()
        .map(|(label, kind, count)| ((label, share(count)), kind))
        .unzip();
    Ok(OpenKnotType {
        distribution,
        types,
        n_closures,
    })
}

/// Type of the chain closed through one far point.
fn close(
    chain: &[V],
    point: V,
    reducer: &mut Reducer,
    table: &KnotTable,
) -> Result<KnotType, KnotError> {
    // ends that coincide are closed already: the way to the far point and back would run through itself
    let is_closed = chain.first() == chain.last();
    reducer.load(chain, is_closed);
    if !is_closed {
        reducer.x.push(point);
    }
    classify(reducer, table, Care::Name)
}

/// At least one point, in directions spread over the sphere.
pub(crate) fn far_points(vertices: &[V], n: usize, seed: u64) -> Result<Vec<V>, KnotError> {
    if n == 0 {
        return Err(KnotError::Setting {
            name: "n_closures",
            value: 0.0,
            expected: "at least one closure is needed, 32 is usual",
        });
    }
    let centre = vertices.iter().sum::<V>() / vertices.len() as f64;
    let radius = vertices
        .iter()
        .map(|x| (x - centre).norm())
        .fold(0.0, f64::max);
    // An irrational offset keeps rays out of the planes that symmetric curves lie in.
    let offset = V::new(1e-3, PI * 1e-4, -2e-4) * radius;
    Ok(fibonacci_directions(n, seed)
        .map(|d| centre + offset + FAR * radius.max(f64::MIN_POSITIVE) * d)
        .collect())
}
