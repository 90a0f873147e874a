//! An elastic scene as an experiment: tight shapes first, then its cases.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::Path;

use topo_knots::KnotTable;

use super::battery::Elastic;
use super::breaking;
use super::case::ElasticCase;
use super::case_run::CaseInputs;
use super::cost::cost_of;
use super::identity::fingerprint;
use super::print;
use super::run;
use super::scene::ElasticScene;
use super::si;
use super::starts;
use super::tied::{Made, Start};
use crate::LabError;
use crate::battery::{Battery, Stage};
use crate::cost::{Cost, Estimate};
use crate::folder::Outcome;
use crate::goal::{Choice, ErrorRow, errors_of_rods};
use crate::progress::{Event, SweepSettings};
use crate::sweep::{self, Experiment, Place, SweepReport};
use topo_analysis::SweepRow;

/// What an elastic sweep leaves behind.
pub type ElasticReport = SweepReport<SweepRow>;

/// An elastic scene with the knots that it may name.
#[derive(Debug, Clone)]
pub struct Rods<'a> {
    scene: Cow<'a, ElasticScene>,
    table: Cow<'a, KnotTable>,
}

impl<'a> Rods<'a> {
    /// The experiment of a scene.
    pub fn of(scene: &'a ElasticScene, table: &'a KnotTable) -> Self {
        Self {
            scene: Cow::Borrowed(scene),
            table: Cow::Borrowed(table),
        }
    }

    /// The experiment of a scene of its own.
    pub(super) fn owned(scene: ElasticScene, table: KnotTable) -> Self {
        Self {
            scene: Cow::Owned(scene),
            table: Cow::Owned(table),
        }
    }

    fn with(&self, scene: ElasticScene) -> Self {
        Self {
            scene: Cow::Owned(scene),
            ..self.clone()
        }
    }
}

impl Experiment for Rods<'_> {
    type Case = ElasticCase;
    type Row = SweepRow;
    /// Starts by name; why not where there is none.
    type Start = BTreeMap<String, Result<Made, String>>;

    fn battery(&self) -> &'static dyn Battery {
        &Elastic
    }

    fn folder(&self) -> &str {
        &self.scene.folder
    }

    fn text(&self) -> String {
        self.scene.resolved_text()
    }

    fn cases(&self) -> Result<Vec<ElasticCase>, LabError> {
        self.scene.cases(&self.table)
    }

    fn name(&self, case: &ElasticCase) -> String {
        self.scene.case_name(case)
    }

    fn fingerprint(&self, case: &ElasticCase) -> Result<String, LabError> {
        let entry = case.entry(&self.table)?;
        Ok(fingerprint(&self.scene, case, &entry))
    }

    fn blank_row(&self, case: &ElasticCase) -> SweepRow {
        self.scene.blank_row(case)
    }

    fn cost(&self, case: &ElasticCase, n_rows: Option<usize>) -> Result<Cost, LabError> {
        let entry = case.entry(&self.table)?;
        Ok(cost_of(&self.scene, case, &entry, n_rows))
    }

    fn stages_before(&self, settings: &SweepSettings) -> Result<Vec<Stage>, LabError> {
        let Self { scene, table } = self;
        let out = &settings.out;
        if scene.tie.is_some() {
            let estimate =
                starts::estimate(&scene.cases(table)?, &scene.tighten, out, settings.jobs);
            return Ok(vec![Stage::shapes(estimate)]);
        }
        let names = scene.knots_used(table)?;
        let estimate = Estimate::of_shapes(&names, table, &scene.tighten, out, settings.jobs)?;
        Ok(vec![Stage::shapes(estimate)])
    }

    fn prepare(
        &self,
        todo: &[&ElasticCase],
        settings: &SweepSettings,
        progress: &(dyn Fn(Event<'_>) + Sync),
    ) -> Result<Self::Start, LabError> {
        let (tighten, table) = (&self.scene.tighten, &self.table);
        match self.scene.tie {
            Some(_) => starts::make(todo, tighten, settings, progress),
            None => starts::of_knots(todo, table, tighten, settings, progress),
        }
    }

    fn run(
        &self,
        case: &ElasticCase,
        shapes: &Self::Start,
        place: &Place<'_>,
    ) -> Result<Option<Outcome<SweepRow>>, LabError> {
        let made = match shapes.get(&case.start_name()) {
            Some(Ok(made)) => made,
            Some(Err(reason)) => {
                return Err(LabError::Shape {
                    knot: case.knot.clone(),
                    reason: reason.clone(),
                });
            }
            // interrupted while shapes were made
            None => return Ok(None),
        };
        let Some(start) = Start::of(made, case) else {
            return Ok(None);
        };
        let inputs = CaseInputs {
            scene: &self.scene,
            case,
            start,
            table: &self.table,
        };
        run::run(&inputs, place)
    }

    fn header(&self) -> String {
        print::header(self.scene.si.as_ref())
    }

    fn legend(&self) -> &'static [&'static str] {
        print::legend(self.scene.si.as_ref())
    }

    fn line(&self, row: &SweepRow) -> String {
        print::line(row, self.scene.si.as_ref())
    }

    fn findings(&self, rows: &[SweepRow]) -> Vec<String> {
        let breaking = self.scene.charge.breaking;
        let of = |bears| {
            rows.iter()
                .filter_map(move |row| breaking::line(bears, row))
        };
        breaking.into_iter().flat_map(of).collect()
    }

    fn write_beside(&self, folder: &Path, rows: &[SweepRow]) -> Result<(), LabError> {
        si::write(folder, self.scene.si.as_ref(), rows)
    }

    fn choose_settings(&mut self, jobs: usize) -> Result<Option<Choice>, LabError> {
        let (scene, choice) = self.scene.with_chosen_settings(&self.table, jobs)?;
        *self = self.with(scene);
        Ok(choice)
    }

    fn coarser(&self, choice: &Choice, rows: &[SweepRow]) -> Result<Option<Self>, LabError> {
        let scene = self.scene.check_of(&self.table, choice, rows)?;
        Ok(Some(self.with(scene)))
    }

    fn errors(&self, choice: &Choice, rows: &[SweepRow], coarser: &[SweepRow]) -> Vec<ErrorRow> {
        errors_of_rods(choice, rows, coarser)
    }
}

/// Runs all cases of a scene; what an earlier run finished with the same settings is kept, and a case that was interrupted or
/// killed goes on from its last checkpoint.
///
/// Each case writes its own folder and is complete when its `run.json` is there; `sweep.csv`, and `failed.csv` where a case failed,
/// are written at the end, also after an interrupt, from what is finished. Results do not depend on the number of jobs.
///
/// # Errors
/// An unknown knot, a folder with the results of another scene, or files that cannot be written. A case that fails is no error: it
/// is in the report.
pub fn run_sweep(
    scene: &ElasticScene,
    table: &KnotTable,
    settings: &SweepSettings,
    progress: &(dyn Fn(Event<'_>) + Sync),
) -> Result<ElasticReport, LabError> {
    sweep::run(&Rods::of(scene, table), settings, progress)
}

/// What [`run_sweep`] is expected to take for what is not finished, the start shapes not counted.
///
/// # Errors
/// An unknown knot, or a folder with the results of another scene.
pub fn estimate_sweep(
    scene: &ElasticScene,
    table: &KnotTable,
    settings: &SweepSettings,
) -> Result<Estimate, LabError> {
    sweep::estimate(&Rods::of(scene, table), settings)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::Ordering;

    use topo_core::Phase;

    use super::*;
    use crate::RESULTS_VERSION;

    const SCENE: &str = "[rod]\nknot = \"3_1\"\ntwist = [0.0, 1.0]\n[rod.contact]\n[rod.friction]\n[charge]\nduration = 0.05\n[discharge]\nuntil_released = 0.3\nclosures = 4\n[accuracy]\nedges = 60\ntolerance = 1e-2\n";

    fn settings(out: &Path, jobs: usize) -> SweepSettings {
        SweepSettings {
            jobs,
            ..SweepSettings::new(out)
        }
    }

    fn timeless(report: &ElasticReport) -> Vec<SweepRow> {
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
        let results = folder.path().join(&scene.folder);
        let first_case = results.join(&first.rows[0].case);
        let read = |file: &str| std::fs::read(first_case.join(file)).unwrap();
        let series = read("series.csv");
        let again = run_sweep(&scene, &table, &settings(folder.path(), 2), &|_| {}).unwrap();
        assert_eq!((again.n_computed, again.n_reused), (0, 2));
        assert_eq!(again.rows, first.rows);
        let mark = first_case.join("run.json");
        std::fs::write(&mark, "{\"fingerprint\": ").unwrap();
        let mended = run_sweep(&scene, &table, &settings(folder.path(), 1), &|_| {}).unwrap();
        assert_eq!((mended.n_computed, mended.n_reused), (1, 1));
        assert_eq!(timeless(&mended), timeless(&first));
        assert_eq!(read("series.csv"), series);
        let mut other = scene.clone();
        other.accuracy.tolerance = 2e-2;
        let refused = run_sweep(&other, &table, &settings(folder.path(), 0), &|_| {});
        let refused = refused.unwrap_err().to_string();
        assert!(
            refused.contains("accuracy.tolerance = 0.01 there, 0.02 here"),
            "{refused}"
        );
        // a scene may grow
        let mut longer = scene.clone();
        longer.twists.push(0.5);
        let grown = run_sweep(&longer, &table, &settings(folder.path(), 0), &|_| {}).unwrap();
        assert_eq!((grown.n_computed, grown.n_reused), (1, 2));
        assert_eq!(grown.rows[..2], mended.rows[..]);
        assert!(run_sweep(&scene, &table, &settings(folder.path(), 0), &|_| {}).is_err());
    }

    #[test]
    fn what_an_earlier_run_left_is_distinguished_and_computed_again() {
        let table = KnotTable::builtin();
        let scene = ElasticScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let sweep = |scene: &ElasticScene| {
            let replaced = std::sync::Mutex::new(Vec::new());
            let report = run_sweep(scene, &table, &settings(folder.path(), 1), &|event| {
                if let Event::Replaced { names, reason } = event {
                    replaced
                        .lock()
                        .unwrap()
                        .push((reason.to_owned(), names.len()));
                }
            })
            .unwrap();
            (timeless(&report), replaced.into_inner().unwrap())
        };
        let (first, replaced) = sweep(&scene);
        assert!(replaced.is_empty());
        let case = folder.path().join(&scene.folder).join(&first[0].case);
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
            let (rows, replaced) = sweep(&scene);
            assert_eq!(rows, first);
            assert!(replaced.len() == 1 && replaced[0].1 == 1, "{replaced:?}");
            assert!(replaced[0].0.contains(reason), "{replaced:?}");
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
            let (rows, replaced) = sweep(&scene);
            assert_eq!(rows, first);
            assert!(
                replaced.len() == 1 && replaced[0].0.contains("missing or damaged"),
                "{replaced:?}"
            );
            assert!(std::fs::read(&path).unwrap() == whole);
        }
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
            let case = &scene.cases(&table).unwrap()[usize::from(shard == "2/2")];
            let name = scene.case_name(case);
            let to = merged.path().join(&scene.folder).join(&name);
            std::fs::create_dir_all(&to).unwrap();
            for file in std::fs::read_dir(elsewhere.path().join(&scene.folder).join(&name)).unwrap()
            {
                let file = file.unwrap();
                std::fs::copy(file.path(), to.join(file.file_name())).unwrap();
            }
            let only_gather = SweepSettings {
                only_finished: true,
                ..settings(merged.path(), 1)
            };
            let so_far = run_sweep(&scene, &table, &only_gather, &|_| {}).unwrap();
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

    /// Stopped inside the charge and inside the discharge of a rod: its checkpoint stays, the next run goes on from it, and a finished
    /// case leaves none behind. A checkpoint that is damaged is reported, and the case begun again.
    #[test]
    fn a_rod_that_was_stopped_goes_on() {
        let table = KnotTable::builtin();
        let scene = ElasticScene::parse(SCENE, Path::new("scene.toml")).unwrap();
        let calm = tempfile::tempdir().unwrap();
        let first = run_sweep(&scene, &table, &settings(calm.path(), 1), &|_| {}).unwrap();
        let torn = tempfile::tempdir().unwrap();
        let case = |out: &Path| out.join(&scene.folder).join(&first.rows[0].case);
        let checkpoints = || {
            let entries = std::fs::read_dir(case(torn.path())).into_iter().flatten();
            let paths = entries.map(|e| e.unwrap().path());
            let is_one = |p: &std::path::PathBuf| p.extension().is_some_and(|e| e == "checkpoint");
            let mut found: Vec<_> = paths.filter(is_one).collect();
            found.sort();
            found
        };
        let stop_at = |phase: Phase, step: u64| {
            let stopping = settings(torn.path(), 1);
            let report = run_sweep(&scene, &table, &stopping, &|event| {
                if let Event::Progress { progress, .. } = event
                    && (progress.phase, progress.step) == (phase, step)
                {
                    stopping.interrupt.request();
                }
            })
            .unwrap();
            assert!(report.interrupted && report.rows.is_empty());
        };
        let replaced = std::sync::Mutex::new(Vec::new());
        let finish = || {
            let report = run_sweep(&scene, &table, &settings(torn.path(), 1), &|event| {
                if let Event::Replaced { reason, .. } = event {
                    replaced.lock().unwrap().push(reason.to_owned());
                }
            })
            .unwrap();
            assert_eq!(timeless(&report), timeless(&first));
            for file in ["charge.csv", "series.csv", "snapshots.csv"] {
                let [a, b] =
                    [calm.path(), torn.path()].map(|out| std::fs::read(case(out).join(file)));
                assert!(a.unwrap() == b.unwrap(), "{file}");
            }
            assert!(checkpoints().is_empty());
        };
        stop_at(Phase::Charge, 3);
        assert_eq!(checkpoints().len(), 1);
        stop_at(Phase::Discharge, 5);
        stop_at(Phase::Discharge, 9);
        assert_eq!(checkpoints().len(), 2, "the charge and the discharge");
        finish();
        for damaged in 0..2 {
            std::fs::remove_dir_all(torn.path().join(&scene.folder)).unwrap();
            stop_at(Phase::Discharge, 9);
            std::fs::write(&checkpoints()[damaged], b"TOPOCKPT nonsense").unwrap();
            finish();
        }
        let damaged = "its checkpoint is damaged";
        assert_eq!(replaced.into_inner().unwrap(), [damaged, damaged]);
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
        let entries: Vec<_> = std::fs::read_dir(folder.path().join(&scene.folder))
            .unwrap()
            .collect();
        assert_eq!(entries.len(), 2, "only the table and the scene");
    }
}
