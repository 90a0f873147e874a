//! RKC2, fused with the kernel: a field follows its dynamics with long stable steps.

use serde::{Deserialize, Serialize};
use topo_core::{Counters, Rejection, Rkc2Stages};

use crate::kernel::run::{Combination, Kernel};
use crate::real::Real;

/// Limit of stages per step.
const MAX_STAGES: usize = 250;

/// Largest ratio of Λ to the rate by the molecular field: well below one, where predictor and corrector turn unstable.
const LEFT: f64 = 0.65;

/// What else moves the field, besides its molecular field.
pub(crate) trait Drift<T> {
    /// Writes to `drift` the rate that it adds at `q`, where the molecular field is `field`.
    ///
    /// # Errors
    /// Why a step that led to `q` is to be refused.
    fn at(&mut self, q: &[T], field: &[T], drift: &mut [T]) -> Result<(), Rejection>;
}

/// A field that advances in time, with all that a step needs; arrays are in the kernel's layout.
///
/// The method and its coefficients are those of [`topo_core::Rkc2`], applied here a second time: a stage is one pass over
/// memory, in single or double precision (the molecular field of the last one, and the combination of the last, the one before,
/// the start and its rate), whereas that one gets rates as vectors from a model and combines them in separate passes.
///
/// A drift G(Q), such as that of a flow, responds to the molecular field H and is as stiff; each of its values costs as much as
/// many stages. So a step takes it as linear in time, minus a share of H chosen for stability:
///
/// ```math
/// \dot Q = (1 + \omega)\,\Gamma H(Q) + \Lambda(t), \qquad \Lambda = G - \omega\,\Gamma H
/// ```
///
/// Λ runs from its value at the start to the one extrapolated from the step before (predictor), then to the one at the end so
/// found (corrector): order two (1.8 at a fixed step in layers next to walls, where G and Γ H cancel), and stable, as Λ is less
/// than (1 + ω) Γ H for the stiffest mode. The error estimate compares the step with the trapezoidal rule on the *whole* rate,
/// with the drift at each end.
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
    drift: Option<HeldDrift<T>>,
    /// Length of the last trial.
    last_step: f64,
    pub counters: Counters,
}

/// A drift along a step: Λ at its start, at its end, and at the start of the step before.
struct HeldDrift<T> {
    start: Vec<T>,
    end: Vec<T>,
    earlier: Vec<T>,
    /// Length of the step before, if there was one.
    earlier_step: Option<f64>,
    /// ω.
    share: f64,
}

/// What a checkpoint keeps of a drift.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct DriftMemory {
    earlier: Vec<f64>,
    earlier_step: f64,
}

impl DriftMemory {
    /// Whether it is one of a field of so many numbers.
    pub(crate) fn fits(&self, length: usize) -> bool {
        self.earlier.len() == length
            && self.earlier.iter().all(|x| x.is_finite())
            && self.earlier_step.is_finite()
            && self.earlier_step > 0.0
    }
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
            drift: None,
            last_step: 0.0,
            counters: Counters::default(),
        }
    }

    /// With a drift whose largest ratio to the rate by the molecular field is `ratio`; it is known once [`set_drift`](Self::set_drift) was called.
    pub(crate) fn with_drift(mut self, ratio: f64) -> Self {
        let zeros = || vec![T::of(0.0); self.q.len()];
        self.drift = Some(HeldDrift {
            start: zeros(),
            end: zeros(),
            earlier: zeros(),
            earlier_step: None,
            share: ((ratio - LEFT) / (1.0 + LEFT)).max(0.0),
        });
        self
    }

    /// Computes the drift at the present field.
    ///
    /// # Errors
    /// As [`Drift::at`].
    pub(crate) fn set_drift(
        &mut self,
        kernel: &Kernel<T>,
        drift: &mut dyn Drift<T>,
    ) -> Result<(), Rejection> {
        let Some(mut known) = self.drift.take() else {
            return Ok(());
        };
        let share = known.share * self.mobility;
        let found = lagging(
            kernel,
            drift,
            &self.q,
            &mut self.before,
            &mut known.start,
            share,
        );
        self.drift = Some(known);
        found
    }

    /// Forgets the step before: the drift has jumped.
    pub(crate) fn forget_earlier_drift(&mut self) {
        if let Some(drift) = &mut self.drift {
            drift.earlier_step = None;
        }
    }

    /// What a later run needs to continue to the same bits; none without a drift or before the second step.
    pub(crate) fn drift_memory(&self) -> Option<DriftMemory> {
        let drift = self.drift.as_ref()?;
        Some(DriftMemory {
            earlier: drift.earlier.iter().map(|x| (*x).into()).collect(),
            earlier_step: drift.earlier_step?,
        })
    }

    /// Continues from a memory that fits.
    pub(crate) fn restore_drift(&mut self, memory: &DriftMemory) {
        if let Some(drift) = &mut self.drift {
            for (x, y) in drift.earlier.iter_mut().zip(&memory.earlier) {
                *x = T::of(*y);
            }
            drift.earlier_step = Some(memory.earlier_step);
        }
    }

    /// Factor by which a drift raises what the stages take of the molecular field.
    fn stretch(&self) -> f64 {
        1.0 + self.drift.as_ref().map_or(0.0, |drift| drift.share)
    }

    /// Longest stable step.
    pub(crate) fn longest_step(&self, kernel: &Kernel<T>) -> f64 {
        Rkc2Stages::reach(MAX_STAGES) * (1.0 - 1e-12)
            / (self.stretch() * self.mobility * kernel.stiffest())
    }

    /// Computes the rate at the present field.
    pub(crate) fn update_rate(&mut self, kernel: &Kernel<T>) {
        if !self.rate_known {
            self.square_of_field = rate(kernel, self.mobility, &self.q, &mut self.rate);
            self.counters.n_rate_evaluations += 1;
            self.rate_known = true;
        }
    }

    /// Tries a step of length `dt`; gives the local error, the root mean square of |dQ| over the fluid.
    ///
    /// # Errors
    /// When the step needs too many stages, its result is not finite, or the drift refuses it.
    pub(crate) fn try_step(
        &mut self,
        kernel: &Kernel<T>,
        dt: f64,
        drift: Option<&mut dyn Drift<T>>,
    ) -> Result<f64, Rejection> {
        self.counters.n_trials += 1;
        let needed = Rkc2Stages::needed(dt * self.stretch() * self.mobility * kernel.stiffest());
        if needed > MAX_STAGES {
            return Err(Rejection::TooManyStages {
                needed,
                limit: MAX_STAGES,
            });
        }
        self.update_rate(kernel);
        let error = match (drift, self.drift.take()) {
            (Some(drift), Some(mut known)) => {
                let outcome = self.step_with(kernel, dt, needed, drift, &mut known);
                let error = outcome.map(|()| {
                    let [a, b, c, d] = self.against_trapezoid(dt, 1.0 + known.share);
                    let own = [(0.4 * dt, &known.start[..]), (0.4 * dt, &known.end)];
                    kernel.rms([a, b, c, d, own[0], own[1]])
                });
                self.drift = Some(known);
                error?
            }
            (_, known) => {
                self.drift = known;
                self.stages(kernel, dt, needed, None);
                self.evaluate_end(kernel);
                kernel.rms(self.against_trapezoid(dt, 1.0))
            }
        };
        self.last_step = dt;
        if error.is_finite() {
            Ok(error)
        } else {
            Err(Rejection::NotFinite {
                what: "error estimate",
            })
        }
    }

    /// Predicts and corrects a step; the drift at its end is left in `known.end`.
    fn step_with(
        &mut self,
        kernel: &Kernel<T>,
        dt: f64,
        needed: usize,
        drift: &mut dyn Drift<T>,
        known: &mut HeldDrift<T>,
    ) -> Result<(), Rejection> {
        let share = known.share * self.mobility;
        let HeldDrift {
            start,
            end,
            earlier,
            earlier_step,
            ..
        } = known;
        let on = earlier_step.map_or(0.0, |earlier_step| dt / earlier_step);
        kernel.linear(end, 0.0, [(1.0 + on, &start[..]), (-on, &earlier[..])]);
        self.stages(kernel, dt, needed, Some((known.share, start, end)));
        lagging(kernel, drift, &self.last, &mut self.before, end, share)?;
        self.stages(kernel, dt, needed, Some((known.share, start, end)));
        self.evaluate_end(kernel);
        lagging(kernel, drift, &self.last, &mut self.before, end, share)
    }

    /// Goes through the stages of a step, to `last`; with ω, and the ends of the line that Λ follows.
    fn stages(
        &mut self,
        kernel: &Kernel<T>,
        dt: f64,
        needed: usize,
        drift: Option<(f64, &[T], &[T])>,
    ) {
        let stretch = 1.0 + drift.map_or(0.0, |(share, ..)| share);
        let mobility = self.mobility;
        let mut stages = Rkc2Stages::new(needed);
        let first = stages.first();
        let inputs = [(1.0, &self.q[..]), (first * dt * stretch, &self.rate)];
        kernel.linear(&mut self.last, 0.0, inputs);
        if let Some((_, start, _)) = drift {
            kernel.linear(&mut self.last, 1.0, [(first * dt, start)]);
            // It may have served as memory; cells that take no part keep their values.
            self.before.copy_from_slice(&self.q);
        }
        // Where the last stage and the one before stand in the step, as a share of it.
        let (mut at, mut at_before) = (first, 0.0);
        for stage in 2..=needed {
            let s = stages.next_stage();
            // Displacements from the start turned into fields: their factors sum to one.
            let on_start = 1.0 - s.on_last - s.on_before;
            let (on_rate, on_start_rate) =
                (s.on_rate * dt * stretch, s.on_start_rate * dt * stretch);
            self.counters.n_rate_evaluations += 1;
            if kernel.second.is_some() {
                rate(kernel, mobility, &self.last, &mut self.end_rate);
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
            } else {
                // The one before the second stage is the start itself.
                let (on_old, on_start) = if stage == 2 {
                    (0.0, on_start + s.on_before)
                } else {
                    (s.on_before, on_start)
                };
                let what = Combination {
                    on_q: s.on_last,
                    on_old,
                    on_field: on_rate * mobility,
                    inputs: [(on_start, &self.q[..]), (on_start_rate, &self.rate[..])],
                    relaxing: false,
                };
                if stage == 2 {
                    kernel.combine::<false, 2, false>(&self.last, &what, &mut self.before);
                } else {
                    kernel.combine::<true, 2, false>(&self.last, &what, &mut self.before);
                }
            }
            if let Some((_, start, end)) = drift {
                let on_end = s.on_rate * dt * at;
                let on_start = (s.on_rate + s.on_start_rate) * dt - on_end;
                kernel.linear(&mut self.before, 1.0, [(on_start, start), (on_end, end)]);
            }
            let next = s.on_last * at + s.on_before * at_before + s.on_rate + s.on_start_rate;
            (at, at_before) = (next, at);
            std::mem::swap(&mut self.last, &mut self.before);
        }
    }

    /// Terms of the last trial less the trapezoidal rule, Λ left out.
    fn against_trapezoid(&self, dt: f64, stretch: f64) -> [(f64, &[T]); 4] {
        let half = 0.4 * dt * stretch;
        [
            (0.8, &self.q),
            (-0.8, &self.last),
            (half, &self.rate),
            (half, &self.end_rate),
        ]
    }

    /// The rate at the last trial.
    fn evaluate_end(&mut self, kernel: &Kernel<T>) {
        self.end_square = rate(kernel, self.mobility, &self.last, &mut self.end_rate);
        self.counters.n_rate_evaluations += 1;
    }

    /// The last trial becomes the field.
    pub(crate) fn accept(&mut self) {
        std::mem::swap(&mut self.q, &mut self.last);
        std::mem::swap(&mut self.rate, &mut self.end_rate);
        self.square_of_field = self.end_square;
        self.rate_known = true;
        if let Some(drift) = &mut self.drift {
            std::mem::swap(&mut drift.earlier, &mut drift.start);
            std::mem::swap(&mut drift.start, &mut drift.end);
            drift.earlier_step = Some(self.last_step);
        }
    }

    /// Forgets the rate: the surface has changed.
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
        let n_arrays = if self.drift.is_some() { 8 } else { 5 };
        (n_arrays * self.q.len() * size_of::<T>()) as u64
    }
}

/// Writes Λ at `q` to `drift`: what it adds there, less `share` times the molecular field, which is left in `field`.
fn lagging<T: Real>(
    kernel: &Kernel<T>,
    by: &mut dyn Drift<T>,
    q: &[T],
    field: &mut [T],
    drift: &mut [T],
    share: f64,
) -> Result<(), Rejection> {
    kernel.molecular_field(q, field);
    by.at(q, field, drift)?;
    kernel.linear(drift, 1.0, [(-share, &*field)]);
    Ok(())
}

/// Writes the rate at `q` by the molecular field; gives the sum of mass times H:H.
fn rate<T: Real>(kernel: &Kernel<T>, mobility: f64, q: &[T], rate: &mut [T]) -> f64 {
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
    sums[3]
}
