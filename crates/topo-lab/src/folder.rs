//! Folders of results: whether they can be written, and which case they hold.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::LabError;
use crate::progress::Event;

/// Makes a folder and those above it.
pub(crate) fn make_folder(folder: &Path) -> Result<(), LabError> {
    std::fs::create_dir_all(folder).map_err(|source| LabError::Output {
        path: folder.to_owned(),
        source,
    })
}

/// Makes sure that a folder can be written to.
///
/// # Errors
/// The folder and what to do.
pub fn writable(folder: &Path) -> Result<(), LabError> {
    let wrong = |source| LabError::Output {
        path: folder.to_owned(),
        source,
    };
    make_folder(folder)?;
    tempfile::tempfile_in(folder).map(drop).map_err(wrong)
}

/// Removes a file, if it is there.
pub(crate) fn forget_file(path: &Path) -> Result<(), LabError> {
    match std::fs::remove_file(path) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => Err(LabError::Output {
            path: path.to_owned(),
            source,
        }),
        _ => Ok(()),
    }
}

/// Removes checkpoints of other settings, or all when `mark` is empty.
pub(crate) fn forget_checkpoints(folder: &Path, mark: &str) -> Result<(), LabError> {
    let wrong = |source| LabError::Output {
        path: folder.to_owned(),
        source,
    };
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Ok(());
    };
    for entry in entries {
        let entry = entry.map_err(wrong)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let ours = !mark.is_empty() && name.ends_with(&format!("-{mark}.checkpoint"));
        if name.ends_with(".checkpoint") && !ours {
            std::fs::remove_file(entry.path()).map_err(wrong)?;
        }
    }
    Ok(())
}

/// What tells whether a finished case can be used.
#[derive(Deserialize)]
struct CaseMark {
    fingerprint: String,
    versions: Option<Versions>,
    /// Digests of the other files of the folder; missing in those of early versions.
    #[serde(default)]
    files: BTreeMap<String, String>,
}

#[derive(Deserialize)]
struct Versions {
    results: u32,
}

/// What a case came to.
#[derive(Debug, Clone, Deserialize)]
#[serde(bound = "T: DeserializeOwned")]
pub struct Outcome<T> {
    /// Its rows of the table.
    pub rows: Vec<T>,
    /// Why it did not finish.
    #[serde(default)]
    pub failure: Option<String>,
}

/// What lies in the folder of a case, whoever computed it.
#[derive(Debug)]
pub(crate) enum Left {
    /// A finished case.
    Case {
        /// Its identity.
        fingerprint: String,
        /// Version of its results.
        results: Option<u32>,
    },
    /// A `run.json` that is none.
    Damaged,
}

/// What a folder holds of a finished case; `None` without its mark.
pub(crate) fn left_of(folder: &Path) -> Option<Left> {
    let text = std::fs::read_to_string(folder.join("run.json")).ok()?;
    Some(match serde_json::from_str::<CaseMark>(&text) {
        Ok(mark) => Left::Case {
            fingerprint: mark.fingerprint,
            results: mark.versions.map(|v| v.results),
        },
        Err(_) => Left::Damaged,
    })
}

/// Short hash of everything that the numbers of a case depend on, the results version of its battery among it.
pub fn identity(all: &serde_json::Value) -> String {
    blake3::hash(all.to_string().as_bytes()).to_hex()[..16].to_owned()
}

/// Digest of a file; `None` if it cannot be read.
fn digest_of(path: &Path) -> Option<String> {
    let bytes = std::fs::read(path).ok()?;
    Some(blake3::hash(&bytes).to_hex()[..16].to_owned())
}

/// Digests of files of a case, for its `run.json`: a later run sees by them whether all is still there and sound.
pub(crate) fn digests(folder: &Path, names: &[&str]) -> BTreeMap<String, String> {
    let one = |name: &&str| Some(((*name).to_owned(), digest_of(&folder.join(name))?));
    names.iter().filter_map(one).collect()
}

/// What an earlier run left of a case.
#[derive(Debug, Clone)]
pub(crate) enum Earlier<T> {
    /// Nothing, or nothing that is finished.
    None,
    /// What it came to, with the same settings and version.
    Finished(Outcome<T>),
    /// Something that cannot be used, and why.
    Unusable(&'static str),
}

impl<T> Earlier<T> {
    /// Whether it need not be computed.
    pub(crate) fn is_finished(&self) -> bool {
        matches!(self, Self::Finished(_))
    }

    /// Why what is there cannot be used.
    pub(crate) fn reason(&self) -> Option<&'static str> {
        match self {
            Self::Unusable(reason) => Some(reason),
            _ => None,
        }
    }

    /// What a finished case came to.
    pub(crate) fn outcome(self) -> Option<Outcome<T>> {
        match self {
            Self::Finished(outcome) => Some(outcome),
            _ => None,
        }
    }
}

const CORRUPT: &str = "its run.json is damaged";
const OTHER_VERSION: &str = "it is of another results version";
const OTHER_SETTINGS: &str = "it was computed with other settings";
const DAMAGED_FILE: &str = "one of its files is missing or damaged";
const NO_ROWS: &str = "its run.json has no rows";

/// What is left of a case in `folder`; usable only with the same identity.
///
/// `version` is the results version of now; a file of another one is distinguished from one of other settings.
pub(crate) fn finished<T: DeserializeOwned>(
    folder: &Path,
    fingerprint: &str,
    version: u32,
) -> Earlier<T> {
    let text = match std::fs::read_to_string(folder.join("run.json")) {
        Ok(text) => text,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Earlier::None,
        Err(_) => return Earlier::Unusable(CORRUPT),
    };
    let Ok(mark) = serde_json::from_str::<CaseMark>(&text) else {
        return Earlier::Unusable(CORRUPT);
    };
    if mark.versions.is_some_and(|v| v.results != version) {
        return Earlier::Unusable(OTHER_VERSION);
    }
    if mark.fingerprint != fingerprint {
        return Earlier::Unusable(OTHER_SETTINGS);
    }
    let sound =
        |(name, digest): (&String, &String)| digest_of(&folder.join(name)).as_ref() == Some(digest);
    if !mark.files.iter().all(sound) {
        return Earlier::Unusable(DAMAGED_FILE);
    }
    match serde_json::from_str::<Outcome<T>>(&text) {
        Ok(outcome) if !outcome.rows.is_empty() => Earlier::Finished(outcome),
        Ok(_) => Earlier::Unusable(NO_ROWS),
        Err(_) => Earlier::Unusable(CORRUPT),
    }
}

/// Tells which cases of an earlier run are computed again and why, one word a reason.
pub(crate) fn tell_replaced(
    cases: impl Iterator<Item = (String, Option<&'static str>)>,
    progress: &(dyn Fn(Event<'_>) + Sync),
) {
    let mut by_reason: BTreeMap<&'static str, Vec<String>> = BTreeMap::new();
    for (name, reason) in cases {
        if let Some(reason) = reason {
            by_reason.entry(reason).or_default().push(name);
        }
    }
    for (reason, names) in &by_reason {
        progress(Event::Replaced { names, reason });
    }
}
