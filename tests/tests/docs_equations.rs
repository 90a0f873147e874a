//! The equations of the documentation are LaTeX, and rustdoc's pages typeset them without a network.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use topo_view::Outside;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The text of every `math` fence in a documentation comment below `folder`, with the file that it stands in.
fn equations(folder: &Path, found: &mut Vec<(PathBuf, String)>) {
    let mut paths: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            equations(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = fs::read_to_string(&path).unwrap();
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
    }
}

fn all_equations() -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    equations(&root().join("crates"), &mut found);
    assert!(found.len() > 50, "only {} equations found", found.len());
    found
}

/// Letters beyond ASCII are not LaTeX: KaTeX would set them in another font.
#[test]
fn equations_are_latex() {
    for (path, text) in all_equations() {
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

/// rustdoc makes a page of all equations with the header and KaTeX of `cargo xtask docs`; Chromium shows it without a network.
#[test]
#[ignore = "needs Chromium: `cargo xtask test` runs it where there is one"]
fn browser_every_equation_of_the_docs_is_typeset() {
    let browser = Outside::Browser
        .find()
        .unwrap_or_else(|| panic!("{}", Outside::Browser.needs()));
    let equations = all_equations();
    let dir = tempfile::tempdir().unwrap();
    let assets = root().join("xtask/rustdoc");
    let mut source = String::new();
    for (_, text) in &equations {
        source += "//! ```math\n";
        source.extend(text.lines().map(|l| format!("//! {l}\n")));
        source += "//! ```\n";
    }
    let file = dir.path().join("equations.rs");
    fs::write(&file, source).unwrap();
    let header = dir.path().join("header.html");
    let shipped = fs::read_to_string(assets.join("header.html")).unwrap();
    fs::write(&header, format!("{shipped}{PROBE}")).unwrap();
    let pages = dir.path().join("doc");
    let made = Command::new(std::env::var_os("RUSTDOC").unwrap_or_else(|| "rustdoc".into()))
        .arg(&file)
        .arg("--html-in-header")
        .arg(&header)
        .arg("--out-dir")
        .arg(&pages)
        .status();
    assert!(made.unwrap().success());
    let katex = pages.join("katex");
    fs::create_dir_all(&katex).unwrap();
    for name in ["katex.min.js", "katex.min.css"] {
        fs::copy(assets.join("katex").join(name), katex.join(name)).unwrap();
    }
    let style = fs::read_to_string(katex.join("katex.min.css")).unwrap();
    assert!(style.split("url(").skip(1).all(|u| u.starts_with("data:")));
    let shown = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-dev-shm-usage"])
        .args([
            "--host-resolver-rules=MAP * ~NOTFOUND",
            "--virtual-time-budget=8000",
        ])
        .arg(format!(
            "--user-data-dir={}",
            dir.path().join("profile").display()
        ))
        .arg("--dump-dom")
        .arg(format!(
            "file://{}",
            pages.join("equations/index.html").display()
        ))
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
    assert!(
        fonts >= 4 && missing == 0,
        "{fonts} fonts, {missing} missing"
    );
}
