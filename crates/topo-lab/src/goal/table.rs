//! The measured table: what a resolution and a tolerance cost, and how far off they are.

use super::choice::Point;
use super::pair::{Measurement, cases, quantity};
use super::setting::Setting;
use crate::system::System;
use crate::tradeoff::{TradeoffRow, ladder_of};
use topo_analysis::{median, quantile};

/// A coarser run should be coarser by more than this: differences to nearer ones are rather those of how a sphere falls on the
/// lattice, or of ties of contacts.
const COARSER: f64 = 1.6;

/// Settings of a ladder from coarse to fine, each with the finest that is enough coarser, or with the coarsest.
fn settings(ladder: &[(f64, f64)]) -> Vec<Setting> {
    let beside = |k: usize| {
        let fine = ladder[k];
        let with = |&coarse: &(f64, f64)| Setting { fine, coarse };
        let all = || ladder[..k].iter().rev().map(with);
        let enough = all().find(|s| s.ratio() > COARSER);
        enough.or_else(|| all().next_back())
    };
    (0..ladder.len()).filter_map(beside).collect()
}

/// The settings that goals choose from, as a trade-off measured them, from coarse to fine.
///
/// # Validation
/// `each_setting_has_a_coarser_one_beside_it`
pub fn points(system: System, rows: &[TradeoffRow]) -> Vec<Point> {
    let names = cases(rows);
    let of = |setting: Setting| {
        let found: Vec<Measurement> = names
            .iter()
            .map(|case| Measurement::of(system, &setting, case, rows))
            .filter(|m| m.reference.is_some())
            .collect();
        // a run that did not come so far is off by all of it
        let errors = || found.iter().map(|m| m.error.unwrap_or(1.0));
        let bytes = rows
            .iter()
            .filter(|r| quantity(system) == Some(r.quantity.as_str()))
            .filter(|r| r.value == system.resolution_name(setting.fine.0, setting.fine.1));
        Some(Point {
            resolution: setting.fine.0,
            tolerance: setting.fine.1,
            median_error: median(errors())?,
            high_error: quantile(errors(), 0.9)?,
            cpu_seconds: found.iter().map(|m| m.cpu_seconds).sum::<f64>() / found.len() as f64,
            peak_bytes: bytes.map(|r| r.peak_bytes).max()?,
            check_resolution: setting.coarse.0,
            check_tolerance: setting.coarse.1,
            n_cases: found.len(),
        })
    };
    settings(&ladder_of(system))
        .into_iter()
        .filter_map(of)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tradeoff::{REFERENCE, TradeoffRun, compared};

    /// Runs of the whole ladder whose time is that of `time` at the resolution.
    fn rows(system: System, time: impl Fn(f64) -> Option<f64>) -> Vec<TradeoffRow> {
        let mut runs = Vec::new();
        for case in ["a", "b", "c"] {
            let mut put = |setting: &str, value: String, result| {
                runs.push(TradeoffRun {
                    case: case.to_owned(),
                    setting: setting.to_owned(),
                    value,
                    quantity: quantity(system).unwrap().to_owned(),
                    result,
                    cpu_seconds: 1.5,
                    peak_bytes: 7,
                });
            };
            put(REFERENCE, "finest".to_owned(), Some(10.0));
            for (resolution, tolerance) in ladder_of(system) {
                let value = system.resolution_name(resolution, tolerance);
                put("resolution", value, time(resolution));
            }
        }
        compared(system, &runs)
    }

    #[test]
    fn each_setting_has_a_coarser_one_beside_it() {
        let rods = points(
            System::Rod,
            &rows(System::Rod, |n| (n != 140.0).then(|| 10.0 + 10.0 / n)),
        );
        let ladder = ladder_of(System::Rod);
        assert_eq!(
            rods.len(),
            ladder.len() - 1,
            "the coarsest has none beside it"
        );
        for (p, own) in rods.iter().zip(&ladder[1..]) {
            assert_eq!((p.resolution, p.tolerance), *own);
        }
        let beside: Vec<_> = rods
            .iter()
            .map(|p| (p.resolution, p.check_resolution))
            .collect();
        assert_eq!(
            beside,
            [
                (100.0, 70.0),
                (140.0, 70.0),
                (200.0, 100.0),
                (280.0, 140.0),
                (400.0, 200.0)
            ]
        );
        for p in &rods {
            assert_eq!((p.n_cases, p.cpu_seconds, p.peak_bytes), (3, 3.0, 7));
            // a run that failed is off by all of it
            let error = if p.resolution == 140.0 {
                1.0
            } else {
                1.0 / p.resolution
            };
            assert!((p.median_error - error).abs() < 1e-12 && (p.high_error - error).abs() < 1e-12);
        }
        let colloids = points(System::Nematic, &rows(System::Nematic, |h| Some(10.0 + h)));
        let beside: Vec<_> = colloids
            .iter()
            .map(|p| (p.resolution, p.check_resolution))
            .collect();
        assert_eq!(
            beside,
            [(1.5, 2.0), (1.2, 2.0), (1.0, 2.0), (0.75, 1.5), (0.5, 1.0)]
        );
        assert!(
            colloids
                .iter()
                .all(|p| (p.high_error - 0.1 * p.resolution).abs() < 1e-12)
        );
        assert!(points(System::Knots, &[]).is_empty());
    }
}
