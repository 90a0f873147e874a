//! Two small systems with known solutions, on which the integrators are tested.

use super::{LinearlyImplicit, Model, SpectralBound, Stepper};
use crate::control::Rejection;

/// Nonlinear oscillator that spirals onto the unit circle: in polar form r' = r (1 - r^2)/2, angle' = 1.
pub(crate) struct Oscillator {
    /// The Jacobian given to the integrator is the true one times this.
    jacobian_factor: f64,
    /// Inverse of W.
    inverse: [f64; 4],
}

impl Default for Oscillator {
    fn default() -> Self {
        Self {
            jacobian_factor: 1.0,
            inverse: [0.0; 4],
        }
    }
}

impl Oscillator {
    pub fn with_jacobian_factor(jacobian_factor: f64) -> Self {
        Self {
            jacobian_factor,
            ..Self::default()
        }
    }

    pub fn start(&self) -> Vec<f64> {
        vec![0.5, 0.0]
    }

    fn exact(&self, t: f64) -> [f64; 2] {
        // 1/r^2 - 1 decays like exp(-t).
        let r = 1.0 / (1.0 + 3.0 * (-t).exp()).sqrt();
        [r * t.cos(), r * t.sin()]
    }

    pub fn local_error(&self, t: f64, state: &[f64]) -> f64 {
        let exact = self.exact(t);
        (state[0] - exact[0]).abs().max((state[1] - exact[1]).abs())
    }

    pub fn distance_from_exact(&self, end: &[f64]) -> f64 {
        self.local_error(1.0, end)
    }
}

impl Model for Oscillator {
    type State = Vec<f64>;
    fn n_dof(&self) -> usize {
        2
    }
    fn rate(&mut self, u: &Vec<f64>, rate: &mut [f64]) -> Result<(), Rejection> {
        let growth = 0.5 * (1.0 - u[0] * u[0] - u[1] * u[1]);
        rate[0] = growth * u[0] - u[1];
        rate[1] = growth * u[1] + u[0];
        Ok(())
    }
    fn advance(&self, from: &Vec<f64>, step: &[f64], to: &mut Vec<f64>) -> Result<(), Rejection> {
        add(from, step, to)
    }
}

impl LinearlyImplicit for Oscillator {
    fn prepare(&mut self, u: &Vec<f64>, g_dt: f64) -> Result<(), Rejection> {
        let growth = 0.5 * (1.0 - u[0] * u[0] - u[1] * u[1]);
        let f = g_dt * self.jacobian_factor;
        let w = [
            1.0 - f * (growth - u[0] * u[0]),
            f * (1.0 + u[0] * u[1]),
            -f * (1.0 - u[0] * u[1]),
            1.0 - f * (growth - u[1] * u[1]),
        ];
        let determinant = w[0] * w[3] - w[1] * w[2];
        self.inverse = [
            w[3] / determinant,
            -w[1] / determinant,
            -w[2] / determinant,
            w[0] / determinant,
        ];
        Ok(())
    }
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), Rejection> {
        let [a, b, c, d] = self.inverse;
        let (x, y) = (rhs[0], rhs[1]);
        rhs[0] = a * x + b * y;
        rhs[1] = c * x + d * y;
        Ok(())
    }
}

impl SpectralBound for Oscillator {
    fn spectral_radius(&mut self, _: &Vec<f64>) -> Result<f64, Rejection> {
        Ok(2.0)
    }
}

/// Prothero and Robinson's problem made autonomous: u' = -stiffness (u - cos t) - sin t, t' = 1, with the solution u = cos t.
pub(crate) struct Relaxation {
    pub stiffness: f64,
    g_dt: f64,
    time: f64,
}

impl Relaxation {
    pub fn new(stiffness: f64) -> Self {
        Self {
            stiffness,
            g_dt: 0.0,
            time: 0.0,
        }
    }

    pub fn slow(&self, t: f64) -> f64 {
        t.cos()
    }

    pub fn distance_from_exact(&self, end: &[f64]) -> f64 {
        (end[0] - self.slow(end[1])).abs().max((end[1] - 1.0).abs())
    }
}

impl Model for Relaxation {
    type State = Vec<f64>;
    fn n_dof(&self) -> usize {
        2
    }
    fn rate(&mut self, u: &Vec<f64>, rate: &mut [f64]) -> Result<(), Rejection> {
        rate[0] = -self.stiffness * (u[0] - u[1].cos()) - u[1].sin();
        rate[1] = 1.0;
        Ok(())
    }
    fn advance(&self, from: &Vec<f64>, step: &[f64], to: &mut Vec<f64>) -> Result<(), Rejection> {
        add(from, step, to)
    }
}

impl LinearlyImplicit for Relaxation {
    fn prepare(&mut self, u: &Vec<f64>, g_dt: f64) -> Result<(), Rejection> {
        (self.g_dt, self.time) = (g_dt, u[1]);
        Ok(())
    }
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), Rejection> {
        let coupling = -self.stiffness * self.time.sin() - self.time.cos();
        rhs[0] = (rhs[0] + self.g_dt * coupling * rhs[1]) / (1.0 + self.g_dt * self.stiffness);
        Ok(())
    }
}

impl SpectralBound for Relaxation {
    fn spectral_radius(&mut self, _: &Vec<f64>) -> Result<f64, Rejection> {
        Ok(self.stiffness)
    }
}

fn add(from: &[f64], step: &[f64], to: &mut [f64]) -> Result<(), Rejection> {
    for i in 0..from.len() {
        to[i] = from[i] + step[i];
    }
    Ok(())
}

/// Integrates from the model's start to time 1 in `n_steps` equal steps.
pub(crate) fn integrate<M: Model<State = Vec<f64>> + Start, S: Stepper<M>>(
    stepper: &mut S,
    model: &mut M,
    n_steps: u32,
) -> Vec<f64> {
    let mut state = model.start_state();
    let mut next = state.clone();
    for _ in 0..n_steps {
        stepper
            .step(model, &state, 1.0 / f64::from(n_steps), &mut next)
            .unwrap();
        stepper.accepted();
        std::mem::swap(&mut state, &mut next);
    }
    state
}

/// A test model knows where it starts.
pub(crate) trait Start: Model {
    fn start_state(&self) -> Self::State;
}

impl Start for Oscillator {
    fn start_state(&self) -> Vec<f64> {
        self.start()
    }
}

impl Start for Relaxation {
    fn start_state(&self) -> Vec<f64> {
        vec![1.0, 0.0]
    }
}

/// Observed order between `n_steps` and four times as many.
pub(crate) fn convergence_order(error: impl Fn(u32) -> f64, n_steps: u32) -> f64 {
    (error(n_steps) / error(4 * n_steps)).log2() / 2.0
}
