//! Which pairs are in the pattern of a matrix.

use serde::{Deserialize, Serialize};

use super::{ActivePair, ContactPairs};
use crate::RodState;

/// The pairs of a sparse pattern, ascending: kept as long as all pairs in reach are among them and they are not many more.
#[derive(Debug, Default, Clone, Serialize, Deserialize)]
pub(crate) struct KnownPairs {
    pairs: Vec<(u32, u32)>,
    /// Pairs in reach when the pattern was made.
    n_active_then: usize,
}

/// Pairs a little out of reach that a pattern holds in advance, in h.
const FORESIGHT: f64 = 0.15;

impl KnownPairs {
    /// Whether all pairs are of a rod of `n` vertices.
    pub(crate) fn are_of(&self, n: usize) -> bool {
        self.pairs.iter().all(|&(i, j)| i < j && (j as usize) < n)
    }

    /// The pairs held.
    pub(crate) fn list(&self) -> &[(u32, u32)] {
        &self.pairs
    }

    /// Places in the list of pairs that are all in it and ascend as it does.
    pub(crate) fn places<'a>(
        &'a self,
        part: impl Iterator<Item = (u32, u32)> + 'a,
    ) -> impl Iterator<Item = usize> + 'a {
        let mut place = 0;
        part.map(move |pair| {
            while self.pairs[place] != pair {
                place += 1;
            }
            place
        })
    }

    /// Whether the pattern can be used for `n` vertices with these pairs in reach, and with `further` ones that ascend as well.
    ///
    /// A pattern with far too many pairs costs more in every factorisation than a new symbolic analysis. One that had as many
    /// pairs when it was made would get as many again.
    pub(crate) fn serve(
        &self,
        n: usize,
        active: &[ActivePair],
        further: impl Iterator<Item = (u32, u32)>,
    ) -> bool {
        let n_active = active.len();
        let lean = self.pairs.len() <= 2 * n_active + n || 2 * n_active >= self.n_active_then;
        lean && is_part(active.iter().map(|p| (p.i, p.j)), &self.pairs)
            && is_part(further, &self.pairs)
    }

    /// Takes up the pairs in reach at `state`, those about to be, and `further` ones.
    pub(crate) fn renew(
        &mut self,
        state: &RodState,
        pairs: &ContactPairs,
        further: impl Iterator<Item = (u32, u32)>,
    ) {
        pairs.near(state, FORESIGHT, &mut self.pairs);
        let n_near = self.pairs.len();
        self.pairs.extend(further);
        if self.pairs.len() > n_near {
            self.pairs.sort_unstable();
            self.pairs.dedup();
        }
        self.n_active_then = pairs.active().len();
    }
}

/// Whether each of the ascending `part` is among the ascending `whole`.
fn is_part(mut part: impl Iterator<Item = (u32, u32)>, whole: &[(u32, u32)]) -> bool {
    let mut rest = whole.iter();
    part.all(|p| rest.any(|q| *q == p))
}
