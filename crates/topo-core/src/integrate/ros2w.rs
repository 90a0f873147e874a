//! ROS2-W: a two-stage Rosenbrock method of order 2 that forgives any Jacobian.

use super::{Counters, LinearlyImplicit, Stepper, Trial};
use crate::check::{InvalidValue, in_range};
use crate::control::Rejection;

/// 1 + 1/sqrt 2: L-stable, the smoother and more robust choice at loose tolerances.
pub const GAMMA_L_STABLE_LARGE: f64 = 1.0 + std::f64::consts::FRAC_1_SQRT_2;
/// 1 - 1/sqrt 2: L-stable, with a much smaller error constant; pays at tight tolerances.
pub const GAMMA_L_STABLE_SMALL: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// Two-stage Rosenbrock-W method for stiff systems.
///
/// ```math
/// W k_1 = F(u_0), \quad W k_2 = F(u_0 \oplus \Delta t\, k_1) - 2 k_1, \quad
/// u_1 = u_0 \oplus \Delta t\,(\tfrac32 k_1 + \tfrac12 k_2), \quad W = 1 - \gamma\,\Delta t\, J
/// ```
///
/// Order 2 for every J, so that a Gauss-Newton matrix or a split one costs accuracy in the error constant only; L-stable with the
/// exact J at both values of gamma. The error is estimated by the distance dt (k1 + k2)/2 to the embedded first-order
/// solution. F(u0) is computed once a state: a repeated step costs one factorisation, one rate and two solves.
///
/// # Validation
/// `order_two_with_the_exact_and_with_a_wrong_jacobian`, `stiff_modes_die_in_one_step`, `error_estimate_bounds_the_local_error`
///
/// # References
/// `verwer1999`
#[derive(Clone, Debug)]
pub struct Ros2w {
    gamma: f64,
    rate: Vec<f64>,
    rate_known: bool,
    first: Vec<f64>,
    second: Vec<f64>,
    step: Vec<f64>,
    counters: Counters,
}

impl Default for Ros2w {
    fn default() -> Self {
        Self {
            gamma: GAMMA_L_STABLE_LARGE,
            rate: Vec::new(),
            rate_known: false,
            first: Vec::new(),
            second: Vec::new(),
            step: Vec::new(),
            counters: Counters::default(),
        }
    }
}

impl Ros2w {
    /// The method with `gamma`, best one of [`GAMMA_L_STABLE_LARGE`] (the default) and [`GAMMA_L_STABLE_SMALL`].
    ///
    /// # Errors
    /// [`InvalidValue`] when `gamma` is outside 1/4..=2: below 1/4 the method is not A-stable.
    pub fn new(gamma: f64) -> Result<Self, InvalidValue> {
        Ok(Self {
            gamma: in_range("gamma", gamma, 0.25, 2.0)?,
            ..Self::default()
        })
    }

    /// The parameter gamma.
    pub fn gamma(&self) -> f64 {
        self.gamma
    }
}

impl<M: LinearlyImplicit> Stepper<M> for Ros2w {
    fn step(
        &mut self,
        model: &mut M,
        state: &M::State,
        dt: f64,
        to: &mut M::State,
    ) -> Result<Trial, Rejection> {
        let n = model.n_dof();
        if self.rate.len() != n {
            for buffer in [
                &mut self.rate,
                &mut self.first,
                &mut self.second,
                &mut self.step,
            ] {
                *buffer = vec![0.0; n];
            }
            self.rate_known = false;
        }
        self.counters.n_trials += 1;
        if !self.rate_known {
            self.counters.n_rate_evaluations += 1;
            model.rate(state, &mut self.rate)?;
            self.rate_known = true;
        }
        self.counters.n_factorisations += 1;
        model.prepare(state, self.gamma * dt)?;

        self.first.copy_from_slice(&self.rate);
        self.counters.n_solves += 1;
        model.solve(&mut self.first)?;
        for (step, k1) in self.step.iter_mut().zip(&self.first) {
            *step = dt * k1;
        }
        model.advance(state, &self.step, to)?;
        self.counters.n_rate_evaluations += 1;
        model.rate(to, &mut self.second)?;
        for (k2, k1) in self.second.iter_mut().zip(&self.first) {
            *k2 -= 2.0 * k1;
        }
        self.counters.n_solves += 1;
        model.solve(&mut self.second)?;

        for i in 0..n {
            let (k1, k2) = (self.first[i], self.second[i]);
            self.step[i] = dt * (1.5 * k1 + 0.5 * k2);
            // The second stage is no longer needed, the estimate of the error is.
            self.second[i] = 0.5 * dt * (k1 + k2);
        }
        let error = model.error_norm(&self.second);
        if !error.is_finite() {
            return Err(Rejection::NotFinite {
                what: "error estimate",
            });
        }
        model.advance(state, &self.step, to)?;
        Ok(Trial { error })
    }

    fn displacement(&self) -> &[f64] {
        &self.step
    }

    fn accepted(&mut self) {
        self.rate_known = false;
    }

    fn reset(&mut self) {
        self.rate_known = false;
    }

    fn order(&self) -> u32 {
        2
    }

    fn error_order(&self) -> u32 {
        2
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Oscillator, Relaxation, convergence_order, integrate};
    use super::*;

    #[test]
    fn order_two_with_the_exact_and_with_a_wrong_jacobian() {
        for gamma in [GAMMA_L_STABLE_LARGE, GAMMA_L_STABLE_SMALL] {
            for jacobian_factor in [1.0, 0.6, 0.0] {
                let error = |n_steps: u32| {
                    let mut model = Oscillator::with_jacobian_factor(jacobian_factor);
                    let end = integrate(&mut Ros2w::new(gamma).unwrap(), &mut model, n_steps);
                    model.distance_from_exact(&end)
                };
                let order = convergence_order(error, 200);
                assert!(
                    (1.9..2.3).contains(&order),
                    "gamma {gamma}, J x {jacobian_factor}: {order}"
                );
            }
        }
    }

    #[test]
    fn order_two_of_a_stiff_problem_with_slow_forcing() {
        // At stiffness 1e6 the exact Jacobian keeps order 2: the slow manifold is followed.
        let error = |n_steps: u32| {
            let mut model = Relaxation::new(1e6);
            let end = integrate(&mut Ros2w::default(), &mut model, n_steps);
            model.distance_from_exact(&end)
        };
        let order = convergence_order(error, 40);
        assert!(order > 1.8, "{order}");
        assert!(error(100) < 1e-3, "{}", error(100));
    }

    #[test]
    fn stiff_modes_die_in_one_step() {
        let mut model = Relaxation::new(1e12);
        let from = vec![model.slow(0.0) + 1.0, 0.0];
        for gamma in [GAMMA_L_STABLE_LARGE, GAMMA_L_STABLE_SMALL] {
            let mut to = from.clone();
            Ros2w::new(gamma)
                .unwrap()
                .step(&mut model, &from, 1e-3, &mut to)
                .unwrap();
            let left = (to[0] - model.slow(to[1])).abs();
            assert!(left < 1e-5, "gamma {gamma}: {left}");
        }
    }

    #[test]
    fn error_estimate_bounds_the_local_error() {
        for dt in [0.2, 0.05, 0.0125] {
            let mut model = Oscillator::default();
            let from = model.start();
            let mut to = from.clone();
            let mut ros2 = Ros2w::default();
            let estimate = ros2.step(&mut model, &from, dt, &mut to).unwrap().error;
            let local = model.local_error(dt, &to);
            assert!(
                estimate > local && estimate < 3.0 * dt * dt,
                "dt {dt}: estimate {estimate:e}, true {local:e}"
            );
        }
    }

    #[test]
    fn a_repeated_step_does_not_compute_the_rate_again() {
        let mut model = Oscillator::default();
        let from = model.start();
        let mut to = from.clone();
        let mut ros2 = Ros2w::default();
        ros2.step(&mut model, &from, 0.5, &mut to).unwrap();
        ros2.step(&mut model, &from, 0.25, &mut to).unwrap();
        let counters = Stepper::<Oscillator>::counters(&ros2);
        assert_eq!(
            (
                counters.n_rate_evaluations,
                counters.n_factorisations,
                counters.n_solves
            ),
            (3, 2, 4)
        );
        let mut fresh = from.clone();
        Ros2w::default()
            .step(&mut model, &from, 0.25, &mut fresh)
            .unwrap();
        assert_eq!(to, fresh);
        assert!(Ros2w::new(f64::NAN).is_err() && Ros2w::new(0.1).is_err());
    }

    #[test]
    fn what_is_not_finite_is_refused() {
        let mut model = Oscillator::default();
        let from = vec![f64::NAN, 0.0];
        let mut to = from.clone();
        let refused = Ros2w::default().step(&mut model, &from, 0.1, &mut to);
        assert_eq!(
            refused,
            Err(Rejection::NotFinite {
                what: "error estimate"
            })
        );
    }
}
