//! What every step must pass before it is accepted.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use topo_core::Rejection;

use crate::contact::{ContactPairs, segment_distance};
use crate::{Chain, RodState};

/// Limits on one step; each refuses with a name of its own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Guards {
    /// Largest displacement of a vertex, in h.
    pub displacement: f64,
    /// Largest rise of the total energy beyond the work done on the rod, relative.
    pub energy_rise: f64,
    /// Largest sum of such rises over a run, relative to the energy it starts with.
    pub energy_rise_in_all: f64,
    /// Largest drift of Tw + Wr of a closed rod before the run fails, in turns.
    pub link_drift: f64,
}

impl Default for Guards {
    fn default() -> Self {
        Self {
            displacement: 0.25,
            energy_rise: 1e-4,
            energy_rise_in_all: 1e-3,
            link_drift: 0.01,
        }
    }
}

/// How much energy a run may still gain by errors of its steps.
///
/// A single step may gain little, and never more than a tenth of what the whole run has left: the sum cannot reach the limit,
/// however many steps there are. The energy of a gradient flow falls in any step that is short enough, so a refused step is
/// repeated with a shorter one.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(crate) struct RiseBudget {
    /// Energy that the limits are relative to.
    scale: f64,
    risen: f64,
}

/// Share of what is left that one step may use.
const SHARE: f64 = 0.1;
/// Differences of energies below this share of the scale are rounding.
const ROUNDING: f64 = 1e-14;

impl RiseBudget {
    /// The budget after a rise that hardly counts.
    #[cfg(test)]
    pub(crate) fn after_a_rise(self) -> Self {
        Self {
            risen: self.risen + 1e-9 * self.scale,
            ..self
        }
    }

    /// For a run that starts at `energy`.
    pub(crate) fn new(energy: f64) -> Self {
        Self {
            scale: energy.abs(),
            risen: 0.0,
        }
    }

    /// Whether its numbers are finite.
    pub(crate) fn is_sound(&self) -> bool {
        self.scale.is_finite() && self.risen.is_finite()
    }

    /// Widens the scale of a run whose ends are driven: it may start at rest.
    pub(crate) fn widen(&mut self, energy: f64) {
        self.scale = self.scale.max(energy.abs());
    }

    /// Largest rise that a step from `energy` may have.
    pub(crate) fn allowed(&self, guards: &Guards, energy: f64) -> f64 {
        let left = (guards.energy_rise_in_all * self.scale - self.risen).max(0.0);
        (guards.energy_rise * energy.abs().max(1e-12))
            .min(SHARE * left)
            .max(ROUNDING * self.scale)
    }

    /// Records the rise of an accepted step.
    pub(crate) fn book(&mut self, rise: f64) {
        self.risen += rise.max(0.0);
    }
}

/// Largest displacement of a vertex in a component-major step, and where.
pub(crate) fn largest_displacement(step: &[f64], n: usize) -> (usize, f64) {
    let mut worst = (0, 0.0);
    for i in 0..n {
        let square =
            step[i] * step[i] + step[n + i] * step[n + i] + step[2 * n + i] * step[2 * n + i];
        if square > worst.1 {
            worst = (i, square);
        }
    }
    (worst.0, worst.1.sqrt())
}

/// Proof that no two parts of the rod pass through each other during a step.
///
/// Along the straight path from one state to the next, a point of edge i moves relative to a point of edge j by at most the
/// largest relative displacement of their end points. If that stays below the distance of the two edges at the start, they
/// cannot meet. Pairs far apart are proved by the displacement limit; all others, also those inside the contact window, are
/// measured.
///
/// # Errors
/// [`Rejection::Crossing`] names the first pair of edges that is not proved apart.
pub(crate) fn certify(
    from: &RodState,
    step: &[f64],
    largest: f64,
    pairs: &ContactPairs,
    near: &mut Vec<(u32, u32)>,
) -> Result<(), Rejection> {
    let x = from.vertices();
    let edges = || from.components().iter().flat_map(Chain::edges);
    let longest = from
        .components()
        .iter()
        .flat_map(|chain| chain.edges().map(|j| x[chain.edge_end(j)] - x[j]))
        .map(|edge| edge.norm_squared())
        .fold(0.0, f64::max)
        .sqrt();
    let limit = 2.0 * largest + longest;
    for c in 0..from.n_components() {
        certify_neighbours(from, step, limit, pairs, c)?;
    }
    let first_of_two = pairs.first_of_two();
    if let Some(c) = first_of_two {
        certify_across(from, step, limit, pairs, c)?;
    }
    // strands in reach of each other: edges around each listed pair of vertices
    if !pairs.vertices_within(limit, x, near) {
        // so coarse a rod that the list is shorter than its edges
        for i in edges() {
            let chain = from.chain_of(i);
            let joined = chain.is_closed() || pairs.is_cyclic_along(from, from.component_of(i));
            let seam = chain.edges().end - 1;
            for j in edges().filter(|&j| j > i) {
                let next = j == i + 1 && chain.edges().contains(&j);
                let around = joined && i == chain.first() && j == seam;
                let across =
                    i == seam && j == seam + 2 && first_of_two == Some(from.component_of(i));
                if !(next || around || across) {
                    certify_pair(from, step, limit, i, j)?;
                }
            }
        }
    }
    for &(a, b) in near.iter() {
        for i in edges_at(from, a as usize) {
            for j in edges_at(from, b as usize) {
                if i != j && from.edge_end(i) != j && from.edge_end(j) != i {
                    certify_pair(from, step, limit, i, j)?;
                }
            }
        }
    }
    Ok(())
}

/// Proof for neighbours along component `c`, which the contact list leaves out.
fn certify_neighbours(
    from: &RodState,
    step: &[f64],
    limit: f64,
    pairs: &ContactPairs,
    c: usize,
) -> Result<(), Rejection> {
    let chain = &from.components()[c];
    let (edges, n_edges) = (chain.edges(), chain.n_edges());
    let joined = chain.is_closed() || pairs.is_cyclic_along(from, c);
    let farthest = if joined { n_edges / 2 } else { n_edges };
    let width = ((pairs.window().outer() / chain.rest_length())
        .min(n_edges as f64)
        .ceil() as usize
        + 1)
    .min(farthest);
    for i in edges.clone() {
        for k in 2..=width {
            let j = i + k;
            if j < edges.end {
                certify_pair(from, step, limit, i, j)?;
            } else if joined {
                certify_pair(from, step, limit, i, j - n_edges)?;
            }
        }
    }
    Ok(())
}

/// The same for neighbours on the two sides of a cut between component `c` and the next one, but for the two that end there.
fn certify_across(
    from: &RodState,
    step: &[f64],
    limit: f64,
    pairs: &ContactPairs,
    c: usize,
) -> Result<(), Rejection> {
    let [before, after] = [c, c + 1].map(|c| from.components()[c]);
    let width = (pairs.window().outer() / before.rest_length()).ceil() as usize + 1;
    for (a, i) in before.edges().rev().enumerate().take(width) {
        for (b, j) in after.edges().enumerate().take(width - a) {
            if a + b > 0 {
                certify_pair(from, step, limit, i, j)?;
            }
        }
    }
    Ok(())
}

/// Proof for the edges i and j, none of whose points can meet if their middles are further apart than `limit`.
#[inline]
fn certify_pair(
    from: &RodState,
    step: &[f64],
    limit: f64,
    i: usize,
    j: usize,
) -> Result<(), Rejection> {
    let (x, n) = (from.vertices(), from.n_vertices());
    let (i1, j1) = (from.edge_end(i), from.edge_end(j));
    // the bound by the middles costs no square root of a segment pair
    let middles = (x[i] + x[i1] - x[j] - x[j1]).norm_squared() * 0.25;
    if middles > limit * limit {
        return Ok(());
    }
    let moved = |i: usize| Vector3::new(step[i], step[n + i], step[2 * n + i]);
    let (a, b) = ([moved(i), moved(i1)], [moved(j), moved(j1)]);
    let relative = a
        .iter()
        .flat_map(|p| b.iter().map(move |q| (p - q).norm_squared()))
        .fold(0.0, f64::max)
        .sqrt();
    if relative < segment_distance(&x[i], &x[i1], &x[j], &x[j1]) {
        Ok(())
    } else {
        Err(Rejection::Crossing {
            edges: (i.min(j), i.max(j)),
        })
    }
}

/// The edges that meet at a vertex.
fn edges_at(state: &RodState, i: usize) -> impl Iterator<Item = usize> {
    let chain = state.chain_of(i);
    let before = (chain.is_closed() || i > chain.first()).then(|| chain.edge_before(i));
    let after = chain.edges().contains(&i).then_some(i);
    before.into_iter().chain(after)
}

#[cfg(test)]
mod tests;
