//! A scene's cases, in parallel, resumable, into one table.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use topo_knots::KnotTable;

use super::case::{self, CaseJob, RESULTS_VERSION, fingerprint};
use super::cost::cost_of;
use super::scene::{ElasticCase, ElasticScene};
use crate::AnalysisError;
use crate::cost::{Cost, Estimate, Speed, Stopwatch, estimate, threads};
use crate::folder::{Earlier, finished, tell_replaced, writable};
use crate::knots::{Shapes, tight_shapes};
use crate::progress::{Event, SweepSettings, with_jobs};
use crate::system::System;
use crate::table::{SweepRow, write_table};

/// What a sweep leaves behind.
#[derive(Debug, Clone)]
pub struct SweepReport {
    /// Rows of the table, cases in the order of the scene.
    pub rows: Vec<SweepRow>,
    /// Cases computed now.
    pub n_computed: usize,
    /// Cases found finished.
    pub n_reused: usize,
    /// Whether it was asked to stop before the end.
    pub interrupted: bool,
    /// Tight shapes it started from.
    pub shapes: Shapes,
    /// What it was expected to take.
    pub estimate: Estimate,
    /// Seconds that its cases took, the start shapes not counted.
    pub wall_seconds: f64,
}

/// Runs all cases of a scene; what an earlier run finished with the same settings is kept.
///
/// Each case writes its own folder and is complete when its `run.json` is there; `elastic/sweep.csv` is written at the end, also
/// after an interrupt, from what is finished. Results do not depend on the number of jobs.
///
/// # Errors
/// An unknown knot, a rod that cannot be built, or files that cannot be written. A run that stops early is no error: its row
/// carries the reason.
pub fn run_sweep(
    scene: &ElasticScene,
    table: &KnotTable,
    settings: &SweepSettings,
    progress: &(dyn Fn(Event<'_>) + Sync),
) -> Result<SweepReport, AnalysisError> {
    let folder = scene.results(&settings.out);
    writable(&folder)?;
    let Plan {
        cases,
        costs,
        found,
        todo,
    } = plan(scene, table, settings)?;
    let estimate = cost(settings, &costs, &found, &todo);
    let n_reused = found.iter().filter(|f| f.is_finished()).count();
    let n_todo = estimate.n_cases;
    progress(Event::Begin {
        n_cases: n_todo + n_reused,
        n_reused,
        estimate: &estimate,
    });
    let names_of = cases.iter().map(ElasticCase::name);
    tell_replaced(names_of.zip(found.iter().map(Earlier::reason)), progress);
    let mut names: Vec<String> = cases
        .iter()
        .zip(&todo)
        .filter(|(_, todo)| **todo)
        .map(|(c, _)| c.knot.clone())
        .collect();
    names.dedup();
    names.sort();
    names.dedup();
    let n_done = AtomicUsize::new(n_reused);
    let (shapes, computed, wall_seconds) =
        with_jobs(settings.jobs, || -> Result<_, AnalysisError> {
            let shapes = tight_shapes(
                &names,
                table,
                &scene.tighten,
                &settings.out,
                &settings.interrupt,
                progress,
            )?;
            let clock = Stopwatch::start();
            let computed: Vec<Option<Vec<SweepRow>>> = cases
                .par_iter()
                .zip(&costs)
                .zip(&todo)
                .with_max_len(1)
                .map(|((case, cost), todo)| {
                    if !todo || settings.interrupt.is_requested() {
                        return Ok(None);
                    }
                    let Some(tight) = shapes.get(&case.knot) else {
                        return Ok(None);
                    };
                    let job = CaseJob {
                        scene,
                        case,
                        tight,
                        table,
                    };
                    let rows = case::run(&job, &folder.join(case.name()), &settings.interrupt)?;
                    if let Some(rows) = &rows {
                        let n_done = n_done.fetch_add(1, Ordering::Relaxed) + 1;
                        let warnings: Vec<&str> = rows
                            .iter()
                            .map(|r| r.warnings.as_str())
                            .filter(|w| !w.is_empty())
                            .collect();
                        progress(Event::Case {
                            name: &case.name(),
                            n_done,
                            expected: cost.seconds,
                            warnings: &warnings.join(";"),
                        });
                    }
                    Ok(rows)
                })
                .collect::<Result<_, AnalysisError>>()?;
            Ok((shapes, computed, clock.seconds()))
        })??;
    let n_computed = computed.iter().filter(|c| c.is_some()).count();
    let interrupted = settings.interrupt.is_requested() && n_computed < n_todo;
    let rows: Vec<SweepRow> = found
        .into_iter()
        .zip(computed)
        .filter_map(|(f, c)| f.rows().or(c))
        .flatten()
        .collect();
    write_table(&folder.join("sweep.csv"), &rows)?;
    Ok(SweepReport {
        rows,
        n_computed,
        n_reused,
        interrupted,
        shapes,
        estimate,
        wall_seconds,
    })
}

/// What [`run_sweep`] is expected to take for what is not finished, the start shapes not counted.
///
/// # Errors
/// An unknown knot.
pub fn estimate_sweep(
    scene: &ElasticScene,
    table: &KnotTable,
    settings: &SweepSettings,
) -> Result<Estimate, AnalysisError> {
    let Plan {
        costs, found, todo, ..
    } = plan(scene, table, settings)?;
    Ok(cost(settings, &costs, &found, &todo))
}

/// The cases of a scene, what is left of them, and which are computed now.
struct Plan {
    cases: Vec<ElasticCase>,
    costs: Vec<Cost>,
    found: Vec<Earlier<SweepRow>>,
    todo: Vec<bool>,
}

fn plan(
    scene: &ElasticScene,
    table: &KnotTable,
    settings: &SweepSettings,
) -> Result<Plan, AnalysisError> {
    let folder = scene.results(&settings.out);
    let cases = scene.cases(table)?;
    let mut found = Vec::with_capacity(cases.len());
    let mut costs = Vec::with_capacity(cases.len());
    for (k, case) in cases.iter().enumerate() {
        let entry = table.get(&case.knot)?;
        let mark = fingerprint(scene, case, &entry);
        found.push(if settings.fresh && settings.takes(k) {
            Earlier::None
        } else {
            finished(&folder.join(case.name()), &mark, RESULTS_VERSION)
        });
        let n_cuts = match &found[k] {
            Earlier::Finished(rows) => Some(rows.len()),
            _ => None,
        };
        costs.push(cost_of(scene, case, &entry, n_cuts));
    }
    let todo = (0..cases.len())
        .map(|k| !found[k].is_finished() && settings.takes(k))
        .collect();
    Ok(Plan {
        cases,
        costs,
        found,
        todo,
    })
}

fn cost(
    settings: &SweepSettings,
    costs: &[Cost],
    found: &[Earlier<SweepRow>],
    todo: &[bool],
) -> Estimate {
    let taken: Vec<(f64, f64)> = found
        .iter()
        .zip(costs)
        .filter_map(|(f, cost)| match f {
            Earlier::Finished(rows) => {
                Some((cost.seconds, rows.iter().map(|r| r.cpu_seconds).sum()))
            }
            _ => None,
        })
        .collect();
    let left = costs.iter().zip(todo).filter(|(_, todo)| **todo);
    let costs: Vec<Cost> = left.map(|(cost, _)| *cost).collect();
    let speed = Speed::of(System::Rod, &taken);
    estimate(&costs, speed, threads(settings.jobs), true)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    const SCENE: &str = "[rod]\nknot = \"3_1\"\ntwist = [0.0, 1.0]\n[rod.contact]\n[rod.friction]\n[charge]\nduration = 0.05\n[discharge]\nuntil_released = 0.3\nclosures = 4\n[accuracy]\nedges = 60\ntolerance = 1e-2\n";

    fn settings(out: &Path, jobs: usize) -> SweepSettings {
        SweepSettings {
            jobs,
            ..SweepSettings::new(out)
        }
    }

    fn timeless(report: &SweepReport) -> Vec<SweepRow> {
        let drop = |r: &SweepRow| SweepRow {
            cpu_seconds: 0.0,
            ..r.clone()
        };
        report.rows.iter().map(drop).collect()
    }

    #[test]
    fn finished_cases_are_kept_damaged_ones_computed_again_and_jobs_change_nothing() {
        let table = KnotTable::builtin();
        let scene = ElasticScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let first = run_sweep(&scene, &table, &settings(folder.path(), 2), &|_| {}).unwrap();
        assert_eq!(
            (first.n_computed, first.n_reused, first.rows.len()),
            (2, 0, 2)
        );
        let results = folder.path().join("elastic");
        let read = |file: &str| std::fs::read(results.join(file)).unwrap();
        let series = read("3_1_twist+0.00_shrunk_n60/series.csv");
        let again = run_sweep(&scene, &table, &settings(folder.path(), 2), &|_| {}).unwrap();
        assert_eq!((again.n_computed, again.n_reused), (0, 2));
        assert_eq!(again.rows, first.rows);
        let mark = results.join("3_1_twist+0.00_shrunk_n60/run.json");
        std::fs::write(&mark, "{\"fingerprint\": ").unwrap();
        let mended = run_sweep(&scene, &table, &settings(folder.path(), 1), &|_| {}).unwrap();
        assert_eq!((mended.n_computed, mended.n_reused), (1, 1));
        assert_eq!(timeless(&mended), timeless(&first));
        assert_eq!(read("3_1_twist+0.00_shrunk_n60/series.csv"), series);
        let mut other = scene.clone();
        other.accuracy.tolerance = 2e-2;
        let changed = run_sweep(&other, &table, &settings(folder.path(), 0), &|_| {}).unwrap();
        assert_eq!(changed.n_computed, 2);
    }

    #[test]
    fn what_an_earlier_run_left_is_told_apart_and_computed_again() {
        let table = KnotTable::builtin();
        let scene = ElasticScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let sweep = |scene: &ElasticScene| {
            let told = std::sync::Mutex::new(Vec::new());
            let report = run_sweep(scene, &table, &settings(folder.path(), 1), &|event| {
                if let Event::Replaced { names, reason } = event {
                    told.lock().unwrap().push((reason.to_owned(), names.len()));
                }
            })
            .unwrap();
            (timeless(&report), told.into_inner().unwrap())
        };
        let (first, told) = sweep(&scene);
        assert!(told.is_empty());
        let case = folder.path().join("elastic/3_1_twist+0.00_shrunk_n60");
        let mark = case.join("run.json");
        let text = std::fs::read_to_string(&mark).unwrap();
        let version = format!("\"results\": {RESULTS_VERSION}");
        assert!(text.contains(&version));
        let rows_gone: serde_json::Value = {
            let mut run: serde_json::Value = serde_json::from_str(&text).unwrap();
            run["rows"] = serde_json::json!([]);
            run
        };
        for (left, reason) in [
            (text[..text.len() / 2].to_owned(), "damaged"),
            (
                text.replace(&version, "\"results\": 999"),
                "another results version",
            ),
            (rows_gone.to_string(), "no rows"),
        ] {
            std::fs::write(&mark, left).unwrap();
            let (rows, told) = sweep(&scene);
            assert_eq!(rows, first);
            assert!(told.len() == 1 && told[0].1 == 1, "{told:?}");
            assert!(told[0].0.contains(reason), "{told:?}");
        }
        for (file, left) in [
            ("snapshots.csv", None),
            ("series.csv", Some("cut,time\n1,")),
        ] {
            let path = case.join(file);
            let whole = std::fs::read(&path).unwrap();
            match left {
                None => std::fs::remove_file(&path).unwrap(),
                Some(text) => std::fs::write(&path, text).unwrap(),
            }
            let (rows, told) = sweep(&scene);
            assert_eq!(rows, first);
            assert!(
                told.len() == 1 && told[0].0.contains("missing or damaged"),
                "{told:?}"
            );
            assert!(std::fs::read(&path).unwrap() == whole);
        }
        let mut other = scene.clone();
        other.accuracy.tolerance = 2e-2;
        let (_, told) = sweep(&other);
        assert_eq!(
            told,
            [("it was computed with other settings".to_owned(), 2)]
        );
        assert!(sweep(&other).1.is_empty());
    }

    #[test]
    fn shards_merge_into_the_whole_table() {
        let table = KnotTable::builtin();
        let scene = ElasticScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let whole = tempfile::tempdir().unwrap();
        let calm = run_sweep(&scene, &table, &settings(whole.path(), 1), &|_| {}).unwrap();
        let merged = tempfile::tempdir().unwrap();
        for shard in ["2/2", "1/2"] {
            let elsewhere = tempfile::tempdir().unwrap();
            let part = SweepSettings {
                shard: Some(shard.parse().unwrap()),
                ..settings(elsewhere.path(), 1)
            };
            assert_eq!(estimate_sweep(&scene, &table, &part).unwrap().n_cases, 1);
            let report = run_sweep(&scene, &table, &part, &|_| {}).unwrap();
            assert!(report.n_computed == 1 && report.rows.len() == 1 && !report.interrupted);
            let name = scene.cases(&table).unwrap()[usize::from(shard == "2/2")].name();
            let to = merged.path().join("elastic").join(&name);
            std::fs::create_dir_all(&to).unwrap();
            for file in std::fs::read_dir(elsewhere.path().join("elastic").join(&name)).unwrap() {
                let file = file.unwrap();
                std::fs::copy(file.path(), to.join(file.file_name())).unwrap();
            }
            let told = SweepSettings {
                only_finished: true,
                ..settings(merged.path(), 1)
            };
            let so_far = run_sweep(&scene, &table, &told, &|_| {}).unwrap();
            assert_eq!(so_far.n_computed, 0);
            assert_eq!(so_far.rows.len(), if shard == "2/2" { 1 } else { 2 });
        }
        let report = run_sweep(&scene, &table, &settings(merged.path(), 1), &|_| {}).unwrap();
        assert_eq!((report.n_computed, report.n_reused), (0, 2));
        assert_eq!(timeless(&report), timeless(&calm));
    }

    #[test]
    fn a_folder_that_cannot_be_written_is_refused_before_anything_runs() {
        let table = KnotTable::builtin();
        let scene = ElasticScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        // a file where the folder should be: permissions do not stop the superuser
        let file = folder.path().join("results");
        std::fs::write(&file, "").unwrap();
        let begun = std::sync::atomic::AtomicBool::new(false);
        let error = run_sweep(&scene, &table, &settings(&file, 1), &|_| {
            begun.store(true, Ordering::Relaxed);
        })
        .unwrap_err()
        .to_string();
        assert!(
            error.contains("results") && error.contains("--out"),
            "{error}"
        );
        assert!(!begun.load(Ordering::Relaxed));
    }

    #[test]
    fn an_interrupted_sweep_writes_no_case_it_has_not_finished() {
        let table = KnotTable::builtin();
        let scene = ElasticScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let settings = settings(folder.path(), 1);
        settings.interrupt.request();
        let report = run_sweep(&scene, &table, &settings, &|_| {}).unwrap();
        assert!(report.interrupted && report.rows.is_empty());
        let entries: Vec<_> = std::fs::read_dir(folder.path().join("elastic"))
            .unwrap()
            .collect();
        assert_eq!(entries.len(), 1, "only the table");
    }
}
