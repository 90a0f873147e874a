//! `topo scene`: what is wrong with a file, and a file to begin with.

use std::path::Path;
use std::process::Command;

/// Exit code, standard output and standard error.
fn topo(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_topo"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let code = output.status.code().unwrap();
    (code, text(&output.stdout), text(&output.stderr))
}

const WRONG: &str =
    "[rod]\nknot = \"3_1\"\ntwits = 2\nreading = \"soft\"\n[rod.contact]\nstiffness = \"20\"\n";
const HEADER: &str = "file,line,column,key,found,expected";

#[test]
fn all_faults_of_a_file_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("s.toml"), WRONG).unwrap();
    let (code, table, said) = topo(here, &["scene", "check", "s.toml"]);
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!((code, lines.len()), (2, 4), "{table}");
    assert_eq!(lines[0], HEADER);
    for (line, begin) in lines[1..].iter().zip([
        "s.toml,3,1,rod.twits,2,",
        "s.toml,4,11,rod.reading,\"\"\"soft\"\"\",",
        "s.toml,6,13,rod.contact.stiffness,\"\"\"20\"\"\",",
    ]) {
        assert!(line.starts_with(begin), "{line}");
    }
    assert!(said.contains("3 faults"), "{said}");

    let (code, object, _) = topo(here, &["scene", "check", "s.toml", "--json"]);
    let object: serde_json::Value = serde_json::from_str(&object).unwrap();
    let faults = object["data"]["faults"].as_array().unwrap();
    assert_eq!((code, faults.len()), (2, 3), "{object}");
    let keys: Vec<&String> = faults[0].as_object().unwrap().keys().collect();
    let keys: Vec<&str> = keys.into_iter().map(String::as_str).collect();
    assert_eq!(keys.join(","), HEADER);
    assert_eq!(
        (&faults[1]["line"], &faults[1]["key"]),
        (&4.into(), &"rod.reading".into())
    );

    // the first of them is what a run says
    let (code, _, said) = topo(here, &["run", "s.toml"]);
    assert_eq!(code, 2);
    assert!(
        said.contains("s.toml, line 3: rod.twits") && said.contains("--> s.toml:3:1"),
        "{said}"
    );
}

#[test]
fn an_unknown_knot_is_shown_in_its_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("s.toml"),
        "[rod]\nknot = [\"3_1\", \"3_7\"]\n",
    )
    .unwrap();
    let (code, _, said) = topo(folder.path(), &["run", "s.toml"]);
    assert_eq!(code, 2);
    for words in [
        "s.toml, line 2: rod.knot = \"3_7\"",
        "no knot `3_7`",
        "--> s.toml:2:16",
    ] {
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn a_new_scene_is_right_and_nothing_is_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for (arguments, file) in [
        (vec!["scene", "new"], "scene.toml"),
        (
            vec!["scene", "new", "--battery", "nematic", "colloid.toml"],
            "colloid.toml",
        ),
    ] {
        assert_eq!(topo(here, &arguments).0, 0);
        let written = std::fs::read_to_string(here.join(file)).unwrap();
        let (code, table, _) = topo(here, &["scene", "check", file]);
        assert_eq!((code, table.trim()), (0, HEADER));
        std::fs::write(here.join(file), "mine").unwrap();
        let (code, _, said) = topo(here, &arguments);
        assert!(code == 2 && said.contains("--force"), "{said}");
        assert_eq!(std::fs::read_to_string(here.join(file)).unwrap(), "mine");
        assert_eq!(topo(here, &[&arguments[..], &["--force"]].concat()).0, 0);
        assert_eq!(std::fs::read_to_string(here.join(file)).unwrap(), written);
    }
    for (arguments, words) in [
        (
            vec!["scene", "new", "--battery", "lead"],
            "elastic, nematic",
        ),
        (vec!["scene", "new", "figures.toml"], "rename the file"),
        (vec!["scene", "check", "none.toml"], "none.toml"),
    ] {
        let (code, _, said) = topo(here, &arguments);
        assert!(code == 2 && said.contains(words), "{said}");
    }
}

#[test]
fn a_new_scene_runs_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    assert_eq!(topo(here, &["scene", "new", "mine.toml"]).0, 0);
    let (code, table, said) = topo(here, &["run", "mine.toml"]);
    assert_eq!(code, 0, "{said}");
    assert!(
        table.contains("3_1") && here.join("results/mine/sweep.csv").exists(),
        "{table}"
    );
}
