//! Rosenbrock-W methods: linearly implicit, and of full order for any Jacobian.

use super::{Counters, LinearlyImplicit, Stepper, StepperMemory, Trial};
use crate::check::{InvalidValue, in_range};
use crate::control::Rejection;

/// 1 + 1/sqrt 2: ROS2-W is L-stable, the more robust choice at loose tolerances.
pub const GAMMA_L_STABLE_LARGE: f64 = 1.0 + std::f64::consts::FRAC_1_SQRT_2;
/// 1 - 1/sqrt 2: ROS2-W is L-stable, with a much smaller error constant; better at tight tolerances.
pub const GAMMA_L_STABLE_SMALL: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

const MOST_STAGES: usize = 4;
type Row = [f64; MOST_STAGES];

/// Coefficients of a method in the form that needs no product with J.
#[derive(Clone, Copy, Debug)]
struct Tableau {
    n_stages: usize,
    order: u32,
    gamma: f64,
    a: [Row; MOST_STAGES],
    c: [Row; MOST_STAGES],
    m: Row,
    e: Row,
}

/// A Rosenbrock-W method for stiff systems.
///
/// ```math
/// W k_i = F\Bigl(u_0 \oplus \Delta t \sum_{j<i} a_{ij} k_j\Bigr) + \sum_{j<i} c_{ij} k_j, \quad
/// u_1 = u_0 \oplus \Delta t \sum_i m_i k_i, \quad W = 1 - \gamma\,\Delta t\, J
/// ```
///
/// The order holds for every J: a Gauss-Newton matrix, a part of the Jacobian or an old one changes only the error constant.
/// The error is estimated by the distance to an embedded solution of one order less,
///
/// ```math
/// \mathrm{err} = \Delta t \sum_i e_i k_i
/// ```
///
/// F(u_0) is computed once per state. A repeated step costs one factorisation, and a rate and a solve for each further stage.
///
/// # Validation
/// `the_order_with_the_exact_and_with_a_wrong_jacobian`, `order_conditions_hold`, `stiff_modes_die_in_one_step`,
/// `error_estimate_bounds_the_local_error`
///
/// # References
/// [verwer1999], [rang2005]
///
/// [verwer1999]: https://doi.org/10.1137/S1064827597326651
/// [rang2005]: https://doi.org/10.1007/s10543-005-0035-y
#[derive(Clone, Debug)]
pub struct RosenbrockW {
    tableau: Tableau,
    rate: Vec<f64>,
    rate_known: bool,
    stages: Vec<Vec<f64>>,
    step: Vec<f64>,
    error: Vec<f64>,
    counters: Counters,
}

impl Default for RosenbrockW {
    fn default() -> Self {
        Self::ros34pw2()
    }
}

impl RosenbrockW {
    /// ROS34PW2: four stages, order 3, L-stable, the last stage is the solution itself.
    pub fn ros34pw2() -> Self {
        Self::with(ROS34PW2.tableau())
    }

    /// ROS2-W: two stages, order 2, for `gamma` best one of [`GAMMA_L_STABLE_LARGE`] and [`GAMMA_L_STABLE_SMALL`].
    ///
    /// # Errors
    /// [`InvalidValue`] when `gamma` is outside 1/4..=2: below 1/4 the method is not A-stable.
    pub fn ros2w(gamma: f64) -> Result<Self, InvalidValue> {
        let gamma = in_range("gamma", gamma, 0.25, 2.0)?;
        let mut tableau = Tableau {
            n_stages: 2,
            order: 2,
            gamma,
            a: [[0.0; MOST_STAGES]; MOST_STAGES],
            c: [[0.0; MOST_STAGES]; MOST_STAGES],
            m: [1.5, 0.5, 0.0, 0.0],
            e: [0.5, 0.5, 0.0, 0.0],
        };
        tableau.a[1][0] = 1.0;
        tableau.c[1][0] = -2.0;
        Ok(Self::with(tableau))
    }

    fn with(tableau: Tableau) -> Self {
        Self {
            tableau,
            rate: Vec::new(),
            rate_known: false,
            stages: Vec::new(),
            step: Vec::new(),
            error: Vec::new(),
            counters: Counters::default(),
        }
    }

    fn allocate(&mut self, n: usize) {
        for buffer in [&mut self.rate, &mut self.step, &mut self.error] {
            *buffer = vec![0.0; n];
        }
        self.stages = vec![vec![0.0; n]; self.tableau.n_stages];
    }

    /// The parameter γ.
    pub fn gamma(&self) -> f64 {
        self.tableau.gamma
    }
}

impl<M: LinearlyImplicit> Stepper<M> for RosenbrockW {
    fn step(
        &mut self,
        model: &mut M,
        state: &M::State,
        dt: f64,
        to: &mut M::State,
    ) -> Result<Trial, Rejection> {
        let (n, t) = (model.n_dof(), self.tableau);
        if self.rate.len() != n {
            self.allocate(n);
            self.rate_known = false;
        }
        self.counters.n_trials += 1;
        if !self.rate_known {
            self.counters.n_rate_evaluations += 1;
            model.rate(state, &mut self.rate)?;
            self.rate_known = true;
        }
        self.counters.n_factorisations += 1;
        model.prepare(state, t.gamma * dt)?;
        for i in 0..t.n_stages {
            let (done, rest) = self.stages.split_at_mut(i);
            let stage = &mut rest[0];
            if i == 0 {
                stage.copy_from_slice(&self.rate);
            } else {
                combine(dt, &t.a[i], done, &mut self.step);
                model.advance(state, &self.step, to)?;
                self.counters.n_rate_evaluations += 1;
                model.rate(to, stage)?;
                add(1.0, &t.c[i], done, stage);
            }
            self.counters.n_solves += 1;
            model.solve(stage)?;
        }
        combine(dt, &t.m, &self.stages, &mut self.step);
        combine(dt, &t.e, &self.stages, &mut self.error);
        let error = model.error_norm(&self.error);
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
        self.tableau.order
    }

    fn error_order(&self) -> u32 {
        self.tableau.order
    }

    fn counters(&self) -> Counters {
        self.counters
    }

    fn memory(&self) -> StepperMemory {
        StepperMemory {
            counters: self.counters,
            has_begun: !self.rate.is_empty(),
            rate: self.rate_known.then(|| self.rate.clone()),
            radius: None,
        }
    }

    fn recall(&mut self, memory: StepperMemory, n_dof: usize) {
        if memory.has_begun {
            self.allocate(n_dof);
        }
        self.counters = memory.counters;
        self.rate_known = memory.rate.is_some();
        if let Some(rate) = memory.rate {
            self.rate = rate;
        }
    }
}

/// out = dt Σ w_j k_j.
fn combine(dt: f64, weights: &Row, stages: &[Vec<f64>], out: &mut [f64]) {
    out.fill(0.0);
    add(dt, weights, stages, out);
}

/// out += dt Σ w_j k_j.
fn add(dt: f64, weights: &Row, stages: &[Vec<f64>], out: &mut [f64]) {
    for (stage, weight) in stages.iter().zip(weights).filter(|(_, w)| **w != 0.0) {
        let factor = dt * weight;
        for (o, k) in out.iter_mut().zip(stage) {
            *o += factor * k;
        }
    }
}

/// Coefficients as published, for K_i = F(u_0 + dt Σ α_ij K_j) + dt J Σ γ_ij K_j, u_1 = u_0 + dt Σ b_i K_i.
struct Published {
    order: u32,
    alpha: [Row; MOST_STAGES],
    gamma: [Row; MOST_STAGES],
    b: Row,
    /// Weights of the embedded solution.
    embedded: Row,
}

impl Published {
    /// With k = Σ γ_ij K_j/γ the products with J are gone.
    fn tableau(&self) -> Tableau {
        let gamma = self.gamma[0][0];
        let inverse = inverse_of_lower(&self.gamma);
        let transformed = |row: &Row| -> Row {
            std::array::from_fn(|j| {
                gamma
                    * (0..MOST_STAGES)
                        .map(|k| row[k] * inverse[k][j])
                        .sum::<f64>()
            })
        };
        let below_diagonal = |i: usize, j: usize| {
            if j < i { -gamma * inverse[i][j] } else { 0.0 }
        };
        Tableau {
            n_stages: MOST_STAGES,
            order: self.order,
            gamma,
            a: self.alpha.map(|row| transformed(&row)),
            c: std::array::from_fn(|i| std::array::from_fn(|j| below_diagonal(i, j))),
            m: transformed(&self.b),
            e: transformed(&std::array::from_fn(|i| self.b[i] - self.embedded[i])),
        }
    }
}

fn inverse_of_lower(lower: &[Row; MOST_STAGES]) -> [Row; MOST_STAGES] {
    let mut inverse = [[0.0; MOST_STAGES]; MOST_STAGES];
    for j in 0..MOST_STAGES {
        inverse[j][j] = 1.0 / lower[j][j];
        for i in j + 1..MOST_STAGES {
            let sum: f64 = (j..i).map(|k| lower[i][k] * inverse[k][j]).sum();
            inverse[i][j] = -sum / lower[i][i];
        }
    }
    inverse
}

/// Table of [rang2005].
///
/// [rang2005]: https://doi.org/10.1007/s10543-005-0035-y
const ROS34PW2: Published = {
    const G: f64 = 4.358_665_215_084_59e-1;
    const B: Row = [
        2.421_238_070_609_534_6e-1,
        -1.223_250_583_904_514_7,
        1.545_260_255_335_102,
        G,
    ];
    Published {
        order: 3,
        alpha: [
            [0.0; MOST_STAGES],
            [2.0 * G, 0.0, 0.0, 0.0],
            [
                8.445_706_001_536_942e-1,
                -1.129_906_423_648_418_5e-1,
                0.0,
                0.0,
            ],
            [0.0, 0.0, 1.0, 0.0],
        ],
        gamma: [
            [G, 0.0, 0.0, 0.0],
            [-2.0 * G, G, 0.0, 0.0],
            [
                -9.033_805_701_304_408e-1,
                5.418_067_238_809_532_6e-2,
                G,
                0.0,
            ],
            [B[0], B[1], 5.452_602_553_351_021e-1, G],
        ],
        b: B,
        embedded: [
            3.781_090_314_581_937e-1,
            -9.604_229_221_242_318e-2,
            0.5,
            2.179_332_607_542_295e-1,
        ],
    }
};

#[cfg(test)]
mod tests {
    use super::super::testing::{Oscillator, Relaxation, convergence_order, integrate};
    use super::*;

    fn methods() -> [RosenbrockW; 3] {
        [
            RosenbrockW::ros34pw2(),
            RosenbrockW::ros2w(GAMMA_L_STABLE_LARGE).unwrap(),
            RosenbrockW::ros2w(GAMMA_L_STABLE_SMALL).unwrap(),
        ]
    }

    fn order_of(method: &RosenbrockW) -> f64 {
        f64::from(method.tableau.order)
    }

    #[test]
    fn the_order_with_the_exact_and_with_a_wrong_jacobian() {
        let orders = methods().map(|m| Stepper::<Oscillator>::error_order(&m));
        assert_eq!(orders, [3, 2, 2]);
        for method in methods() {
            for jacobian_factor in [1.0, 0.6, 0.0] {
                let error = |n_steps: u32| {
                    let mut model = Oscillator::with_jacobian_factor(jacobian_factor);
                    let end = integrate(&mut method.clone(), &mut model, n_steps);
                    model.distance_from_exact(&end)
                };
                let order = convergence_order(error, 200) - order_of(&method);
                assert!(
                    (-0.1..0.3).contains(&order),
                    "{:?}, J x {jacobian_factor}: {order}",
                    method.tableau
                );
            }
        }
    }

    /// Every condition of order three for any J, and those of order two for the embedded weights.
    #[test]
    fn order_conditions_hold() {
        let (p, one) = (&ROS34PW2, [1.0; MOST_STAGES]);
        let dot = |u: &Row, v: &Row| -> f64 { u.iter().zip(v).map(|(a, b)| a * b).sum() };
        let times = |m: &[Row; MOST_STAGES], v: &Row| -> Row { m.map(|row| dot(&row, v)) };
        let (alpha, gamma) = (times(&p.alpha, &one), times(&p.gamma, &one));
        for (b, order) in [(&p.b, 3), (&p.embedded, 2)] {
            let mut conditions = vec![
                (dot(b, &one), 1.0),
                (dot(b, &alpha), 0.5),
                (dot(b, &gamma), 0.0),
            ];
            if order == 3 {
                conditions.extend([
                    (dot(b, &alpha.map(|a| a * a)), 1.0 / 3.0),
                    (dot(b, &times(&p.alpha, &alpha)), 1.0 / 6.0),
                    (dot(b, &times(&p.alpha, &gamma)), 0.0),
                    (dot(b, &times(&p.gamma, &alpha)), 0.0),
                    (dot(b, &times(&p.gamma, &gamma)), 0.0),
                ]);
            }
            for (k, (found, wanted)) in conditions.iter().enumerate() {
                assert!(
                    (found - wanted).abs() < 1e-15,
                    "condition {k} of order {order}: {found}"
                );
            }
        }
    }

    #[test]
    fn order_two_of_a_stiff_problem_with_slow_forcing() {
        // At stiffness 1e6 the exact Jacobian keeps order 2: the slow manifold is followed.
        for method in methods() {
            let error = |n_steps: u32| {
                let mut model = Relaxation::new(1e6);
                let end = integrate(&mut method.clone(), &mut model, n_steps);
                model.distance_from_exact(&end)
            };
            let order = convergence_order(error, 40);
            assert!(order > 1.8, "{:?}: {order}", method.tableau);
            assert!(error(100) < 1e-3, "{}", error(100));
        }
    }

    #[test]
    fn stiff_modes_die_in_one_step() {
        let mut model = Relaxation::new(1e12);
        let from = vec![model.slow(0.0) + 1.0, 0.0];
        for mut method in methods() {
            let mut to = from.clone();
            method.step(&mut model, &from, 1e-3, &mut to).unwrap();
            let left = (to[0] - model.slow(to[1])).abs();
            assert!(left < 1e-5, "{:?}: {left}", method.tableau);
        }
    }

    #[test]
    fn error_estimate_bounds_the_local_error() {
        for method in methods() {
            for dt in [0.2, 0.05, 0.0125] {
                let mut model = Oscillator::default();
                let from = model.start();
                let mut to = from.clone();
                let mut method = method.clone();
                let estimate = method.step(&mut model, &from, dt, &mut to).unwrap().error;
                let local = model.local_error(dt, &to);
                assert!(
                    estimate > local && estimate < 3.0 * dt.powf(order_of(&method)),
                    "{:?}, dt {dt}: estimate {estimate:e}, true {local:e}",
                    method.tableau
                );
            }
        }
    }

    #[test]
    fn a_repeated_step_does_not_compute_the_rate_again() {
        for mut method in methods() {
            let n = method.tableau.n_stages as u64;
            let mut model = Oscillator::default();
            let from = model.start();
            let (mut to, mut fresh, mut other) = (from.clone(), from.clone(), method.clone());
            method.step(&mut model, &from, 0.5, &mut to).unwrap();
            method.step(&mut model, &from, 0.25, &mut to).unwrap();
            let counters = Stepper::<Oscillator>::counters(&method);
            assert_eq!(
                (
                    counters.n_rate_evaluations,
                    counters.n_factorisations,
                    counters.n_solves
                ),
                (1 + 2 * (n - 1), 2, 2 * n)
            );
            other.step(&mut model, &from, 0.25, &mut fresh).unwrap();
            assert_eq!(to, fresh);
        }
        assert!(RosenbrockW::ros2w(f64::NAN).is_err() && RosenbrockW::ros2w(0.1).is_err());
    }

    #[test]
    fn what_is_not_finite_is_refused() {
        let mut model = Oscillator::default();
        let from = vec![f64::NAN, 0.0];
        let mut to = from.clone();
        for mut method in methods() {
            let refused = method.step(&mut model, &from, 0.1, &mut to);
            assert_eq!(
                refused,
                Err(Rejection::NotFinite {
                    what: "error estimate"
                })
            );
        }
    }
}
