//! When the tips of a cut rod have left each other.

use crate::{RodState, Tips};

/// Whether every pair of points near the two tips that only the cut keeps apart is more than `distance` apart, so that the tips may
/// from now on touch each other as strands do.
pub(crate) fn tips_have_parted(state: &RodState, tips: Tips, distance: f64, window: f64) -> bool {
    let chain = &state.components()[tips.component()];
    let (x, n) = (state.vertices(), chain.n_vertices());
    let reach = (window / chain.rest_length()).ceil().min(n as f64) as usize;
    let are_apart = |i: usize, j: usize| (x[i] - x[j]).norm_squared() > distance * distance;
    match tips {
        Tips::Of(_) => (0..=reach.min(n - 1)).all(|i| {
            (0..=(reach - i).min(n - 1)).all(|k| {
                let j = n - 1 - k;
                // a short rod: the pair is close along the rod itself
                j <= i + 2 * reach || are_apart(chain.first() + i, chain.first() + j)
            })
        }),
        Tips::Between(c) => {
            let next = state.components()[c + 1].vertices();
            let mut own = chain.vertices().rev().enumerate().take(reach + 1);
            own.all(|(k, i)| next.clone().take(reach - k + 1).all(|j| are_apart(i, j)))
        }
    }
}
