//! The cases of a scene, in parallel, resumable, into one table: the same for every battery.

mod dynamic;
mod experiment;
mod failed;
mod mark;
mod name;
mod place;
mod plan;
mod row;

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::LabError;
use crate::cost::{Estimate, Stopwatch};
use crate::folder::{Outcome, forget_checkpoints, tell_replaced, writable};
use crate::progress::{Event, SweepSettings, with_jobs};
use plan::Plan;
use topo_analysis::{Warnings, write_table};

pub use experiment::Experiment;
pub use failed::FailedCase;
pub use name::CaseName;
pub(crate) use name::value;
pub use place::{About, CaseFolder, Place};
pub use row::Row;

/// What a sweep leaves behind.
#[derive(Debug, Clone)]
pub struct SweepReport<R> {
    /// Rows of the table, cases in the order of the scene.
    pub rows: Vec<R>,
    /// Cases without a result, or whose run did not finish.
    pub failed: Vec<FailedCase>,
    /// Cases computed now.
    pub n_computed: usize,
    /// Cases found finished.
    pub n_reused: usize,
    /// Whether it was asked to stop before the end.
    pub interrupted: bool,
    /// What it was expected to take.
    pub estimate: Estimate,
    /// Seconds that its cases took, what they start from not counted.
    pub wall_seconds: f64,
}

/// What is expected to be computed.
///
/// # Errors
/// As [`run`].
pub(crate) fn estimate<E: Experiment>(
    experiment: &E,
    settings: &SweepSettings,
) -> Result<Estimate, LabError> {
    Ok(Plan::of(experiment, settings)?.estimate)
}

/// What became of a case now.
enum Now<R> {
    /// It is not computed here, or was stopped.
    Untouched,
    /// It came to an end, well or not.
    Done(Outcome<R>),
    /// It has no result.
    Refused(String),
}

/// Runs all cases of a scene; what an earlier run finished with the same settings is kept.
///
/// Each case writes its own folder and is complete when its `run.json` is there; `sweep.csv`, and `failed.csv` where a case failed,
/// are written at the end, also after an interrupt, from what is finished, whichever shard computed it. A case that fails leaves
/// the others alone. Results do not depend on the number of jobs.
///
/// # Errors
/// A scene that makes no sense, a folder with the results of another scene, or files that cannot be written.
pub(crate) fn run<E: Experiment>(
    experiment: &E,
    settings: &SweepSettings,
    progress: &(dyn Fn(Event<'_>) + Sync),
) -> Result<SweepReport<E::Row>, LabError> {
    let folder = settings.out.join(experiment.folder());
    let plan = Plan::of(experiment, settings)?;
    writable(&folder)?;
    mark::write(&folder, &experiment.text())?;
    for k in (0..plan.cases.len()).filter(|&k| settings.fresh && settings.takes(k)) {
        forget_checkpoints(&folder.join(&plan.names[k]), "")?;
    }
    let n_reused = plan.n_finished();
    let n_todo = plan.estimate.n_cases;
    progress(Event::Begin {
        n_cases: n_todo + n_reused,
        n_reused,
        estimate: &plan.estimate,
    });
    let reasons = plan.found.iter().map(|f| f.reason());
    tell_replaced(plan.names.iter().cloned().zip(reasons), progress);
    let n_done = AtomicUsize::new(n_reused);
    let (now, wall_seconds) = with_jobs(settings.jobs, || -> Result<_, LabError> {
        let todo: Vec<&E::Case> = plan.todo().map(|k| &plan.cases[k]).collect();
        let start = experiment.prepare(&todo, settings, progress)?;
        let clock = Stopwatch::start();
        let one = |&(k, expected): &(usize, f64)| {
            let folder = folder.join(&plan.names[k]);
            let place = Place {
                battery: experiment.battery(),
                name: &plan.names[k],
                fingerprint: &plan.fingerprints[k],
                folder: &folder,
                settings,
                is_alone: !plan.is_side_by_side,
                expected,
                progress,
            };
            let end = run_case(experiment, &plan.cases[k], &start, &place, &n_done)?;
            Ok((k, end))
        };
        let order = plan.order();
        let mut now: Vec<(usize, Now<E::Row>)> = if plan.is_side_by_side {
            let all = order.par_iter().with_max_len(1).map(one);
            all.collect::<Result<_, LabError>>()?
        } else {
            order.iter().map(one).collect::<Result<_, LabError>>()?
        };
        now.sort_by_key(|(k, _)| *k);
        Ok((now, clock.seconds()))
    })??;
    let count = |is: fn(&Now<E::Row>) -> bool| now.iter().filter(|(_, n)| is(n)).count();
    let n_computed = count(|n| matches!(n, Now::Done(_)));
    let n_left = count(|n| matches!(n, Now::Untouched));
    let estimate = plan.estimate;
    let (rows, failed) = gather(experiment, plan, now);
    write_table(&folder.join("sweep.csv"), &rows)?;
    experiment.write_beside(&folder, &rows)?;
    failed::write(&folder, &failed)?;
    Ok(SweepReport {
        rows,
        failed,
        n_computed,
        n_reused,
        interrupted: settings.interrupt.is_requested() && n_left > 0,
        estimate,
        wall_seconds,
    })
}

fn run_case<E: Experiment>(
    experiment: &E,
    case: &E::Case,
    start: &E::Start,
    place: &Place<'_>,
    n_done: &AtomicUsize,
) -> Result<Now<E::Row>, LabError> {
    if place.settings.interrupt.is_requested() {
        return Ok(Now::Untouched);
    }
    let tell = |warnings: &str| {
        (place.progress)(Event::Case {
            name: place.name,
            n_done: n_done.fetch_add(1, Ordering::Relaxed) + 1,
            expected: place.expected,
            warnings,
        });
    };
    match experiment.run(case, start, place) {
        Ok(Some(outcome)) => {
            let said = outcome.rows.iter().flat_map(Row::warnings);
            tell(&said.cloned().collect::<Warnings>().to_string());
            Ok(Now::Done(outcome))
        }
        Ok(None) => Ok(Now::Untouched),
        Err(error) if error.is_of_one_case() => {
            let reason = error.to_string();
            tell(&format!("failed: {reason}"));
            Ok(Now::Refused(reason))
        }
        Err(error) => Err(error),
    }
}

/// Rows and failures of what is finished, earlier or now, in the order of the cases.
fn gather<E: Experiment>(
    experiment: &E,
    plan: Plan<E>,
    now: Vec<(usize, Now<E::Row>)>,
) -> (Vec<E::Row>, Vec<FailedCase>) {
    let (mut rows, mut failed) = (Vec::new(), Vec::new());
    let mut ends: Vec<Now<E::Row>> = plan
        .found
        .into_iter()
        .map(|f| f.outcome().map_or(Now::Untouched, Now::Done))
        .collect();
    for (k, end) in now {
        ends[k] = end;
    }
    for ((case, name), end) in plan.cases.iter().zip(plan.names).zip(ends) {
        let reason = match end {
            Now::Untouched => None,
            Now::Refused(reason) => Some(reason),
            Now::Done(outcome) => {
                let blank = experiment.blank_row(case);
                rows.extend(outcome.rows.into_iter().map(|r| r.with_settings_of(&blank)));
                outcome.failure
            }
        };
        failed.extend(reason.map(|reason| FailedCase { case: name, reason }));
    }
    (rows, failed)
}
