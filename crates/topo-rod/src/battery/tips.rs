//! When the tips of a cut rod have left each other.

use crate::{Chain, RodState};

/// Whether every pair of points near the two tips of `chain` that only the seam keeps apart is more than `distance` apart, so that
/// the tips may from now on touch each other as strands do.
pub(crate) fn tips_have_parted(
    state: &RodState,
    chain: &Chain,
    distance: f64,
    window: f64,
) -> bool {
    let (x, n) = (&state.vertices()[chain.vertices()], chain.n_vertices());
    let reach = (window / chain.rest_length()).ceil().min(n as f64) as usize;
    let square = distance * distance;
    (0..=reach.min(n - 1)).all(|i| {
        (0..=(reach - i).min(n - 1)).all(|k| {
            let j = n - 1 - k;
            // a short rod: the pair is close along the rod itself
            j <= i + 2 * reach || (x[i] - x[j]).norm_squared() > square
        })
    })
}
