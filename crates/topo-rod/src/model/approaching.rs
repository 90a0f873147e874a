//! Pairs about to touch, which the Newton matrix counts as touching already.

use serde::{Deserialize, Serialize};

use crate::RodState;
use crate::contact::{ActivePair, ContactPairs};

/// Which pairs will touch within the next step.
///
/// Contact pushes in one direction only. A matrix made where two vertices are just apart does not contain it: the step runs
/// them into each other by much more than the tolerance, is refused or bounces off, and the next matrix is made just apart
/// again. Stiff strands in that cycle take steps a hundred times too short. With the pair in the matrix the step ends about
/// where they touch. Vertices that part, or that are farther apart than a part of the tolerance, are left out: a matrix that
/// holds what should move causes an error that the embedded estimate does not see.
///
/// The pairs are looked for only for a few steps after a refused one, as ordinary runs need none of this.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct ApproachingPairs {
    pairs: Vec<ActivePair>,
    margin: f64,
    prepared: Option<u64>,
    n_wary: u32,
}

/// Widest gap of a pair that is expected to touch, in tolerances.
const MARGIN: f64 = 0.25;
/// Accepted steps after a refused one in which pairs are looked for.
const WARY: u32 = 16;

impl ApproachingPairs {
    /// For steps with errors of `tolerance`.
    pub(super) fn new(tolerance: f64) -> Self {
        Self {
            pairs: Vec::new(),
            margin: MARGIN * tolerance,
            prepared: None,
            n_wary: 0,
        }
    }

    /// Whether it is one for the same steps, of a rod of `n` vertices.
    pub(super) fn is_like(&self, fresh: &Self, n: usize) -> bool {
        let is_sound = |p: &ActivePair| {
            let numbers = [p.weight, p.distance];
            p.i < p.j
                && (p.j as usize) < n
                && p.normal.iter().chain(&numbers).all(|x| x.is_finite())
        };
        self.margin == fresh.margin && self.pairs.iter().all(is_sound)
    }

    /// Whether pairs are looked for.
    #[cfg(test)]
    pub(super) fn is_wary(&self) -> bool {
        self.n_wary > 0
    }

    /// Called when a matrix is made at the state `stamp`: if that happens twice, the first step from there was refused.
    pub(super) fn look_out(&mut self, stamp: u64) {
        if self.prepared.replace(stamp) == Some(stamp) {
            self.n_wary = WARY;
        }
    }

    /// Counts an accepted step.
    pub(super) fn step(&mut self) {
        self.n_wary = self.n_wary.saturating_sub(1);
    }

    /// Pairs found last.
    pub(super) fn pairs(&self) -> &[ActivePair] {
        &self.pairs
    }

    /// Finds the pairs that would close their gap to `diameter` within the time `ahead` at the present rate.
    pub(super) fn update(
        &mut self,
        state: &RodState,
        pairs: &ContactPairs,
        diameter: f64,
        rate: Option<&[f64]>,
        ahead: f64,
    ) {
        self.pairs.clear();
        let Some(v) = rate.filter(|_| self.n_wary > 0) else {
            return;
        };
        let n = state.n_vertices();
        let close = pairs.between(state.vertices(), diameter, diameter + self.margin);
        self.pairs.extend(close.filter(|p| {
            let (i, j) = (p.i as usize, p.j as usize);
            let parting: f64 = (0..3)
                .map(|k| p.normal[k] * (v[k * n + i] - v[k * n + j]))
                .sum();
            p.distance - diameter + ahead * parting < 0.0
        }));
    }
}
