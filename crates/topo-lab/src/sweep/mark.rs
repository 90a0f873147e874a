//! Whose results a folder holds: the scene written out beside its table, and the refusal of another one.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use serde_json::Value;
use topo_core::write_atomic_bytes;

use super::name::differences;
use crate::LabError;
use crate::folder::{Left, left_of};

/// The scene of a folder, every value written out.
const SCENE: &str = "scene.toml";
/// Most keys that a refusal names.
const MOST_KEYS: usize = 4;
/// Longest value that a refusal shows.
const LONGEST: usize = 60;

/// Refuses a folder with finished cases that are none of this scene's; `known` are names and fingerprints of its cases.
///
/// More cases may be added to a scene: what is finished stays. Cases of its own that another results version computed are no
/// reason either, they are computed again. Cases that an earlier program finished under other names get those of now, once nothing is
/// refused.
pub(super) fn check(
    folder: &Path,
    text: &str,
    known: &[(String, String)],
    version: u32,
) -> Result<(), LabError> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Ok(());
    };
    let own: BTreeSet<(&str, &str)> = known
        .iter()
        .map(|(n, f)| (n.as_str(), f.as_str()))
        .collect();
    let names: BTreeSet<&str> = known.iter().map(|(n, _)| n.as_str()).collect();
    let names_of: BTreeMap<&str, &str> = own.iter().map(|(n, f)| (*f, *n)).collect();
    let mut foreign: Vec<(String, Left)> = Vec::new();
    let mut renamed: Vec<(PathBuf, PathBuf)> = Vec::new();
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let Some(left) = left_of(&entry.path()) else {
            continue;
        };
        let is_own = match &left {
            Left::Damaged => names.contains(name.as_str()),
            Left::Case { results, .. } if *results != Some(version) => {
                names.contains(name.as_str())
            }
            Left::Case { fingerprint, .. } => own.contains(&(name.as_str(), fingerprint.as_str())),
        };
        if is_own {
            continue;
        }
        let name_now = match &left {
            Left::Case {
                fingerprint,
                results,
            } if *results == Some(version) => names_of.get(fingerprint.as_str()),
            _ => None,
        };
        match name_now.map(|n| folder.join(n)).filter(|p| !p.exists()) {
            Some(place) => renamed.push((entry.path(), place)),
            None => foreign.push((name, left)),
        }
    }
    if foreign.is_empty() {
        return renamed.into_iter().try_for_each(|(from, to)| {
            std::fs::rename(from, &to).map_err(|source| LabError::Output { path: to, source })
        });
    }
    foreign.sort_by(|a, b| a.0.cmp(&b.0));
    Err(LabError::OtherScene {
        folder: folder.to_owned(),
        why: why(folder, text, &foreign, version),
    })
}

/// What differs: keys of the scene where the folder has one, else the first case that is not of it.
fn why(folder: &Path, text: &str, foreign: &[(String, Left)], version: u32) -> String {
    let here = values(text);
    let there = std::fs::read_to_string(folder.join(SCENE)).map_or(Value::Null, |t| values(&t));
    let mut changed = Vec::new();
    if there.is_object() {
        differences("", Some(&there), Some(&here), &mut changed);
    }
    let said = |key: &str, of: &Value| {
        let pointer = format!("/{}", key.replace('.', "/"));
        of.pointer(&pointer).map_or("nothing".to_owned(), shortened)
    };
    if changed.is_empty() {
        let (name, left) = &foreign[0];
        let n = foreign.len();
        let cases = if n == 1 { "case" } else { "cases" };
        return match left {
            Left::Case {
                results: Some(r), ..
            } if *r != version => {
                format!("{n} {cases} of results version {r} (now {version}), such as {name}")
            }
            _ => format!("{n} {cases} that this scene has not, such as {name}"),
        };
    }
    let mut keys: Vec<String> = changed
        .iter()
        .take(MOST_KEYS)
        .map(|(key, _)| {
            format!(
                "{key} = {} there, {} here",
                said(key, &there),
                said(key, &here)
            )
        })
        .collect();
    if changed.len() > MOST_KEYS {
        keys.push(format!("{} more keys", changed.len() - MOST_KEYS));
    }
    keys.join("; ")
}

/// A scene's text as nested values.
fn values(text: &str) -> Value {
    let table: Result<toml::Table, _> = toml::from_str(text);
    table.map_or(Value::Null, |t| {
        serde_json::to_value(t).unwrap_or(Value::Null)
    })
}

fn shortened(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= LONGEST {
        return text;
    }
    let start: String = text.chars().take(LONGEST).collect();
    format!("{start}...")
}

/// Writes the scene beside its table.
pub(super) fn write(folder: &Path, text: &str) -> Result<(), LabError> {
    let path = folder.join(SCENE);
    if std::fs::read_to_string(&path).is_ok_and(|there| there == text) {
        return Ok(());
    }
    Ok(write_atomic_bytes(&path, text.as_bytes())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: &str =
        "[rod]\nknot = [\"3_1\"]\ntwist = [0.0, 1.0]\n[accuracy]\ntolerance = 0.01\n";

    fn case(folder: &Path, name: &str, fingerprint: &str, results: u32) {
        let folder = folder.join(name);
        std::fs::create_dir_all(&folder).unwrap();
        let run = serde_json::json!({"fingerprint": fingerprint, "versions": {"results": results}});
        std::fs::write(folder.join("run.json"), run.to_string()).unwrap();
    }

    fn known() -> Vec<(String, String)> {
        [("a", "1"), ("b", "2")]
            .map(|(n, f)| (n.to_owned(), f.to_owned()))
            .to_vec()
    }

    fn refused(folder: &Path) -> Option<String> {
        check(folder, HERE, &known(), 5)
            .err()
            .map(|e| e.to_string())
    }

    #[test]
    fn a_folder_of_the_same_scene_is_gone_on_with() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path();
        assert_eq!(refused(&folder.join("not there")), None);
        assert_eq!(refused(folder), None);
        // parts of a sweep, merged by hand: no scene beside them
        case(folder, "a", "1", 5);
        assert_eq!(refused(folder), None);
        write(folder, HERE).unwrap();
        // of an earlier program, and damaged: computed again
        case(folder, "b", "old", 4);
        assert_eq!(refused(folder), None);
        std::fs::write(folder.join("b/run.json"), "{").unwrap();
        assert_eq!(refused(folder), None);
        // what is no case is nobody's business
        std::fs::create_dir(folder.join("export")).unwrap();
        std::fs::write(folder.join("notes.txt"), "").unwrap();
        assert_eq!(refused(folder), None);
    }

    #[test]
    fn another_scene_is_refused_with_the_keys_that_differ() {
        let dir = tempfile::tempdir().unwrap();
        let folder = dir.path();
        case(folder, "a", "other", 5);
        let text = refused(folder).unwrap();
        assert!(
            text.contains("1 case that this scene has not, such as a"),
            "{text}"
        );
        assert!(text.contains("--out"), "{text}");
        write(
            folder,
            &HERE.replace("0.01", "0.02").replace("[0.0, 1.0]", "[0.0]"),
        )
        .unwrap();
        let text = refused(folder).unwrap();
        for key in [
            "accuracy.tolerance = 0.02 there, 0.01 here",
            "rod.twist = [0.0] there, [0.0,1.0] here",
        ] {
            assert!(text.contains(key), "{text}");
        }
    }

    #[test]
    fn results_of_an_earlier_program_are_recognised() {
        let dir = tempfile::tempdir().unwrap();
        // the same cases under the names of then
        case(dir.path(), "a", "1", 5);
        case(dir.path(), "b_as_it_was_called", "2", 5);
        assert_eq!(refused(dir.path()), None);
        assert!(dir.path().join("b/run.json").exists());
        assert!(!dir.path().join("b_as_it_was_called").exists());
        case(dir.path(), "a", "1", 5);
        case(dir.path(), "named_otherwise_then", "1", 4);
        let text = refused(dir.path()).unwrap();
        assert!(
            text.contains("results version 4 (now 5)") && text.contains("named_otherwise_then"),
            "{text}"
        );
    }
}
