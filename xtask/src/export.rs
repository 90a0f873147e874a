//! Shapes and fields of a case as files for other tools: VTK XML, numpy archives, input of nemaktis.

mod about;
mod colloid;
mod fibre;
mod field;
mod npz;
#[cfg(test)]
mod tests;
mod vtk;

use crate::data;
use crate::error::XtaskError;
use about::About;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::path::{Path, PathBuf};
use topo_lab::{NEMATIC_RESULTS_VERSION, RESULTS_VERSION};

/// Which files.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// VTK XML.
    pub vtk: bool,
    /// Archives for numpy.
    pub npz: bool,
    /// Fields for nemaktis: micrometres that a correlation length stands for.
    pub nemaktis: Option<f64>,
}

/// The files of an export, noted as they are made.
pub struct Files<'a> {
    folder: &'a Path,
    made: Vec<PathBuf>,
    /// What the user should know.
    notes: Vec<String>,
}

impl Files<'_> {
    /// Place of a file, noted.
    fn place(&mut self, name: &str) -> PathBuf {
        let path = self.folder.join(name);
        self.made.push(path.clone());
        path
    }

    /// Writes the times of files, if there are any.
    fn series(&mut self, what: &str, files: &[(f64, String)]) -> Result<(), XtaskError> {
        if files.is_empty() {
            return Ok(());
        }
        vtk::series(&self.place(&format!("{what}.pvd")), files)
    }
}

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
pub fn write(case: &Path, folder: &Path, wanted: &Wanted) -> Result<Made, XtaskError> {
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
                     (topo-nematic-case/1): name the folder of a case that `cargo xtask run` or `figures` computed"
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
fn finished(case: &Path) -> Result<Value, XtaskError> {
    let path = case.join("run.json");
    let text = std::fs::read_to_string(&path).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound | std::io::ErrorKind::NotADirectory => {
            refusal(case, &why_no_case(case))
        }
        _ => XtaskError::File {
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
            "the folder of {} cases, no case itself; name one of them, such as {}",
            cases.len(),
            first.display()
        ),
        None => "no run.json is there, so it is no finished case; name the folder of one finished case, in which its run left \
                 that file"
            .to_owned(),
    }
}

/// Numbers of another results version may mean something else.
fn check_version(case: &Path, run: &Value, version: u32) -> Result<(), XtaskError> {
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
fn part<T: DeserializeOwned>(case: &Path, name: &str, value: &Value) -> Result<T, XtaskError> {
    serde_json::from_value(value.clone())
        .map_err(|e| damaged(case, "run.json", &format!("{name}: {e}")))
}

/// Rows of a table of the case.
fn table<T: DeserializeOwned>(case: &Path, name: &str) -> Result<Vec<T>, XtaskError> {
    data::read_csv(&case.join(name)).map_err(|e| match e {
        XtaskError::Missing { .. } => damaged(case, name, "not found"),
        XtaskError::Table { reason, .. } => damaged(case, name, &reason),
        other => other,
    })
}

fn damaged(case: &Path, name: &str, reason: &str) -> XtaskError {
    refusal(
        &case.join(name),
        &format!("{reason}; the case is damaged: run its scene again, which computes it anew"),
    )
}

fn refusal(path: &Path, reason: &str) -> XtaskError {
    XtaskError::Input(format!("{}: {reason}", path.display()))
}
