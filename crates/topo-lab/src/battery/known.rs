//! The battery of a scene file, known by its table.

use std::path::Path;

use super::{Battery, Scene};
use crate::LabError;
use crate::scene::read_text;

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
    let wrong = |message| LabError::Scene {
        path: path.to_owned(),
        message,
    };
    let tables: toml::Table = toml::from_str(text).map_err(|e| wrong(e.to_string()))?;
    let there = batteries.iter().filter(|b| tables.contains_key(b.table()));
    match there.collect::<Vec<_>>()[..] {
        [battery] => battery.parse(text, path),
        [] => {
            let known = batteries.iter();
            let known = known.map(|b| format!("[{}] ({})", b.table(), b.what()));
            let known = listed(known.collect(), "or");
            Err(wrong(format!("no table {known}: write one")))
        }
        ref several => {
            let names = several.iter().map(|b| format!("[{}]", b.table()));
            let names = listed(names.collect(), "and");
            let all = if several.len() == 2 { "both" } else { "all" };
            Err(wrong(format!(
                "the tables {names} are {all} there: keep one, a scene is one battery"
            )))
        }
    }
}

/// Words with commas between them, and a last one.
fn listed(words: Vec<String>, last: &str) -> String {
    match &words[..] {
        [first @ .., end] if !first.is_empty() => format!("{} {last} {end}", first.join(", ")),
        _ => words.concat(),
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
            "s.toml is not a scene:\nno table [rod] (a knotted fibre) or [nematic] (a colloid): write one"
        );
        assert_eq!(
            words("[rod]\n[nematic]\n"),
            "s.toml is not a scene:\nthe tables [rod] and [nematic] are both there: keep one, a scene is one battery"
        );
        assert!(words("[rod\n").contains("line 1"));
    }

    #[test]
    fn lists_read_as_sentences() {
        let list = |n: usize| {
            let words = ["a", "b", "c"][..n].iter().map(ToString::to_string);
            listed(words.collect(), "or")
        };
        assert_eq!([list(0), list(1)], ["", "a"]);
        assert_eq!([list(2), list(3)], ["a or b", "a, b or c"]);
    }
}
