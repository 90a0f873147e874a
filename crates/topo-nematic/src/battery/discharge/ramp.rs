//! An anchoring that is switched gradually.

use crate::NematicState;
use crate::anchoring::Anchoring;
use crate::battery::switch::{SwitchTarget, SwitchedNematic, blend, extend_into_cut_cells};
use crate::domain::SpecialCell;
use crate::kernel::run::{Kernel, Threads};
use crate::real::Real;

/// Steps of a ramp, at least.
const RAMP_STEPS: f64 = 64.0;

/// The anchoring while it is ramped: the links at both ends, and the kernel that waits until the ramp is over.
pub(super) struct Ramp<T> {
    pub duration: f64,
    waiting: Kernel<T>,
    ends: [Vec<SpecialCell>; 2],
}

impl<T: Real> Ramp<T> {
    /// A ramp over `duration`; `kernel`, that after it, is exchanged for the one whose links are ramped.
    pub fn begin(
        switched: &SwitchedNematic,
        duration: f64,
        gapless: bool,
        kernel: &mut Kernel<T>,
    ) -> Self {
        let battery = &switched.charged.battery;
        let threads = battery.accuracy().threads;
        let mut ramped = battery.kernel::<T>(&battery.charged_surface(), threads);
        if gapless {
            ramped = ramped.without_gaps();
        }
        let last = switched.charged.surface_at_end_of_ramp(&switched.settings);
        let last = battery.kernel::<T>(&last, threads);
        Self {
            duration,
            ends: [ramped.domain.special.clone(), last.domain.special],
            waiting: std::mem::replace(kernel, ramped),
        }
    }

    /// Length of a step from `time` on, at most `dt`: a ramp takes at least a fixed number of steps, and a step ends at its
    /// end.
    pub fn step(&self, dt: f64, time: f64) -> f64 {
        let left = self.duration - time;
        let dt = dt.min(self.duration / RAMP_STEPS);
        if dt > 0.99 * left { left } else { dt }
    }

    /// Whether the ramp is over at `time`.
    pub fn is_over(&self, time: f64) -> bool {
        time >= self.duration * (1.0 - 1e-12)
    }

    /// Sets the links of `kernel` as at `share` of the ramp.
    pub fn set(&self, kernel: &mut Kernel<T>, share: f64) {
        blend(kernel, &self.ends[0], &self.ends[1], share);
    }

    /// Puts the kernel after the ramp in place, `state` having the energy `energy` with the one so far.
    pub fn end(
        self,
        switched: &SwitchedNematic,
        energy: f64,
        kernel: &mut Kernel<T>,
        state: &mut NematicState,
    ) {
        let battery = &switched.charged.battery;
        if matches!(switched.settings.to, SwitchTarget::Free(_)) {
            let surface = switched.charged.surface_after(&switched.settings);
            let double = battery.kernel::<f64>(&surface, Threads::One);
            extend_into_cut_cells(battery, Anchoring::Free, &double, energy, state);
        }
        *kernel = self.waiting;
    }
}
