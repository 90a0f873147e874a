//! Pictures of whatever a folder of results holds: a sweep of any battery, or several of them, with a page that shows them.

mod drawn;
mod find;
mod page;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use drawn::{DrawnSweep, Shot};

use crate::data;
use crate::error::{ViewError, check};
use crate::export::files::refusal;
use crate::figures::Drawn;
use crate::shown::Shown;
use crate::sweeps::{Cases, against, curves, parts};
use topo_core::Interrupt;
use topo_lab::FailedCase;

pub use find::{Found, find};

/// What drawing a folder made.
#[derive(Debug)]
pub struct Made {
    /// The page.
    pub page: PathBuf,
    /// Pictures and their numbers.
    pub files: Vec<PathBuf>,
    /// What was drawn of each sweep, in words.
    pub drawn: Vec<String>,
    /// Cases that failed.
    pub failed: Vec<FailedCase>,
    /// What was not drawn or is not there, and why.
    pub notes: Vec<String>,
}

/// Writes the pictures of a sweep into `place`, and adds them to `files`; gives a line that says what was drawn.
fn write_shots(
    sweep: &DrawnSweep,
    place: &Path,
    interrupt: &Interrupt,
    files: &mut Vec<PathBuf>,
) -> Result<String, ViewError> {
    let mut names = Vec::new();
    for shot in &sweep.shots {
        check(interrupt)?;
        let picture = &shot.drawn.picture;
        for (extension, bytes) in [
            ("csv", shot.drawn.csv.as_bytes()),
            ("svg", picture.svg.as_bytes()),
            ("png", &picture.png[..]),
        ] {
            let path = place.join(format!("{}.{extension}", shot.name));
            data::write(&path, bytes)?;
            files.push(path);
        }
        names.push(shot.name.as_str());
    }
    Ok(format!(
        "{}: {}, {} discharges: {}",
        sweep.name,
        sweep.what,
        sweep.cases.rows.len(),
        names.join(", ")
    ))
}

/// Draws the sweeps found into `FOLDER/figures`, the page last; `done` hears of each sweep. Nothing is written before all is drawn.
///
/// # Errors
/// Tables that cannot be read, sweeps without a finished case, files that cannot be written, or a stop.
pub fn draw(
    found: &Found<'_>,
    interrupt: &Interrupt,
    done: &dyn Fn(&str),
) -> Result<Made, ViewError> {
    let mut sweeps = Vec::new();
    for (folder, battery) in &found.sweeps {
        sweeps.push(sweep(found, folder, *battery, interrupt)?);
        done(&sweeps[sweeps.len() - 1].name);
    }
    if sweeps.iter().all(|s| s.cases.rows.is_empty()) {
        return Err(refusal(&found.folder, &why_nothing(&sweeps)));
    }
    let place = found.folder.join("figures");
    let (mut files, mut drawn) = (Vec::new(), Vec::new());
    for sweep in &sweeps {
        drawn.push(write_shots(sweep, &place, interrupt, &mut files)?);
    }
    let page = place.join("index.html");
    data::write(
        &page,
        page::write(&found.folder, &sweeps, &found.foreign).as_bytes(),
    )?;
    let failed = sweeps.iter().flat_map(|s| s.cases.failed.clone());
    let failed = failed.collect();
    let mut notes: Vec<String> = sweeps.iter().flat_map(DrawnSweep::remarks).collect();
    notes.extend(
        found
            .foreign
            .iter()
            .map(|(folder, why)| format!("{}: not drawn: {why}", folder.display())),
    );
    Ok(Made {
        page,
        files,
        drawn,
        failed,
        notes,
    })
}

/// Draws all of one sweep.
fn sweep(
    found: &Found<'_>,
    folder: &Path,
    battery: &dyn Shown,
    interrupt: &Interrupt,
) -> Result<DrawnSweep, ViewError> {
    let cases = Cases::read(folder, battery.guide())?;
    let is_all = *folder == found.folder;
    let name = found.name_of(folder);
    let mut shots = Vec::new();
    let mut add = |stem: &str, title: String, drawn: Option<Drawn>| {
        shots.extend(drawn.map(|drawn| Shot {
            name: if is_all {
                stem.to_owned()
            } else {
                format!("{}-{stem}", name.replace('/', "-"))
            },
            title,
            drawn,
        }));
    };
    if !cases.rows.is_empty() {
        for swept in &cases.swept {
            check(interrupt)?;
            let stem = format!("over-{}", swept.setting.column.replace('_', "-"));
            let title = format!("Results against: {}", swept.setting.label);
            add(&stem, title, against::draw(&cases, swept)?);
        }
        check(interrupt)?;
        add(
            "curves",
            "Discharge curves".to_owned(),
            curves::draw(&cases)?,
        );
        let title = "Energy of the discharge, part by part".to_owned();
        add("parts", title, parts::draw(&cases)?);
        for own in battery.pictures() {
            check(interrupt)?;
            add(own.name, own.title.to_owned(), (own.draw)(&cases)?);
        }
    }
    Ok(DrawnSweep {
        notes: find::other_version(folder, battery).into_iter().collect(),
        what: battery.what(),
        name,
        cases,
        shots,
    })
}

/// What to say of a folder in which no case is finished.
fn why_nothing(sweeps: &[DrawnSweep]) -> String {
    let lacks: Vec<String> = sweeps.iter().flat_map(DrawnSweep::lacks).collect();
    let lacks = if lacks.is_empty() {
        String::new()
    } else {
        format!(" ({})", lacks.join("; "))
    };
    format!(
        "no case is finished, so there is nothing to draw{lacks}; run the scene again, which goes on from where it was"
    )
}
