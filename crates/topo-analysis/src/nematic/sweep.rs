//! A scene's cases, resumable, into one table.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use topo_nematic::{NematicBattery, Progress, Threads};

use super::case::{self, CaseRun, fingerprint, forget_others};
use super::scene::{NematicCase, NematicScene};
use super::table::NematicRow;
use crate::AnalysisError;
use crate::folder::{finished, writable};
use crate::progress::{Event, SweepSettings, with_jobs};
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
}

/// Runs all cases of a scene; what an earlier run finished with the same settings is kept, and a case that was interrupted or
/// killed goes on from its last checkpoint.
///
/// Each case writes its own folder and is complete when its `run.json` is there; `nematic/sweep.csv` is written at the end, also
/// after an interrupt, from what is finished. Results do not depend on the number of jobs.
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
    let found: Vec<Option<NematicRow>> = cases
        .iter()
        .map(|case| {
            let place = folder.join(name(case));
            let kept = (!settings.fresh).then(|| finished(&place, &fingerprint(scene, case)));
            if settings.fresh {
                forget_others(&place, "")?;
            }
            Ok(kept.flatten().and_then(|rows| rows.into_iter().next()))
        })
        .collect::<Result<_, AnalysisError>>()?;
    let n_reused = found.iter().filter(|f| f.is_some()).count();
    let mut largest = 0;
    for (case, _) in cases.iter().zip(&found).filter(|(_, f)| f.is_none()) {
        let battery = NematicBattery::new(&case.nematic, &scene.accuracy).map_err(|source| {
            AnalysisError::Nematic {
                case: name(case),
                source,
            }
        })?;
        let bytes = battery.memory().total();
        largest = largest.max(bytes);
    }
    progress(Event::Begin {
        n_cases: cases.len(),
        n_reused,
    });
    let together = largest <= BIG_CASE && cases.len() - n_reused > 1;
    let threads = if together { Threads::One } else { Threads::All };
    let n_done = AtomicUsize::new(n_reused);
    let one = |(case, found): (&NematicCase, &Option<NematicRow>)| -> Result<_, AnalysisError> {
        if found.is_some() || settings.interrupt.is_requested() {
            return Ok(None);
        }
        let name = name(case);
        let told = |p: &Progress| {
            progress(Event::Working {
                name: &name,
                what: &case::told(p),
            });
        };
        let run = CaseRun {
            scene,
            case,
            folder: &folder.join(&name),
            interrupt: &settings.interrupt,
            threads,
            told: &told,
        };
        let row = run.run()?;
        if let Some(row) = &row {
            progress(Event::Case {
                name: &name,
                n_done: n_done.fetch_add(1, Ordering::Relaxed) + 1,
                warnings: &row.warnings,
            });
        }
        Ok(row)
    };
    // strong charges take longest: they go first, so that no thread waits for them at the end
    let mut order: Vec<usize> = (0..cases.len()).collect();
    order.sort_by_key(|&k| (cases[k].flow.is_none(), std::cmp::Reverse(cases[k].q)));
    let mut computed: Vec<(usize, Option<NematicRow>)> = with_jobs(settings.jobs, || {
        let of = |&k: &usize| Ok((k, one((&cases[k], &found[k]))?));
        if together {
            order.par_iter().with_max_len(1).map(of).collect()
        } else {
            order.iter().map(of).collect::<Result<_, AnalysisError>>()
        }
    })??;
    computed.sort_by_key(|c| c.0);
    let n_computed = computed.iter().filter(|c| c.1.is_some()).count();
    let rows: Vec<NematicRow> = found
        .into_iter()
        .zip(computed)
        .filter_map(|(f, (_, c))| f.or(c))
        .collect();
    write_table(&folder.join("sweep.csv"), &rows)?;
    Ok(NematicReport {
        interrupted: settings.interrupt.is_requested() && rows.len() < cases.len(),
        rows,
        n_computed,
        n_reused,
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
            out: out.to_owned(),
            jobs,
            fresh: false,
            interrupt: Interrupt::new(),
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
            let scene = NematicScene::parse(&text, Path::new("scene.toml")).unwrap();
            let error = run_nematic_sweep(&scene, &settings(folder.path(), 1), &|_| {})
                .unwrap_err()
                .to_string();
            assert!(error.contains(word), "{change:?}: {error}");
        }
    }
}
