//! Do estimated errors hold? Runs by wish on cases that the table was not measured on, against converged references.

use serde::{Deserialize, Serialize};

use super::{REFERENCE, System, TradeoffEvent, TradeoffRun, TradeoffWork, nematic, rod, run_all};
use crate::AnalysisError;
use crate::wish::{Load, Measured, Point, Wish, grant};

/// Accuracies asked for in turn.
const RODS: [f64; 3] = [0.1, 0.05, 0.03];
const COLLOIDS: [f64; 3] = [0.1, 0.03, 0.02];

/// One run by wish beside its reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeldBackRow {
    /// `rod` or `nematic`.
    pub system: String,
    /// Which case.
    pub case: String,
    /// The accuracy asked for.
    pub accuracy: f64,
    /// The setting that was picked.
    pub setting: String,
    /// The time found.
    pub result: Option<f64>,
    /// That of the reference.
    pub reference: Option<f64>,
    /// |result/reference − 1|.
    pub relative_error: Option<f64>,
    /// What was estimated.
    pub estimate: Option<f64>,
    /// Processor seconds of the run and of the coarser one.
    pub cpu_seconds: f64,
}

impl HeldBackRow {
    /// Whether the estimate is at least as large as the error; a run without result or reference is not.
    pub fn is_covered(&self) -> bool {
        self.estimate
            .zip(self.relative_error)
            .is_some_and(|(estimate, error)| estimate >= error)
    }

    /// Estimate over true error.
    pub fn ratio(&self) -> Option<f64> {
        Some(self.estimate? / self.relative_error?)
    }
}

/// Runs the held-back cases, known ones not again; none when interrupted before the end.
///
/// # Errors
/// An accuracy that the table does not grant, or a case that cannot be set up.
pub fn held_back(
    work: &TradeoffWork<'_>,
) -> Result<(Vec<TradeoffRun>, Vec<HeldBackRow>), AnalysisError> {
    let rods = rod::held_back_cases()?;
    let colloids = nematic::held_back_cases();
    let rod_points = granted(Measured::Rod, &RODS, rods.len())?;
    let colloid_points = granted(Measured::Nematic, &COLLOIDS, colloids.len())?;
    let mut trials = rod::held_back_trials(&rods, &rod_points, work)?;
    trials.extend(nematic::held_back_trials(&colloids, &colloid_points));
    (work.told)(TradeoffEvent::Begin(trials.len()));
    let runs = run_all(&trials, work)?;
    if work.interrupt.is_requested() {
        return Ok((runs, Vec::new()));
    }
    let mut rows = Vec::new();
    for (k, (case, p)) in rods.iter().zip(&rod_points).enumerate() {
        let name = rod::case_name(case);
        let at = |n: f64, t: f64| rod::resolution(n as usize, t);
        rows.push(row(System::Rod, name, RODS[k % RODS.len()], p, &at, &runs));
    }
    for (k, (case, p)) in colloids.iter().zip(&colloid_points).enumerate() {
        let name = nematic::case_name(case);
        let asked = COLLOIDS[k % COLLOIDS.len()];
        rows.push(row(
            System::Nematic,
            name,
            asked,
            p,
            &nematic::resolution,
            &runs,
        ));
    }
    Ok((runs, rows))
}

fn granted(table: Measured, asked: &[f64], n: usize) -> Result<Vec<Point>, AnalysisError> {
    let load = Load {
        cases: 1.0,
        threads: 1,
    };
    let one = |k: usize| {
        let wish = Wish::Accuracy(asked[k % asked.len()]);
        let granted = grant(table, wish, load).map_err(|reason| AnalysisError::Wish {
            wish: wish.to_string(),
            reason,
        })?;
        Ok(granted.point)
    };
    (0..n).map(one).collect()
}

fn row(
    system: System,
    case: String,
    accuracy: f64,
    point: &Point,
    name: &dyn Fn(f64, f64) -> String,
    runs: &[TradeoffRun],
) -> HeldBackRow {
    let quantity = if system == System::Rod {
        "t99"
    } else {
        "t99.9"
    };
    let find = |setting: &str, value: Option<&str>| {
        runs.iter().find(|r| {
            r.case == case
                && r.quantity == quantity
                && r.setting == setting
                && value.is_none_or(|v| r.value == v)
        })
    };
    let setting = name(point.resolution, point.tolerance);
    let own = find("resolution", Some(&setting));
    let check = name(point.check_resolution, point.check_tolerance);
    let check = find("resolution", Some(&check));
    let result = own.and_then(|r| r.result);
    let reference = find(REFERENCE, None).and_then(|r| r.result);
    let difference = result
        .zip(check.and_then(|r| r.result))
        .map(|(a, b)| b / a - 1.0);
    HeldBackRow {
        system: system.name().to_owned(),
        accuracy,
        setting,
        result,
        reference,
        relative_error: result.zip(reference).map(|(a, b)| (a / b - 1.0).abs()),
        estimate: result.map(|_| point.estimate(difference)),
        cpu_seconds: own.into_iter().chain(check).map(|r| r.cpu_seconds).sum(),
        case,
    }
}
