//! docs/adding-a-knot.md, followed word by word.

mod page;

use page::{Block, blocks, folder, read, topo};
use std::process::Command;

const PAGE: &str = "docs/adding-a-knot.md";

#[test]
fn page_adds_nine_forty_two() {
    let page = read(PAGE);
    let (_kept, folder) = folder();
    std::fs::create_dir(folder.join("my-knots")).unwrap();
    let mut outputs = Vec::new();
    for Block {
        language,
        text,
        name,
    } in blocks(&page)
    {
        match language {
            "toml" => std::fs::write(folder.join(name), text).unwrap(),
            _ => {
                for command in text.lines() {
                    let words = command.strip_prefix("cargo xtask ").expect(command);
                    outputs.push(topo(&folder, words.split_whitespace()));
                }
            }
        }
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
    assert!(folder.join("my-results/my-scene/sweep.csv").exists());
    // The length, within the bar of the draft quality.
    let record = std::fs::read_to_string(folder.join("my-results/knots/9_42.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    let excess = record["excess_percent"].as_f64().unwrap();
    println!("excess {excess:.3} %");
    assert!((-0.5..1.0).contains(&excess), "{excess}");
}

#[test]
fn wrong_words_are_refused_with_the_invariant() {
    let page = read(PAGE);
    let file = blocks(&page)[0].text;
    let (_kept, folder) = folder();
    for (from, to, expected) in [
        ("[-1, -1, -1, 2,", "[-1, -1, 1, 2,", "alexander"),
        ("signature = 2", "signature = -2", "signature"),
        ("[-1, -1, -1, 2,", "[-1, -1, 2,", "link"),
        ("determinant = 7", "determinant = 9", "determinant"),
    ] {
        let text = file.replacen(from, to, 1);
        std::fs::write(folder.join("9_42.toml"), text).unwrap();
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
            .current_dir(&folder)
            .output()
            .unwrap();
        let complaint = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(2), "{complaint}");
        assert!(complaint.contains(expected), "{expected}: {complaint}");
    }
}
