//! Observers, which see a run and never change it, and the schedules that say when.

use serde::{Deserialize, Serialize};

use crate::check::{InvalidValue, finite, non_negative, positive};
use crate::ledger::Ledger;

/// What an observer sees.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a, S> {
    /// Time, in the model's unit.
    pub time: f64,
    /// Accepted steps so far.
    pub step: u64,
    /// Length of the last accepted step, in the model's unit of time; 0 before the first.
    pub dt: f64,
    /// The state.
    pub state: &'a S,
    /// Where the energy is and where it went; empty when the model keeps no ledger.
    pub ledger: &'a Ledger,
}

/// Something that observes a run at scheduled times.
pub trait Observer<S> {
    /// Looks at one sample.
    fn observe(&mut self, sample: &Sample<'_, S>);
}

impl<S, F: FnMut(&Sample<'_, S>)> Observer<S> for F {
    fn observe(&mut self, sample: &Sample<'_, S>) {
        self(sample);
    }
}

/// An observer with its schedule.
pub struct Scheduled<'a, S> {
    schedule: Schedule,
    observer: &'a mut dyn Observer<S>,
}

impl<'a, S> Scheduled<'a, S> {
    /// Lets `observer` look whenever `schedule` is due.
    pub fn new(schedule: Schedule, observer: &'a mut dyn Observer<S>) -> Self {
        Self { schedule, observer }
    }

    /// Shows `sample` if the schedule is due.
    pub fn offer(&mut self, sample: &Sample<'_, S>) {
        if self.schedule.due(sample.time, sample.step) {
            self.observer.observe(sample);
        }
    }

    /// The schedule.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }
}

impl<S> std::fmt::Debug for Scheduled<'_, S> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Scheduled")
            .field("schedule", &self.schedule)
            .finish_non_exhaustive()
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Kind {
    Always,
    EverySteps(u64),
    Every(f64),
    Times(Vec<f64>),
    LogSpaced { first: f64, per_decade: f64 },
}

/// When to look: at every step, every n steps, or at the first accepted step at or past each scheduled time.
///
/// Times are not met to the bit unless the schedule is [`exact`](Self::exact), which shortens steps to end on them: states
/// updated by retractions cannot be interpolated, and a step shortened for output alone changes the run. Several
/// scheduled times passed in one step make one observation; samples carry their true time.
///
/// # Validation
/// `each_kind_is_due_when_it_should_be`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Schedule {
    kind: Kind,
    exact: bool,
    /// Number of the next scheduled time.
    next: u64,
    last_step: Option<u64>,
}

impl Schedule {
    fn of(kind: Kind) -> Self {
        Self {
            kind,
            exact: false,
            next: 0,
            last_step: None,
        }
    }

    /// At every accepted step, and at the start.
    pub fn always() -> Self {
        Self::of(Kind::Always)
    }

    /// Every `n_steps` accepted steps, and at the start; 0 counts as 1.
    pub fn every_steps(n_steps: u64) -> Self {
        Self::of(Kind::EverySteps(n_steps.max(1)))
    }

    /// At the times 0, `interval`, 2 `interval` and so on.
    ///
    /// # Errors
    /// [`InvalidValue`] when `interval` is not a positive finite number.
    pub fn every(interval: f64) -> Result<Self, InvalidValue> {
        Ok(Self::of(Kind::Every(positive("interval", interval)?)))
    }

    /// At the given `times`, in any order.
    ///
    /// # Errors
    /// [`InvalidValue`] when a time is not finite.
    pub fn at(times: &[f64]) -> Result<Self, InvalidValue> {
        let mut times = times.to_vec();
        for time in &times {
            finite("output time", *time)?;
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        Ok(Self::of(Kind::Times(times)))
    }

    /// At time 0 and at `first` * 10^(k / `per_decade`), k = 0, 1, 2, ...: evenly dense in log t.
    ///
    /// # Errors
    /// [`InvalidValue`] when an argument is not a positive finite number, or `per_decade` exceeds 10^6.
    pub fn log_spaced(first: f64, per_decade: f64) -> Result<Self, InvalidValue> {
        positive("first", first)?;
        positive("per_decade", per_decade)?;
        non_negative("1e6 - per_decade", 1e6 - per_decade)?;
        Ok(Self::of(Kind::LogSpaced { first, per_decade }))
    }

    /// The same schedule, with steps shortened to end on its times.
    pub fn exact(mut self) -> Self {
        self.exact = true;
        self
    }

    /// Whether `later` is this schedule after some of its times have passed.
    pub fn leads_to(&self, later: &Self) -> bool {
        self.kind == later.kind && self.exact == later.exact && self.next <= later.next
    }

    /// Whether to look at the state reached at `time` after `step` steps; each step is due once at most.
    pub fn due(&mut self, time: f64, step: u64) -> bool {
        if self.last_step == Some(step) {
            return false;
        }
        let due = match &self.kind {
            Kind::Always => true,
            Kind::EverySteps(n) => step.is_multiple_of(*n),
            _ => self.scheduled(self.next).is_some_and(|next| time >= next),
        };
        if due {
            self.last_step = Some(step);
            self.next = self.next.max(self.first_after(time));
        }
        due
    }

    /// Next time at which a step has to end, if the schedule is exact.
    pub fn next_exact(&self) -> Option<f64> {
        if self.exact {
            self.scheduled(self.next)
        } else {
            None
        }
    }

    /// Scheduled time number `k`.
    fn scheduled(&self, k: u64) -> Option<f64> {
        match &self.kind {
            Kind::Always | Kind::EverySteps(_) => None,
            Kind::Every(interval) => Some(interval * k as f64),
            Kind::Times(times) => times.get(usize::try_from(k).ok()?).copied(),
            // Number 0 is the start.
            Kind::LogSpaced { .. } if k == 0 => Some(0.0),
            Kind::LogSpaced { first, per_decade } => {
                Some(first * 10_f64.powf((k - 1) as f64 / per_decade))
            }
        }
    }

    /// Number of the first scheduled time after `time`.
    fn first_after(&self, time: f64) -> u64 {
        let guess = match &self.kind {
            Kind::Always | Kind::EverySteps(_) => return 0,
            Kind::Times(times) => return times.partition_point(|t| *t <= time) as u64,
            Kind::Every(interval) => (time / interval).floor(),
            Kind::LogSpaced { first, per_decade } => {
                ((time / first).log10() * per_decade).floor() + 1.0
            }
        };
        // The guess is at most a rounding too low or too high; the cast saturates.
        let mut k = (guess.max(1.0) as u64).saturating_sub(1).max(self.next);
        for _ in 0..4 {
            if self.scheduled(k).is_some_and(|t| t <= time) {
                k = k.saturating_add(1);
            }
        }
        k
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn due_times(mut schedule: Schedule, dt: f64, n: u64) -> Vec<u64> {
        (0..n)
            .filter(|step| schedule.due(dt * *step as f64, *step))
            .collect()
    }

    #[test]
    fn each_kind_is_due_when_it_should_be() {
        assert_eq!(due_times(Schedule::always(), 1.0, 4), [0, 1, 2, 3]);
        assert_eq!(due_times(Schedule::every_steps(3), 1.0, 8), [0, 3, 6]);
        assert_eq!(due_times(Schedule::every_steps(0), 1.0, 2), [0, 1]);
        assert_eq!(
            due_times(Schedule::every(2.5).unwrap(), 1.0, 11),
            [0, 3, 5, 8, 10]
        );
        assert_eq!(due_times(Schedule::every(0.1).unwrap(), 1.0, 3), [0, 1, 2]);
        assert_eq!(
            due_times(Schedule::at(&[7.0, 2.5, 2.6, 2.5]).unwrap(), 1.0, 20),
            [3, 7]
        );
        // 1, 10^(1/2), 10, 10^(3/2).
        assert_eq!(
            due_times(Schedule::log_spaced(1.0, 2.0).unwrap(), 1.0, 40),
            [0, 1, 4, 10, 32]
        );
    }

    #[test]
    fn a_step_is_seen_once() {
        let mut schedule = Schedule::always();
        assert!(schedule.due(0.0, 0) && !schedule.due(0.0, 0) && schedule.due(1.0, 1));
    }

    #[test]
    fn a_schedule_leads_to_its_own_later_self_only() {
        let fresh = Schedule::log_spaced(1.0, 2.0).unwrap();
        let mut later = fresh.clone();
        assert!(later.due(5.0, 3));
        assert!(fresh.leads_to(&later) && !later.leads_to(&fresh));
        assert!(!fresh.leads_to(&Schedule::log_spaced(1.0, 3.0).unwrap()));
        assert!(!fresh.leads_to(&fresh.clone().exact()));
    }

    #[test]
    fn exact_schedules_name_the_next_time() {
        let mut schedule = Schedule::every(0.3).unwrap().exact();
        assert_eq!(schedule.next_exact(), Some(0.0));
        for k in 0..1000_u64 {
            let next = schedule.next_exact().unwrap();
            assert_eq!(next, 0.3 * k as f64);
            assert!(schedule.due(next, k));
        }
        assert_eq!(Schedule::every(0.3).unwrap().next_exact(), None);
        let mut logarithmic = Schedule::log_spaced(1e-3, 7.0).unwrap().exact();
        let mut last = -1.0;
        for k in 0..100 {
            let next = logarithmic.next_exact().unwrap();
            assert!(next > last);
            last = next;
            assert!(logarithmic.due(next, k));
        }
        // 10^(61/20) after a jump over sixty
        let mut dense = Schedule::log_spaced(1e-3, 20.0).unwrap().exact();
        assert!(dense.due(1.05, 0));
        assert!((dense.next_exact().unwrap() / 1.122_018_454_301_963 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn broken_schedules_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Schedule::every(bad).is_err());
            assert!(
                Schedule::log_spaced(bad, 5.0).is_err() && Schedule::log_spaced(1.0, bad).is_err()
            );
        }
        assert!(Schedule::at(&[1.0, f64::NAN]).is_err());
    }

    proptest::proptest! {
        #[test]
        fn any_time_is_answered(time in proptest::num::f64::ANY, unit in 1e-300_f64..1e300, step: u64) {
            for mut schedule in [Schedule::every(unit).unwrap(), Schedule::log_spaced(unit, 10.0).unwrap()] {
                let due = schedule.due(time, step);
                proptest::prop_assert!(due == (time >= 0.0));
                if due && time < 1e15 * unit {
                    proptest::prop_assert!(schedule.exact().next_exact().unwrap() > time);
                }
            }
        }
    }
}
