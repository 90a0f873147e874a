//! Which measured setting grants a wish.

use serde::Serialize;

use super::Wish;
use super::table::{Measured, Point};
use crate::cost::EFFICIENCY;

/// A wish with the setting that grants it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Grant {
    /// What was asked for.
    pub wish: Wish,
    /// The setting and what was measured of it.
    pub point: Point,
    /// Processor seconds expected, the runs included that tell the error.
    pub cpu_seconds: f64,
}

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
/// What can be had instead.
///
/// # Validation
/// `the_cheapest_that_is_good_enough`, `the_best_that_is_cheap_enough`
pub(crate) fn grant(table: Measured, wish: Wish, load: Load) -> Result<Grant, String> {
    choose(&table.points(), wish, load)
}

fn choose(points: &[Point], wish: Wish, load: Load) -> Result<Grant, String> {
    let seconds = |p: &Point| {
        let check = points
            .iter()
            .find(|o| (o.resolution, o.tolerance) == (p.check_resolution, p.check_tolerance));
        // the coarsest are in the table as checks only: they cost less than half
        load.cases * (p.cpu_seconds + check.map_or(0.5 * p.cpu_seconds, |c| c.cpu_seconds))
    };
    let granted = |p: &Point| Grant {
        wish,
        point: *p,
        cpu_seconds: seconds(p),
    };
    match wish {
        Wish::Accuracy(error) => {
            let good = points.iter().filter(|p| p.high_error <= error);
            let cheapest = good.min_by(|a, b| seconds(a).total_cmp(&seconds(b)));
            cheapest.map(granted).ok_or_else(|| {
                let best = points.iter().map(|p| p.high_error).fold(1.0, f64::min);
                format!(
                    "the most accurate setting measured is off by {best:.1e} in a tenth of the cases: ask for that at most, or give settings in a table [accuracy]"
                )
            })
        }
        Wish::Budget(budget) => {
            let held = budget * load.threads as f64 * EFFICIENCY;
            let cheap = points.iter().filter(|p| seconds(p) <= held);
            let best = cheap.min_by(|a, b| a.high_error.total_cmp(&b.high_error));
            best.map(granted).ok_or_else(|| {
                let least = points.iter().map(seconds).fold(f64::INFINITY, f64::min);
                let least = least / (load.threads as f64 * EFFICIENCY);
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
            scale: 1.0,
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
        let of = |error| choose(&table(), Wish::Accuracy(error), LOAD);
        assert_eq!(of(0.1).unwrap().point.resolution, 100.0);
        assert_eq!(of(0.05).unwrap().point.resolution, 200.0);
        let fine = of(0.002).unwrap();
        assert_eq!(fine.point.resolution, 400.0);
        assert!(
            (fine.cpu_seconds - 48.0).abs() < 1e-9,
            "with its check at 200"
        );
        let refused = of(0.001).unwrap_err();
        assert!(
            refused.contains("2.0e-3") && refused.contains("[accuracy]"),
            "{refused}"
        );
    }

    #[test]
    fn the_best_that_is_cheap_enough() {
        let of = |seconds| choose(&table(), Wish::Budget(seconds), LOAD);
        assert_eq!(of(100.0).unwrap().point.resolution, 400.0);
        assert_eq!(of(10.0).unwrap().point.resolution, 200.0);
        assert_eq!(of(2.0).unwrap().point.resolution, 100.0);
        let refused = of(1.0).unwrap_err();
        assert!(refused.contains("2 s"), "{refused}");
    }
}
