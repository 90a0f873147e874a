//! What users get wrong, at the command line: a clear sentence and exit code 2, before anything runs.

use std::path::Path;
use std::process::Command;

const SCENE: &str = "[rod]\nknot = \"3_1\"\n[accuracy]\nedges = 60\ntolerance = 1e-2\n";

/// Exit code and what was said.
fn refused(arguments: &[&str]) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_topo"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code().unwrap(), said)
}

fn scene(folder: &Path) -> String {
    let path = folder.join("scene.toml");
    std::fs::write(&path, SCENE).unwrap();
    path.display().to_string()
}

#[test]
fn shards_out_of_range_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let scene = scene(dir.path());
    let out = dir.path().join("out").display().to_string();
    for shard in ["0/2", "3/2", "1/0", "two", "1/99999"] {
        for command in [vec!["run", &scene], vec!["figures"]] {
            let mut arguments = command.clone();
            arguments.extend(["--shard", shard, "--out", &out]);
            let (code, said) = refused(&arguments);
            assert_eq!(code, 2, "{arguments:?}: {said}");
            assert!(said.contains("--shard") && said.contains("i/n"), "{said}");
        }
    }
    assert!(!dir.path().join("out").exists());
}

#[test]
fn folders_that_cannot_be_written_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let scene = scene(dir.path());
    let mut places = Vec::new();
    let file = dir.path().join("file");
    std::fs::write(&file, "").unwrap();
    places.push(file.join("below"));
    let locked = dir.path().join("locked");
    std::fs::create_dir(&locked).unwrap();
    let mut rights = std::fs::metadata(&locked).unwrap().permissions();
    rights.set_readonly(true);
    std::fs::set_permissions(&locked, rights).unwrap();
    if tempfile::tempfile_in(&locked).is_ok() {
        println!("skipped in part: this user may write everywhere");
    } else {
        places.push(locked.clone());
    }
    for place in &places {
        let out = place.display().to_string();
        for command in [vec!["run", &scene], vec!["figures"]] {
            let mut arguments = command.clone();
            arguments.extend(["--out", &out]);
            let (code, said) = refused(&arguments);
            assert_eq!(code, 2, "{said}");
            assert!(said.contains("--out") && said.contains(&out), "{said}");
        }
    }
}

#[test]
fn options_of_export_and_checkpoints_are_checked() {
    let dir = tempfile::tempdir().unwrap();
    let scene = scene(dir.path());
    let here = dir.path().display().to_string();
    for (arguments, words) in [
        (vec!["export", &here], ["run.json", "finished case"]),
        (
            vec!["export", &here, "--micrometres", "0"],
            ["--micrometres", "positive"],
        ),
        (
            vec!["run", &scene, "--checkpoint", "nan"],
            ["--checkpoint", "25"],
        ),
    ] {
        let (code, said) = refused(&arguments);
        assert_eq!(code, 2, "{said}");
        assert!(words.iter().all(|w| said.contains(w)), "{said}");
    }
}
