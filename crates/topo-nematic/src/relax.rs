//! FIRE, fused with the kernel: a field relaxes to a minimum of its energy.

use topo_core::{Fire, FireSums};

use crate::kernel::run::{Combination, Kernel};
use crate::real::Real;

/// Positions and velocities of a relaxation in progress, in the kernel's layout.
///
/// The method is [`Fire`], in two passes over memory: the molecular field with the sums that decide on the next step, and the step.
pub(crate) struct Relaxation<'a, T> {
    kernel: &'a Kernel<T>,
    pub q: Vec<T>,
    pub velocity: Vec<T>,
    force: Vec<T>,
    pub fire: Fire,
    longest: f64,
}

impl<'a, T: Real> Relaxation<'a, T> {
    /// A relaxation at rest, from nothing.
    pub(crate) fn new(kernel: &'a Kernel<T>) -> Self {
        let n = kernel.array_length();
        // The semi-implicit scheme is stable below twice the inverse of the highest frequency; near that limit the shortest waves
        // ring for thousands of steps.
        let longest = 0.7 * 2.0 / kernel.stiffest_relaxation().sqrt();
        Self {
            kernel,
            q: vec![T::of(0.0); n],
            velocity: vec![T::of(0.0); n],
            force: vec![T::of(0.0); n],
            fire: Fire::at_rest(longest),
            longest,
        }
    }

    /// Starts from a field in the layout of states.
    pub(crate) fn set(&mut self, flat: &[f64]) {
        self.kernel.spread(flat, &mut self.q);
    }

    /// Continues from what an earlier one had reached.
    pub(crate) fn restore(&mut self, q: Vec<T>, velocity: Vec<T>, fire: Fire) {
        if q.len() == self.q.len() && velocity.len() == self.q.len() {
            self.q = q;
            self.velocity = velocity;
            self.fire = fire;
        }
    }

    /// Takes one step and gives the root mean square of the molecular field before it; NaN when the field is not finite.
    pub(crate) fn step(&mut self) -> f64 {
        let what = Combination {
            on_q: 0.0,
            on_old: 0.0,
            on_field: 1.0,
            inputs: [(0.0, &self.velocity[..])],
            relaxing: true,
        };
        let mut sums = self
            .kernel
            .combine::<false, 1, true>(&self.q, &what, &mut self.force);
        if self.kernel.second.is_some() {
            self.kernel.add_second(&self.q, 1.0, &mut self.force);
            sums = self.kernel.sums_of(&self.force, &self.velocity);
        }
        let [ff, fv, vv, residual] = sums;
        let rms = (residual / self.kernel.domain.total_mass.max(1.0)).sqrt();
        if !rms.is_finite() || ff == 0.0 {
            return rms;
        }
        let sums = FireSums {
            force_squared: ff,
            power: fv,
            speed_squared: vv,
        };
        let step = self.fire.step(self.longest, sums);
        let (on_velocity, on_force) = (T::of(step.on_velocity), T::of(step.on_force));
        let (forth, back) = (T::of(step.forth), T::of(step.back));
        self.kernel
            .for_each3(&mut self.q, &mut self.velocity, &self.force, |x, v, f| {
                let next = on_velocity * *v + on_force * f;
                *x += back * *v + forth * next;
                *v = next;
            });
        rms
    }

    /// Molecular field at the present positions is not kept: gives the field away.
    pub(crate) fn into_q(self) -> Vec<T> {
        self.q
    }

    /// Bytes of the arrays.
    pub(crate) fn n_bytes(&self) -> u64 {
        (3 * self.q.len() * size_of::<T>()) as u64
    }
}

impl<T: Real> Kernel<T> {
    /// Upper bound of the largest eigenvalue of the second derivative of the energy, per volume, for scaled special cells.
    pub(crate) fn stiffest_relaxation(&self) -> f64 {
        self.stiffest_with(12.0 + self.domain.stiffest_wall())
    }

    /// Upper bound of the largest eigenvalue of the second derivative of the energy, per volume.
    pub(crate) fn stiffest(&self) -> f64 {
        self.stiffest_with(self.domain.stiffest())
    }

    fn stiffest_with(&self, laplacian: f64) -> f64 {
        let h = self.domain.grid.spacing();
        let m = self.material();
        let order = m.order().max(m.equilibrium_order().unwrap_or(0.0));
        // Each component of the divergence has three terms of at most 1/h.
        let second = self.second.as_ref().map_or(0.0, |s| 3.0 * s.constant.abs());
        (m.elastic_constant * laplacian + second) / (h * h) + m.largest_bulk_stiffness(order)
    }
}
