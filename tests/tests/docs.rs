//! What the documentation promises exists: the tests that it names, the works that it cites, its equations typeset.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use topo_view::Outside;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every Rust file of the workspace with its text.
fn sources() -> Vec<(PathBuf, String)> {
    let mut folders: Vec<PathBuf> = ["crates", "tests", "xtask", "benches"]
        .map(|f| root().join(f))
        .to_vec();
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        let Ok(entries) = fs::read_dir(&folder) else {
            continue;
        };
        for path in entries.map(|e| e.unwrap().path()) {
            if path.is_dir() && path.file_name().is_some_and(|n| n != "target") {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                files.push((path, text));
            }
        }
    }
    assert!(files.len() > 50, "only {} files found", files.len());
    files
}

/// Names of functions marked as tests.
fn tests_in(text: &str) -> Vec<&str> {
    let mut names = Vec::new();
    let mut is_test = false;
    for line in text.lines().map(str::trim) {
        if line == "#[test]" {
            is_test = true;
        } else if let Some(rest) = line.strip_prefix("fn ").filter(|_| is_test) {
            names.push(&rest[..rest.find(['(', '<']).unwrap_or(rest.len())]);
            is_test = false;
        }
    }
    names
}

fn all_tests(sources: &[(PathBuf, String)]) -> BTreeSet<&str> {
    let tests: BTreeSet<_> = sources
        .iter()
        .flat_map(|(_, text)| tests_in(text))
        .collect();
    assert!(tests.contains("docs_name_only_existing_tests"));
    tests
}

/// What stands between backticks and reads like the name of a test.
fn quoted_names(text: &str) -> impl Iterator<Item = &str> {
    let is_name = |s: &&str| {
        !s.is_empty()
            && s.chars()
                .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
    };
    text.split('`').skip(1).step_by(2).filter(is_name)
}

/// The lines of a documentation comment that follow a heading, up to the next heading or the end of the comment.
fn section<'a>(text: &'a str, heading: &'a str) -> impl Iterator<Item = &'a str> {
    let mut inside = false;
    text.lines().filter(move |line| {
        let comment = line
            .trim()
            .strip_prefix("//")
            .map(|l| l.trim_start_matches(['/', '!']).trim());
        match comment {
            Some(c) if c.starts_with('#') => {
                inside = c == heading;
                false
            }
            Some(_) => inside,
            None => {
                inside = false;
                false
            }
        }
    })
}

/// Every test named in docs/validation.md (in the last column of its tables) or under "# Validation" exists.
#[test]
fn docs_name_only_existing_tests() {
    let sources = sources();
    let tests = all_tests(&sources);
    let page = fs::read_to_string(root().join("docs/validation.md")).unwrap();
    let mut named = 0;
    for row in page.lines().filter(|l| l.starts_with('|')) {
        let last = row.trim_end_matches('|').rsplit('|').next().unwrap_or("");
        for name in quoted_names(last) {
            assert!(
                tests.contains(name),
                "docs/validation.md names `{name}`, which is no test"
            );
            named += 1;
        }
    }
    assert!(named > 30, "only {named} tests named");
    for (path, text) in &sources {
        for name in section(text, "# Validation").flat_map(quoted_names) {
            assert!(
                tests.contains(name),
                "{} names `{name}`, which is no test",
                path.display()
            );
        }
    }
}

/// Every test of physics, here, is a row of docs/validation.md.
#[test]
fn docs_list_every_physics_test() {
    let sources = sources();
    let page = fs::read_to_string(root().join("docs/validation.md")).unwrap();
    let listed: BTreeSet<_> = quoted_names(&page).collect();
    for name in all_tests(&sources) {
        if ["val_", "law_"].iter().any(|p| name.starts_with(p)) {
            assert!(listed.contains(name), "docs/validation.md lacks `{name}`");
        }
    }
}

fn is_key(s: &str) -> bool {
    let letters = s.trim_start_matches(|c: char| c.is_ascii_lowercase());
    let word = letters.trim_start_matches(|c: char| c.is_ascii_digit());
    letters.len() < s.len()
        && letters.len() - word.len() == 4
        && (letters.starts_with("18") || letters.starts_with("19") || letters.starts_with("20"))
        && word.chars().all(|c| c.is_ascii_lowercase())
}

/// Every key cited in the sources or in docs/ has an entry in docs/references.bib, and no key has two.
#[test]
fn docs_cite_only_known_works() {
    let bib = fs::read_to_string(root().join("docs/references.bib")).unwrap();
    let keys: Vec<&str> = bib
        .lines()
        .filter(|l| l.starts_with('@'))
        .filter_map(|l| l.split(['{', ',']).nth(1))
        .collect();
    let known: BTreeSet<_> = keys.iter().copied().collect();
    assert_eq!(keys.len(), known.len(), "a key has two entries");
    assert!(known.iter().all(|k| is_key(k)), "{known:?}");
    let mut cited = BTreeSet::new();
    for (path, text) in &sources() {
        let comments = text.lines().filter(|l| l.trim_start().starts_with("//"));
        let bracketed = comments.flat_map(|l| l.split(['[', ']']).skip(1).step_by(2));
        let referred = section(text, "# References").flat_map(quoted_names);
        for key in bracketed.chain(referred).filter(|k| is_key(k)) {
            assert!(
                known.contains(key),
                "{} cites {key}, unknown to docs/references.bib",
                path.display()
            );
            cited.insert(key.to_owned());
        }
    }
    assert!(cited.len() > 20, "only {} works cited", cited.len());
    for entry in fs::read_dir(root().join("docs")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "md") {
            let text = fs::read_to_string(&path).unwrap();
            for key in text
                .split(['[', ']'])
                .skip(1)
                .step_by(2)
                .filter(|k| is_key(k))
            {
                assert!(known.contains(key), "{} cites {key}", path.display());
            }
        }
    }
}

/// Keys of the works in docs/references.bib with the address of each that has one.
fn addresses(bib: &str) -> Vec<(&str, Option<String>)> {
    let field = |entry: &str, name: &str| {
        let value = entry.split_once(&format!("{name} = {{"))?.1;
        Some(value[..value.find("}\n")?].to_owned())
    };
    let entries = bib.split("\n@").skip(1);
    let one = |entry| {
        let key = str::split(entry, ['{', ',']).nth(1).unwrap();
        // as an address has them
        let doi = field(entry, "doi").map(|d| d.replace('<', "%3C").replace('>', "%3E"));
        let doi = doi.map(|d| format!("https://doi.org/{d}"));
        (key, doi.or_else(|| field(entry, "url")))
    };
    entries.map(one).collect()
}

/// The comments that document items, without code between their lines.
fn documentation(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap();
    let is_comment = |l: &str| l.starts_with("///") || l.starts_with("//!");
    let lines: Vec<&str> = code.lines().map(str::trim).collect();
    let blocks = lines.split(|l| !is_comment(l));
    blocks.map(|b| b.join("\n")).collect()
}

/// A work that the documentation of an item cites is a link to the address that docs/references.bib has of it.
#[test]
fn docs_link_the_works_they_cite() {
    let bib = fs::read_to_string(root().join("docs/references.bib")).unwrap();
    let addresses = addresses(&bib);
    let crates = root().join("crates");
    let mut n = 0;
    for (path, text) in &sources() {
        if !path.starts_with(&crates) || path.ends_with("tests.rs") {
            continue;
        }
        for block in documentation(text) {
            for (key, address) in &addresses {
                let Some(address) = address else { continue };
                let file = path.display();
                let is_bare = block.contains(&format!("`{key}`"));
                assert!(!is_bare, "{file} cites {key} without a link");
                if block.contains(&format!("[{key}]")) {
                    let is_linked = block.contains(&format!("[{key}]: {address}"));
                    assert!(is_linked, "{file} does not lead from {key} to {address}");
                    n += 1;
                }
            }
        }
    }
    assert!(n > 30, "only {n} links");
}

/// Every page with a program in Rust is among the documentation tests of this crate.
#[test]
fn docs_with_rust_are_compiled() {
    let mut pages = vec![root().join("README.md"), root().join("CONTRIBUTING.md")];
    pages.extend(
        fs::read_dir(root().join("docs"))
            .unwrap()
            .map(|e| e.unwrap().path()),
    );
    let compiled = fs::read_to_string(root().join("tests/src/lib.rs")).unwrap();
    let mut n = 0;
    for page in pages
        .iter()
        .filter(|p| p.extension().is_some_and(|e| e == "md"))
    {
        let text = fs::read_to_string(page).unwrap();
        if text.lines().any(|l| l.starts_with("```rust")) {
            let path = page.strip_prefix(root()).unwrap().display().to_string();
            let included = format!("include_str!(\"../../{path}\")");
            assert!(
                compiled.contains(&included),
                "tests/src/lib.rs lacks {included}"
            );
            n += 1;
        }
    }
    assert!(n > 0, "README.md has no program any more");
}

/// CONTRIBUTING names files and crates that are there: a path from the root, or the end of the path of a source file.
#[test]
fn contributing_names_only_existing_files() {
    let text = fs::read_to_string(root().join("CONTRIBUTING.md")).unwrap();
    let sources = sources();
    let is_there = |name: &str| {
        let end = format!("/{name}");
        root().join(name).exists()
            || sources
                .iter()
                .any(|(p, _)| p.display().to_string().ends_with(&end))
    };
    let is_path = |s: &&str| {
        let has_ending = [".rs", ".toml", ".md"].iter().any(|end| s.ends_with(end));
        !s.contains(' ') && (s.contains('/') || has_ending)
    };
    let named: Vec<&str> = text.split('`').skip(1).step_by(2).filter(is_path).collect();
    assert!(named.len() > 10, "{named:?}");
    for name in named {
        assert!(
            is_there(name),
            "CONTRIBUTING.md names {name}, which is not there"
        );
    }
    let rows = text
        .lines()
        .filter_map(|l| l.strip_prefix("| `topo-")?.split_once('`'));
    let listed: BTreeSet<String> = rows.map(|(name, _)| format!("topo-{name}")).collect();
    let crates = fs::read_dir(root().join("crates")).unwrap();
    let there = crates.map(|e| e.unwrap().file_name().into_string().unwrap());
    assert_eq!(
        listed,
        there.collect(),
        "the table of crates in CONTRIBUTING.md"
    );
}

/// The text of every `math` block in the comments of the sources, with its file.
fn equations() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for (path, text) in sources() {
        let mut open: Option<String> = None;
        for line in text.lines().map(str::trim) {
            let comment = line.strip_prefix("///").or(line.strip_prefix("//!"));
            match (comment.map(str::trim), &mut open) {
                (Some("```math"), None) => open = Some(String::new()),
                (Some("```"), Some(equation)) => {
                    found.push((path.clone(), std::mem::take(equation)));
                    open = None;
                }
                (Some(text), Some(equation)) => *equation += &format!("{text}\n"),
                _ => {}
            }
        }
        assert_eq!(open, None, "{}: an equation without end", path.display());
    }
    assert!(found.len() > 50, "only {} equations found", found.len());
    found
}

/// Letters beyond ASCII are not LaTeX: KaTeX would set them in another font.
#[test]
fn docs_have_equations_in_latex() {
    for (path, text) in equations() {
        assert!(text.is_ascii(), "{}: {text}", path.display());
    }
}

/// What happened in the page becomes its title.
const PROBE: &str = r#"<script>
addEventListener('load', async () => {
  await document.fonts.ready;
  const fonts = [...document.fonts].filter((f) => f.family.startsWith('KaTeX'));
  const left = [...document.querySelectorAll('pre.language-math')].map((e) => e.textContent);
  const report = [document.querySelectorAll('.katex-display').length, left.length,
    fonts.filter((f) => f.status === 'loaded').length, fonts.filter((f) => f.status === 'error').length];
  document.title = 'REPORT' + report.join(',') + ';' + left.join(' | ');
});
</script>"#;

/// A page of rustdoc with these equations, with the header and KaTeX of `cargo xtask docs` and the probe.
fn page_of(equations: &[(PathBuf, String)], folder: &Path) -> PathBuf {
    let assets = root().join("xtask/rustdoc");
    let mut source = String::new();
    for (_, text) in equations {
        source += "//! ```math\n";
        source.extend(text.lines().map(|l| format!("//! {l}\n")));
        source += "//! ```\n";
    }
    let file = folder.join("equations.rs");
    fs::write(&file, source).unwrap();
    let header = folder.join("header.html");
    let shipped = fs::read_to_string(assets.join("header.html")).unwrap();
    fs::write(&header, format!("{shipped}{PROBE}")).unwrap();
    let pages = folder.join("doc");
    let rustdoc = std::env::var_os("RUSTDOC").unwrap_or_else(|| "rustdoc".into());
    let mut rustdoc = Command::new(rustdoc);
    rustdoc.arg(&file).arg("--html-in-header").arg(&header);
    rustdoc.arg("--out-dir").arg(&pages);
    assert!(rustdoc.status().unwrap().success());
    let katex = pages.join("katex");
    fs::create_dir_all(&katex).unwrap();
    for name in ["katex.min.js", "katex.min.css"] {
        fs::copy(assets.join("katex").join(name), katex.join(name)).unwrap();
    }
    let style = fs::read_to_string(katex.join("katex.min.css")).unwrap();
    assert!(style.split("url(").skip(1).all(|u| u.starts_with("data:")));
    pages.join("equations/index.html")
}

/// rustdoc makes a page of all equations, and Chromium shows it without a network.
#[test]
#[ignore = "needs Chromium: `cargo xtask test` runs it where there is one"]
fn browser_every_equation_of_the_docs_is_typeset() {
    let browser = Outside::Browser
        .find()
        .unwrap_or_else(|| panic!("{}", Outside::Browser.needs()));
    let dir = tempfile::tempdir().unwrap();
    let equations = equations();
    let page = page_of(&equations, dir.path());
    let profile = dir.path().join("profile");
    let shown = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-dev-shm-usage"])
        .arg("--host-resolver-rules=MAP * ~NOTFOUND")
        .arg("--virtual-time-budget=8000")
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg("--dump-dom")
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&shown.stdout);
    let (report, as_latex) = dom
        .split_once("<title>REPORT")
        .and_then(|t| t.1.split_once("</title>")?.0.split_once(';'))
        .unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&shown.stderr)));
    let counts: Vec<usize> = report.split(',').map(|n| n.parse().unwrap()).collect();
    let [typeset, left, fonts, missing] = counts[..] else {
        panic!("{report}");
    };
    assert_eq!((typeset, left), (equations.len(), 0), "{as_latex}");
    assert!(fonts >= 4, "only {fonts} fonts used");
    assert_eq!(missing, 0, "fonts without data");
}
