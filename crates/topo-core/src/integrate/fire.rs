//! FIRE: fast inertial relaxation to a minimum of the energy, by forces alone.

use crate::check::{InvalidValue, in_range, positive};
use crate::control::Rejection;

/// Steps of downhill motion before the clock runs faster.
const DELAY: u64 = 20;
const GROWTH: f64 = 1.1;
const SHRINK: f64 = 0.5;
const MIXING_START: f64 = 0.25;
const MIXING_SHRINK: f64 = 0.99;
/// The clock stays within these multiples of the first step.
const SLOWEST: f64 = 0.02;
/// Successive uphill steps after which the force cannot be the gradient of anything.
const MAX_UPHILL: u64 = 2000;

/// Where a relaxation stands.
#[derive(Clone, Copy, Debug)]
pub struct Relaxed<'a> {
    /// Steps taken.
    pub step: u64,
    /// Positions.
    pub positions: &'a [f64],
    /// Force at the positions.
    pub force: &'a [f64],
    /// Largest absolute component of the force.
    pub largest_force: f64,
}

/// Writes the force at the given positions.
pub type ForceFn<'a> = dyn FnMut(&[f64], &mut [f64]) -> Result<(), Rejection> + 'a;

/// Why a relaxation ended.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RelaxationEnd {
    /// The caller's test was met.
    Converged,
    /// The limit of steps was reached.
    StepLimit,
    /// The motion was uphill for thousands of steps: the force is no gradient.
    Uphill,
    /// The force could not be had, or is not finite; positions are the last ones tried.
    Refused(Rejection),
}

/// Result of a relaxation.
#[derive(Clone, Debug, PartialEq)]
pub struct Relaxation {
    /// Why it ended.
    pub end: RelaxationEnd,
    /// Steps taken, which is one less than evaluations of the force.
    pub n_steps: u64,
    /// Largest absolute component of the last force.
    pub largest_force: f64,
}

/// Minimiser by damped inertial motion that stops and restarts whenever it runs uphill.
///
/// ```math
/// v \leftarrow (1 - a)(v + F\,\Delta t) + a\,|v + F\,\Delta t|\,F/|F|, \quad x \leftarrow x + v\,\Delta t
/// ```
///
/// The semi-implicit form with a half step back after an uphill one. Needs no Hessian and no line search, and a cap on the
/// displacement keeps contacts from being jumped over. Masses are 1: scale the unknowns, or the forces, to equal stiffness.
///
/// # Validation
/// `finds_the_minimum_of_a_curved_valley`, `no_component_moves_beyond_the_cap`
///
/// # References
/// `bitzek2006`, `guenole2020`
#[derive(Clone, Debug, PartialEq)]
pub struct Fire {
    dt: f64,
    dt_max: f64,
    cap: f64,
    max_steps: u64,
}

impl Fire {
    /// Relaxation with first time step `dt` (about a tenth of the shortest period; it grows tenfold at most) and no component
    /// moving by more than `cap` in a step.
    ///
    /// # Errors
    /// [`InvalidValue`] when an argument is not a positive finite number.
    pub fn new(dt: f64, cap: f64) -> Result<Self, InvalidValue> {
        positive("dt", dt)?;
        Ok(Self {
            dt,
            dt_max: 10.0 * dt,
            cap: positive("cap", cap)?,
            max_steps: 100_000,
        })
    }

    /// With a time step that grows to at most `ratio` (1 to 1000) times the first.
    ///
    /// # Errors
    /// [`InvalidValue`] outside that range.
    pub fn with_max_growth(mut self, ratio: f64) -> Result<Self, InvalidValue> {
        self.dt_max = self.dt * in_range("ratio", ratio, 1.0, 1000.0)?;
        Ok(self)
    }

    /// With at most `max_steps` steps (100 000 by default).
    pub fn with_max_steps(mut self, max_steps: u64) -> Self {
        self.max_steps = max_steps;
        self
    }

    /// Moves `positions` downhill along `force` until `converged` says so.
    ///
    /// `force` writes the force at the given positions; `converged` is asked after each evaluation.
    pub fn relax(
        &self,
        positions: &mut [f64],
        force: &mut ForceFn<'_>,
        converged: &mut dyn FnMut(&Relaxed<'_>) -> bool,
    ) -> Relaxation {
        let n = positions.len();
        let (mut velocity, mut pull) = (vec![0.0; n], vec![0.0; n]);
        let (mut dt, mut mixing) = (self.dt, MIXING_START);
        let (mut n_downhill, mut n_uphill, mut step) = (0_u64, 0_u64, 0_u64);
        let mut largest_force = 0.0;
        let end = loop {
            if let Err(why) = force(positions, &mut pull) {
                break RelaxationEnd::Refused(why);
            }
            largest_force = super::max_norm(&pull);
            if !largest_force.is_finite() {
                break RelaxationEnd::Refused(Rejection::NotFinite { what: "force" });
            }
            if converged(&Relaxed {
                step,
                positions,
                force: &pull,
                largest_force,
            }) {
                break RelaxationEnd::Converged;
            }
            if step >= self.max_steps {
                break RelaxationEnd::StepLimit;
            }
            step += 1;

            let power: f64 = pull.iter().zip(&velocity).map(|(f, v)| f * v).sum();
            if power > 0.0 {
                n_downhill += 1;
                n_uphill = 0;
                if n_downhill > DELAY {
                    dt = (dt * GROWTH).min(self.dt_max);
                    mixing *= MIXING_SHRINK;
                }
            } else {
                n_downhill = 0;
                n_uphill += 1;
                if n_uphill > MAX_UPHILL {
                    break RelaxationEnd::Uphill;
                }
                // The first steps start from rest: no reason to slow down yet.
                if step > DELAY {
                    dt = (dt * SHRINK).max(SLOWEST * self.dt);
                    mixing = MIXING_START;
                }
                let back = self.capped(dt, &velocity) * 0.5;
                for (x, v) in positions.iter_mut().zip(&mut velocity) {
                    *x -= back * *v;
                    *v = 0.0;
                }
            }
            for (v, f) in velocity.iter_mut().zip(&pull) {
                *v += dt * f;
            }
            let pull_norm = norm(&pull);
            if pull_norm > 0.0 {
                let along = mixing * norm(&velocity) / pull_norm;
                for (v, f) in velocity.iter_mut().zip(&pull) {
                    *v = (1.0 - mixing) * *v + along * f;
                }
            }
            let forth = self.capped(dt, &velocity);
            for (x, v) in positions.iter_mut().zip(&velocity) {
                *x += forth * v;
            }
        };
        Relaxation {
            end,
            n_steps: step,
            largest_force,
        }
    }

    /// The time step, or less where the fastest component would pass the cap.
    fn capped(&self, dt: f64, velocity: &[f64]) -> f64 {
        let fastest = super::max_norm(velocity);
        if dt * fastest > self.cap {
            self.cap / fastest
        } else {
            dt
        }
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Force of Rosenbrock's function.
    fn valley(x: &[f64], force: &mut [f64]) -> Result<(), Rejection> {
        let bend = x[1] - x[0] * x[0];
        force[0] = 2.0 * (1.0 - x[0]) + 400.0 * x[0] * bend;
        force[1] = -200.0 * bend;
        Ok(())
    }

    #[test]
    fn finds_the_minimum_of_a_curved_valley() {
        let mut x = [-1.2, 1.0];
        let fire = Fire::new(2e-3, 0.1).unwrap();
        let done = fire.relax(&mut x, &mut valley, &mut |r| r.largest_force < 1e-9);
        assert_eq!(done.end, RelaxationEnd::Converged);
        assert!(
            (x[0] - 1.0).abs() < 1e-8 && (x[1] - 1.0).abs() < 1e-8,
            "{x:?} after {}",
            done.n_steps
        );
        assert!(done.n_steps < 20_000, "{}", done.n_steps);
    }

    #[test]
    fn no_component_moves_beyond_the_cap() {
        let mut x = [50.0, -30.0];
        let mut last = x;
        let mut largest: f64 = 0.0;
        let mut spring = |x: &[f64], f: &mut [f64]| {
            f[0] = -1e6 * x[0];
            f[1] = -x[1];
            Ok(())
        };
        let fire = Fire::new(1e-4, 0.25).unwrap().with_max_steps(500);
        let done = fire.relax(&mut x, &mut spring, &mut |r| {
            largest = largest
                .max((r.positions[0] - last[0]).abs())
                .max((r.positions[1] - last[1]).abs());
            last = [r.positions[0], r.positions[1]];
            false
        });
        assert_eq!((done.end, done.n_steps), (RelaxationEnd::StepLimit, 500));
        // A half step back and a step forth may add up.
        assert!(largest > 0.2 && largest <= 0.375, "{largest}");
    }

    #[test]
    fn troubles_are_values() {
        let fire = Fire::new(0.1, 0.1).unwrap();
        let broken = fire.relax(
            &mut [1.0],
            &mut |_, f| {
                f[0] = f64::NAN;
                Ok(())
            },
            &mut |_| false,
        );
        assert_eq!(
            broken.end,
            RelaxationEnd::Refused(Rejection::NotFinite { what: "force" })
        );
        let refusal = Rejection::Domain { what: "planted" };
        let refused = fire.relax(&mut [1.0], &mut |_, _| Err(refusal.clone()), &mut |_| false);
        assert_eq!(refused.end, RelaxationEnd::Refused(refusal));
        let empty = fire.relax(&mut [], &mut |_, _| Ok(()), &mut |r| r.largest_force == 0.0);
        assert_eq!((empty.end, empty.n_steps), (RelaxationEnd::Converged, 0));
        // A force that flips its sign at each call is no gradient.
        let mut sign = 1.0;
        let flipping = fire.relax(
            &mut [1.0],
            &mut |_, f| {
                sign = -sign;
                f[0] = sign;
                Ok(())
            },
            &mut |_| false,
        );
        assert_eq!(flipping.end, RelaxationEnd::Uphill);
        assert!(Fire::new(0.0, 1.0).is_err() && Fire::new(1.0, f64::NAN).is_err());
    }

    /// A pull that never turns leaves free fall, v ← v + F dt and x ← x + v dt, whose steps grow by 1.1 from the 22nd on.
    #[test]
    fn a_constant_force_is_free_fall_in_growing_steps() {
        let (first, force) = (1e-3, [3.0, 4.0]);
        let (mut dt, mut v, mut fallen) = (first, 0.0, 0.0);
        for step in 1..=60 {
            if step > 21 {
                dt = f64::min(1.1 * dt, 10.0 * first);
            }
            v += dt;
            fallen += dt * v;
        }
        let mut x = [0.0, 0.0];
        let mut pull = |_: &[f64], f: &mut [f64]| {
            f.copy_from_slice(&force);
            Ok(())
        };
        let fire = Fire::new(first, 1e3).unwrap().with_max_steps(60);
        fire.relax(&mut x, &mut pull, &mut |_| false);
        for (x, f) in x.iter().zip(force) {
            assert!(
                (x / (f * fallen) - 1.0).abs() < 1e-12,
                "{x} of {}",
                f * fallen
            );
        }
    }
}
