//! Speed against accuracy: the same cases under many settings, compared with converged references.

mod front;
mod knots;
mod nematic;
mod rod;
mod sets;
mod trial;

use rayon::prelude::*;

use crate::LabError;
use crate::preset::Preset;
use crate::system::System;
pub use front::{Setting, settings_of};
pub use sets::CaseSet;
pub(crate) use sets::MEASURED;
use trial::{Meter, Trial};
pub use trial::{PeakBytes, REFERENCE, TradeoffEvent, TradeoffRow, TradeoffRun, TradeoffWork};

/// Runs every setting of a system on the present pool of threads; what is `known` is not run again.
///
/// When interrupted, what is finished is returned.
///
/// # Errors
/// A case that cannot be set up; a run that stops early is no error, its numbers are missing.
pub fn tradeoff(
    system: System,
    preset: Preset,
    work: &TradeoffWork<'_>,
) -> Result<Vec<TradeoffRun>, LabError> {
    let trials = match (system, preset) {
        (System::Rod, Preset::Draft) => rod::trials(work)?,
        (System::Nematic, Preset::Draft) => nematic::trials(),
        (System::Knots, _) => knots::trials(preset)?,
        _ => return ladder(system, CaseSet::Table, work),
    };
    (work.report)(TradeoffEvent::Begin(trials.len()));
    run_all(&trials, work)
}

/// Runs the settings that goals choose from on the cases of a set; what is `known` is not run again.
///
/// When interrupted, what is finished is returned. There is no ladder of knots.
///
/// # Errors
/// A case that cannot be set up.
pub fn ladder(
    system: System,
    set: CaseSet,
    work: &TradeoffWork<'_>,
) -> Result<Vec<TradeoffRun>, LabError> {
    let trials = match system {
        System::Rod => rod::ladder_trials(set, work)?,
        System::Nematic => nematic::ladder_trials(set),
        System::Knots => Vec::new(),
    };
    (work.report)(TradeoffEvent::Begin(trials.len()));
    let runs = run_all(&trials, work)?;
    Ok(match system {
        System::Nematic => nematic::with_references(runs),
        _ => runs,
    })
}

fn run_all(trials: &[Trial], work: &TradeoffWork<'_>) -> Result<Vec<TradeoffRun>, LabError> {
    let meter = Meter {
        peak: work.peak_bytes,
    };
    let done: Vec<Vec<TradeoffRun>> = trials
        .par_iter()
        .with_max_len(1)
        .map(|trial| {
            let known = work.known.iter().filter(|run| trial.is_of(run));
            let mut runs: Vec<TradeoffRun> = known.cloned().collect();
            if runs.is_empty() {
                if work.interrupt.is_requested() {
                    return Ok(runs);
                }
                let Some(outcome) = (trial.run)(&meter, work.interrupt)? else {
                    return Ok(runs);
                };
                runs.extend(
                    outcome
                        .quantities
                        .iter()
                        .map(|(quantity, result)| TradeoffRun {
                            case: trial.case.clone(),
                            setting: trial.setting.to_owned(),
                            value: trial.value.clone(),
                            quantity: (*quantity).to_owned(),
                            result: *result,
                            cpu_seconds: outcome.cpu_seconds,
                            peak_bytes: outcome.peak_bytes,
                        }),
                );
            }
            (work.report)(TradeoffEvent::Done {
                name: &trial.name(),
                runs: &runs,
            });
            Ok(runs)
        })
        .collect::<Result<_, LabError>>()?;
    Ok(done.concat())
}

/// Runs beside their references, with the front marked.
///
/// # Validation
/// `errors_are_against_the_reference_of_the_case`, `the_front_has_no_dominated_setting`
pub fn compared(system: System, runs: &[TradeoffRun]) -> Vec<TradeoffRow> {
    let mut rows: Vec<TradeoffRow> = runs
        .iter()
        .map(|run| {
            let reference = runs
                .iter()
                .find(|r| {
                    r.setting == REFERENCE && r.case == run.case && r.quantity == run.quantity
                })
                .and_then(|r| r.result);
            let error = |(a, b): (f64, f64)| {
                let error = (a / b - 1.0).abs();
                (b.abs() > ZERO && error.is_finite()).then_some(error)
            };
            TradeoffRow {
                system: system.name().to_owned(),
                case: run.case.clone(),
                setting: run.setting.clone(),
                value: run.value.clone(),
                quantity: run.quantity.clone(),
                result: run.result,
                reference,
                relative_error: run.result.zip(reference).and_then(error),
                cpu_seconds: run.cpu_seconds,
                peak_bytes: run.peak_bytes,
                pareto: false,
            }
        })
        .collect();
    front::mark(&mut rows);
    rows
}

impl System {
    /// Name of a resolution (edges, or a spacing in xi_N) with a tolerance, as trade-offs give it.
    pub fn resolution_name(self, resolution: f64, tolerance: f64) -> String {
        match self {
            Self::Nematic => nematic::resolution(resolution, tolerance),
            _ => rod::resolution(resolution as usize, tolerance),
        }
    }
}

/// By how much the grid of a setting, fitted to the cell of a case, is finer than the coarser one; none where nothing is fitted.
pub(crate) fn fitted_ratio(system: System, case: &str, coarse: f64, fine: f64) -> Option<f64> {
    if system != System::Nematic {
        return None;
    }
    Some(nematic::fitted(case, coarse)? / nematic::fitted(case, fine)?)
}

/// Resolutions and tolerances that goals choose from, from coarse to fine; each is compared with the one before it.
pub(crate) fn ladder_of(system: System) -> Vec<(f64, f64)> {
    match system {
        System::Rod => rod::LADDER.iter().map(|&(n, t)| (n as f64, t)).collect(),
        System::Nematic => nematic::LADDER.to_vec(),
        System::Knots => Vec::new(),
    }
}

/// A reference below this is zero: an order parameter without tilt.
const ZERO: f64 = 1e-3;

#[cfg(test)]
mod tests {
    use topo_core::Interrupt;

    use super::trial::Outcome;
    use super::*;

    pub(super) fn run(case: &str, value: &str, result: f64, cpu_seconds: f64) -> TradeoffRun {
        TradeoffRun {
            case: case.to_owned(),
            setting: if value == REFERENCE {
                REFERENCE
            } else {
                "resolution"
            }
            .to_owned(),
            value: value.to_owned(),
            quantity: "t99".to_owned(),
            result: Some(result),
            cpu_seconds,
            peak_bytes: 1,
        }
    }

    #[test]
    fn errors_are_against_the_reference_of_the_case() {
        let runs = [
            run("a", REFERENCE, 10.0, 9.0),
            run("b", REFERENCE, 20.0, 9.0),
            run("a", "coarse", 11.0, 1.0),
            run("b", "coarse", 19.0, 1.0),
            run("c", "coarse", 19.0, 1.0),
        ];
        let rows = compared(System::Rod, &runs);
        let errors: Vec<_> = rows.iter().map(|r| r.relative_error).collect();
        assert_eq!(errors[..2], [Some(0.0); 2]);
        assert!((errors[2].unwrap() - 0.1).abs() < 1e-12);
        assert!((errors[3].unwrap() - 0.05).abs() < 1e-12);
        assert_eq!((errors[4], rows[4].reference), (None, None));
    }

    #[test]
    fn finished_runs_are_kept_and_others_named() {
        let trial = |value: &str| Trial {
            case: "a".to_owned(),
            setting: "resolution",
            value: value.to_owned(),
            run: Box::new(|meter, _| {
                let (found, cpu_seconds, peak_bytes) = meter.measure(|| 2.0);
                Ok(Some(Outcome {
                    quantities: vec![("t99", found)],
                    cpu_seconds,
                    peak_bytes,
                }))
            }),
        };
        let known = [run("a", "coarse", 7.0, 1.0)];
        let n_reported = std::sync::atomic::AtomicUsize::new(0);
        let interrupt = Interrupt::new();
        let work = TradeoffWork {
            out: std::path::Path::new("."),
            known: &known,
            interrupt: &interrupt,
            peak_bytes: &|run| {
                run();
                5
            },
            report: &|_| {
                n_reported.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            },
        };
        let trials = [trial("coarse"), trial("fine")];
        let runs = run_all(&trials, &work).unwrap();
        assert_eq!((runs[0].result, runs[1].result), (Some(7.0), Some(2.0)));
        assert_eq!(runs[1].peak_bytes, 5);
        interrupt.request();
        assert_eq!(run_all(&trials, &work).unwrap().len(), 1);
        assert_eq!(n_reported.into_inner(), 3);
    }
}
