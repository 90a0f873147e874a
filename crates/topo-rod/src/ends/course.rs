//! How the ends of an open rod are moved and loaded in time.

use std::borrow::Cow;

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{EndCondition, EndMotion, Ends};
use crate::RodError;

/// A number in time: linear between the times that it names, and constant after the last.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum TimeCourse {
    /// The same at all times.
    Constant(f64),
    /// From 0 in a straight line to a value, which it keeps.
    Ramp(Ramp),
    /// Times, the first of them 0, and values.
    Table(Vec<[f64; 2]>),
}

/// A straight line from 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    /// Value at its end.
    #[schemars(extend("x-unit" = "as the key"), example = 20.0)]
    pub to: f64,
    /// Time that it takes.
    #[schemars(extend("x-unit" = "T_0", "exclusiveMinimum" = 0), example = 50.0)]
    pub over: f64,
}

impl Default for TimeCourse {
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

impl TimeCourse {
    /// Times and values, in order of time.
    fn points(&self) -> Cow<'_, [[f64; 2]]> {
        match self {
            Self::Constant(value) => vec![[0.0, *value]].into(),
            Self::Ramp(ramp) => vec![[0.0, 0.0], [ramp.over, ramp.to]].into(),
            Self::Table(points) => points.into(),
        }
    }

    /// Times at which its rate may change.
    pub(crate) fn times(&self) -> impl Iterator<Item = f64> {
        let points = self.points().into_owned();
        points.into_iter().map(|p| p[0])
    }

    /// Value at a time.
    pub fn at(&self, time: f64) -> f64 {
        let points = self.points();
        let behind = points.partition_point(|p| p[0] <= time);
        match (behind.checked_sub(1).map(|k| points[k]), points.get(behind)) {
            (Some([t, x]), Some([next, y])) => x + (y - x) * (time - t) / (next - t),
            (Some([_, x]), None) => x,
            (None, first) => first.map_or(0.0, |p| p[1]),
        }
    }

    /// Rate from a time on, until the next of its times.
    fn rate_after(&self, time: f64) -> f64 {
        let points = self.points();
        let behind = points.partition_point(|p| p[0] <= time);
        match (behind.checked_sub(1).map(|k| points[k]), points.get(behind)) {
            (Some([t, x]), Some([next, y])) => (y - x) / (next - t),
            _ => 0.0,
        }
    }

    fn is_zero(&self) -> bool {
        self.points().iter().all(|p| p[1] == 0.0)
    }

    /// The same with its times in another unit, of which one of the present unit is `unit`.
    pub(crate) fn scaled(&self, unit: f64) -> Self {
        let points = self.points();
        Self::Table(points.iter().map(|[t, x]| [t * unit, *x]).collect())
    }

    pub(crate) fn checked(&self, key: &'static str, begins_at_zero: bool) -> Result<(), RodError> {
        let wrong = |reason| Err(RodError::Course { key, reason });
        let points = self.points();
        if points.iter().flatten().any(|x| !x.is_finite()) {
            return wrong("every time and value must be a finite number");
        }
        if let Self::Ramp(ramp) = self
            && ramp.over <= 0.0
        {
            return wrong("a ramp takes a time above zero");
        }
        match points.first() {
            None => return wrong("a table needs at least one [time, value]"),
            Some([t, _]) if *t != 0.0 => return wrong("the first time of a table is 0"),
            Some([_, x]) if begins_at_zero && *x != 0.0 => {
                return wrong(
                    "it counts from the start and begins at 0: write a ramp { to = .., over = .. } or a table that begins with [0, 0]",
                );
            }
            _ => {}
        }
        if points.windows(2).any(|w| w[1][0] <= w[0][0]) {
            return wrong(
                "the times of a table must grow from row to row: put its rows in the order of time, each time once",
            );
        }
        Ok(())
    }
}

/// How one end is held, moved and loaded in time; free and unloaded by default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Grip {
    /// How it is held, until it is released.
    #[schemars(example = EndCondition::Clamped)]
    pub condition: EndCondition,
    /// Displacement of a held end from its start.
    #[schemars(extend("x-unit" = "h", "examples" = [[{ "to": 20.0, "over": 50.0 }, 0.0, 0.0]]))]
    pub displacement: [TimeCourse; 3],
    /// Rotation of a clamped end about its tangent, in radians.
    #[schemars(extend("x-unit" = "rad", "examples" = [{ "to": 6.0, "over": 10.0 }]))]
    pub rotation: TimeCourse,
    /// Force on a free end, per area.
    #[schemars(extend("x-unit" = "E_b", "examples" = [[[[0.0, 0.0], [10.0, 0.01]], 0.0, 0.0]]))]
    pub force: [TimeCourse; 3],
    /// Torque about the tangent on an end that is not clamped, per area.
    #[schemars(extend("x-unit" = "E_b h"), example = 0.1)]
    pub torque: TimeCourse,
    /// Time from which on nothing holds, moves or loads it.
    #[schemars(extend("x-unit" = "T_0", "x-default" = "never"), example = 60.0)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub released: Option<f64>,
}

impl Grip {
    /// Whether it does nothing at all.
    pub fn is_free(&self) -> bool {
        *self == Self::default()
    }

    fn courses(&self) -> impl Iterator<Item = (&'static str, &TimeCourse, bool)> {
        let of = |key, begins| move |c| (key, c, begins);
        let moved = self.displacement.iter().map(of("displacement", true));
        let pushed = self.force.iter().map(of("force", false));
        moved
            .chain([("rotation", &self.rotation, true)])
            .chain(pushed)
            .chain([("torque", &self.torque, false)])
    }

    fn checked(&self) -> Result<(), RodError> {
        for (key, course, begins_at_zero) in self.courses() {
            course.checked(key, begins_at_zero)?;
        }
        if let Some(time) = self.released {
            topo_core::positive("released", time)?;
        }
        Ok(())
    }

    fn scaled(&self, unit: f64) -> Self {
        Self {
            condition: self.condition,
            displacement: self.displacement.each_ref().map(|c| c.scaled(unit)),
            rotation: self.rotation.scaled(unit),
            force: self.force.each_ref().map(|c| c.scaled(unit)),
            torque: self.torque.scaled(unit),
            released: self.released.map(|t| t * unit),
        }
    }

    /// Whether it has let go at a time.
    fn is_off(&self, time: f64) -> bool {
        self.released.is_some_and(|released| time >= released)
    }

    /// Condition and motion from a time on, and how its force and torque change.
    fn after(&self, time: f64) -> (EndCondition, EndMotion, EndMotion) {
        if self.is_off(time) {
            return Default::default();
        }
        let motion = EndMotion {
            velocity: self.displacement.each_ref().map(|c| c.rate_after(time)),
            rotation_rate: self.rotation.rate_after(time),
            force: self.force.each_ref().map(|c| c.at(time)),
            torque: self.torque.at(time),
        };
        let change = EndMotion {
            force: self.force.each_ref().map(|c| c.rate_after(time)),
            torque: self.torque.rate_after(time),
            ..EndMotion::default()
        };
        (self.condition, motion, change)
    }
}

/// The grips of both ends in time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GripSchedule {
    grips: [Grip; 2],
    /// Times at which something changes, ascending, the first of them 0.
    breaks: Vec<f64>,
}

/// What holds and draws both ends between two such times.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct GripSegment {
    pub(crate) ends: Ends,
    start: f64,
    change: [EndMotion; 2],
}

impl GripSchedule {
    /// That of `grips`, whose times are in units of `unit`.
    ///
    /// # Errors
    /// Numbers out of order or range, a contradiction, or forces on a free rod that do not balance at some time.
    pub(crate) fn new(grips: &[Grip; 2], unit: f64, has_twist: bool) -> Result<Self, RodError> {
        grips.iter().try_for_each(Grip::checked)?;
        for grip in grips {
            let wrong = |reason| Err(RodError::Ends { reason });
            let moves = grip.displacement.iter().any(|c| !c.is_zero());
            let pushed = grip.force.iter().any(|c| !c.is_zero());
            match grip.condition {
                EndCondition::Free if moves => {
                    return wrong("a free end has no prescribed displacement: pin or clamp it");
                }
                EndCondition::Pinned | EndCondition::Clamped if pushed => {
                    return wrong("a held end takes no force: free it");
                }
                EndCondition::Free | EndCondition::Pinned if !grip.rotation.is_zero() => {
                    return wrong("only a clamped end has a prescribed rotation: clamp it");
                }
                EndCondition::Clamped if !grip.torque.is_zero() => {
                    return wrong("a clamped end takes no torque: pin or free it");
                }
                _ => {}
            }
        }
        let grips = grips.each_ref().map(|grip| grip.scaled(unit));
        let mut breaks: Vec<f64> = grips
            .iter()
            .flat_map(|grip| {
                let released = grip.released;
                let times = grip.courses().flat_map(|(_, c, _)| c.times());
                let acting = times.filter(move |t| released.is_none_or(|r| *t < r));
                acting.chain(released).collect::<Vec<f64>>()
            })
            .chain([0.0])
            .collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let schedule = Self { grips, breaks };
        for (k, &start) in schedule.breaks.iter().enumerate() {
            let segment = schedule.segment(start);
            segment.ends.checked(has_twist)?;
            let end = schedule.breaks.get(k + 1).copied().unwrap_or(start + 1.0);
            segment.ends_at(end).checked(has_twist)?;
        }
        Ok(schedule)
    }

    /// When the segment after `segment` begins.
    pub(crate) fn next_break(&self, segment: &GripSegment) -> Option<f64> {
        self.breaks.iter().copied().find(|t| *t > segment.start)
    }

    /// What holds and draws the ends just before `time`.
    pub(crate) fn segment_before(&self, time: f64) -> GripSegment {
        let behind = self.breaks.partition_point(|t| *t < time);
        self.segment(self.breaks[behind.max(1) - 1])
    }

    /// What holds and draws the ends from `time` on.
    pub(crate) fn segment(&self, time: f64) -> GripSegment {
        let behind = self.breaks.partition_point(|t| *t <= time);
        let start = self.breaks[behind.max(1) - 1];
        let [a, b] = self.grips.each_ref().map(|grip| grip.after(start));
        GripSegment {
            ends: Ends {
                conditions: [a.0, b.0],
                motions: [a.1, b.1],
            },
            start,
            change: [a.2, b.2],
        }
    }
}

impl GripSegment {
    /// The ends with their force and torque at a time.
    pub(crate) fn ends_at(&self, time: f64) -> Ends {
        let mut ends = self.ends;
        for (motion, change) in ends.motions.iter_mut().zip(&self.change) {
            let passed = time - self.start;
            let force = Vector3::from(motion.force) + Vector3::from(change.force) * passed;
            motion.force = force.into();
            motion.torque += change.torque * passed;
        }
        ends
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn courses_are_linear_between_their_times() {
        let table = TimeCourse::Table(vec![[0.0, 1.0], [2.0, 5.0], [3.0, 5.0]]);
        for (time, value, rate) in [
            (0.0, 1.0, 2.0),
            (1.0, 3.0, 2.0),
            (2.0, 5.0, 0.0),
            (9.0, 5.0, 0.0),
        ] {
            assert_eq!((table.at(time), table.rate_after(time)), (value, rate));
        }
        let ramp = TimeCourse::Ramp(Ramp { to: 4.0, over: 8.0 });
        assert_eq!(
            (ramp.at(2.0), ramp.at(10.0), ramp.rate_after(8.0)),
            (1.0, 4.0, 0.0)
        );
        assert_eq!(ramp.scaled(10.0).at(20.0), 1.0);
        let constant = TimeCourse::Constant(3.0);
        assert_eq!((constant.at(7.0), constant.rate_after(0.0)), (3.0, 0.0));
    }

    #[test]
    fn a_schedule_changes_at_its_times_and_lets_go() {
        let drawn = Grip {
            condition: EndCondition::Clamped,
            displacement: [
                TimeCourse::Ramp(Ramp { to: 6.0, over: 3.0 }),
                TimeCourse::default(),
                TimeCourse::default(),
            ],
            released: Some(5.0),
            ..Grip::default()
        };
        let held = Grip {
            condition: EndCondition::Pinned,
            ..Grip::default()
        };
        let schedule = GripSchedule::new(&[drawn, held], 2.0, true).unwrap();
        assert_eq!(schedule.breaks, [0.0, 6.0, 10.0]);
        assert_eq!(
            schedule.segment(0.0).ends.motions[0].velocity,
            [1.0, 0.0, 0.0]
        );
        assert_eq!(schedule.segment(6.0).ends.motions[0].velocity, [0.0; 3]);
        assert_eq!(
            schedule.segment(10.0).ends.conditions,
            [EndCondition::Free, EndCondition::Pinned]
        );
        let next = |time| schedule.next_break(&schedule.segment(time));
        assert_eq!((next(6.0), next(10.0)), (Some(10.0), None));
        assert_eq!(schedule.segment_before(6.0), schedule.segment(0.0));
    }

    #[test]
    fn what_is_out_of_order_is_refused() {
        let refused = |grip: Grip, word: &str| {
            let other = Grip {
                condition: EndCondition::Clamped,
                ..Grip::default()
            };
            let error = GripSchedule::new(&[grip, other], 1.0, true)
                .expect_err(word)
                .to_string();
            assert!(error.contains(word), "{error}");
        };
        let force = |table: &[[f64; 2]]| Grip {
            force: [
                TimeCourse::Table(table.to_vec()),
                TimeCourse::default(),
                TimeCourse::default(),
            ],
            ..Grip::default()
        };
        refused(
            force(&[[0.0, 0.0], [2.0, 1.0], [1.0, 1.0]]),
            "order of time",
        );
        refused(force(&[[1.0, 0.0]]), "first time");
        refused(force(&[]), "at least one");
        refused(force(&[[0.0, f64::NAN]]), "finite");
        let rotation = TimeCourse::Constant(1.0);
        refused(
            Grip {
                rotation,
                ..Grip::default()
            },
            "begins at 0",
        );
        let rotation = TimeCourse::Ramp(Ramp { to: 1.0, over: 1.0 });
        refused(
            Grip {
                rotation,
                ..Grip::default()
            },
            "clamp it",
        );
    }
}
