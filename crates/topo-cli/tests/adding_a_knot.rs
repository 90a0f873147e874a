//! docs/adding-a-knot.md, followed word by word.

use std::path::Path;
use std::process::Command;

/// The fenced blocks of a language, in order.
fn blocks<'a>(page: &'a str, language: &'a str) -> impl Iterator<Item = &'a str> {
    let fence = format!("```{language}\n");
    page.split("```")
        .skip(1)
        .step_by(2)
        .filter(move |block| format!("```{block}").starts_with(&fence))
        .map(move |block| &block[language.len() + 1..])
}

#[test]
fn page_adds_nine_forty_two() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(root.join("docs/adding-a-knot.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("my-knots")).unwrap();
    let file = blocks(&page, "toml").next().unwrap();
    std::fs::write(folder.path().join("my-knots/9_42.toml"), file).unwrap();
    let scene = blocks(&page, "toml").last().unwrap();
    std::fs::write(folder.path().join("my-scene.toml"), scene).unwrap();
    let mut outputs = Vec::new();
    for command in blocks(&page, "sh").flat_map(str::lines) {
        let mut words = command.split_whitespace();
        assert_eq!(
            [words.next(), words.next()],
            [Some("cargo"), Some("xtask")],
            "{command}"
        );
        let run = Command::new(env!("CARGO_BIN_EXE_topo"))
            .args(words)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&run.stdout).into_owned();
        let complaint = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success(), "{command}: {complaint}");
        outputs.push(text);
    }
    let [shown, tightened, _searched, named, charged] = &outputs[..] else {
        panic!("{} commands on the page", outputs.len())
    };
    assert!(shown.contains("69.4756 (ashton2011)"), "{shown}");
    assert!(
        tightened.contains("9_42") && !tightened.contains("NOT CONVERGED"),
        "{tightened}"
    );
    assert!(named.starts_with("9_42, as in the table"), "{named}");
    assert!(named.contains("consistent") || named.contains("certain"));
    assert!(
        charged.contains("9_42") && !charged.contains("warning"),
        "{charged}"
    );
    assert!(folder.path().join("my-results/my-scene/sweep.csv").exists());
    // The length, within the bar of the draft quality.
    let record = std::fs::read_to_string(folder.path().join("my-results/knots/9_42.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    let excess = record["excess_percent"].as_f64().unwrap();
    println!("excess {excess:.3} %");
    assert!((-0.5..1.0).contains(&excess), "{excess}");
}

#[test]
fn wrong_words_are_refused_with_the_invariant() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = std::fs::read_to_string(root.join("docs/adding-a-knot.md")).unwrap();
    let file = blocks(&page, "toml").next().unwrap();
    let folder = tempfile::tempdir().unwrap();
    for (from, to, expected) in [
        ("[-1, -1, -1, 2,", "[-1, -1, 1, 2,", "alexander"),
        ("signature = 2", "signature = -2", "signature"),
        ("[-1, -1, -1, 2,", "[-1, -1, 2,", "link"),
        ("determinant = 7", "determinant = 9", "determinant"),
    ] {
        let text = file.replacen(from, to, 1);
        std::fs::write(folder.path().join("9_42.toml"), text).unwrap();
        let run = Command::new(env!("CARGO_BIN_EXE_topo"))
            .args([
                "knot",
                "tighten",
                "9_42",
                "--quality",
                "draft",
                "--knots",
                ".",
            ])
            .current_dir(folder.path())
            .output()
            .unwrap();
        let complaint = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(2), "{complaint}");
        assert!(complaint.contains(expected), "{expected}: {complaint}");
    }
}
