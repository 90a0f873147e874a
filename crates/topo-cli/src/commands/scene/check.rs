//! `topo scene check FILE`: all that is wrong with scene files.

use std::path::PathBuf;

use topo_lab::scene_faults;

use crate::batteries::Batteries;
use crate::commands::knot::print;
use crate::duration::count;
use crate::error::CliError;
use crate::output;

/// Prints the table of faults.
pub fn run(files: &[PathBuf], batteries: &Batteries<'_>) -> Result<(), CliError> {
    let mut faults = Vec::new();
    for file in files {
        faults.extend(scene_faults(batteries, file)?);
    }
    output::data("faults", &faults);
    let mut table = csv::WriterBuilder::new()
        .has_headers(false)
        .from_writer(Vec::new());
    let wrong = |e: csv::Error| CliError::Step(format!("the table of faults: {e}"));
    table
        .write_record(["file", "line", "column", "key", "found", "expected"])
        .map_err(wrong)?;
    for fault in &faults {
        table.serialize(fault).map_err(wrong)?;
    }
    let text = table.into_inner().unwrap_or_default();
    print(&String::from_utf8_lossy(&text));
    match faults.len() {
        0 => Ok(()),
        n => Err(CliError::Input(format!(
            "{} found; `topo run` shows where the first one is",
            count(n, "fault")
        ))),
    }
}
