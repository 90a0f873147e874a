//! An anchoring that is switched little by little.

use super::switch::SwitchedNematic;
use crate::domain::SpecialCell;
use crate::kernel::run::{Kernel, Threads};
use crate::real::Real;

/// Steps of a ramp, at least.
pub(super) const RAMP_STEPS: f64 = 64.0;

/// The anchoring while it is ramped: a kernel whose links are set for each step, and the links at both ends.
pub(super) struct Ramp<T> {
    pub duration: f64,
    pub kernel: Kernel<T>,
    pub ends: [Vec<SpecialCell>; 2],
}

impl<T: Real> Ramp<T> {
    pub fn new(switched: &SwitchedNematic, duration: f64, threads: Threads, gapless: bool) -> Self {
        let battery = &switched.charged.battery;
        let mut kernel = battery.kernel::<T>(&battery.charged_surface(), threads);
        if gapless {
            kernel = kernel.without_gaps();
        }
        let last = switched.charged.surface_at_end_of_ramp(&switched.settings);
        let last = battery.kernel::<T>(&last, threads);
        Self {
            duration,
            ends: [kernel.domain.special.clone(), last.domain.special],
            kernel,
        }
    }
}
