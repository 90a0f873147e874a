//! FIRE: fast inertial relaxation to a minimum of the energy, by forces alone.

use serde::{Deserialize, Serialize};

use crate::hooks::MOST_COUNTED;

/// Successive downhill steps before the clock runs faster.
const DELAY: u32 = 5;
const GROWTH: f64 = 1.1;
const SHRINK: f64 = 0.5;
const MIXING_START: f64 = 0.1;
const MIXING_SHRINK: f64 = 0.99;
/// First and shortest time step, as shares of the longest.
const FIRST: f64 = 0.3;
const SHORTEST: f64 = 0.02;

/// Damped inertial motion that stops and restarts whenever it runs uphill.
///
/// ```math
/// v \leftarrow (1 - a)(v + F\,\Delta t) + a\,|v + F\,\Delta t|\,F/|F|, \quad x \leftarrow x + v\,\Delta t
/// ```
///
/// F is the force, a the mixing. This is the semi-implicit form: after an uphill step half of it is taken back. It needs no Hessian and no line
/// search. Masses are 1, so scale the unknowns or the forces to equal stiffness. Three sums over all unknowns decide on a step, and
/// the step combines position, velocity and force. The model chooses how these are stored and computed.
///
/// # Validation
/// `finds_the_minimum_of_a_curved_valley`, `a_constant_force_is_free_fall_in_growing_steps`, `an_uphill_step_is_half_undone`
///
/// # References
/// [bitzek2006], [guenole2020]
///
/// [bitzek2006]: https://doi.org/10.1103/PhysRevLett.97.170201
/// [guenole2020]: https://doi.org/10.1016/j.commatsci.2020.109584
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fire {
    dt: f64,
    mixing: f64,
    n_downhill: u32,
    n_steps: u64,
}

/// Sums over all unknowns at the present positions, for [`Fire::step`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FireSums {
    /// F · F, which is positive.
    pub force_squared: f64,
    /// F · v.
    pub power: f64,
    /// v · v.
    pub speed_squared: f64,
}

/// One step of [`Fire`], with v' the velocity after it.
///
/// ```math
/// v' = a_v v + a_F F, \qquad x' = x + b\,v + \Delta t\,v'
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FireStep {
    /// Factor b of the velocity: 0, or a negative time that takes half of an uphill step back.
    pub back: f64,
    /// Factor a_v of the velocity.
    pub on_velocity: f64,
    /// Factor a_F of the force: a time.
    pub on_force: f64,
    /// Time step Δt.
    pub forth: f64,
}

impl Fire {
    /// A relaxation that begins from rest, whose longest time step will be `longest`.
    ///
    /// The scheme is stable below 2/ω, where ω is the highest frequency of the unknowns. Times are in the model's unit.
    pub fn at_rest(longest: f64) -> Self {
        Self {
            dt: FIRST * longest,
            mixing: MIXING_START,
            n_downhill: 0,
            n_steps: 0,
        }
    }

    /// The next step, with time steps of at most `longest`.
    pub fn step(&mut self, longest: f64, sums: FireSums) -> FireStep {
        let FireSums {
            force_squared,
            power,
            speed_squared,
        } = sums;
        self.n_steps += 1;
        // Positions go back before the velocity is stopped.
        let (mut back, mut keep) = (0.0, 1.0);
        if power > 0.0 {
            self.n_downhill += 1;
            if self.n_downhill > DELAY {
                self.dt = (self.dt * GROWTH).min(longest);
                self.mixing *= MIXING_SHRINK;
            }
        } else if self.n_steps > 1 {
            back = -0.5 * self.dt;
            keep = 0.0;
            self.n_downhill = 0;
            self.dt = (self.dt * SHRINK).max(SHORTEST * longest);
            self.mixing = MIXING_START;
        }
        let (dt, a) = (self.dt, self.mixing);
        // |v + dt F|, v being stopped or not.
        let after = keep * (speed_squared + 2.0 * dt * power) + dt * dt * force_squared;
        let speed = after.max(0.0).sqrt();
        FireStep {
            back,
            on_velocity: (1.0 - a) * keep,
            on_force: (1.0 - a) * dt + a * speed / force_squared.sqrt(),
            forth: dt,
        }
    }

    /// Steps taken.
    pub fn n_steps(&self) -> u64 {
        self.n_steps
    }

    /// Whether a relaxation can continue with it. Check this for one that was read from a file.
    pub fn is_sound(&self) -> bool {
        self.dt.is_finite()
            && self.dt > 0.0
            && (0.0..=1.0).contains(&self.mixing)
            && self.n_downhill < u32::MAX / 2
            && self.n_steps < MOST_COUNTED
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dot(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(x, y)| x * y).sum()
    }

    /// Moves `x` until the largest force is below `tolerance` or so many steps are taken; gives the number of steps.
    fn relax(
        x: &mut [f64],
        longest: f64,
        tolerance: f64,
        most: u64,
        force: impl Fn(&[f64], &mut [f64]),
    ) -> u64 {
        let (mut v, mut f) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        let mut fire = Fire::at_rest(longest);
        loop {
            force(x, &mut f);
            if crate::max_norm(&f) < tolerance || fire.n_steps() == most {
                return fire.n_steps();
            }
            let step = fire.step(
                longest,
                FireSums {
                    force_squared: dot(&f, &f),
                    power: dot(&f, &v),
                    speed_squared: dot(&v, &v),
                },
            );
            for ((x, v), f) in x.iter_mut().zip(&mut v).zip(&f) {
                let next = step.on_velocity * *v + step.on_force * f;
                *x += step.back * *v + step.forth * next;
                *v = next;
            }
        }
    }

    /// Rosenbrock's function.
    #[test]
    fn finds_the_minimum_of_a_curved_valley() {
        let mut x = [-1.2, 1.0];
        let n = relax(&mut x, 0.02, 1e-9, 20_000, |x, force| {
            let bend = x[1] - x[0] * x[0];
            force[0] = 2.0 * (1.0 - x[0]) + 400.0 * x[0] * bend;
            force[1] = -200.0 * bend;
        });
        assert!(
            (x[0] - 1.0).abs() < 1e-8 && (x[1] - 1.0).abs() < 1e-8,
            "{x:?} after {n}"
        );
        assert!(n < 2000, "{n}");
    }

    /// A pull that never turns leaves free fall, v ← v + F dt and x ← x + v dt, whose steps grow by 1.1 from the 7th on.
    #[test]
    fn a_constant_force_is_free_fall_in_growing_steps() {
        let (longest, force) = (1e-2, [3.0, 4.0]);
        let (mut dt, mut v, mut fallen) = (0.3 * longest, 0.0, 0.0);
        for step in 1..=60 {
            if step > 6 {
                dt = f64::min(1.1 * dt, longest);
            }
            v += dt;
            fallen += dt * v;
        }
        let mut x = [0.0, 0.0];
        relax(&mut x, longest, 0.0, 60, |_, f| f.copy_from_slice(&force));
        for (x, f) in x.iter().zip(force) {
            assert!(
                (x / (f * fallen) - 1.0).abs() < 1e-12,
                "{x} of {}",
                f * fallen
            );
        }
    }

    /// Uphill, half of the last step is undone, the clock runs at half its pace, and what remains is a fall from rest, v' = F dt.
    #[test]
    fn an_uphill_step_is_half_undone() {
        let sums = |power: f64| FireSums {
            force_squared: 4.0,
            power,
            speed_squared: 9.0,
        };
        let mut fire = Fire::at_rest(1.0);
        let first = fire.step(1.0, sums(0.0));
        assert_eq!((first.back, first.forth), (0.0, 0.3), "it began from rest");
        let second = fire.step(1.0, sums(-1.0));
        assert_eq!((second.back, second.forth), (-0.15, 0.15));
        assert_eq!(second.on_velocity, 0.0);
        assert!((second.on_force - 0.15).abs() < 1e-15);
        // However long it goes uphill, the clock does not stop.
        for _ in 0..20 {
            fire.step(1.0, sums(-1.0));
        }
        assert_eq!(fire.step(1.0, sums(-1.0)).forth, 0.02);
    }

    #[test]
    fn broken_clocks_are_found() {
        let fire = Fire::at_rest(0.1);
        assert!(fire.is_sound() && !Fire::at_rest(0.0).is_sound());
        for bad in [f64::NAN, f64::INFINITY, -1.0] {
            assert!(
                !Fire { dt: bad, ..fire }.is_sound()
                    && !Fire {
                        mixing: bad,
                        ..fire
                    }
                    .is_sound()
            );
        }
        let endless = Fire {
            n_steps: u64::MAX,
            ..fire
        };
        assert!(!endless.is_sound());
    }
}
