//! The window W that leaves neighbours along the rod out of contact and friction.

use serde::{Deserialize, Serialize};

/// Smooth step in arclength s, in h, from 0 below s_0 to 1 above s_1 = (π/2) s_0.
///
/// ```math
/// W(s) = u^2 (3 - 2 u), \qquad u = \frac{s - s_0}{s_1 - s_0} \text{ clamped to } [0, 1]
/// ```
///
/// Two points of a tube bent as tightly as it can be (a half circle of radius d/2) are π d/2 apart along the rod when they
/// are d apart in space: inside that arc they are close because the rod is bent, not because strands touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Window {
    inner: f64,
    outer: f64,
}

impl Window {
    /// The window for strands that act on each other up to the distance `reach`.
    pub fn new(reach: f64) -> Self {
        Self {
            inner: reach,
            outer: std::f64::consts::FRAC_PI_2 * reach,
        }
    }

    /// Separation s_0 up to which W = 0, in h.
    pub fn inner(&self) -> f64 {
        self.inner
    }

    /// Separation s_1 from which W = 1, in h.
    pub fn outer(&self) -> f64 {
        self.outer
    }

    /// W at a `separation` along the rod, in h.
    #[inline]
    pub fn weight(&self, separation: f64) -> f64 {
        let u = ((separation - self.inner) / (self.outer - self.inner)).clamp(0.0, 1.0);
        u * u * (3.0 - 2.0 * u)
    }
}

/// Natural arclength between vertices i and j of a rod of natural length `length`: the shorter way round if `cyclic`.
#[inline]
pub fn arc_separation(i: usize, j: usize, rest_length: f64, length: f64, cyclic: bool) -> f64 {
    let s = rest_length * i.abs_diff(j) as f64;
    if cyclic { s.min(length - s) } else { s }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn window_rises_from_zero_to_one_between_d_and_half_pi_d() {
        let w = Window::new(2.0);
        assert_eq!(w.weight(2.0), 0.0);
        assert_eq!(w.weight(std::f64::consts::PI), 1.0);
        assert!((w.weight(1.0 + std::f64::consts::FRAC_PI_2) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn separation_wraps_at_the_seam_of_a_closed_rod() {
        assert_eq!(arc_separation(1, 99, 0.5, 50.0, true), 1.0);
        assert_eq!(arc_separation(1, 99, 0.5, 50.0, false), 49.0);
    }
}
