//! Knot types of an open curve: closed along many directions, with the probability of each type.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::reduce::{Ray, Reducer};
use super::{Care, classify};
use crate::invariant::{fibonacci_directions, usable_vertices};
use crate::{KnotError, KnotTable, V};

/// Radius of the sphere of closing points, in units of the radius of the curve.
const FAR: f64 = 50.0;

/// Knot types of an open curve under closures in all directions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OpenKnotType {
    /// Label and share of each type met, most frequent first, then by label.
    pub distribution: Vec<(String, f64)>,
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
/// `tubiana2011`, `dabrowski2021`
pub fn identify_open(
    vertices: &[V],
    n_closures: usize,
    seed: u64,
    table: &KnotTable,
) -> Result<OpenKnotType, KnotError> {
    let vertices = &*usable_vertices(vertices, false)?;
    if n_closures == 0 {
        let expected = "at least one closure is needed, 32 is usual";
        return Err(KnotError::Setting {
            name: "n_closures",
            value: 0.0,
            expected,
        });
    }
    let far = far_points(vertices, n_closures, seed);
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
    let mut counts: Vec<(String, usize)> = Vec::new();
    for point in far {
        let label = close(&chain, point, &mut reducer, table)?;
        match counts.iter_mut().find(|(known, _)| *known == label) {
            Some((_, count)) => *count += 1,
            None => counts.push((label, 1)),
        }
    }
    counts.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
    let share = |(label, count)| (label, count as f64 / n_closures as f64);
    Ok(OpenKnotType {
        distribution: counts.into_iter().map(share).collect(),
        n_closures,
    })
}

/// Label of the chain closed through one far point.
fn close(
    chain: &[V],
    point: V,
    reducer: &mut Reducer,
    table: &KnotTable,
) -> Result<String, KnotError> {
    // Not as a closed chain: ends that coincide must both stay, the far point lies between them.
    reducer.load(chain, false);
    reducer.x.push(point);
    Ok(classify(reducer, table, Care::Name)?.label())
}

pub(super) fn far_points(vertices: &[V], n: usize, seed: u64) -> Vec<V> {
    let centre = vertices.iter().sum::<V>() / vertices.len() as f64;
    let radius = vertices
        .iter()
        .map(|x| (x - centre).norm())
        .fold(0.0, f64::max);
    // An irrational offset keeps rays out of the planes that symmetric curves lie in.
    let offset = V::new(1e-3, PI * 1e-4, -2e-4) * radius;
    fibonacci_directions(n, seed)
        .map(|d| centre + offset + FAR * radius.max(f64::MIN_POSITIVE) * d)
        .collect()
}
