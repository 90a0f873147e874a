//! Shapes and fields of a case as files for other tools: VTK XML, numpy archives, input of nemaktis.

mod about;
pub(crate) mod colloid;
pub(crate) mod fibre;
mod field;
pub(crate) mod files;
pub(crate) mod finished;
mod npz;
#[cfg(test)]
mod tests;
mod vtk;

pub use about::{About, Fact};
pub use files::{Files, Wanted};
pub use finished::Finished;
pub use npz::{Archive, Element};
pub use vtk::{Array, line};

use crate::error::ViewError;
use crate::program::program;
use crate::shown::Shown;
use files::refusal;
use std::path::{Path, PathBuf};

/// What an export made.
#[derive(Debug)]
pub struct Made {
    /// Its files.
    pub files: Vec<PathBuf>,
    /// What the user should know.
    pub notes: Vec<String>,
}

/// Writes the files of a case of one of the batteries into a folder.
///
/// # Errors
/// A folder that holds no finished case of this results version, fields where none were kept, files that cannot be written.
pub fn write(
    case: &Path,
    folder: &Path,
    wanted: &Wanted,
    batteries: &[&dyn Shown],
) -> Result<Made, ViewError> {
    let case = Finished::read(case)?;
    let Some(battery) = batteries.iter().find(|b| b.schema() == case.schema()) else {
        return Err(refusal(case.folder, &of_no_battery(&case, batteries)));
    };
    case.check_version(battery.results())?;
    let mut files = Files {
        folder,
        made: Vec::new(),
        notes: Vec::new(),
    };
    battery.export(&case, wanted, &mut files)?;
    Ok(Made {
        files: files.made,
        notes: files.notes,
    })
}

/// What to say of a case that none of the batteries knows.
fn of_no_battery(case: &Finished<'_>, batteries: &[&dyn Shown]) -> String {
    let found = match case.schema() {
        "" => "not given",
        schema => schema,
    };
    let known: Vec<String> = batteries
        .iter()
        .map(|b| format!("that of {} ({})", b.what(), b.schema()))
        .collect();
    format!(
        "the schema of its run.json is {found}, and known are {}: name the folder of a case that `{} run` or `figures` computed",
        known.join(" and "),
        program()
    )
}
