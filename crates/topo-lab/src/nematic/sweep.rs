//! A nematic scene as an experiment.

use std::path::Path;

use topo_nematic::{NematicBattery, Threads};

use super::battery::Colloid;
use super::case::NematicCase;
use super::cost::case_cost;
use super::field;
use super::identity::fingerprint;
use super::print;
use super::run::ColloidRun;
use super::scene::NematicScene;
use crate::LabError;
use crate::battery::Battery;
use crate::cost::{Cost, Estimate};
use crate::folder::Outcome;
use crate::goal::{Choice, ErrorRow, errors_of_colloids};
use crate::progress::{Event, SweepSettings};
use crate::sweep::{self, Experiment, Place, SweepReport};
use topo_analysis::NematicRow;

/// What a nematic sweep leaves behind.
pub type NematicReport = SweepReport<NematicRow>;

impl Experiment for NematicScene {
    type Case = NematicCase;
    type Row = NematicRow;
    type Start = ();

    fn battery(&self) -> &'static dyn Battery {
        &Colloid
    }

    fn folder(&self) -> &str {
        &self.folder
    }

    fn text(&self) -> String {
        self.resolved_text()
    }

    fn cases(&self) -> Result<Vec<NematicCase>, LabError> {
        Ok(NematicScene::cases(self))
    }

    fn name(&self, case: &NematicCase) -> String {
        self.case_name(case)
    }

    fn fingerprint(&self, case: &NematicCase) -> Result<String, LabError> {
        Ok(fingerprint(self, case))
    }

    fn blank_row(&self, case: &NematicCase) -> NematicRow {
        NematicScene::blank_row(self, case)
    }

    fn cost(&self, case: &NematicCase, _n_rows: Option<usize>) -> Result<Cost, LabError> {
        let battery = NematicBattery::new(&case.nematic, &self.accuracy);
        let battery = battery.map_err(|source| LabError::Nematic {
            case: self.case_name(case),
            source,
        })?;
        Ok(case_cost(case, &battery))
    }

    fn uses_all_threads(&self) -> bool {
        true
    }

    fn has_all(&self, folder: &Path, settings: &SweepSettings) -> bool {
        !settings.keep_fields || field::are_kept(folder)
    }

    fn prepare(
        &self,
        _todo: &[&NematicCase],
        _settings: &SweepSettings,
        _progress: &(dyn Fn(Event<'_>) + Sync),
    ) -> Result<(), LabError> {
        Ok(())
    }

    fn run(
        &self,
        case: &NematicCase,
        _start: &(),
        place: &Place<'_>,
    ) -> Result<Option<Outcome<NematicRow>>, LabError> {
        let threads = if place.is_alone {
            Threads::All
        } else {
            Threads::One
        };
        ColloidRun {
            scene: self,
            case,
            place,
            threads,
        }
        .run()
    }

    fn header(&self) -> String {
        print::HEADER.to_owned()
    }

    fn legend(&self) -> &'static [&'static str] {
        print::LEGEND
    }

    fn line(&self, row: &NematicRow) -> String {
        print::line(row)
    }

    fn findings(&self, rows: &[NematicRow]) -> Vec<String> {
        print::resonances(rows)
    }

    fn choose_settings(&mut self, jobs: usize) -> Result<Option<Choice>, LabError> {
        let (scene, choice) = self.with_chosen_settings(jobs)?;
        *self = scene;
        Ok(choice)
    }

    fn coarser(&self, choice: &Choice, _rows: &[NematicRow]) -> Result<Option<Self>, LabError> {
        Ok(Some(self.check_of(choice)))
    }

    fn errors(
        &self,
        choice: &Choice,
        rows: &[NematicRow],
        coarser: &[NematicRow],
    ) -> Vec<ErrorRow> {
        errors_of_colloids(choice, rows, coarser)
    }
}

/// Runs all cases of a scene; what an earlier run finished with the same settings is kept, and a case that was interrupted or
/// killed goes on from its last checkpoint.
///
/// Each case writes its own folder and is complete when its `run.json` is there; `sweep.csv`, and `failed.csv` where a case failed,
/// are written at the end, also after an interrupt, from what is finished, whichever shard computed it. Results do not depend on
/// the number of jobs.
///
/// # Errors
/// Parameters that make no sense, a grid that does not fit in memory, a folder with the results of another scene, or files that
/// cannot be written; all cases are looked at before the first is computed. A case that fails is no error: it is in the report.
pub fn run_nematic_sweep(
    scene: &NematicScene,
    settings: &SweepSettings,
    progress: &(dyn Fn(Event<'_>) + Sync),
) -> Result<NematicReport, LabError> {
    sweep::run(scene, settings, progress)
}

/// What [`run_nematic_sweep`] is expected to take for what is not finished; a case that was begun counts in full.
///
/// # Errors
/// Parameters that make no sense, a grid that does not fit in memory, or a folder with the results of another scene.
pub fn estimate_nematic_sweep(
    scene: &NematicScene,
    settings: &SweepSettings,
) -> Result<Estimate, LabError> {
    sweep::estimate(scene, settings)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use topo_core::{Interrupt, Phase};

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
        let case = folder.path().join(&scene.folder).join(&first.rows[0].case);
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
            if let Event::Progress { progress, .. } = event
                && (progress.phase, progress.step) == (Phase::Discharge, 4)
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
    fn a_damaged_checkpoint_is_reported_and_the_case_begun_anew() {
        let scene = NematicScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let calm = run_nematic_sweep(&scene, &settings(folder.path(), 1), &|_| {}).unwrap();
        let torn = tempfile::tempdir().unwrap();
        let stop_in = |phase: Phase| {
            let stop = Interrupt::new();
            let stopping = SweepSettings {
                interrupt: stop.clone(),
                ..settings(torn.path(), 1)
            };
            run_nematic_sweep(&scene, &stopping, &|event| {
                if let Event::Progress { progress, .. } = event
                    && (progress.phase, progress.step) == (phase, 4)
                {
                    stop.request();
                }
            })
            .unwrap();
        };
        for damaged in ["charge-", "discharge-", "snapshots-"] {
            stop_in(Phase::Discharge);
            let case = torn.path().join(&scene.folder).join(&calm.rows[0].case);
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
            let replaced = std::sync::Mutex::new(Vec::new());
            let mended = run_nematic_sweep(&scene, &settings(torn.path(), 1), &|event| {
                if let Event::Replaced { reason, .. } = event {
                    replaced.lock().unwrap().push(reason.to_owned());
                }
            })
            .unwrap();
            assert_eq!(timeless(&mended), timeless(&calm));
            assert_eq!(
                replaced.into_inner().unwrap(),
                ["its checkpoint is damaged"]
            );
            std::fs::remove_dir_all(torn.path().join(&scene.folder)).unwrap();
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
            // What is there can be gathered without computing the rest.
            let only_gather = SweepSettings {
                only_finished: true,
                ..settings(merged.path(), 1)
            };
            let so_far = run_nematic_sweep(&scene, &only_gather, &|_| {}).unwrap();
            assert!(so_far.n_computed == 0 && so_far.rows.len() == report.rows.len());
            assert!(report.wall_seconds > 0.0 && report.estimate.cpu_seconds > 0.0);
        }
        let report = run_nematic_sweep(&scene, &settings(merged.path(), 1), &|_| {}).unwrap();
        assert_eq!((report.n_computed, report.n_reused), (0, 2));
        assert_eq!(timeless(&report), timeless(&calm));
    }
}
