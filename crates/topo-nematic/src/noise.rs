//! Fields without any symmetry, the same in every run of a test.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Numbers between -1 and 1.
pub(crate) fn noise(seed: u64) -> impl Iterator<Item = f64> {
    let mut rng = Pcg64::seed_from_u64(seed);
    std::iter::repeat_with(move || rng.random_range(-1.0..1.0))
}
