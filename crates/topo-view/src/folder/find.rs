//! Which sweeps lie in a folder, and of which batteries they are.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::error::ViewError;
use crate::export::files::refusal;
use crate::program::program;
use crate::shown::Shown;
use crate::sweeps::cases::{file_name, folders, has_checkpoint};

/// How deep sweeps are looked for.
const DEPTH: usize = 3;
/// Folders of files that were made of results.
const MADE: [&str; 2] = ["figures", "export"];

/// The sweeps of a folder.
pub struct Found<'a> {
    /// The folder.
    pub folder: PathBuf,
    /// Folders of sweeps with their batteries.
    pub sweeps: Vec<(PathBuf, &'a dyn Shown)>,
    /// Folders with tables that none of the batteries made, and why.
    pub foreign: Vec<(PathBuf, String)>,
}

impl Found<'_> {
    /// Name of a sweep below the folder.
    pub(super) fn name_of(&self, sweep: &Path) -> String {
        match sweep.strip_prefix(&self.folder) {
            Ok(below) if below != Path::new("") => below.display().to_string(),
            _ => std::path::absolute(sweep).map_or_else(|_| file_name(sweep), |p| file_name(&p)),
        }
    }
}

/// Finds the sweeps of a folder: itself, or those below it.
///
/// # Errors
/// A folder that holds none, and what would be right.
pub fn find<'a>(folder: &Path, batteries: &[&'a dyn Shown]) -> Result<Found<'a>, ViewError> {
    if !folder.is_dir() {
        let what = if folder.exists() {
            "a file"
        } else {
            "no such folder"
        };
        let text = format!("{what}; {}", right());
        return Err(refusal(folder, &text));
    }
    if folder.join("run.json").exists() {
        let text = format!(
            "one case of a sweep; name the folder above it, or write its shapes with `{} export`",
            program()
        );
        return Err(refusal(folder, &text));
    }
    let mut found = Found {
        folder: folder.to_owned(),
        sweeps: Vec::new(),
        foreign: Vec::new(),
    };
    search(folder, DEPTH, batteries, &mut found);
    match (&found.sweeps[..], &found.foreign[..]) {
        ([], []) => {
            let text = format!(
                "nothing to draw: no sweep.csv and no finished case; {}",
                right()
            );
            Err(refusal(folder, &text))
        }
        ([], [(place, why), ..]) => Err(refusal(place, &format!("{why}; {}", right()))),
        _ => Ok(found),
    }
}

fn right() -> String {
    format!(
        "name the folder of a scene that `{} run` wrote, such as results/my-scene, or one of such folders",
        program()
    )
}

fn search<'a>(folder: &Path, depth: usize, batteries: &[&'a dyn Shown], found: &mut Found<'a>) {
    if is_sweep(folder) {
        match battery_of(folder, batteries) {
            Ok(battery) => found.sweeps.push((folder.to_owned(), battery)),
            Err(why) => found.foreign.push((folder.to_owned(), why)),
        }
        return;
    }
    if depth == 0 {
        return;
    }
    for below in folders(folder) {
        if !MADE.contains(&file_name(&below).as_str()) {
            search(&below, depth - 1, batteries, found);
        }
    }
}

/// Whether a folder holds the table or the cases of a sweep.
fn is_sweep(folder: &Path) -> bool {
    let is_case = |p: &PathBuf| p.join("run.json").exists() || has_checkpoint(p);
    folder.join("sweep.csv").exists() || folders(folder).iter().any(is_case)
}

/// What the first finished case says of itself.
fn first_case(folder: &Path) -> Option<Value> {
    let mut runs = folders(folder).into_iter().map(|p| p.join("run.json"));
    runs.find_map(|path| {
        let text = std::fs::read_to_string(path).ok()?;
        let run: Value = serde_json::from_str(&text).ok()?;
        run["schema"].is_string().then_some(run)
    })
}

/// The battery of a sweep: by the schema of its cases, or where none is finished by the table of its scene.
fn battery_of<'a>(folder: &Path, batteries: &[&'a dyn Shown]) -> Result<&'a dyn Shown, String> {
    let known = || {
        let all: Vec<String> = batteries
            .iter()
            .map(|b| format!("{} ({})", b.what(), b.schema()))
            .collect();
        all.join(", ")
    };
    if let Some(run) = first_case(folder) {
        let schema = run["schema"].as_str().unwrap_or("");
        let of = batteries.iter().find(|b| b.schema() == schema);
        return of.copied().ok_or_else(|| {
            format!(
                "its cases are of the schema {schema}, and known are {}",
                known()
            )
        });
    }
    let scene = std::fs::read_to_string(folder.join("scene.toml")).unwrap_or_default();
    let scene: toml::Table = toml::from_str(&scene).unwrap_or_default();
    let of = batteries.iter().find(|b| scene.contains_key(b.table()));
    of.copied().ok_or_else(|| {
        format!(
            "neither a finished case nor scene.toml tells what it is of; known are {}",
            known()
        )
    })
}

/// What to say of numbers that another results version computed.
pub(super) fn other_version(folder: &Path, battery: &dyn Shown) -> Option<String> {
    let run = first_case(folder)?;
    let found = run["versions"]["results"].as_u64()?;
    let now = u64::from(battery.results());
    (found != now).then(|| {
        format!("computed with results version {found}, and now is {now}: columns may mean something else; run the scene again to compute it again")
    })
}
