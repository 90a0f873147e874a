//! RKC2: a Runge-Kutta-Chebyshev method of order 2, explicit and stable far along the negative real axis.

use super::{Counters, SpectralBound, Stepper, StepperMemory, Trial};
use crate::check::{InvalidValue, in_range};
use crate::control::Rejection;

/// Damping of the stability polynomial, as a fraction of its argument's range.
const DAMPING: f64 = 2.0 / 13.0;

/// Stabilised explicit method of order 2 with as many stages as the stiffness needs.
///
/// ```math
/// D_j = \mu_j D_{j-1} + \nu_j D_{j-2} + \Delta t\,(\tilde\mu_j F_{j-1} + \tilde\gamma_j F_0), \quad
/// F_j = F(u_0 \oplus D_j), \quad \Delta t\,\rho \le \tfrac23 (s^2 - 1)(1 - \tfrac{2}{15}\varepsilon)
/// ```
///
/// ε is the damping and ρ the spectral radius. The number s of stages grows as the square root of Δt ρ, where a plain explicit
/// method needs steps in proportion to Δt ρ itself; no linear algebra is needed. The stages are displacements D_j from the old
/// state, so a model can apply them as retractions. The local error is estimated to third order, and F_1 is reused by the next
/// step:
///
/// ```math
/// \mathrm{err} = \tfrac45 (u_0 - u_1) + \tfrac25\, \Delta t\, (F_0 + F_1)
/// ```
///
/// # Validation
/// `order_two`, `stable_up_to_its_bound_and_not_beyond`, `error_estimate_follows_the_local_error`
///
/// # References
/// [sommeijer1998]
///
/// [sommeijer1998]: https://doi.org/10.1016/S0377-0427(97)00219-7
#[derive(Clone, Debug)]
pub struct Rkc2 {
    max_stages: usize,
    /// Spectral radius and rate at the old state, once known.
    radius: Option<f64>,
    rate_known: bool,
    end_rate_known: bool,
    rate: Vec<f64>,
    stage_rate: Vec<f64>,
    before: Vec<f64>,
    last: Vec<f64>,
    counters: Counters,
}

impl Default for Rkc2 {
    fn default() -> Self {
        Self {
            max_stages: 200,
            radius: None,
            rate_known: false,
            end_rate_known: false,
            rate: Vec::new(),
            stage_rate: Vec::new(),
            before: Vec::new(),
            last: Vec::new(),
            counters: Counters::default(),
        }
    }
}

impl Rkc2 {
    /// The method with at most `max_stages` stages per step (2 to 10 000; 200 by default).
    ///
    /// # Errors
    /// [`InvalidValue`] outside that range.
    pub fn new(max_stages: usize) -> Result<Self, InvalidValue> {
        in_range("max_stages", max_stages as f64, 2.0, 1e4)?;
        Ok(Self {
            max_stages,
            ..Self::default()
        })
    }

    /// Limit of stages per step.
    pub fn max_stages(&self) -> usize {
        self.max_stages
    }

    fn allocate(&mut self, n: usize) {
        for buffer in [
            &mut self.rate,
            &mut self.stage_rate,
            &mut self.before,
            &mut self.last,
        ] {
            *buffer = vec![0.0; n];
        }
    }

    fn radius<M: SpectralBound>(
        &mut self,
        model: &mut M,
        state: &M::State,
    ) -> Result<f64, Rejection> {
        if let Some(radius) = self.radius {
            return Ok(radius);
        }
        let radius = model.spectral_radius(state)?;
        if !(radius.is_finite() && radius >= 0.0) {
            return Err(Rejection::NotFinite {
                what: "spectral radius",
            });
        }
        self.radius = Some(radius);
        Ok(radius)
    }
}

/// Stages that keep a step of `dt` times spectral radius stable.
fn stages_for(dt_radius: f64) -> f64 {
    (1.0 + (1.54 * dt_radius + 1.0).sqrt().floor()).max(2.0)
}

/// Value, first and second derivative of a Chebyshev polynomial at w0.
#[derive(Clone, Copy, Debug)]
struct Chebyshev {
    t: f64,
    dt: f64,
    ddt: f64,
}

impl Chebyshev {
    const ZERO: Self = Self {
        t: 1.0,
        dt: 0.0,
        ddt: 0.0,
    };

    fn one(w: f64) -> Self {
        Self {
            t: w,
            dt: 1.0,
            ddt: 0.0,
        }
    }

    /// T_{j+1} from this T_j and `before` = T_{j-1}.
    fn next(self, before: Self, w: f64) -> Self {
        Self {
            t: 2.0 * w * self.t - before.t,
            dt: 2.0 * w * self.dt - before.dt + 2.0 * self.t,
            ddt: 2.0 * w * self.ddt - before.ddt + 4.0 * self.dt,
        }
    }

    fn b(self) -> f64 {
        self.ddt / (self.dt * self.dt)
    }
}

/// Factors of one stage: displacements and rates (times the step) that make up the next displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rkc2Stage {
    /// Factor μ of the last displacement.
    pub on_last: f64,
    /// Factor ν of the displacement before that.
    pub on_before: f64,
    /// Factor of the step times the rate at the last displacement.
    pub on_rate: f64,
    /// Factor of the step times the rate at its start.
    pub on_start_rate: f64,
}

/// The coefficients of [`Rkc2`], stage by stage, for a model that computes its rate and applies them in one pass.
///
/// The displacement after the first stage is [`first`](Self::first) times the step times the rate; each further stage follows from
/// [`next_stage`](Self::next_stage), n - 1 times. The error estimate is 0.4 dt (F_0 + F_1) - 0.8 (u_1 - u_0).
#[derive(Clone, Copy, Debug)]
pub struct Rkc2Stages {
    w0: f64,
    w1: f64,
    b2: f64,
    before: Chebyshev,
    here: Chebyshev,
    b_before: f64,
    b_here: f64,
}

impl Rkc2Stages {
    /// Coefficients of a step of `n_stages` (2 at least) stages.
    pub fn new(n_stages: usize) -> Self {
        let n_stages = n_stages.max(2);
        let s = n_stages as f64;
        let w0 = 1.0 + DAMPING / (s * s);
        let (mut before, mut here) = (Chebyshev::ZERO, Chebyshev::one(w0));
        for _ in 1..n_stages {
            (before, here) = (here, here.next(before, w0));
        }
        let w1 = here.dt / here.ddt;
        // b_0 = b_1 = b_2.
        let (before, here) = (Chebyshev::ZERO, Chebyshev::one(w0));
        let b2 = here.next(before, w0).b();
        Self {
            w0,
            w1,
            b2,
            before,
            here,
            b_before: b2,
            b_here: b2,
        }
    }

    /// Stages that keep a step stable when its length times the spectral radius is `dt_radius`.
    pub fn needed(dt_radius: f64) -> usize {
        // The cast saturates, so that no radius overflows it.
        stages_for(dt_radius) as usize
    }

    /// Largest product of step and spectral radius that `n_stages` keep stable.
    pub fn reach(n_stages: usize) -> f64 {
        let most = n_stages.saturating_sub(1) as f64;
        ((most * most - 1.0) / 1.54).max(0.0) + 0.5
    }

    /// Factor of the rate in the first stage.
    pub fn first(&self) -> f64 {
        self.b2 * self.w1
    }

    /// Factors of the next stage.
    pub fn next_stage(&mut self) -> Rkc2Stage {
        let next = self.here.next(self.before, self.w0);
        let b = next.b();
        let on_rate = 2.0 * b * self.w1 / self.b_here;
        let stage = Rkc2Stage {
            on_last: 2.0 * b * self.w0 / self.b_here,
            on_before: -b / self.b_before,
            on_rate,
            on_start_rate: -(1.0 - self.b_here * self.here.t) * on_rate,
        };
        (self.before, self.here) = (self.here, next);
        (self.b_before, self.b_here) = (self.b_here, b);
        stage
    }
}

impl<M: SpectralBound> Stepper<M> for Rkc2 {
    fn step(
        &mut self,
        model: &mut M,
        state: &M::State,
        dt: f64,
        to: &mut M::State,
    ) -> Result<Trial, Rejection> {
        let n = model.n_dof();
        if self.rate.len() != n {
            self.allocate(n);
            Stepper::<M>::reset(self);
        }
        self.counters.n_trials += 1;
        self.end_rate_known = false;
        let n_stages = Rkc2Stages::needed(dt * self.radius(model, state)?);
        if n_stages > self.max_stages {
            return Err(Rejection::TooManyStages {
                needed: n_stages,
                limit: self.max_stages,
            });
        }
        if !self.rate_known {
            self.counters.n_rate_evaluations += 1;
            model.rate(state, &mut self.rate)?;
            self.rate_known = true;
        }

        let mut stages = Rkc2Stages::new(n_stages);
        let first = stages.first() * dt;
        self.before.fill(0.0);
        for (d, f) in self.last.iter_mut().zip(&self.rate) {
            *d = first * f;
        }
        for _ in 2..=n_stages {
            model.advance(state, &self.last, to)?;
            self.counters.n_rate_evaluations += 1;
            model.rate(to, &mut self.stage_rate)?;
            let stage = stages.next_stage();
            let (mu, nu) = (stage.on_last, stage.on_before);
            let (mu_rate, start_rate) = (stage.on_rate * dt, stage.on_start_rate * dt);
            for i in 0..n {
                let next = mu * self.last[i]
                    + nu * self.before[i]
                    + mu_rate * self.stage_rate[i]
                    + start_rate * self.rate[i];
                self.before[i] = self.last[i];
                self.last[i] = next;
            }
        }
        model.advance(state, &self.last, to)?;
        self.counters.n_rate_evaluations += 1;
        model.rate(to, &mut self.stage_rate)?;
        for i in 0..n {
            self.before[i] = 0.4 * dt * (self.rate[i] + self.stage_rate[i]) - 0.8 * self.last[i];
        }
        let error = model.error_norm(&self.before);
        if !error.is_finite() {
            return Err(Rejection::NotFinite {
                what: "error estimate",
            });
        }
        self.end_rate_known = true;
        Ok(Trial { error })
    }

    fn displacement(&self) -> &[f64] {
        &self.last
    }

    fn accepted(&mut self) {
        std::mem::swap(&mut self.rate, &mut self.stage_rate);
        self.rate_known = self.end_rate_known;
        self.end_rate_known = false;
        self.radius = None;
    }

    fn reset(&mut self) {
        self.rate_known = false;
        self.end_rate_known = false;
        self.radius = None;
    }

    fn longest_step(&mut self, model: &mut M, state: &M::State) -> Result<f64, Rejection> {
        let reach = Rkc2Stages::reach(self.max_stages);
        Ok(reach * (1.0 - 1e-12) / self.radius(model, state)?)
    }

    fn order(&self) -> u32 {
        2
    }

    fn error_order(&self) -> u32 {
        3
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn memory(&self) -> StepperMemory {
        StepperMemory {
            counters: self.counters,
            has_begun: !self.rate.is_empty(),
            rate: self.rate_known.then(|| self.rate.clone()),
            radius: self.radius,
        }
    }

    fn recall(&mut self, memory: StepperMemory, n_dof: usize) {
        if memory.has_begun {
            self.allocate(n_dof);
        }
        self.counters = memory.counters;
        self.radius = memory.radius;
        self.end_rate_known = false;
        self.rate_known = memory.rate.is_some();
        if let Some(rate) = memory.rate {
            self.rate = rate;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Oscillator, Relaxation, convergence_order, integrate};
    use super::*;

    #[test]
    fn order_two() {
        let error = |n_steps: u32| {
            let mut model = Oscillator::default();
            let end = integrate(&mut Rkc2::default(), &mut model, n_steps);
            model.distance_from_exact(&end)
        };
        let order = convergence_order(error, 50);
        assert!((1.9..2.2).contains(&order), "{order}");
    }

    #[test]
    fn stable_up_to_its_bound_and_not_beyond() {
        // At stiffness 1e4 and dt = 0.05, forward Euler multiplies errors by 499 each step.
        let mut model = Relaxation::new(1e4);
        let end = integrate(&mut Rkc2::default(), &mut model, 20);
        assert!(
            model.distance_from_exact(&end) < 1e-2,
            "{}",
            model.distance_from_exact(&end)
        );
        // A model that understates its stiffness by a factor of four is lost.
        struct Understated(Relaxation);
        impl crate::integrate::Model for Understated {
            type State = Vec<f64>;
            fn n_dof(&self) -> usize {
                2
            }
            fn rate(&mut self, u: &Vec<f64>, rate: &mut [f64]) -> Result<(), Rejection> {
                self.0.rate(u, rate)
            }
            fn advance(
                &self,
                from: &Vec<f64>,
                step: &[f64],
                to: &mut Vec<f64>,
            ) -> Result<(), Rejection> {
                self.0.advance(from, step, to)
            }
        }
        impl SpectralBound for Understated {
            fn spectral_radius(&mut self, _: &Vec<f64>) -> Result<f64, Rejection> {
                Ok(0.25 * self.0.stiffness)
            }
        }
        let mut lost = Understated(Relaxation::new(1e4));
        let (mut state, mut next) = (vec![1.0 + 1e-9, 0.0], vec![0.0, 0.0]);
        let mut rkc = Rkc2::default();
        for _ in 0..20 {
            rkc.step(&mut lost, &state, 0.05, &mut next).unwrap();
            Stepper::<Understated>::accepted(&mut rkc);
            std::mem::swap(&mut state, &mut next);
        }
        assert!((state[0] - 1.0_f64.cos()).abs() > 1.0);
    }

    #[test]
    fn error_estimate_follows_the_local_error() {
        let mut last = f64::NAN;
        for dt in [0.2, 0.1, 0.05] {
            let mut model = Oscillator::default();
            let from = model.start();
            let mut to = from.clone();
            let estimate = Rkc2::default()
                .step(&mut model, &from, dt, &mut to)
                .unwrap()
                .error;
            let local = model.local_error(dt, &to);
            assert!(
                estimate > 0.3 * local && estimate < 10.0 * local,
                "dt {dt}: {estimate:e} for {local:e}"
            );
            if last.is_finite() {
                assert!(
                    (2.7..3.3).contains(&(last / estimate).log2()),
                    "{}",
                    (last / estimate).log2()
                );
            }
            last = estimate;
        }
    }

    #[test]
    fn the_rate_at_the_end_serves_the_next_step() {
        let mut model = Oscillator::default();
        let mut rkc = Rkc2::default();
        let mut state = model.start();
        let mut next = state.clone();
        for _ in 0..2 {
            rkc.step(&mut model, &state, 0.01, &mut next).unwrap();
            Stepper::<Oscillator>::accepted(&mut rkc);
            std::mem::swap(&mut state, &mut next);
        }
        // Two stages: one rate at the start of all, one inside each step, one at each end.
        assert_eq!(Stepper::<Oscillator>::counters(&rkc).n_rate_evaluations, 5);
    }

    #[test]
    fn the_limit_of_stages_limits_the_step() {
        let mut model = Relaxation::new(1e6);
        let state = vec![1.0, 0.0];
        let mut to = state.clone();
        for max_stages in [2, 3, 10, 200] {
            let mut rkc = Rkc2::new(max_stages).unwrap();
            let longest = rkc.longest_step(&mut model, &state).unwrap();
            assert!(
                rkc.step(&mut model, &state, longest, &mut to).is_ok(),
                "{max_stages}"
            );
            let refused = rkc.step(&mut model, &state, 4.0 * longest + 1e-5, &mut to);
            assert!(
                matches!(refused, Err(Rejection::TooManyStages { .. })),
                "{max_stages}: {refused:?}"
            );
        }
        let absurd = Rkc2::default().step(&mut model, &state, 1e300, &mut to);
        assert!(matches!(absurd, Err(Rejection::TooManyStages { .. })));
        assert!(Rkc2::new(1).is_err());
    }

    /// Stability reaches to 2/3 (s² − 1)(1 − 2/15 · 2/13) with s stages (`sommeijer1998`).
    #[test]
    fn the_reach_of_stages_needs_them_all_and_is_stable() {
        for s in 2..300 {
            let reach = Rkc2Stages::reach(s);
            let bound = 2.0 / 3.0 * (s * s - 1) as f64 * (1.0 - 2.0 / 15.0 * DAMPING);
            assert!(
                Rkc2Stages::needed(reach) == s && reach < bound,
                "{s}: {reach} of {bound}"
            );
        }
        assert_eq!(Rkc2::new(17).unwrap().max_stages(), 17);
    }

    #[test]
    fn the_displacement_is_what_a_step_moved() {
        let mut model = Oscillator::default();
        let (mut rkc, from) = (Rkc2::default(), model.start());
        let mut to = from.clone();
        rkc.step(&mut model, &from, 0.01, &mut to).unwrap();
        let moved = Stepper::<Oscillator>::displacement(&rkc);
        assert_eq!(moved.len(), from.len());
        for (k, m) in moved.iter().enumerate() {
            assert!((from[k] + m - to[k]).abs() < 1e-15);
        }
    }
}
