//! Limited-memory quasi-Newton minimisation (BFGS) with a preconditioner.

/// Pairs of step and change of gradient that are remembered.
const MEMORY: usize = 20;
/// Share of the expected decrease that a step must reach.
const ENOUGH: f64 = 1e-4;
/// Largest displacement of a coordinate in a step.
const LONGEST: f64 = 0.05;

/// A function to minimise.
pub(super) trait Objective {
    /// The value at `x`; writes the gradient.
    fn value(&mut self, x: &[f64], gradient: &mut [f64]) -> f64;
    /// Applies an estimate of the inverse Hessian in place.
    fn precondition(&mut self, direction: &mut [f64]);
}

/// How a minimisation went.
pub(super) struct Minimised {
    pub n_evaluations: usize,
    /// Whether the caller's test stopped it.
    pub interrupted: bool,
}

/// Minimises from `x` on, until the preconditioned gradient falls below `tolerance`, `stop` holds, or steps run out.
///
/// # References
/// [nocedal2006]
///
/// [nocedal2006]: https://doi.org/10.1007/978-0-387-40065-5
pub(super) fn minimise(
    objective: &mut impl Objective,
    x: &mut [f64],
    most_steps: usize,
    tolerance: f64,
    stop: impl Fn(&[f64]) -> bool,
) -> Option<Minimised> {
    let n = x.len();
    let mut gradient = vec![0.0; n];
    let mut value = objective.value(x, &mut gradient);
    let mut n_evaluations = 1;
    let mut memory = Memory::default();
    let (mut direction, mut trial, mut next) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    for _ in 0..most_steps {
        direction.copy_from_slice(&gradient);
        memory.apply(objective, &mut direction);
        let mut slope = -dot(&direction, &gradient);
        let largest = direction.iter().fold(0.0_f64, |a, d| a.max(d.abs()));
        if !(value.is_finite() && largest.is_finite()) {
            return None;
        }
        if slope >= 0.0 {
            if memory.pairs.is_empty() {
                break;
            }
            memory.pairs.clear();
            continue;
        }
        if largest < tolerance {
            break;
        }
        let mut step = (LONGEST / largest).min(1.0);
        slope *= step;
        let mut accepted = false;
        for _ in 0..30 {
            for ((t, x), d) in trial.iter_mut().zip(x.iter()).zip(&direction) {
                *t = x - step * d;
            }
            let there = objective.value(&trial, &mut next);
            n_evaluations += 1;
            if there <= value + ENOUGH * slope {
                accepted = true;
                value = there;
                break;
            }
            step *= 0.5;
            slope *= 0.5;
        }
        if !accepted {
            if memory.pairs.is_empty() {
                break;
            }
            memory.pairs.clear();
            continue;
        }
        let s: Vec<f64> = trial.iter().zip(x.iter()).map(|(t, x)| t - x).collect();
        let y: Vec<f64> = next.iter().zip(&gradient).map(|(a, b)| a - b).collect();
        memory.learn(objective, s, y, &mut direction);
        x.copy_from_slice(&trial);
        gradient.copy_from_slice(&next);
        if stop(x) {
            return Some(Minimised {
                n_evaluations,
                interrupted: true,
            });
        }
    }
    Some(Minimised {
        n_evaluations,
        interrupted: false,
    })
}

/// The estimate of the inverse Hessian.
struct Memory {
    /// Steps, changes of the gradient along them, and one over their products.
    pairs: Vec<(Vec<f64>, Vec<f64>, f64)>,
    weights: [f64; MEMORY],
    /// Scales the preconditioner to the curvature along the last step, so that full steps mostly serve.
    scale: f64,
}

impl Default for Memory {
    fn default() -> Self {
        Self {
            pairs: Vec::new(),
            weights: [0.0; MEMORY],
            scale: 1.0,
        }
    }
}

impl Memory {
    /// Applies the estimate in place, by the recursion of two loops.
    fn apply(&mut self, objective: &mut impl Objective, direction: &mut [f64]) {
        for (k, (s, y, rate)) in self.pairs.iter().enumerate().rev() {
            self.weights[k] = rate * dot(s, direction);
            axpy(-self.weights[k], y, direction);
        }
        objective.precondition(direction);
        direction.iter_mut().for_each(|d| *d *= self.scale);
        for (k, (s, y, rate)) in self.pairs.iter().enumerate() {
            let back = rate * dot(y, direction);
            axpy(self.weights[k] - back, s, direction);
        }
    }

    /// Takes up a step and the change of the gradient along it; `work` is overwritten.
    fn learn(
        &mut self,
        objective: &mut impl Objective,
        s: Vec<f64>,
        y: Vec<f64>,
        work: &mut [f64],
    ) {
        if self.pairs.len() == MEMORY {
            self.pairs.remove(0);
        }
        let curvature = dot(&s, &y);
        if curvature > 1e-10 * dot(&y, &y).sqrt() * dot(&s, &s).sqrt() {
            work.copy_from_slice(&y);
            objective.precondition(work);
            self.scale = curvature / dot(&y, work);
            self.pairs.push((s, y, 1.0 / curvature));
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn axpy(factor: f64, x: &[f64], out: &mut [f64]) {
    for (o, x) in out.iter_mut().zip(x) {
        *o += factor * x;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Valley;

    impl Objective for Valley {
        fn value(&mut self, x: &[f64], g: &mut [f64]) -> f64 {
            // Rosenbrock's function.
            let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
            g[0] = -2.0 * a - 400.0 * x[0] * b;
            g[1] = 200.0 * b;
            a * a + 100.0 * b * b
        }
        fn precondition(&mut self, direction: &mut [f64]) {
            direction.iter_mut().for_each(|d| *d *= 1e-2);
        }
    }

    #[test]
    fn finds_the_bottom_of_a_bent_valley() {
        let mut x = [-1.2, 1.0];
        let run = minimise(&mut Valley, &mut x, 500, 1e-10, |_| false).expect("finite");
        assert!(!run.interrupted);
        assert!(
            (x[0] - 1.0).abs() < 1e-6 && (x[1] - 1.0).abs() < 1e-6,
            "{x:?}"
        );
    }
}
