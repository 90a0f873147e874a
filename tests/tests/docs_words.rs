//! The documentation in plain words, a README that is short and true, pages that can be reached.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Words that hid what was meant, and what says it.
const PLAIN: [(&str, &str); 16] = [
    ("told", "reported, said"),
    ("dear", "expensive"),
    ("dearer", "more expensive"),
    ("in the hand", "in three dimensions, by itself"),
    ("be had", "is possible, is found"),
    ("calls for", "prefetches, needs"),
    ("made-up", "artificial, generated"),
    ("come to its end", "finish"),
    ("comes to its end", "finishes"),
    ("came to its end", "finished"),
    ("hang on", "depend on"),
    ("hangs on", "depends on"),
    ("anew", "again"),
    ("in vain", "without result"),
    ("wish", "goal"),
    ("whence", "from where"),
];

/// Files with one of these endings below a folder.
fn files(folder: &Path, endings: &[&str], found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let has = |e: &std::ffi::OsStr| endings.iter().any(|x| e == *x);
        if path.is_dir() {
            files(&path, endings, found);
        } else if path.extension().is_some_and(has) {
            found.push(path);
        }
    }
}

/// Where `words` stand in a line, between characters that are part of no word.
fn stands_in(words: &str, line: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices(words).any(|(at, _)| {
        !line[..at].ends_with(is_part) && !line[at + words.len()..].starts_with(is_part)
    })
}

#[test]
fn docs_are_in_plain_words() {
    let mut pages = vec![root().join("README.md"), root().join("CONTRIBUTING.md")];
    let folders = ["docs", "crates", "xtask", "scenes", "benches", "tests/src"];
    for folder in folders {
        let endings = ["md", "rs", "py", "pyi", "toml", "ipynb"];
        files(&root().join(folder), &endings, &mut pages);
    }
    assert!(pages.len() > 300, "{}", pages.len());
    let mut found = Vec::new();
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        for (number, line) in (1..).zip(text.lines()) {
            let lower = line.to_lowercase();
            for (words, plain) in PLAIN {
                if stands_in(words, &lower) {
                    let page = page.strip_prefix(root()).unwrap().display();
                    found.push(format!("{page}:{number}: \"{words}\": say {plain}"));
                }
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn words_are_found_between_other_words_only() {
    assert!(stands_in("told", "it is told, at the end"));
    assert!(!stands_in("told", "untold; told_apart; toldo"));
    assert!(stands_in("be had", "cannot be had"));
}

/// At most a thousand words; what stands in a table or a program counts as well.
#[test]
fn docs_begin_with_a_short_readme() {
    let text = read("README.md");
    let is_word = |w: &&str| w.chars().any(char::is_alphanumeric);
    let n = text.split_whitespace().filter(is_word).count();
    assert!(n <= 1000, "README.md has {n} words");
}

/// The scene that stands above a command is the file that the command names.
#[test]
fn docs_show_the_scene_that_they_run() {
    let text = read("README.md");
    assert!(text.contains(&format!(
        "`scenes/elastic-quick.toml`:\n\n```toml\n{}```",
        read("scenes/elastic-quick.toml")
    )));
}

/// Files that a page or a help text names below `scenes/` are there.
#[test]
fn docs_name_only_scenes_that_are_there() {
    let mut pages = vec![root().join("README.md"), root().join("CONTRIBUTING.md")];
    files(&root().join("docs"), &["md"], &mut pages);
    files(&root().join("scenes"), &["toml"], &mut pages);
    files(&root().join("crates/topo-cli/src"), &["rs"], &mut pages);
    files(&root().join("xtask/src"), &["rs"], &mut pages);
    let mut n = 0;
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        for (at, _) in text.match_indices("scenes/") {
            let is_part = |c: char| c.is_alphanumeric() || "-_./".contains(c);
            let name = &text[at..];
            let name = &name[..name.find(|c| !is_part(c)).unwrap_or(name.len())];
            // these two are written beside the figures
            let is_result = ["scenes/elastic.toml", "scenes/nematic.toml"].contains(&name);
            if let Some(name) = name.strip_suffix(".toml").filter(|_| !is_result) {
                let path = root().join(format!("{name}.toml"));
                assert!(path.exists(), "{} names {name}.toml", page.display());
                n += 1;
            }
        }
    }
    assert!(n > 10, "{n}");
}

/// Every page of `docs/` is linked from the README, or is a notebook.
#[test]
fn docs_can_be_reached_from_the_readme() {
    let text = read("README.md");
    let linked: BTreeSet<&str> = text
        .split("](docs/")
        .skip(1)
        .filter_map(|rest| rest.split([')', '#']).next())
        .collect();
    for entry in fs::read_dir(root().join("docs")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if name.ends_with(".md") {
            assert!(
                linked.contains(name.as_str()),
                "README.md has no link to docs/{name}"
            );
        }
    }
    for page in linked {
        assert!(root().join("docs").join(page).exists(), "docs/{page}");
    }
}
