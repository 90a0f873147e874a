//! What a mode that decays dissipates within a step, over what its mean velocity does.

/// φ − 1 in the mean over the modes of a step with the secant form `slow`.
pub(crate) fn excess<T: Copy>(
    slow: f64,
    g: Option<f64>,
    a: T,
    smoothed: T,
    form: impl Fn(T, T) -> f64,
) -> f64 {
    if slow <= 0.0 {
        return 0.0;
    }
    let bound = relaxation_factor((form(a, a) / slow).sqrt()) - 1.0;
    let Some(g) = g else {
        return bound;
    };
    let sum = 6.0 * g * form(a, smoothed) + (1.0 - 6.0 * g) * form(smoothed, smoothed);
    (sum / (12.0 * slow)).clamp(0.0, bound)
}

/// (z/2) coth(z/2): mean square of a velocity that decays by e^(−z) over a step, over the square of its mean.
fn relaxation_factor(z: f64) -> f64 {
    if z < 1e-3 {
        1.0 + z * z / 12.0
    } else {
        0.5 * z / (0.5 * z).tanh()
    }
}
