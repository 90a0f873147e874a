//! The loop of trial steps that both batteries run: try, judge, accept or refuse, shorten, end at a requested time.

use serde::{Deserialize, Serialize};

use crate::control::{Rejection, RejectionCounts, StepControl};
use crate::hooks::MOST_COUNTED;
use crate::stop::StopReason;

/// What [`TimeStepping`] advances: a model with its state and its integrator.
///
/// [`Simulation`](crate::Simulation) is one, for a [`Model`](crate::Model) of numbers in flat vectors and any
/// [`Stepper`](crate::Stepper). A system that fuses its rate with the stages of its integrator implements it on its own.
pub trait Advance {
    /// Longest step from the present state that is worth a trial. Called once before each accepted step.
    ///
    /// # Errors
    /// A [`Rejection`] that ends the run, since no shorter step helps.
    fn longest_step(&mut self) -> Result<f64, Rejection>;

    /// Length of a trial from `time` that does not pass `target`, the control having proposed `dt`.
    fn trial_length(&self, dt: f64, time: f64, target: f64) -> f64 {
        in_halves(dt, target - time)
    }

    /// Tries a step of length `dt` from `time` and checks all guards. Returns the local error, which `control` has accepted.
    ///
    /// # Errors
    /// Why the step is refused: by the integrator, by [`StepControl::judge`], or by a guard.
    fn try_step(&mut self, time: f64, dt: f64, control: &StepControl) -> Result<f64, Rejection>;

    /// Makes the last trial, of length `dt`, the state, and updates the energy account.
    fn accept(&mut self, dt: f64);

    /// Power of the step length with which the error estimate of one step vanishes.
    fn error_order(&self) -> u32;
}

/// The length `dt`, or less: near the end two equal steps are made rather than a long and a very short one.
fn in_halves(dt: f64, remaining: f64) -> f64 {
    if dt >= remaining * (1.0 - 1e-9) {
        remaining
    } else {
        dt.min(0.5 * remaining)
    }
}

/// Where a run is in time: its step control, and what was tried and refused on the way.
///
/// # Validation
/// `steps_end_on_the_target_to_the_bit`, `decays_as_it_should`, `every_way_to_stop`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeStepping {
    pub(crate) time: f64,
    pub(crate) last_dt: f64,
    pub(crate) control: StepControl,
    n_steps: u64,
    pub(crate) n_trials: u64,
    rejections: RejectionCounts,
}

impl TimeStepping {
    /// A run at time 0.
    pub fn new(control: StepControl) -> Self {
        Self {
            time: 0.0,
            last_dt: 0.0,
            control,
            n_steps: 0,
            n_trials: 0,
            rejections: RejectionCounts::default(),
        }
    }

    /// Makes one accepted step of `system` that does not pass `target`.
    ///
    /// A step that reaches `target` ends there to the bit. Refused steps are counted and followed by shorter ones.
    ///
    /// # Errors
    /// The reason to stop, with the state before the step: the limit of trial steps, a step below the shortest one, or a
    /// failure that no shorter step avoids.
    pub fn step_towards(
        &mut self,
        target: f64,
        system: &mut impl Advance,
    ) -> Result<(), StopReason> {
        let longest = system
            .longest_step()
            .map_err(|why| StopReason::Failed { why })?;
        let mut proposed = self.control.dt().min(longest);
        loop {
            if self.n_trials >= self.control.max_trials() {
                return Err(StopReason::StepLimit { n: self.n_trials });
            }
            self.n_trials += 1;
            let dt = system.trial_length(proposed, self.time, target);
            let time = if dt < target - self.time {
                self.time + dt
            } else {
                target
            };
            let why = match system.try_step(self.time, dt, &self.control) {
                Ok(_) if time <= self.time => Rejection::Domain {
                    what: "the step is lost in the rounding of the time",
                },
                Ok(error) => {
                    system.accept(dt);
                    self.control.accept(dt, error, system.error_order());
                    (self.time, self.last_dt) = (time, dt);
                    self.n_steps += 1;
                    return Ok(());
                }
                Err(why) => why,
            };
            proposed = self.refuse(dt, why, system.error_order())?;
        }
    }

    /// Counts a refused step of length `dt`; returns the length of the next one.
    fn refuse(&mut self, dt: f64, why: Rejection, error_order: u32) -> Result<f64, StopReason> {
        self.rejections.add(&why);
        if matches!(why, Rejection::Fatal { .. }) {
            return Err(StopReason::Failed { why });
        }
        self.control
            .reject(dt, &why, error_order)
            .ok_or(StopReason::StepTooSmall { dt, last: why })
    }

    /// Why this cannot be a run that began with `control` and is followed until `until`; `None` if it can. For one read from a
    /// file.
    pub fn flaw(&self, control: &StepControl, until: f64) -> Option<&'static str> {
        let refused = self.rejections.iter().map(|(_, n)| n);
        let mut counts = refused.chain([self.n_steps, self.n_trials]);
        if !(0.0..=until).contains(&self.time) || !self.last_dt.is_finite() {
            Some("its time is none of this run")
        } else if !control.leads_to(&self.control) {
            Some("the step control is one of another run")
        } else if counts.any(|n| n >= MOST_COUNTED) {
            Some("a counter is out of range")
        } else {
            None
        }
    }

    /// Resets the count of trial steps.
    pub fn restart_trials(&mut self) {
        self.n_trials = 0;
    }

    /// Time reached, in the model's unit.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Length of the last accepted step; 0 before the first.
    pub fn last_dt(&self) -> f64 {
        self.last_dt
    }

    /// Accepted steps so far.
    pub fn n_steps(&self) -> u64 {
        self.n_steps
    }

    /// Trial steps, accepted or not, since the count was last reset.
    pub fn n_trials(&self) -> u64 {
        self.n_trials
    }

    /// Refused steps so far, by name.
    pub fn rejections(&self) -> &RejectionCounts {
        &self.rejections
    }

    /// Step control.
    pub fn control(&self) -> &StepControl {
        &self.control
    }

    /// Step control, to be changed between runs.
    pub fn control_mut(&mut self) -> &mut StepControl {
        &mut self.control
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps without error, at most 0.3 long; those above a limit are refused.
    #[derive(Default)]
    struct Steady {
        lengths: Vec<f64>,
        clipped: bool,
        most: Option<f64>,
    }

    impl Advance for Steady {
        fn longest_step(&mut self) -> Result<f64, Rejection> {
            Ok(0.3)
        }
        fn trial_length(&self, dt: f64, time: f64, target: f64) -> f64 {
            if self.clipped {
                dt.min(target - time)
            } else {
                in_halves(dt, target - time)
            }
        }
        fn try_step(&mut self, _: f64, dt: f64, control: &StepControl) -> Result<f64, Rejection> {
            control.judge(0.0)?;
            match self.most {
                Some(most) if dt > most => Err(Rejection::Domain { what: "planted" }),
                _ => Ok(0.0),
            }
        }
        fn accept(&mut self, dt: f64) {
            self.lengths.push(dt);
        }
        fn error_order(&self) -> u32 {
            2
        }
    }

    fn to_one(system: &mut Steady) -> TimeStepping {
        let mut steps = TimeStepping::new(StepControl::new(1e-3, 0.5).unwrap());
        while steps.time() < 1.0 {
            steps.step_towards(1.0, system).unwrap();
        }
        steps
    }

    #[test]
    fn steps_end_on_the_target_to_the_bit() {
        for (clipped, lengths) in [(false, [0.3, 0.3, 0.2, 0.2]), (true, [0.3, 0.3, 0.3, 0.1])] {
            let mut system = Steady {
                clipped,
                ..Steady::default()
            };
            let steps = to_one(&mut system);
            assert_eq!(
                (steps.time(), steps.n_steps(), steps.n_trials()),
                (1.0, 4, 4)
            );
            assert_eq!(system.lengths.len(), lengths.len());
            for (found, expected) in system.lengths.iter().zip(lengths) {
                assert!((found - expected).abs() < 1e-15, "{found} of {expected}");
            }
            assert_eq!(steps.last_dt(), system.lengths[3]);
        }
    }

    #[test]
    fn refused_steps_are_followed_by_shorter_ones_and_counted() {
        let mut system = Steady {
            most: Some(0.1),
            ..Steady::default()
        };
        let steps = to_one(&mut system);
        // 0.3 and 0.15 are refused, 0.075 is not.
        assert_eq!(system.lengths[0], 0.075);
        assert!(system.lengths.iter().all(|dt| *dt <= 0.1));
        assert!(steps.rejections().count("domain") >= 2);
        let refused = steps.rejections().total();
        assert_eq!(steps.n_trials(), steps.n_steps() + refused);
    }

    #[test]
    fn reasons_to_stop_leave_the_state() {
        let control = StepControl::new(1e-3, 0.5).unwrap();
        let mut steps = TimeStepping::new(control.with_max_trials(2));
        let mut system = Steady {
            most: Some(0.0),
            ..Steady::default()
        };
        let stop = steps.step_towards(1.0, &mut system);
        assert_eq!(stop, Err(StopReason::StepLimit { n: 2 }));
        assert_eq!((steps.time(), system.lengths.len()), (0.0, 0));
        steps.restart_trials();
        system.most = None;
        assert_eq!(steps.step_towards(1.0, &mut system), Ok(()));
    }

    #[test]
    fn a_later_moment_of_the_run_is_recognised() {
        let control = StepControl::new(1e-3, 0.5).unwrap();
        let later = to_one(&mut Steady::default());
        assert_eq!(later.flaw(&control, 1.0), None);
        assert!(later.flaw(&control, 0.5).unwrap().contains("time"));
        let another = StepControl::new(2e-3, 0.5).unwrap();
        assert!(later.flaw(&another, 1.0).unwrap().contains("step control"));
        let broken = TimeStepping {
            n_steps: u64::MAX,
            ..later
        };
        assert!(broken.flaw(&control, 1.0).unwrap().contains("counter"));
    }
}
