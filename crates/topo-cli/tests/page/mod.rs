//! Pages of the documentation as tests see them: what is fenced, and what the commands on them print.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The text of a page, by its path in the workspace.
pub fn read(page: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(page);
    std::fs::read_to_string(path).unwrap()
}

/// A fenced block: its language, its text, and the last name in backticks before it.
pub struct Block<'a> {
    pub language: &'a str,
    pub text: &'a str,
    pub name: &'a str,
}

/// The fenced blocks of a page, in order.
pub fn blocks(page: &str) -> Vec<Block<'_>> {
    let parts: Vec<&str> = page.split("```").collect();
    let names = |prose: &'_ str| prose.matches('`').count() / 2;
    parts
        .windows(2)
        .step_by(2)
        .map(|pair| {
            let (prose, block) = (pair[0], pair[1]);
            let (language, text) = block.split_once('\n').unwrap();
            let name = prose.split('`').nth((2 * names(prose)).saturating_sub(1));
            Block {
                language,
                text,
                name: name.unwrap_or_default(),
            }
        })
        .collect()
}

/// Runs `topo` in a folder; the words of the command line follow the name of the program.
pub fn topo<'a>(folder: &Path, words: impl IntoIterator<Item = &'a str>) -> String {
    let words: Vec<&str> = words.into_iter().collect();
    let run = Command::new(env!("CARGO_BIN_EXE_topo"))
        .args(&words)
        .current_dir(folder)
        .output()
        .unwrap();
    let complaint = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{words:?}: {complaint}");
    String::from_utf8_lossy(&run.stdout).into_owned()
}

/// A folder in which the pages' commands run.
pub fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_owned();
    (folder, path)
}
