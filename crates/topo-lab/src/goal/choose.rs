//! Which measured setting meets a goal.

use super::Goal;
use super::choice::{Choice, Point};
use super::record::Measured;
use crate::cost::EFFICIENCY;

/// Estimates without a recorded factor: what is doubled is seldom too small.
const UNKNOWN_SCALE: f64 = 2.0;

/// What the cases of a scene cost, in units of the cases that the table was measured on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Load {
    /// Cases, each with its weight.
    pub cases: f64,
    /// Threads.
    pub threads: usize,
}

/// Picks the cheapest setting that is accurate enough, or the most accurate one that is cheap enough.
///
/// # Errors
/// What is possible instead.
///
/// # Validation
/// `the_cheapest_that_is_good_enough`, `the_best_that_is_cheap_enough`
pub(crate) fn choose(table: Measured, goal: Goal, load: Load) -> Result<Choice, String> {
    let factor = table.record().and_then(|r| r.factor);
    let scale = factor.map_or(UNKNOWN_SCALE, |f| f.scale);
    let chosen = choose_from(&table.points(), scale, goal, load)?;
    Ok(Choice {
        unit: table.unit(),
        stale: table.stale(),
        ..chosen
    })
}

pub(super) fn choose_from(
    points: &[Point],
    scale: f64,
    goal: Goal,
    load: Load,
) -> Result<Choice, String> {
    let seconds = |p: &Point| load.cases * p.cpu_seconds;
    let choice = |p: &Point| Choice {
        goal,
        point: *p,
        unit: "",
        scale,
        stale: None,
        cpu_seconds: seconds(p),
    };
    match goal {
        Goal::Accuracy(error) => {
            let good = points.iter().filter(|p| p.high_error <= error);
            let cheapest = good.min_by(|a, b| seconds(a).total_cmp(&seconds(b)));
            cheapest.map(choice).ok_or_else(|| {
                let best = points.iter().map(|p| p.high_error).fold(1.0, f64::min);
                // rounded up, so that what is said can be asked for
                let best = (best * 1e4).ceil() / 1e4;
                format!(
                    "the most accurate setting measured is off by up to {best} in nine cases of ten: ask for accuracy = {best} or more, or give settings in a table [accuracy]"
                )
            })
        }
        Goal::Budget(budget) => {
            let held = budget * load.threads as f64 * EFFICIENCY;
            let cheap = points.iter().filter(|p| seconds(p) <= held);
            let best = cheap.min_by(|a, b| a.high_error.total_cmp(&b.high_error));
            best.map(choice).ok_or_else(|| {
                let least = points.iter().map(seconds).fold(f64::INFINITY, f64::min);
                let least = (least / (load.threads as f64 * EFFICIENCY)).ceil();
                format!("the cheapest setting measured takes about {least:.0} s: give as much, or ask for fewer cases")
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(resolution: f64, high_error: f64, cpu_seconds: f64) -> Point {
        Point {
            resolution,
            tolerance: 1e-3,
            median_error: 0.4 * high_error,
            high_error,
            cpu_seconds,
            peak_bytes: 1,
            check_resolution: 0.5 * resolution,
            check_tolerance: 1e-3,
            n_cases: 9,
        }
    }

    fn table() -> [Point; 3] {
        [
            point(100.0, 0.08, 0.2),
            point(200.0, 0.015, 0.8),
            point(400.0, 0.002, 4.0),
        ]
    }

    const LOAD: Load = Load {
        cases: 10.0,
        threads: 2,
    };

    #[test]
    fn the_cheapest_that_is_good_enough() {
        let of = |error| choose_from(&table(), 1.5, Goal::Accuracy(error), LOAD);
        assert_eq!(of(0.1).unwrap().point.resolution, 100.0);
        assert_eq!(of(0.05).unwrap().point.resolution, 200.0);
        let fine = of(0.002).unwrap();
        assert_eq!(fine.point.resolution, 400.0);
        assert!((fine.cpu_seconds - 40.0).abs() < 1e-9, "ten cases");
        assert_eq!(fine.scale, 1.5);
        let refused = of(0.001).unwrap_err();
        assert!(
            refused.contains("accuracy = 0.002 or more") && refused.contains("[accuracy]"),
            "{refused}"
        );
    }

    #[test]
    fn a_cheaper_setting_that_is_finer_is_taken() {
        let mut points = table();
        points[1].cpu_seconds = 9.0;
        let chosen = choose_from(&points, 1.5, Goal::Accuracy(0.02), LOAD).unwrap();
        assert_eq!(chosen.point.resolution, 400.0);
        let chosen = choose_from(&points, 1.5, Goal::Budget(100.0), LOAD).unwrap();
        assert_eq!(chosen.point.resolution, 400.0);
        // what is just possible is chosen; else the message says what is possible
        points[2].high_error = 0.01234;
        for (asked, is_possible) in [(0.01234, true), (0.0124, true), (0.0123, false)] {
            let found = choose_from(&points, 1.5, Goal::Accuracy(asked), LOAD);
            assert_eq!(found.is_ok(), is_possible);
            if let Err(reason) = found {
                assert!(reason.contains("accuracy = 0.0124 or more"), "{reason}");
            }
        }
    }

    #[test]
    fn the_best_that_is_cheap_enough() {
        let of = |seconds| choose_from(&table(), 1.5, Goal::Budget(seconds), LOAD);
        assert_eq!(of(100.0).unwrap().point.resolution, 400.0);
        assert_eq!(of(10.0).unwrap().point.resolution, 200.0);
        assert_eq!(of(2.0).unwrap().point.resolution, 100.0);
        let refused = of(1.0).unwrap_err();
        assert!(refused.contains("2 s"), "{refused}");
    }
}
