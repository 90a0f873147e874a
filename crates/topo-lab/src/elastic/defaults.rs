//! What a scene of rods has where its file does not say.

/// L/h.
pub fn slenderness() -> f64 {
    50.0
}

/// Poisson's ratio.
pub fn poisson_ratio() -> f64 {
    0.3
}

/// γ = E/E_b.
pub fn stretch_ratio() -> f64 {
    5.0
}

/// Size of the random perturbation of the start curve, in h.
pub fn imperfection() -> f64 {
    1e-3
}

/// Its seed.
pub fn seed() -> u64 {
    1
}

/// Poisson's ratio whose twist ratio 1/(1 + ν) is the one given, to the bit where there is one.
pub(super) fn poisson_ratio_of(twist_ratio: f64) -> f64 {
    let near = 1.0 / twist_ratio - 1.0;
    // 1 + ν is a multiple of this: its neighbours are all that rounding can have meant.
    let spacing = 0.5 * f64::EPSILON;
    (0..16)
        .flat_map(|k| [near + f64::from(k) * spacing, near - f64::from(k) * spacing])
        .find(|ratio| 1.0 / (1.0 + ratio) == twist_ratio)
        .unwrap_or(near)
}

/// Output times of a pull.
pub(super) fn outputs() -> usize {
    100
}
