//! The program with this battery among the others, and a desk to run it at.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use clap::Parser;
use topo_cli::{Batteries, Cli};
use topo_lab::{Colloid, Elastic};
use topo_view::Shown;

use crate::battery::Unwinding;

/// Words of the command line, when this executable is the program.
const WORDS: &str = "THIRD_BATTERY_WORDS";

/// The batteries of `topo` and this one: its registration.
pub const BATTERIES: [&dyn Shown; 3] = [&Elastic, &Colloid, &Unwinding];

/// The program: what is left of it beside the batteries of `topo` is one line, `topo_cli::main_with(&batteries)`.
#[test]
fn the_program() {
    let Ok(words) = std::env::var(WORDS) else {
        return;
    };
    let batteries: &Batteries<'_> = &BATTERIES;
    let words: Vec<String> = serde_json::from_str(&words).unwrap();
    let cli = Cli::try_parse_from(words).unwrap();
    let code = match topo_cli::run(cli, batteries) {
        Ok(_) => 0,
        Err(error) => {
            topo_cli::note!("error: {error}");
            error.exit_code()
        }
    };
    std::process::exit(code.into());
}

pub fn program(words: &[&str]) -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap());
    let words: Vec<&str> = ["topo"].iter().chain(words).copied().collect();
    command.env(WORDS, serde_json::to_string(&words).unwrap());
    command.args(["--exact", "program::the_program", "--nocapture"]);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

pub fn done(words: &[&str]) -> Output {
    let output = program(words).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    output
}

pub fn refused(words: &[&str]) -> String {
    let output = program(words).output().unwrap();
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    said
}

/// A folder with a scene in it, and where the results go.
pub struct Desk {
    dir: tempfile::TempDir,
}

impl Desk {
    pub fn new(scene: &str) -> Self {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("fibres.toml"), scene).unwrap();
        Self { dir }
    }

    pub fn path(&self, name: &str) -> String {
        self.dir.path().join(name).to_str().unwrap().to_owned()
    }

    pub fn run(&self, out: &str, more: &[&str]) -> Output {
        let (scene, out) = (self.path("fibres.toml"), self.path(out));
        done(&[&["run", &scene, "--out", &out], more].concat())
    }

    pub fn folder(&self, out: &str) -> PathBuf {
        self.dir.path().join(out).join("fibres")
    }

    pub fn are_the_same(&self, one: &str, other: &str) {
        let said = done(&["compare", &self.path(one), &self.path(other)]);
        assert!(text(&said.stdout).contains("the same"));
    }
}

pub fn table(folder: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(folder.join("sweep.csv")).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

pub fn cases(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let paths = entries.map(|e| e.unwrap().path());
    paths.filter(|p| p.join("run.json").exists()).collect()
}
