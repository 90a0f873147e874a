//! Shapes and fields of a case as files for other tools: VTK XML, numpy archives, input of nemaktis.

mod about;
mod colloid;
mod fibre;
mod field;
mod files;
mod npz;
#[cfg(test)]
mod tests;
mod vtk;

use crate::error::ViewError;
use crate::program::program;
use about::About;
pub use files::Wanted;
use files::{Files, damaged, refusal};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::{Path, PathBuf};
use topo_lab::{NEMATIC_RESULTS_VERSION, RESULTS_VERSION};

/// What an export made.
#[derive(Debug)]
pub struct Made {
    /// Its files.
    pub files: Vec<PathBuf>,
    /// What the user should know.
    pub notes: Vec<String>,
}

/// Writes the files of a case into a folder.
///
/// # Errors
/// A folder that holds no finished case of this results version, fields where none were kept, files that cannot be written.
pub fn write(case: &Path, folder: &Path, wanted: &Wanted) -> Result<Made, ViewError> {
    let run = finished(case)?;
    let mut files = Files {
        folder,
        made: Vec::new(),
        notes: Vec::new(),
    };
    let about = About::of(&run);
    match run["schema"].as_str() {
        Some("topo-elastic-case/1") => {
            check_version(case, &run, RESULTS_VERSION)?;
            if wanted.nemaktis.is_some() && !wanted.vtk && !wanted.npz {
                return Err(refusal(
                    case,
                    "a fibre has no director field for nemaktis: ask for vtk or npz",
                ));
            }
            let tube = part(case, "tube", &run["tube"])?;
            fibre::write(case, &tube, about, wanted, &mut files)?;
        }
        Some("topo-nematic-case/1") => {
            check_version(case, &run, NEMATIC_RESULTS_VERSION)?;
            let parameters = part(case, "case.nematic", &run["case"]["nematic"])?;
            colloid::write(case, &parameters, about, wanted, &mut files)?;
        }
        other => {
            let found = other.unwrap_or("not given");
            return Err(refusal(
                case,
                &format!(
                    "the schema of its run.json is {found}, neither that of a fibre (topo-elastic-case/1) nor that of a colloid \
                     (topo-nematic-case/1): name the folder of a case that `{} run` or `figures` computed",
                    program()
                ),
            ));
        }
    }
    Ok(Made {
        files: files.made,
        notes: files.notes,
    })
}

/// What `run.json` of a finished case says.
fn finished(case: &Path) -> Result<Value, ViewError> {
    let path = case.join("run.json");
    let text = std::fs::read_to_string(&path).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory => {
            refusal(case, &why_no_case(case))
        }
        _ => ViewError::File {
            path: path.clone(),
            source,
        },
    })?;
    serde_json::from_str(&text).map_err(|e| damaged(case, "run.json", &e.to_string()))
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

/// Numbers of another results version may mean something else.
fn check_version(case: &Path, run: &Value, version: u32) -> Result<(), ViewError> {
    let found = &run["versions"]["results"];
    if found.as_u64() == Some(u64::from(version)) {
        return Ok(());
    }
    let by = run["versions"]["topo"].as_str().unwrap_or("unknown");
    Err(refusal(
        case,
        &format!(
            "a case of results version {found} (topo {by}), and this program reads version {version}: run its scene again, which \
             computes the case anew, or export it with the program that computed it"
        ),
    ))
}

/// A part of `run.json`.
fn part<T: DeserializeOwned>(case: &Path, name: &str, value: &Value) -> Result<T, ViewError> {
    serde_json::from_value(value.clone())
        .map_err(|e| damaged(case, "run.json", &format!("{name}: {e}")))
}
