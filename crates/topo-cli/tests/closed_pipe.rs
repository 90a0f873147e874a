//! Readers that go away (`| head`): the command says no more, goes on to its end, and ends as it would have.

use std::path::Path;
use std::process::{Command, Output, Stdio};

const SCENE: &str = "[nematic]\nradius = 5\nspacing = 1.0\nq = 1\n[charge]\ntolerance = 1e-5\n[discharge]\nuntil_released = 0.9\n[accuracy]\ntolerance = 1e-3\n";

/// A pipe that nobody reads.
fn closed() -> Stdio {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    writer.into()
}

fn xtask(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_topo"));
    command.args(arguments);
    command
}

/// Runs a command with its output closed, and with both closed, and checks how it ends.
fn ends(arguments: &[&str], code: i32) {
    let quiet = |output: Output, what: &str| {
        let said = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
        assert!(!said.contains("panicked"), "{arguments:?} {what}: {said}");
        assert_eq!(
            output.status.code(),
            Some(code),
            "{arguments:?} {what}: {said}"
        );
    };
    let no_output = xtask(arguments).stdout(closed()).output();
    quiet(no_output.unwrap(), "without output");
    let no_errors = xtask(arguments).stderr(closed()).output();
    quiet(no_errors.unwrap(), "without errors");
    let neither = xtask(arguments).stdout(closed()).stderr(closed()).status();
    assert_eq!(neither.unwrap().code(), Some(code), "{arguments:?}");
}

#[test]
fn what_nobody_reads_is_dropped() {
    let dir = tempfile::tempdir().unwrap();
    let here = dir.path().display().to_string();
    ends(&["knot", "list"], 0);
    ends(&["knot", "show", "8_19"], 0);
    ends(&["compare", &here, &here], 0);
    ends(&["run", "no-such-scene.toml"], 2);
    ends(&["knot", "show", "no-such-knot"], 2);
}

#[test]
fn a_run_that_nobody_reads_goes_on() {
    let dir = tempfile::tempdir().unwrap();
    let scene = dir.path().join("scene.toml");
    std::fs::write(&scene, SCENE).unwrap();
    let out = dir.path().join("out");
    let arguments = [
        "run",
        scene.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--fresh",
    ];
    ends(&arguments, 0);
    assert!(n_tables(&out) == 1);
}

/// Tables of sweeps below a folder.
fn n_tables(folder: &Path) -> usize {
    let entries = std::fs::read_dir(folder).unwrap();
    let scenes = entries.map(|e| e.unwrap().path().join("sweep.csv"));
    scenes.filter(|table| table.exists()).count()
}
