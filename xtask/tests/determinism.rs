//! The command that compares one thread, two threads and killed runs, on a small scene and on the whole draft.

use std::path::Path;
use std::process::{Command, Output};

fn determinism(arguments: &[&str], out: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    command.arg("determinism").args(arguments);
    command.arg("--out").arg(out).output().unwrap()
}

fn agrees(output: &Output) {
    let stdout = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{stdout}\n{errors}");
    assert_eq!(stdout.matches(" 0 differ").count(), 2, "{stdout}");
}

#[test]
fn a_small_scene_gives_the_same_numbers_from_any_number_of_threads() {
    let dir = tempfile::tempdir().unwrap();
    let scene = dir.path().join("scene.toml");
    let text = "[rod]\nknot = \"3_1\"\ntwist = [-1.0, 0.0, 1.0]\n[rod.contact]\n[rod.friction]\n[charge]\nduration = 0.05\n[discharge]\nuntil_released = 0.6\nclosures = 4\n[accuracy]\nedges = 60\ntolerance = 5e-3\n";
    std::fs::write(&scene, text).unwrap();
    let scene = scene.display().to_string();
    agrees(&determinism(&[&scene, "--kills", "2"], dir.path()));
}

#[test]
#[ignore = "long: the whole draft three times"]
fn long_the_draft_gives_the_same_numbers_from_any_number_of_threads() {
    let dir = tempfile::tempdir().unwrap();
    agrees(&determinism(&["--kills", "10"], dir.path()));
}
