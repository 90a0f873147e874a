//! The battery of a scene file, known by its table.

use std::path::Path;

use super::{Battery, Scene};
use crate::LabError;
use crate::scene::{Document, SceneFault, listed, nearest, read_text};

/// Reads a scene file of one of the batteries.
///
/// # Errors
/// File, line, key and what would be right.
pub fn read_scene<B: Battery + ?Sized>(
    batteries: &[&B],
    path: &Path,
) -> Result<Box<dyn Scene>, LabError> {
    parse_scene(batteries, &read_text(path)?, path)
}

/// Reads a scene of one of the batteries from a text; `path` names it in messages, and its results.
///
/// # Errors
/// As [`read_scene`].
///
/// # Validation
/// `scenes_are_known_by_their_tables`
pub fn parse_scene<B: Battery + ?Sized>(
    batteries: &[&B],
    text: &str,
    path: &Path,
) -> Result<Box<dyn Scene>, LabError> {
    let document = Document::new(text, path)?;
    let there = batteries.iter().filter(|b| document.has(b.table()));
    match there.collect::<Vec<_>>()[..] {
        [battery] => battery.parse(text, path),
        ref several => Err(no_battery(batteries, several, &document).into()),
    }
}

/// All that is wrong with a scene file of one of the batteries, as far as it can be seen without a run.
///
/// # Errors
/// A file that cannot be read.
///
/// # Validation
/// `all_faults_of_a_file_are_found`
pub fn scene_faults<B: Battery + ?Sized>(
    batteries: &[&B],
    path: &Path,
) -> Result<Vec<SceneFault>, LabError> {
    let text = match read_text(path) {
        Ok(text) => text,
        Err(LabError::Scene(fault)) => return Ok(vec![*fault]),
        Err(e) => return Err(e),
    };
    let document = match Document::read_tables(&text, path) {
        Ok(document) => document,
        Err(faults) => return Ok(faults),
    };
    let there = batteries.iter().filter(|b| document.has(b.table()));
    Ok(match there.collect::<Vec<_>>()[..] {
        [battery] => battery.faults(&text, path),
        ref several => vec![no_battery(batteries, several, &document)],
    })
}

/// What is said of a scene of no battery, or of several.
fn no_battery<B: Battery + ?Sized>(
    batteries: &[&B],
    several: &[&&B],
    document: &Document<'_>,
) -> SceneFault {
    let fault =
        |found: String, expected: &str| SceneFault::of_file(document.path(), found, expected);
    let Some(last) = several.last() else {
        let known = batteries.iter();
        let known: Vec<String> = known
            .map(|b| format!("[{}] ({})", b.table(), b.what()))
            .collect();
        let tables: Vec<&str> = batteries.iter().map(|b| b.table()).collect();
        for (name, _) in document.spans() {
            if let Some(table) = nearest(name.get_ref(), &tables) {
                let found = document.source(&name.span());
                let fault = fault(found, &format!("did you mean [{table}]?"));
                return fault
                    .key(name.get_ref().as_ref())
                    .at(document.text(), &name.span());
            }
        }
        let found = format!("no table {}", listed(&known, "or"));
        return fault(
            found,
            "write one; `topo scene new` writes a scene to begin with",
        );
    };
    let names: Vec<String> = several.iter().map(|b| format!("[{}]", b.table())).collect();
    let all = if several.len() == 2 { "both" } else { "all" };
    let found = format!("the tables {} are {all} there", listed(&names, "and"));
    let fault = fault(found, "keep one, a scene is one battery");
    match document.find(last.table()) {
        Some(place) => fault.at(document.text(), &place.key),
        None => fault,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Colloid, Elastic};

    #[test]
    fn scenes_are_known_by_their_tables() {
        let batteries: [&dyn Battery; 2] = [&Elastic, &Colloid];
        let parse = |text: &str| {
            let scene = parse_scene(&batteries, text, Path::new("s.toml"));
            scene.map(|s| format!("{s:?}")).map_err(|e| e.to_string())
        };
        let rod = parse("[rod]\nknot = \"3_1\"\n").unwrap();
        assert!(rod.starts_with("ElasticScene"), "{rod}");
        let colloid = parse("[nematic]\nq = 1\n").unwrap();
        assert!(colloid.starts_with("NematicScene"), "{colloid}");
        let words = |text: &str| parse(text).unwrap_err();
        assert_eq!(
            words("[charge]\n"),
            "s.toml: no table [rod] (a knotted fibre) or [nematic] (a colloid): write one; `topo scene new` writes a scene to begin with"
        );
        assert_eq!(
            words("[rod]\n[nematic]\n"),
            "s.toml, line 2: the tables [rod] and [nematic] are both there: keep one, a scene is one battery\n --> s.toml:2:2\n  |\n2 | [nematic]\n  |  ^^^^^^^"
        );
        assert!(words("[rod\n").contains("line 1"));
    }
}
