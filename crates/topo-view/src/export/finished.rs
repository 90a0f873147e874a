//! A finished case as exports read it: its folder and what its `run.json` says.

use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::about::About;
use super::files::{damaged, refusal};
use crate::error::ViewError;

/// A finished case.
#[derive(Debug)]
pub struct Finished<'a> {
    /// Its folder.
    pub folder: &'a Path,
    /// What its `run.json` says.
    pub run: Value,
}

impl<'a> Finished<'a> {
    /// Reads the mark of a case.
    ///
    /// # Errors
    /// A folder that holds no finished case, and what it is instead.
    pub fn read(folder: &'a Path) -> Result<Self, ViewError> {
        let path = folder.join("run.json");
        let text = std::fs::read_to_string(&path).map_err(|source| match source.kind() {
            std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory => {
                refusal(folder, &why_no_case(folder))
            }
            _ => ViewError::File {
                path: path.clone(),
                source,
            },
        })?;
        let run =
            serde_json::from_str(&text).map_err(|e| damaged(folder, "run.json", &e.to_string()))?;
        Ok(Self { folder, run })
    }

    /// What it calls itself; empty where it does not say.
    pub fn schema(&self) -> &str {
        self.run["schema"].as_str().unwrap_or("")
    }

    /// What its files say of it.
    pub fn about(&self) -> About {
        About::of(&self.run)
    }

    /// A part of `run.json`, its keys parted by dots.
    ///
    /// # Errors
    /// A part that is missing or no such thing.
    pub fn part<T: DeserializeOwned>(&self, name: &str) -> Result<T, ViewError> {
        let pointer = format!("/{}", name.replace('.', "/"));
        let value = self.run.pointer(&pointer).cloned().unwrap_or(Value::Null);
        serde_json::from_value(value)
            .map_err(|e| damaged(self.folder, "run.json", &format!("{name}: {e}")))
    }

    /// Refuses numbers of another results version, which may mean something else.
    pub(super) fn check_version(&self, version: u32) -> Result<(), ViewError> {
        let found = &self.run["versions"]["results"];
        if found.as_u64() == Some(u64::from(version)) {
            return Ok(());
        }
        let by = self.run["versions"]["topo"].as_str().unwrap_or("unknown");
        Err(refusal(
            self.folder,
            &format!(
                "a case of results version {found} (topo {by}), and this program reads version {version}: run its scene again, which \
                 computes the case again, or export it with the program that computed it"
            ),
        ))
    }
}

/// What a folder without `run.json` is instead, and what to do.
fn why_no_case(folder: &Path) -> String {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return "no such folder; name the folder of one finished case, in which its run left run.json"
            .to_owned();
    };
    let paths: Vec<PathBuf> = entries.flatten().map(|e| e.path()).collect();
    if paths
        .iter()
        .any(|p| p.extension().is_some_and(|e| e == "checkpoint"))
    {
        return "a case that is not finished: run its scene again, which goes on from where it was"
            .to_owned();
    }
    let mut cases: Vec<&PathBuf> = paths
        .iter()
        .filter(|p| p.join("run.json").exists())
        .collect();
    cases.sort();
    match cases.first() {
        Some(first) => format!(
            "a folder of cases ({}), no case itself; name one of them, such as {}",
            cases.len(),
            first.display()
        ),
        None => "no run.json is there, so it is no finished case; name the folder of one finished case, in which its run left \
                 that file"
            .to_owned(),
    }
}
