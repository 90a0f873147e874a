//! Shapes and fields of a case as files for other tools: VTK XML, numpy archives, input of nemaktis.

mod colloid;
mod fibre;
mod npz;
#[cfg(test)]
mod tests;
mod vtk;

use crate::error::XtaskError;
use std::path::{Path, PathBuf};

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
pub fn write(case: &Path, folder: &Path, wanted: &Wanted) -> Result<Made, XtaskError> {
    let path = case.join("run.json");
    let text = std::fs::read_to_string(&path).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => XtaskError::Missing {
            path: path.clone(),
            remedy: "name the folder of one finished case, such as results/elastic/3_1_twist+0.00_shrunk_n200",
        },
        _ => XtaskError::File {
            path: path.clone(),
            source,
        },
    })?;
    let wrong = |reason: String| XtaskError::Table {
        path: path.clone(),
        reason,
    };
    let run: serde_json::Value = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
    let mut files = Files {
        folder,
        made: Vec::new(),
        notes: Vec::new(),
    };
    match run["schema"].as_str() {
        Some("topo-elastic-case/1") => {
            if wanted.nemaktis.is_some() && !wanted.vtk && !wanted.npz {
                return Err(wrong(
                    "a fibre has no director field for nemaktis".to_owned(),
                ));
            }
            fibre::write(case, wanted, &mut files)?;
        }
        Some("topo-nematic-case/1") => {
            let parameters = serde_json::from_value(run["case"]["nematic"].clone())
                .map_err(|e| wrong(format!("case.nematic: {e}")))?;
            colloid::write(case, &parameters, wanted, &mut files)?;
        }
        other => {
            let found = other.unwrap_or("nothing");
            return Err(wrong(format!(
                "its schema is {found}, not topo-elastic-case/1 or topo-nematic-case/1"
            )));
        }
    }
    Ok(Made {
        files: files.made,
        notes: files.notes,
    })
}
