//! Why a step is refused, and how long the next one should be.

use serde::{Deserialize, Serialize};

use crate::check::{InvalidValue, in_range, positive};

/// Why a candidate step was refused. A value, not an error: most refusals are followed by a smaller step.
#[derive(Clone, Debug, PartialEq, Serialize, thiserror::Error)]
#[non_exhaustive]
pub enum Rejection {
    /// The embedded estimate of the local error exceeds twice the tolerance.
    #[error("local error {error:.3e} exceeds twice the tolerance {tolerance:.3e}")]
    ErrorTooLarge {
        /// Estimated error, in the unit of the tolerance.
        error: f64,
        /// The tolerance, in the unit of the model's error norm.
        tolerance: f64,
    },
    /// A vertex moved too far in one step.
    #[error("vertex {vertex} moved by {moved:.3e}, more than {limit:.3e}")]
    Displacement {
        /// Index of the vertex.
        vertex: usize,
        /// How far it moved, in the model's unit of length.
        moved: f64,
        /// How far it may move in one step, in the model's unit of length.
        limit: f64,
    },
    /// The energy rose although nothing drives the system.
    #[error("energy rose by {relative:.3e} of itself")]
    EnergyRise {
        /// Rise relative to the energy before the step.
        relative: f64,
    },
    /// Two edges might have passed through each other.
    #[error("edges {} and {} might have crossed", edges.0, edges.1)]
    Crossing {
        /// Indices of the two edges.
        edges: (usize, usize),
    },
    /// A rate, state or error is NaN or infinite.
    #[error("{what} is not finite")]
    NotFinite {
        /// What is not finite.
        what: &'static str,
    },
    /// A matrix could not be factorised.
    #[error("{what} could not be factorised")]
    Factorisation {
        /// Which matrix.
        what: &'static str,
    },
    /// A stabilised explicit step would need more stages than allowed.
    #[error("step needs {needed} stages, more than {limit}")]
    TooManyStages {
        /// Stages needed for stability.
        needed: usize,
        /// Stages allowed.
        limit: usize,
    },
    /// The model refuses the state; a smaller step may avoid it.
    #[error("model refuses: {what}")]
    Domain {
        /// What is refused.
        what: &'static str,
    },
    /// The model cannot continue: no smaller step helps, the run fails.
    #[error("run is broken: {what}")]
    Fatal {
        /// What is broken.
        what: &'static str,
    },
}

impl Rejection {
    /// Short name by which refusals are counted.
    pub fn name(&self) -> &'static str {
        match self {
            Self::ErrorTooLarge { .. } => "error-too-large",
            Self::Displacement { .. } => "displacement",
            Self::EnergyRise { .. } => "energy-rise",
            Self::Crossing { .. } => "crossing",
            Self::NotFinite { .. } => "not-finite",
            Self::Factorisation { .. } => "factorisation",
            Self::TooManyStages { .. } => "too-many-stages",
            Self::Domain { .. } => "domain",
            Self::Fatal { .. } => "fatal",
        }
    }
}

/// Chooses step lengths so that the local error stays near a tolerance.
///
/// ```math
/// \Delta t \leftarrow \Delta t\;\mathrm{clamp}\bigl(s\,(\mathrm{tol}/\mathrm{err})^{1/q},\; 0.1,\; g\bigr)
/// ```
///
/// with safety s, growth limit g, and q the power with which the error estimate vanishes. The tolerance is the *target*, so a
/// step is refused only when its error exceeds twice the tolerance: as the next step aims at the tolerance anyway, refusing
/// errors barely above it would waste work and make the step length jitter. After a refusal by a guard the step is halved, or
/// brought below the limit of the displacement; the step after a refused one may not grow. [`dt_min`](Self::with_limits) and
/// the limit of trial steps end every run.
///
/// # Validation
/// `steps_follow_the_error`, `refusals_shrink_and_are_counted`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepControl {
    tolerance: f64,
    dt_min: f64,
    dt_max: f64,
    max_growth: f64,
    safety: f64,
    max_trials: u64,
    /// Length proposed for the next step, in the model's unit of time.
    dt: f64,
    just_rejected: bool,
}

/// Largest shrinkage after one refusal for a large error.
const MAX_SHRINK: f64 = 0.1;
/// A step may err by this many tolerances.
const ACCEPTED_TOLERANCES: f64 = 2.0;

impl StepControl {
    /// Control towards `tolerance` (in the unit of the model's error norm), with the first step `dt_initial` (in the model's
    /// unit of time).
    ///
    /// Defaults: steps within 1e-12..=1e6 times the first one, growth at most 2, safety 0.9, ten million trial steps.
    ///
    /// # Errors
    /// [`InvalidValue`] when `tolerance` or `dt_initial` is not a positive finite number.
    pub fn new(tolerance: f64, dt_initial: f64) -> Result<Self, InvalidValue> {
        positive("tolerance", tolerance)?;
        positive("dt_initial", dt_initial)?;
        Ok(Self {
            tolerance,
            dt_min: (dt_initial * 1e-12).max(f64::MIN_POSITIVE),
            dt_max: (dt_initial * 1e6).min(f64::MAX),
            max_growth: 2.0,
            safety: 0.9,
            max_trials: 10_000_000,
            dt: dt_initial,
            just_rejected: false,
        })
    }

    /// With steps within `dt_min`..=`dt_max`; a run that would need shorter ones stops.
    ///
    /// # Errors
    /// [`InvalidValue`] when a limit is not a positive finite number or `dt_min > dt_max`.
    pub fn with_limits(mut self, dt_min: f64, dt_max: f64) -> Result<Self, InvalidValue> {
        positive("dt_max", dt_max)?;
        self.dt_min =
            positive("dt_min", dt_min).and_then(|_| in_range("dt_min", dt_min, 0.0, dt_max))?;
        self.dt_max = dt_max;
        self.dt = self.dt.clamp(dt_min, dt_max);
        Ok(self)
    }

    /// With at most `max_growth` (1 to 10) between successive steps.
    ///
    /// # Errors
    /// [`InvalidValue`] outside that range.
    pub fn with_max_growth(mut self, max_growth: f64) -> Result<Self, InvalidValue> {
        self.max_growth = in_range("max_growth", max_growth, 1.0, 10.0)?;
        Ok(self)
    }

    /// With the factor `safety` (0.1 to 1) on every proposed step.
    ///
    /// # Errors
    /// [`InvalidValue`] outside that range.
    pub fn with_safety(mut self, safety: f64) -> Result<Self, InvalidValue> {
        self.safety = in_range("safety", safety, 0.1, 1.0)?;
        Ok(self)
    }

    /// With at most `max_trials` trial steps, accepted or refused, in a run.
    pub fn with_max_trials(mut self, max_trials: u64) -> Self {
        self.max_trials = max_trials;
        self
    }

    /// Whether `other` is this control some steps later: the same settings, and a next step within their limits.
    ///
    /// Check this before continuing with a control that was read from a file.
    pub fn leads_to(&self, other: &Self) -> bool {
        let later = Self {
            dt: other.dt,
            just_rejected: other.just_rejected,
            ..self.clone()
        };
        later == *other && (self.dt_min..=self.dt_max).contains(&other.dt)
    }

    /// The tolerance, in the unit of the model's error norm.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Length proposed for the next step, in the model's unit of time.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Shortest step, in the model's unit of time.
    pub fn dt_min(&self) -> f64 {
        self.dt_min
    }

    /// Longest step, in the model's unit of time.
    pub fn dt_max(&self) -> f64 {
        self.dt_max
    }

    /// Limit of trial steps in a run.
    pub fn max_trials(&self) -> u64 {
        self.max_trials
    }

    /// Proposes `dt` for the next step, for use after the state was changed from outside.
    ///
    /// # Errors
    /// [`InvalidValue`] when `dt` is not a positive finite number.
    pub fn restart(&mut self, dt: f64) -> Result<(), InvalidValue> {
        self.dt = positive("dt", dt)?.clamp(self.dt_min, self.dt_max);
        self.just_rejected = false;
        Ok(())
    }

    /// Whether a step with `error` is good enough.
    ///
    /// # Errors
    /// [`Rejection::ErrorTooLarge`] above twice the tolerance, [`Rejection::NotFinite`] for a NaN.
    pub fn judge(&self, error: f64) -> Result<(), Rejection> {
        if !error.is_finite() {
            Err(Rejection::NotFinite {
                what: "error estimate",
            })
        } else if error > ACCEPTED_TOLERANCES * self.tolerance {
            Err(Rejection::ErrorTooLarge {
                error,
                tolerance: self.tolerance,
            })
        } else {
            Ok(())
        }
    }

    /// Length that would give an error of one tolerance, as a factor of the present one.
    fn factor(&self, error: f64, error_order: u32) -> f64 {
        let ratio = self.tolerance / error.max(f64::MIN_POSITIVE);
        self.safety * ratio.powf(1.0 / f64::from(error_order.max(1)))
    }

    /// Records an accepted step of length `dt` and proposes the next one.
    ///
    /// A step that was shortened to end at a requested time does not shorten the proposal.
    pub fn accept(&mut self, dt: f64, error: f64, error_order: u32) {
        let growth = if self.just_rejected {
            1.0
        } else {
            self.max_growth
        };
        let next = dt * self.factor(error, error_order).clamp(MAX_SHRINK, growth);
        let cut_short = dt < self.dt && error <= self.tolerance;
        self.dt = if cut_short { next.max(self.dt) } else { next }.clamp(self.dt_min, self.dt_max);
        self.just_rejected = false;
    }

    /// Records a refused step of length `dt` and proposes a shorter one; `None` when that would be below the shortest step.
    pub fn reject(&mut self, dt: f64, why: &Rejection, error_order: u32) -> Option<f64> {
        let factor = match why {
            Rejection::ErrorTooLarge { error, .. } => {
                self.factor(*error, error_order).clamp(MAX_SHRINK, 0.9)
            }
            // about proportional to the step; a ratio that is no number shrinks most
            Rejection::Displacement { moved, limit, .. } => {
                let factor = self.safety * limit / moved;
                if factor > MAX_SHRINK {
                    factor.min(0.9)
                } else {
                    MAX_SHRINK
                }
            }
            _ => 0.5,
        };
        self.just_rejected = true;
        let shorter = dt * factor;
        if shorter < self.dt_min {
            return None;
        }
        self.dt = shorter;
        Some(shorter)
    }
}

/// How many steps were refused, by the name of the reason.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RejectionCounts(std::collections::BTreeMap<String, u64>);

impl RejectionCounts {
    /// Counts one refusal.
    pub fn add(&mut self, why: &Rejection) {
        match self.0.get_mut(why.name()) {
            Some(count) => *count += 1,
            None => drop(self.0.insert(why.name().to_owned(), 1)),
        }
    }

    /// Refusals with this name.
    pub fn count(&self, name: &str) -> u64 {
        self.0.get(name).copied().unwrap_or(0)
    }

    /// All refusals.
    pub fn total(&self) -> u64 {
        self.0.values().sum()
    }

    /// Names and counts, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, u64)> {
        self.0.iter().map(|(name, count)| (name.as_str(), *count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn control() -> StepControl {
        StepControl::new(1e-3, 1.0).unwrap()
    }

    #[test]
    fn another_tolerance_or_a_step_beyond_the_limits_leads_nowhere() {
        let now = control();
        assert_eq!(now.tolerance(), 1e-3);
        let mut later = now.clone();
        later.dt *= 0.5;
        assert!(now.leads_to(&later));
        later.dt = 2.0 * later.dt_max;
        assert!(!now.leads_to(&later));
        assert!(!now.leads_to(&StepControl::new(2e-3, 1.0).unwrap()));
    }

    #[test]
    fn steps_follow_the_error() {
        let mut c = control();
        c.accept(1.0, 1e-3, 2);
        assert_relative_eq!(c.dt(), 0.9);
        c.accept(0.9, 1e-3 * 0.81, 2);
        assert_relative_eq!(c.dt(), 0.9, max_relative = 1e-12);
        c.accept(0.9, 0.0, 2);
        assert_relative_eq!(c.dt(), 1.8);
        // The higher the order of the estimate, the less a given error shortens the step.
        let (mut second, mut third) = (control(), control());
        second.accept(1.0, 1.9e-3, 2);
        third.accept(1.0, 1.9e-3, 3);
        assert!(second.dt() < third.dt() && third.dt() < 1.0);
        let mut limited = control().with_limits(0.1, 1.2).unwrap();
        limited.accept(1.0, 1e-9, 2);
        assert_eq!(limited.dt(), 1.2);
        limited.accept(0.01, 1e-9, 2);
        assert_eq!(limited.dt(), 1.2, "a step cut short keeps the proposal");
    }

    #[test]
    fn refusals_shrink_and_are_counted() {
        let mut c = control();
        assert_eq!(c.judge(2e-3), Ok(()));
        let large = c.judge(1.0).unwrap_err();
        assert_eq!(large.name(), "error-too-large");
        assert_eq!(c.reject(1.0, &large, 2), Some(0.1));
        c.accept(0.1, 1e-12, 2);
        assert_eq!(c.dt(), 0.1, "no growth right after a refusal");
        let moved = |moved| Rejection::Displacement {
            vertex: 0,
            moved,
            limit: 1.0,
        };
        for (far, shorter) in [(2.0, 0.45), (1.01, 0.891_089), (1e9, 0.1), (f64::NAN, 0.1)] {
            let proposed = control().reject(1.0, &moved(far), 2).unwrap();
            assert_relative_eq!(proposed, shorter, max_relative = 1e-5);
        }
        let guard = Rejection::Crossing { edges: (3, 9) };
        assert_eq!(c.reject(0.1, &guard, 2), Some(0.05));
        let mut counts = RejectionCounts::default();
        counts.add(&guard);
        counts.add(&guard);
        counts.add(&large);
        assert_eq!(
            (
                counts.count("crossing"),
                counts.total(),
                counts.iter().count()
            ),
            (2, 3, 2)
        );
        let mut short = control().with_limits(0.9, 2.0).unwrap();
        assert_eq!(short.reject(1.0, &guard, 2), None);
        assert_eq!(c.judge(f64::NAN).unwrap_err().name(), "not-finite");
    }

    #[test]
    fn broken_settings_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(StepControl::new(bad, 1.0).is_err() && StepControl::new(1.0, bad).is_err());
            assert!(
                control().with_limits(bad, 1.0).is_err()
                    && control().with_limits(1e-3, bad).is_err()
            );
            assert!(control().with_max_growth(bad).is_err() && control().with_safety(bad).is_err());
            assert!(control().restart(bad).is_err());
        }
        assert!(control().with_limits(2.0, 1.0).is_err());
    }

    proptest::proptest! {
        #[test]
        fn proposals_stay_within_limits(errors in proptest::collection::vec(proptest::num::f64::ANY, 1..50)) {
            let mut c = control().with_limits(1e-6, 1e3).unwrap();
            for error in errors {
                let dt = c.dt();
                match c.judge(error) {
                    Ok(()) => c.accept(dt, error, 2),
                    Err(why) => drop(c.reject(dt, &why, 2)),
                }
                proptest::prop_assert!((1e-6..=1e3).contains(&c.dt()));
            }
        }
    }
}
