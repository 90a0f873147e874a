//! A scene's cases, resumable, into one table.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use topo_nematic::{NematicBattery, Progress, Threads};

use super::case::{self, CaseRun, RESULTS_VERSION, fingerprint, forget_others};
use super::cost::case_cost;
use super::field;
use super::scene::{NematicCase, NematicScene};
use super::table::NematicRow;
use crate::AnalysisError;
use crate::cost::{Estimate, Speed, Stopwatch, estimate, threads};
use crate::folder::{Earlier, finished, tell_replaced, writable};
use crate::progress::{Event, SweepSettings, with_jobs};
use crate::system::System;
use crate::table::write_table;

/// Cases that hold more than this each run one after another, all threads in each.
const BIG_CASE: u64 = 1 << 30;

/// What a sweep leaves behind.
#[derive(Debug, Clone)]
pub struct NematicReport {
    /// Rows of the table, cases in the order of the scene.
    pub rows: Vec<NematicRow>,
    /// Cases computed now.
    pub n_computed: usize,
    /// Cases found finished.
    pub n_reused: usize,
    /// Whether it was asked to stop before the end.
    pub interrupted: bool,
    /// What it was expected to take.
    pub estimate: Estimate,
    /// Seconds that its cases took.
    pub wall_seconds: f64,
}

/// Runs all cases of a scene; what an earlier run finished with the same settings is kept, and a case that was interrupted or
/// killed goes on from its last checkpoint.
///
/// Each case writes its own folder and is complete when its `run.json` is there; `nematic/sweep.csv` is written at the end, also
/// after an interrupt, from what is finished, whichever shard computed it. Results do not depend on the number of jobs.
///
/// # Errors
/// Parameters that make no sense, a grid that does not fit in memory, or files that cannot be written; all cases are looked at
/// before the first is computed. A run that stops early is no error: its row carries the reason.
pub fn run_nematic_sweep(
    scene: &NematicScene,
    settings: &SweepSettings,
    progress: &(dyn Fn(Event<'_>) + Sync),
) -> Result<NematicReport, AnalysisError> {
    let folder = scene.results(&settings.out);
    writable(&folder)?;
    let cases = scene.cases();
    let name = |case: &NematicCase| scene.blank_row(case).case_name();
    let Plan {
        found,
        todo,
        expected,
        together,
        estimate,
    } = plan(scene, settings, &cases)?;
    for (k, case) in cases.iter().enumerate() {
        if settings.fresh && settings.takes(k) {
            forget_others(&folder.join(name(case)), "")?;
        }
    }
    let n_reused = found.iter().filter(|f| f.is_finished()).count();
    let n_todo = estimate.n_cases;
    progress(Event::Begin {
        n_cases: n_todo + n_reused,
        n_reused,
        estimate: &estimate,
    });
    tell_replaced(
        cases
            .iter()
            .map(name)
            .zip(found.iter().map(Earlier::reason)),
        progress,
    );
    let each = if together { Threads::One } else { Threads::All };
    let n_done = AtomicUsize::new(n_reused);
    let one = |case: &NematicCase, todo: bool, expected: f64| -> Result<_, AnalysisError> {
        if !todo || settings.interrupt.is_requested() {
            return Ok(None);
        }
        let name = name(case);
        let told = |p: &Progress| {
            progress(Event::Working {
                name: &name,
                what: &case::told(p),
            });
        };
        let damaged = || {
            progress(Event::Replaced {
                names: std::slice::from_ref(&name),
                reason: "its checkpoint is damaged",
            });
        };
        let run = CaseRun {
            scene,
            case,
            folder: &folder.join(&name),
            interrupt: &settings.interrupt,
            threads: each,
            keep_fields: settings.keep_fields,
            checkpoint_seconds: settings.checkpoint_seconds,
            damaged: &damaged,
            told: &told,
        };
        let row = run.run()?;
        if let Some(row) = &row {
            progress(Event::Case {
                name: &name,
                n_done: n_done.fetch_add(1, Ordering::Relaxed) + 1,
                expected,
                warnings: &row.warnings,
            });
        }
        Ok(row)
    };
    let mut order: Vec<usize> = (0..cases.len()).collect();
    if together {
        // strong charges take longest: they go first, so that no thread waits for them at the end
        order.sort_by_key(|&k| (cases[k].flow.is_none(), std::cmp::Reverse(cases[k].q)));
    }
    let clock = Stopwatch::start();
    let mut computed: Vec<(usize, Option<NematicRow>)> = with_jobs(settings.jobs, || {
        let of = |&k: &usize| Ok((k, one(&cases[k], todo[k], expected[k])?));
        if together {
            order.par_iter().with_max_len(1).map(of).collect()
        } else {
            order.iter().map(of).collect::<Result<_, AnalysisError>>()
        }
    })??;
    let wall_seconds = clock.seconds();
    computed.sort_by_key(|c| c.0);
    let n_computed = computed.iter().filter(|c| c.1.is_some()).count();
    let rows: Vec<NematicRow> = found
        .into_iter()
        .zip(computed)
        .filter_map(|(f, (_, c))| f.rows().and_then(|rows| rows.into_iter().next()).or(c))
        .collect();
    write_table(&folder.join("sweep.csv"), &rows)?;
    Ok(NematicReport {
        interrupted: settings.interrupt.is_requested() && n_computed < n_todo,
        rows,
        n_computed,
        n_reused,
        estimate,
        wall_seconds,
    })
}

/// What [`run_nematic_sweep`] is expected to take for what is not finished; a case that was begun counts in full.
///
/// # Errors
/// Parameters that make no sense, or a grid that does not fit in memory.
pub fn estimate_nematic_sweep(
    scene: &NematicScene,
    settings: &SweepSettings,
) -> Result<Estimate, AnalysisError> {
    Ok(plan(scene, settings, &scene.cases())?.estimate)
}

/// What is left of the cases of a scene, which are computed now, and how.
struct Plan {
    found: Vec<Earlier<NematicRow>>,
    todo: Vec<bool>,
    /// Processor seconds of each on the models' machine; 0 where nobody asks.
    expected: Vec<f64>,
    /// Whether cases run side by side.
    together: bool,
    estimate: Estimate,
}

fn plan(
    scene: &NematicScene,
    settings: &SweepSettings,
    cases: &[NematicCase],
) -> Result<Plan, AnalysisError> {
    let folder = scene.results(&settings.out);
    let name = |case: &NematicCase| scene.blank_row(case).case_name();
    let mut found: Vec<Earlier<NematicRow>> = Vec::with_capacity(cases.len());
    for (k, case) in cases.iter().enumerate() {
        let place = folder.join(name(case));
        let usable = !(settings.fresh && settings.takes(k))
            && (!settings.keep_fields || field::are_kept(&place));
        found.push(if usable {
            finished(&place, &fingerprint(scene, case), RESULTS_VERSION)
        } else {
            Earlier::None
        });
    }
    let todo: Vec<bool> = (0..cases.len())
        .map(|k| !found[k].is_finished() && settings.takes(k))
        .collect();
    let (mut costs, mut taken) = (Vec::new(), Vec::new());
    let mut expected = vec![0.0; cases.len()];
    for (k, ((case, found), todo)) in cases.iter().zip(&found).zip(&todo).enumerate() {
        if !todo && !found.is_finished() {
            continue;
        }
        let battery = NematicBattery::new(&case.nematic, &scene.accuracy).map_err(|source| {
            AnalysisError::Nematic {
                case: name(case),
                source,
            }
        })?;
        let cost = case_cost(case, &battery);
        expected[k] = cost.seconds;
        match found {
            Earlier::Finished(rows) => {
                let seconds = rows.iter().map(|r| r.cpu_seconds).sum();
                taken.push((cost.seconds, seconds));
            }
            _ => costs.push(cost),
        }
    }
    let largest = costs.iter().map(|c| c.bytes).max().unwrap_or(0);
    let together = largest <= BIG_CASE && costs.len() > 1;
    // with all threads in a case, its own seconds are not those of all threads
    let speed = Speed::of(System::Nematic, if together { &taken } else { &[] });
    let estimate = estimate(&costs, speed, threads(settings.jobs), together);
    Ok(Plan {
        found,
        todo,
        expected,
        together,
        estimate,
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use topo_core::Interrupt;

    use super::*;

    const SCENE: &str = "[nematic]\nradius = 5\nspacing = 1.0\nq = [1, 3]\n[charge]\ntolerance = 1e-5\n[discharge]\nuntil_released = 0.9\n[accuracy]\ntolerance = 1e-3\n";

    fn settings(out: &Path, jobs: usize) -> SweepSettings {
        SweepSettings {
            jobs,
            ..SweepSettings::new(out)
        }
    }

    fn timeless(report: &NematicReport) -> Vec<NematicRow> {
        let drop = |r: &NematicRow| NematicRow {
            cpu_seconds: 0.0,
            peak_bytes: 0,
            ..r.clone()
        };
        report.rows.iter().map(drop).collect()
    }

    #[test]
    fn finished_cases_are_kept_stopped_ones_go_on_and_jobs_change_nothing() {
        let scene = NematicScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let run =
            |jobs| run_nematic_sweep(&scene, &settings(folder.path(), jobs), &|_| {}).unwrap();
        let first = run(2);
        assert_eq!(
            (first.n_computed, first.n_reused, first.rows.len()),
            (2, 0, 2)
        );
        assert!(
            first
                .rows
                .iter()
                .all(|r| r.t50.is_some() && r.stokes_updates == 0)
        );
        assert!(first.rows[1].f_charged > first.rows[0].f_charged);
        let case = folder
            .path()
            .join("nematic")
            .join(first.rows[0].case_name());
        let read = |file: &str| std::fs::read(case.join(file)).unwrap();
        let slices = read("slices.csv");
        let again = run(2);
        assert_eq!((again.n_computed, again.n_reused), (0, 2));
        assert_eq!(again.rows, first.rows);
        // stopped at the first word of the discharge, then gone on
        std::fs::remove_file(case.join("run.json")).unwrap();
        let stop = Interrupt::new();
        let stopping = SweepSettings {
            interrupt: stop.clone(),
            ..settings(folder.path(), 1)
        };
        let report = run_nematic_sweep(&scene, &stopping, &|event| {
            if let Event::Working { what, .. } = event
                && what.starts_with("discharging: step 4")
            {
                stop.request();
            }
        })
        .unwrap();
        assert!(report.interrupted && report.rows.len() == 1);
        let checkpoints = || {
            let entries = std::fs::read_dir(&case).unwrap();
            let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
            names.filter(|n| n.ends_with(".checkpoint")).count()
        };
        assert!(checkpoints() > 0);
        let resumed = run(1);
        assert_eq!((resumed.n_computed, resumed.n_reused), (1, 1));
        assert_eq!(timeless(&resumed), timeless(&first));
        assert_eq!(read("slices.csv"), slices);
        assert_eq!(checkpoints(), 0);
    }

    #[test]
    fn impossible_colloids_are_refused_before_anything_runs() {
        let folder = tempfile::tempdir().unwrap();
        for (change, word) in [
            ("radius = 5\ncell = [1.5, 1.5, 1.5]", "radius"),
            ("radius = -5", "radius"),
            ("radius = 5\nspacing = 40", "spacing"),
        ] {
            let text = format!("[nematic]\n{change}\nq = 1\n");
            let run = |scene| run_nematic_sweep(&scene, &settings(folder.path(), 1), &|_| {});
            let scene = NematicScene::parse(&text, Path::new("scene.toml"));
            let error = scene.and_then(run).unwrap_err().to_string();
            assert!(error.contains(word), "{change:?}: {error}");
        }
    }

    #[test]
    fn a_damaged_checkpoint_is_told_and_the_case_begun_anew() {
        let scene = NematicScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let calm = run_nematic_sweep(&scene, &settings(folder.path(), 1), &|_| {}).unwrap();
        let torn = tempfile::tempdir().unwrap();
        let stop_in = |phase: &str| {
            let stop = Interrupt::new();
            let stopping = SweepSettings {
                interrupt: stop.clone(),
                ..settings(torn.path(), 1)
            };
            run_nematic_sweep(&scene, &stopping, &|event| {
                if let Event::Working { what, .. } = event
                    && what.starts_with(phase)
                {
                    stop.request();
                }
            })
            .unwrap();
        };
        for damaged in ["charge-", "discharge-", "snapshots-"] {
            stop_in("discharging: step 4");
            let case = torn.path().join("nematic").join(calm.rows[1].case_name());
            let mut n_found = 0;
            for entry in std::fs::read_dir(&case).unwrap() {
                let path = entry.unwrap().path();
                let name = path.file_name().unwrap().to_string_lossy().into_owned();
                if name.starts_with(damaged) {
                    n_found += 1;
                    std::fs::write(&path, b"TOPOCKPT nonsense").unwrap();
                }
            }
            assert_eq!(n_found, 1, "{damaged}");
            let told = std::sync::Mutex::new(Vec::new());
            let mended = run_nematic_sweep(&scene, &settings(torn.path(), 1), &|event| {
                if let Event::Replaced { reason, .. } = event {
                    told.lock().unwrap().push(reason.to_owned());
                }
            })
            .unwrap();
            assert_eq!(timeless(&mended), timeless(&calm));
            assert_eq!(told.into_inner().unwrap(), ["its checkpoint is damaged"]);
            std::fs::remove_dir_all(torn.path().join("nematic")).unwrap();
        }
    }

    #[test]
    fn shards_merge_into_the_whole_table() {
        let scene = NematicScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let whole = tempfile::tempdir().unwrap();
        let calm = run_nematic_sweep(&scene, &settings(whole.path(), 1), &|_| {}).unwrap();
        let merged = tempfile::tempdir().unwrap();
        for shard in ["1/2", "2/2"] {
            let part = SweepSettings {
                shard: Some(shard.parse().unwrap()),
                ..settings(merged.path(), 1)
            };
            assert_eq!(estimate_nematic_sweep(&scene, &part).unwrap().n_cases, 1);
            let report = run_nematic_sweep(&scene, &part, &|_| {}).unwrap();
            assert!(report.n_computed == 1 && !report.interrupted);
            // What is there can be told without computing the rest.
            let told = SweepSettings {
                only_finished: true,
                ..settings(merged.path(), 1)
            };
            let so_far = run_nematic_sweep(&scene, &told, &|_| {}).unwrap();
            assert!(so_far.n_computed == 0 && so_far.rows.len() == report.rows.len());
            assert!(report.wall_seconds > 0.0 && report.estimate.cpu_seconds > 0.0);
        }
        let report = run_nematic_sweep(&scene, &settings(merged.path(), 1), &|_| {}).unwrap();
        assert_eq!((report.n_computed, report.n_reused), (0, 2));
        assert_eq!(timeless(&report), timeless(&calm));
    }
}
