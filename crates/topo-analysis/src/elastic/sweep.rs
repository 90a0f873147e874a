//! A scene's cases, in parallel, resumable, into one table.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use topo_knots::KnotTable;

use super::case::{self, CaseJob, fingerprint};
use super::scene::ElasticScene;
use crate::AnalysisError;
use crate::folder::{finished, writable};
use crate::knots::{Shapes, tight_shapes};
use crate::progress::{Event, SweepSettings, with_jobs};
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
    let cases = scene.cases(table)?;
    let mut found = Vec::with_capacity(cases.len());
    for case in &cases {
        let entry = table.get(&case.knot)?;
        let mark = fingerprint(scene, case, entry);
        found.push(if settings.fresh {
            None
        } else {
            finished(&folder.join(case.name()), &mark)
        });
    }
    let n_reused = found.iter().filter(|f| f.is_some()).count();
    progress(Event::Begin {
        n_cases: cases.len(),
        n_reused,
    });
    let mut names: Vec<String> = cases
        .iter()
        .zip(&found)
        .filter(|(_, f)| f.is_none())
        .map(|(c, _)| c.knot.clone())
        .collect();
    names.dedup();
    names.sort();
    names.dedup();
    let n_done = AtomicUsize::new(n_reused);
    let (shapes, computed) = with_jobs(settings.jobs, || -> Result<_, AnalysisError> {
        let shapes = tight_shapes(
            &names,
            table,
            &scene.tighten,
            &settings.out,
            &settings.interrupt,
            progress,
        )?;
        let computed: Vec<Option<Vec<SweepRow>>> = cases
            .par_iter()
            .zip(&found)
            .with_max_len(1)
            .map(|(case, found)| {
                if found.is_some() || settings.interrupt.is_requested() {
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
                        warnings: &warnings.join(";"),
                    });
                }
                Ok(rows)
            })
            .collect::<Result<_, AnalysisError>>()?;
        Ok((shapes, computed))
    })??;
    let n_computed = computed.iter().filter(|c| c.is_some()).count();
    let interrupted = settings.interrupt.is_requested() && n_computed + n_reused < cases.len();
    let rows: Vec<SweepRow> = found
        .into_iter()
        .zip(computed)
        .filter_map(|(f, c)| f.or(c))
        .flatten()
        .collect();
    write_table(&folder.join("sweep.csv"), &rows)?;
    Ok(SweepReport {
        rows,
        n_computed,
        n_reused,
        interrupted,
        shapes,
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use topo_core::Interrupt;

    use super::*;

    const SCENE: &str = "[rod]\nknot = \"3_1\"\ntwist = [0.0, 1.0]\n[rod.contact]\n[rod.friction]\n[charge]\nduration = 0.05\n[discharge]\nuntil_released = 0.3\nclosures = 4\n[accuracy]\nedges = 60\ntolerance = 1e-2\n";

    fn settings(out: &Path, jobs: usize) -> SweepSettings {
        SweepSettings {
            out: out.to_owned(),
            jobs,
            fresh: false,
            interrupt: Interrupt::new(),
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
