//! `topo export CASE`: files for ParaView, PyVista, numpy and nemaktis.

use crate::batteries::Batteries;
use crate::cli::{ExportArgs, ExportFormat};
use crate::duration::count;
use crate::error::CliError;
use crate::output;
use crate::progress::waiting;
use topo_view::export::{self, Wanted};

/// Writes the files of a case of one of the batteries.
pub fn run(args: &ExportArgs, batteries: &Batteries<'_>) -> Result<(), CliError> {
    if !(args.micrometres > 0.0 && args.micrometres <= 1e6) {
        return Err(CliError::Argument {
            key: "--micrometres",
            value: args.micrometres.to_string(),
            remedy: "a positive length up to 1e6 is needed, such as 0.00663".to_owned(),
        });
    }
    let any = |formats: &[ExportFormat]| {
        args.format == ExportFormat::All || formats.contains(&args.format)
    };
    let wanted = Wanted {
        vtk: any(&[ExportFormat::Vtk]),
        npz: any(&[ExportFormat::Npz]),
        nemaktis: any(&[ExportFormat::Nemaktis]).then_some(args.micrometres),
    };
    let folder = args.to.clone().unwrap_or_else(|| args.case.join("export"));
    let made = waiting("writing", || {
        export::write(&args.case, &folder, &wanted, batteries)
    })?;
    output::out(&folder);
    output::data("files", &made.files);
    for note in &made.notes {
        output::warning(note);
        say!("note: {note}");
    }
    let n = count(made.files.len(), "file");
    say!("{n} written to {}", folder.display());
    Ok(())
}
