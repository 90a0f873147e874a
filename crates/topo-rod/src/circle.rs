//! The discharge of a cut circle in closed form.

use std::f64::consts::PI;

use topo_core::{InvalidValue, in_range};

/// Share of its bending energy that a circle without link still holds at the time `t` after it was cut, in units of the slowest
/// bending time T_b = 2 L² η/(π² h² E_b).
///
/// The tangent angle of a planar rod without contact diffuses, however far it turns, and that of a circle starts as a straight
/// line between ends that are free of moment from then on:
///
/// ```math
/// \frac{E(t)}{E(0)} = \frac{8}{\pi^2} \sum_{n\ \mathrm{odd}} \frac{e^{-n^2 t/T_b}}{n^2}
/// ```
///
/// E(0) is the energy of the whole circle, before the cut.
///
/// # Validation
/// `shares_of_the_cut_circle`; `val_the_unknot_discharges_as_its_series` holds a battery against it.
pub fn cut_circle_energy(t: f64) -> f64 {
    if t <= 0.0 {
        return 1.0;
    }
    // the tail beyond n is below e^(-n² t)/n: small terms are summed first
    let last = (40.0 / t).sqrt().min(1e6) as usize;
    let odd = (0..=last / 2).rev().map(|k| (2 * k + 1) as f64);
    8.0 / (PI * PI) * odd.map(|n| (-n * n * t).exp() / (n * n)).sum::<f64>()
}

/// Time at which a cut circle has released the share `share` of its energy, in T_b: the inverse of [`cut_circle_energy`].
///
/// # Errors
/// A share that is not from 1e-4 to 1 − 1e-12.
pub fn cut_circle_time(share: f64) -> Result<f64, InvalidValue> {
    in_range("share", share, 1e-4, 1.0 - 1e-12)?;
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if cut_circle_energy(middle) > 1.0 - share {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_the_cut_circle() {
        for (share, time) in [
            (0.5, 0.485414),
            (0.9, 2.092567),
            (0.99, 4.395152),
            (0.999, 6.697737),
        ] {
            let found = cut_circle_time(share).unwrap();
            assert!((found - time).abs() < 1e-6, "{share}: {found}");
            assert!((cut_circle_energy(found) - (1.0 - share)).abs() < 1e-12);
        }
        // early, while the ends do not feel each other, the curvature near either is an error function
        for t in [1e-6, 1e-4, 1e-2] {
            let early = 1.0 - 4.0 * f64::sqrt(t / PI.powi(3));
            assert!((cut_circle_energy(t) - early).abs() < 1e-9, "{t}");
        }
        assert_eq!(cut_circle_energy(0.0), 1.0);
        assert!(cut_circle_time(1.0).is_err() && cut_circle_time(f64::NAN).is_err());
    }
}
