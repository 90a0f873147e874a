//! `topo figures FOLDER`: pictures of what a folder of results holds.

use std::path::Path;

use crate::error::CliError;
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use topo_view::{Shown, folder};

/// Draws the sweeps of the batteries that lie in a folder.
pub fn run(place: &Path, batteries: &[&dyn Shown]) -> Result<(), CliError> {
    let interrupt = interrupt::install();
    let found = folder::find(place, batteries)?;
    let progress = Progress::start("drawing", found.sweeps.len());
    let made = folder::draw(&found, &interrupt, &|name| progress.done(name))?;
    progress.finish();
    output::out(place);
    let is_table = |p: &&std::path::PathBuf| p.extension().is_some_and(|e| e == "csv");
    made.files
        .iter()
        .filter(is_table)
        .for_each(|p| output::table(p));
    let pictures: Vec<String> = made
        .files
        .iter()
        .filter(|p| !is_table(p))
        .map(|p| p.display().to_string())
        .collect();
    output::data("pictures", pictures);
    output::data("page", made.page.display().to_string());
    for line in &made.drawn {
        say!("{line}");
    }
    for case in &made.failed {
        output::failed(case);
        say!("failed: {}: {}", case.case, case.reason);
    }
    for note in &made.notes {
        output::warning(note);
        say!("note: {note}");
    }
    say!("page: {}", made.page.display());
    Ok(())
}
