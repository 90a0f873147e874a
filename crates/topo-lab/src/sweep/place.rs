//! Where a case runs, and the folder that it writes.

use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::{Map, Value, json};
use topo_analysis::write_table;
use topo_core::{Progress, write_atomic_bytes};

use super::name::value;
use super::row::Row;
use crate::LabError;
use crate::battery::Battery;
use crate::folder::{Outcome, digests, forget_checkpoints, forget_file, make_folder};
use crate::progress::{Event, SweepSettings};

/// Where and how a case runs.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct Place<'a> {
    /// Whose case it is.
    pub battery: &'static dyn Battery,
    /// Its name.
    pub name: &'a str,
    /// Its fingerprint.
    pub fingerprint: &'a str,
    /// Its folder.
    pub folder: &'a Path,
    /// Of the sweep.
    pub settings: &'a SweepSettings,
    /// Whether it has all threads for itself.
    pub is_alone: bool,
    /// Processor seconds that it is expected to take on the models' machine.
    pub expected: f64,
    /// Called with what it does.
    pub progress: &'a (dyn Fn(Event<'_>) + Sync),
}

impl<'a> Place<'a> {
    /// Reports where the case is.
    pub fn working(&self, what: &str) {
        (self.progress)(Event::Working {
            name: self.name,
            what,
        });
    }

    /// Reports how far the case is.
    pub fn progressed(&self, progress: &Progress) {
        (self.progress)(Event::Progress {
            name: self.name,
            progress,
        });
    }

    /// The checkpoint file of one of the case's phases.
    pub fn checkpoint(&self, phase: &str) -> PathBuf {
        let name = format!("{phase}-{}.checkpoint", self.fingerprint);
        self.folder.join(name)
    }

    /// Reports that the case cannot go on from its checkpoint.
    pub(crate) fn tell_damaged(&self) {
        (self.progress)(Event::Replaced {
            names: &[self.name.to_owned()],
            reason: "its checkpoint is damaged",
        });
    }

    /// Runs the case; where a checkpoint cannot be used, that is reported, all checkpoints are forgotten, and the case begins again.
    pub(crate) fn or_anew<T>(
        &self,
        attempt: impl Fn() -> Result<T, LabError>,
    ) -> Result<T, LabError> {
        match attempt() {
            Err(error) if error.is_unusable_checkpoint() => {
                self.tell_damaged();
                forget_checkpoints(self.folder, "")?;
                attempt()
            }
            other => other,
        }
    }

    /// Opens the folder for the files of a case that has finished; what is there of an earlier run is replaced.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn open(&self) -> Result<CaseFolder<'a>, LabError> {
        make_folder(self.folder)?;
        // the mark of completeness of an earlier run goes first, so that a folder never mixes two
        forget_file(&self.folder.join(MARK))?;
        Ok(CaseFolder {
            place: *self,
            files: Vec::new(),
        })
    }
}

/// The file that marks a case complete.
const MARK: &str = "run.json";

/// The folder of a case while it is written: tables, then `run.json`.
pub struct CaseFolder<'a> {
    place: Place<'a>,
    files: Vec<&'static str>,
}

/// What a battery says of a case in its `run.json`, beside what all batteries say.
#[derive(Debug, Clone)]
pub struct About {
    /// What the case is.
    pub case: Value,
    /// What the scene is.
    pub scene: Value,
    /// Seed of what is random in it; none where nothing is.
    pub seed: Option<u64>,
    /// Units of length, time and energy.
    pub units: [&'static str; 3],
    /// Largest gap of the energy account, over the energy.
    pub ledger_residual: f64,
    /// Keys of its own, an object. A key that all batteries have, as `ledger_residual`, takes the place that it has here.
    pub more: Value,
}

impl CaseFolder<'_> {
    /// Writes a table of the case.
    ///
    /// # Errors
    /// A row that cannot stand in a table, or a file that cannot be written.
    pub fn table<T: Serialize>(&mut self, name: &'static str, rows: &[T]) -> Result<(), LabError> {
        write_table(&self.place.folder.join(name), rows)?;
        self.files.push(name);
        Ok(())
    }

    /// What `run.json` says of the case; a battery may say some of it in its own way.
    pub fn about<R: Row>(&self, outcome: &Outcome<R>, about: About) -> Map<String, Value> {
        let Place {
            battery,
            fingerprint,
            folder,
            ..
        } = self.place;
        let rows = &outcome.rows;
        let [length, time, energy] = about.units;
        let mut run = Map::new();
        let mut put = |key: &str, value: Value| run.insert(key.to_owned(), value);
        put("schema", battery.schema().into());
        put("fingerprint", fingerprint.into());
        put("case", about.case);
        put("scene", about.scene);
        if let Some(seed) = about.seed {
            put("seed", seed.into());
        }
        put(
            "versions",
            json!({ "topo": env!("CARGO_PKG_VERSION"), "results": battery.results() }),
        );
        put(
            "units",
            json!({ "length": length, "time": time, "energy": energy }),
        );
        if let Value::Object(more) = about.more {
            more.into_iter().for_each(|(key, value)| {
                put(&key, value);
            });
        }
        put("ledger_residual", about.ledger_residual.into());
        put("rows", value(rows));
        put("failure", value(&outcome.failure));
        put("files", value(&digests(folder, &self.files)));
        let warnings = rows.iter().map(Row::warnings).filter(|w| !w.is_empty());
        put("warnings", value(&warnings.collect::<Vec<_>>()));
        let seconds: f64 = rows.iter().map(Row::cpu_seconds).sum();
        put("timings", json!({ "cpu_seconds": seconds }));
        run
    }

    /// Writes `run.json`, last of all: a folder with this file is complete.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn finish(self, run: &Map<String, Value>) -> Result<(), LabError> {
        let mut text = serde_json::to_string_pretty(run).unwrap_or_default();
        text.push('\n');
        let path = self.place.folder.join(MARK);
        Ok(write_atomic_bytes(&path, text.as_bytes())?)
    }
}
