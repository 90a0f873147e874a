//! Limited-memory quasi-Newton minimisation (BFGS) with a preconditioner.

/// Pairs of step and change of gradient that are remembered.
const MEMORY: usize = 20;
/// Share of the expected fall that a step must bring.
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
/// `nocedal2006`
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
    let mut pairs: Vec<(Vec<f64>, Vec<f64>, f64)> = Vec::new();
    let (mut direction, mut trial, mut next) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let mut weights = [0.0; MEMORY];
    let mut scale = 1.0;
    for _ in 0..most_steps {
        direction.copy_from_slice(&gradient);
        for (k, (s, y, rate)) in pairs.iter().enumerate().rev() {
            weights[k] = rate * dot(s, &direction);
            axpy(-weights[k], y, &mut direction);
        }
        objective.precondition(&mut direction);
        direction.iter_mut().for_each(|d| *d *= scale);
        for (k, (s, y, rate)) in pairs.iter().enumerate() {
            let back = rate * dot(y, &direction);
            axpy(weights[k] - back, s, &mut direction);
        }
        let mut slope = -dot(&direction, &gradient);
        let largest = direction.iter().fold(0.0_f64, |a, d| a.max(d.abs()));
        if !(value.is_finite() && largest.is_finite()) {
            return None;
        }
        if slope >= 0.0 {
            if pairs.is_empty() {
                break;
            }
            pairs.clear();
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
            if pairs.is_empty() {
                break;
            }
            pairs.clear();
            continue;
        }
        if pairs.len() == MEMORY {
            pairs.remove(0);
        }
        let s: Vec<f64> = trial.iter().zip(x.iter()).map(|(t, x)| t - x).collect();
        let y: Vec<f64> = next.iter().zip(&gradient).map(|(a, b)| a - b).collect();
        let curvature = dot(&s, &y);
        if curvature > 1e-10 * dot(&y, &y).sqrt() * dot(&s, &s).sqrt() {
            // Scales the preconditioner to the curvature along the last step, so that full steps mostly serve.
            direction.copy_from_slice(&y);
            objective.precondition(&mut direction);
            scale = curvature / dot(&y, &direction);
            pairs.push((s, y, 1.0 / curvature));
        }
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
