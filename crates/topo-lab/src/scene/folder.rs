//! The name of the folder that a scene's results lie in: that of its file.

use std::path::Path;

use crate::LabError;

/// Folders below an output folder that commands write.
const TAKEN: [&str; 7] = [
    "figures",
    "knots",
    "scenes",
    "tradeoff",
    "buckling",
    "stability",
    "cost",
];

/// Longest name, in bytes: folders of names with a suffix must be possible everywhere.
const LONGEST: usize = 100;

/// Folder of the results of a scene: its file's name without the ending, letters, digits, `-`, `_` and `.` as they are, all else as `-`.
///
/// # Errors
/// A name of which nothing is left, or one that a command writes its own results to.
pub fn folder_of(path: &Path) -> Result<String, LabError> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let kept = |c: char| match c.is_alphanumeric() || matches!(c, '-' | '_' | '.') {
        true => c,
        false => '-',
    };
    let name: String = stem.chars().map(kept).collect();
    let wrong = |reason: String| LabError::SceneName {
        path: path.to_owned(),
        reason,
    };
    if !name.chars().any(char::is_alphanumeric) {
        return Err(wrong("its name has no letter or digit".to_owned()));
    }
    if name.len() > LONGEST {
        return Err(wrong(format!("its name is longer than {LONGEST} bytes")));
    }
    if let Some(taken) = TAKEN.iter().find(|t| t.eq_ignore_ascii_case(&name)) {
        return Err(wrong(format!(
            "`{taken}` is the folder of what other commands write"
        )));
    }
    Ok(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_named_as_the_scene_file() {
        for (path, name) in [
            ("scenes/elastic-quick.toml", "elastic-quick"),
            ("/a/b/my scene_2.1.toml", "my-scene_2.1"),
            ("Ünïcode.toml", "Ünïcode"),
            ("built-in scene", "built-in-scene"),
        ] {
            assert_eq!(folder_of(Path::new(path)).unwrap(), name);
        }
        for path in [
            "",
            "...toml",
            "--.toml",
            "figures.toml",
            "Knots.toml",
            "x/cost.toml",
        ] {
            let message = folder_of(Path::new(path)).unwrap_err().to_string();
            assert!(message.contains("rename the file"), "{path}: {message}");
        }
        assert!(folder_of(Path::new(&format!("{}.toml", "a".repeat(101)))).is_err());
    }
}
