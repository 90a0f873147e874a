//! RKC2, fused with the kernel: a field follows its dynamics with long stable steps.

use topo_core::{Counters, Rejection, Rkc2Stages};

use crate::kernel::run::{Combination, Kernel};
use crate::real::Real;

/// Limit of stages a step.
const MAX_STAGES: usize = 250;

/// What else moves the field, besides its molecular field.
pub(crate) trait ExtraRate<T> {
    /// Adds to `rate` what it adds at `q`.
    fn add_rate(&self, q: &[T], rate: &mut [T]);
}

/// A field on its way, with all that a step needs; arrays are in the kernel's layout.
///
/// The method is `topo_core::Rkc2`. A stage is one pass: the molecular field of the last one, and the combination of the last, the one before,
/// the start and its rate.
pub(crate) struct Stabilised<T> {
    pub q: Vec<T>,
    /// Rate at `q`, if known.
    rate: Vec<T>,
    rate_known: bool,
    /// Sum over the fluid of mass times H:H at `q`, in cells.
    pub square_of_field: f64,
    last: Vec<T>,
    before: Vec<T>,
    end_rate: Vec<T>,
    end_square: f64,
    mobility: f64,
    pub counters: Counters,
}

impl<T: Real> Stabilised<T> {
    pub(crate) fn new(kernel: &Kernel<T>, q: Vec<T>) -> Self {
        let zeros = || vec![T::of(0.0); kernel.array_length()];
        Self {
            last: q.clone(),
            before: q.clone(),
            q,
            rate: zeros(),
            rate_known: false,
            square_of_field: 0.0,
            end_rate: zeros(),
            end_square: 0.0,
            mobility: kernel.material().rotational_mobility,
            counters: Counters::default(),
        }
    }

    /// Longest stable step.
    pub(crate) fn longest_step(&self, kernel: &Kernel<T>) -> f64 {
        Rkc2Stages::reach(MAX_STAGES) * (1.0 - 1e-12) / (self.mobility * kernel.stiffest())
    }

    /// Makes the rate at the present field known.
    pub(crate) fn update_rate(&mut self, kernel: &Kernel<T>, extra: Option<&dyn ExtraRate<T>>) {
        if !self.rate_known {
            self.square_of_field = rate(kernel, self.mobility, &self.q, &mut self.rate, extra);
            self.counters.n_rate_evaluations += 1;
            self.rate_known = true;
        }
    }

    /// Tries a step of length `dt`; gives the local error, the root mean square of |dQ| over the fluid.
    ///
    /// # Errors
    /// When the step needs too many stages or its result is not finite.
    pub(crate) fn try_step(
        &mut self,
        kernel: &Kernel<T>,
        dt: f64,
        extra: Option<&dyn ExtraRate<T>>,
    ) -> Result<f64, Rejection> {
        self.counters.n_trials += 1;
        let needed = Rkc2Stages::needed(dt * self.mobility * kernel.stiffest());
        if needed > MAX_STAGES {
            return Err(Rejection::TooManyStages {
                needed,
                limit: MAX_STAGES,
            });
        }
        self.update_rate(kernel, extra);
        let mut stages = Rkc2Stages::new(needed);
        kernel.linear(
            &mut self.last,
            0.0,
            [(1.0, &self.q), (stages.first() * dt, &self.rate)],
        );
        for stage in 2..=needed {
            let s = stages.next_stage();
            // Displacements from the start turned into fields: their factors sum to one.
            let on_start = 1.0 - s.on_last - s.on_before;
            let (on_rate, on_start_rate) = (s.on_rate * dt, s.on_start_rate * dt);
            self.counters.n_rate_evaluations += 1;
            if extra.is_some() || kernel.second.is_some() {
                rate(kernel, self.mobility, &self.last, &mut self.end_rate, extra);
                if stage == 2 {
                    self.before.copy_from_slice(&self.q);
                }
                let others = [
                    (s.on_last, &self.last[..]),
                    (on_start, &self.q),
                    (on_rate, &self.end_rate),
                    (on_start_rate, &self.rate),
                ];
                kernel.linear(&mut self.before, s.on_before, others);
            } else if stage == 2 {
                // The one before is the start itself.
                let what = Combination {
                    on_q: s.on_last,
                    on_old: 0.0,
                    on_field: on_rate * self.mobility,
                    inputs: [
                        (on_start + s.on_before, &self.q[..]),
                        (on_start_rate, &self.rate[..]),
                    ],
                    relaxing: false,
                };
                kernel.combine::<false, 2, false>(&self.last, &what, &mut self.before);
            } else {
                let what = Combination {
                    on_q: s.on_last,
                    on_old: s.on_before,
                    on_field: on_rate * self.mobility,
                    inputs: [(on_start, &self.q[..]), (on_start_rate, &self.rate[..])],
                    relaxing: false,
                };
                kernel.combine::<true, 2, false>(&self.last, &what, &mut self.before);
            }
            std::mem::swap(&mut self.last, &mut self.before);
        }
        self.end_square = rate(kernel, self.mobility, &self.last, &mut self.end_rate, extra);
        self.counters.n_rate_evaluations += 1;
        let error = kernel.rms([
            (0.8, &self.q),
            (-0.8, &self.last),
            (0.4 * dt, &self.rate),
            (0.4 * dt, &self.end_rate),
        ]);
        if error.is_finite() {
            Ok(error)
        } else {
            Err(Rejection::NotFinite {
                what: "error estimate",
            })
        }
    }

    /// The last trial becomes the field.
    pub(crate) fn accept(&mut self) {
        std::mem::swap(&mut self.q, &mut self.last);
        std::mem::swap(&mut self.rate, &mut self.end_rate);
        self.square_of_field = self.end_square;
        self.rate_known = true;
    }

    /// Writes the molecular field at the present field to memory that is not in use between steps; gives both.
    pub(crate) fn with_molecular_field(&mut self, kernel: &Kernel<T>) -> (&[T], &[T]) {
        kernel.molecular_field(&self.q, &mut self.before);
        (&self.q, &self.before)
    }

    /// Forgets the rate: what else moves the field has changed.
    pub(crate) fn forget_rate(&mut self) {
        self.rate_known = false;
    }

    /// The field at the last trial.
    pub(crate) fn candidate(&self) -> &[T] {
        &self.last
    }

    /// Sum of squares of the molecular field at the last trial.
    pub(crate) fn candidate_square(&self) -> f64 {
        self.end_square
    }

    /// Bytes of the arrays.
    pub(crate) fn n_bytes(&self) -> u64 {
        (5 * self.q.len() * size_of::<T>()) as u64
    }
}

/// Writes the rate at `q`; gives the sum of mass times H:H.
fn rate<T: Real>(
    kernel: &Kernel<T>,
    mobility: f64,
    q: &[T],
    rate: &mut [T],
    extra: Option<&dyn ExtraRate<T>>,
) -> f64 {
    let what = Combination {
        on_q: 0.0,
        on_old: 0.0,
        on_field: mobility,
        // The sum with the field itself is not used.
        inputs: [(0.0, q)],
        relaxing: false,
    };
    let mut sums = kernel.combine::<false, 1, true>(q, &what, rate);
    if kernel.second.is_some() {
        kernel.add_second(q, mobility, rate);
        sums[3] = kernel.sums_of(rate, q)[3] / (mobility * mobility);
    }
    if let Some(extra) = extra {
        extra.add_rate(q, rate);
    }
    sums[3]
}
