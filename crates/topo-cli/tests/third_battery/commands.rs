//! The commands, as for the other batteries: run, shards, resumption, comparison, exports, pictures, refusals.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::time::{Duration, Instant};

use topo_core::Interrupt;
use topo_lab::Battery;

use crate::battery::Unwinding;
use crate::fibre::time_of;
use crate::program::{BATTERIES, Desk, cases, done, program, refused, table, text};

const SCENE: &str = "[unwinding]\nlength = [10, 20]\nturn = { from = -1, to = 3, n = 2 }\n";
/// Cases of a few tenths of a second.
const LONG: &str = "[unwinding]\nlength = 10\nturn = [1, 2, 3, 4, 5, 6]\nedges = 1000\ntolerance = 1e-9\nuntil_released = 0.99999\n";

#[test]
fn a_scene_of_a_third_battery_runs_as_those_of_the_others() {
    let desk = Desk::new(SCENE);
    let said = desk.run("one", &["--jobs", "1"]);
    let printed = text(&said.stdout);
    assert!(printed.contains("L/h    turn  edges"), "{printed}");
    assert!(printed.contains("written to"), "{printed}");
    assert!(text(&said.stderr).contains("estimate: 4 cases"));
    let folder = desk.folder("one");
    let rows = table(&folder);
    assert_eq!((rows.len(), cases(&folder).len()), (4, 4));
    let number = |row: &BTreeMap<String, String>, key: &str| row[key].parse::<f64>().unwrap();
    for row in &rows {
        let (length, turn) = (number(row, "length"), number(row, "turn"));
        for (key, share) in [("t50", 0.5), ("t90", 0.9), ("t99", 0.99)] {
            let exact = time_of(share) * length * length;
            assert!((number(row, key) / exact - 1.0).abs() < 2e-3, "{row:?}");
        }
        let energy = number(row, "energy");
        assert!((energy / (turn * turn / (2.0 * length)) - 1.0).abs() < 1e-12);
        let books = number(row, "energy_left") + number(row, "dissipated") - energy;
        assert!(books.abs() < 5e-3 * energy, "{row:?}");
    }
    let case = folder.join("straight_l10_turn-1.00_n100");
    let run = std::fs::read_to_string(case.join("run.json")).unwrap();
    let run: serde_json::Value = serde_json::from_str(&run).unwrap();
    let keys: Vec<&String> = run.as_object().unwrap().keys().collect();
    assert_eq!(
        keys,
        [
            "schema",
            "fingerprint",
            "case",
            "scene",
            "versions",
            "units",
            "steps",
            "ledger_residual",
            "rows",
            "failure",
            "files",
            "warnings",
            "timings"
        ]
    );
    assert!(run["files"]["series.csv"].is_string());
    // on two threads, a second time, and from the scene that lies beside the table
    desk.run("two", &["--jobs", "2"]);
    desk.are_the_same("one", "two");
    let again = text(&desk.run("one", &[]).stderr);
    assert!(
        again.contains("4 of 4 cases are finished already"),
        "{again}"
    );
    std::fs::copy(folder.join("scene.toml"), desk.path("fibres.toml")).unwrap();
    let own = text(&desk.run("one", &[]).stderr);
    assert!(own.contains("4 of 4 cases are finished already"), "{own}");
}

#[test]
fn shards_of_a_third_battery_merge_into_the_whole_table() {
    let desk = Desk::new(SCENE);
    desk.run("whole", &[]);
    for (shard, part) in [("1/2", "first"), ("2/2", "second")] {
        desk.run(part, &["--shard", shard]);
        assert_eq!(cases(&desk.folder(part)).len(), 2);
        for case in cases(&desk.folder(part)) {
            let to = desk.folder("merged").join(case.file_name().unwrap());
            std::fs::create_dir_all(&to).unwrap();
            for file in std::fs::read_dir(&case).unwrap() {
                let file = file.unwrap();
                std::fs::copy(file.path(), to.join(file.file_name())).unwrap();
            }
        }
    }
    let said = text(&desk.run("merged", &[]).stderr);
    assert!(said.contains("4 of 4 cases are finished already"), "{said}");
    desk.are_the_same("whole", "merged");
}

#[test]
fn a_killed_sweep_of_a_third_battery_is_gone_on_with() {
    let desk = Desk::new(LONG);
    desk.run("calm", &["--jobs", "1"]);
    let (scene, out) = (desk.path("fibres.toml"), desk.path("torn"));
    let folder = desk.folder("torn");
    let start = Instant::now();
    let mut child: Child = program(&["run", &scene, "--out", &out, "--jobs", "1"])
        .spawn()
        .unwrap();
    while cases(&folder).is_empty() && start.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let n_finished = cases(&folder).len();
    assert!((1..6).contains(&n_finished), "{n_finished} cases");
    assert!(!folder.join("sweep.csv").exists());
    let said = text(&desk.run("torn", &[]).stderr);
    let words = format!("{n_finished} of 6 cases are finished already");
    assert!(said.contains(&words), "{said}");
    desk.are_the_same("calm", "torn");
}

#[test]
fn what_a_third_battery_does_not_know_is_refused() {
    let desk = Desk::new(SCENE);
    let (scene, out) = (desk.path("fibres.toml"), desk.path("out"));
    for (option, value) in [
        ("--cuts", "argmax"),
        ("--accuracy", "0.1"),
        ("--knots", "."),
    ] {
        let said = refused(&["run", &scene, "--out", &out, option, value]);
        assert!(
            said.contains(option) && said.contains("leave it out"),
            "{said}"
        );
    }
    let said = refused(&["run", &scene, "--out", &out, "--fields"]);
    assert!(said.contains("--fields"), "{said}");
    for (text, words) in [
        (
            format!("{SCENE}lenght = 3\n"),
            ["fibres.toml", "line 4", "lenght"],
        ),
        (
            format!("{SCENE}edges = 1\n"),
            ["fibres.toml", "line 4", "unwinding.edges = 1"],
        ),
        (
            format!("{SCENE}[rod]\nknot = \"3_1\"\n"),
            ["fibres.toml", "[rod] and [unwinding]", "both there"],
        ),
        (
            "[charge]\n".to_owned(),
            [
                "fibres.toml",
                "no table [rod] (a knotted fibre), [nematic] (a colloid) or [unwinding] (a straight fibre)",
                "write one",
            ],
        ),
    ] {
        std::fs::write(&scene, text).unwrap();
        let said = refused(&["run", &scene, "--out", &out]);
        assert!(words.iter().all(|w| said.contains(w)), "{said}");
    }
    assert!(!Path::new(&out).exists());
}

#[test]
fn cases_of_a_third_battery_are_exported() {
    let desk = Desk::new(SCENE);
    desk.run("out", &[]);
    let case = desk.folder("out").join("straight_l10_turn+3.00_n100");
    let case = case.to_str().unwrap();
    let to = desk.path("exported");
    let said = text(&done(&["export", case, "--to", &to]).stdout);
    assert!(said.contains("3 files written to"), "{said}");
    let line = std::fs::read_to_string(format!("{to}/charged.vtp")).unwrap();
    assert!(line.contains("NumberOfPoints=\"101\"") && line.contains("\"angle\""));
    assert!(Path::new(&format!("{to}/end.vtp")).exists());
    let archive = std::fs::read(format!("{to}/fibre.npz")).unwrap();
    assert!(archive.starts_with(b"PK"));
    let said = refused(&["export", case, "--to", &to, "--format", "nemaktis"]);
    assert!(said.contains("no director"), "{said}");
}

/// Pictures of whatever a folder holds, by what the battery says of its columns.
#[test]
fn sweeps_of_a_third_battery_are_drawn() {
    let desk = Desk::new(SCENE);
    desk.run("out", &[]);
    let folder = desk.folder("out");
    let found = topo_view::folder::find(&folder, &BATTERIES).unwrap();
    let made = topo_view::folder::draw(&found, &Interrupt::new(), &|_| {}).unwrap();
    assert!(
        made.drawn[0].contains("a straight fibre, 4 discharges"),
        "{:?}",
        made.drawn
    );
    for name in ["over-length", "over-turn", "curves"] {
        for extension in ["csv", "svg", "png"] {
            let path = folder.join(format!("figures/{name}.{extension}"));
            assert!(path.exists(), "{path:?} of {:?}", made.files);
        }
    }
    assert!(made.page.exists());
}

/// A battery of a crate of its own is one line in a program's list: nothing else in the workspace knows of this one.
#[test]
fn no_other_file_names_the_third_battery() {
    let own = Path::new(file!()).parent().unwrap().file_name().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut folders: Vec<PathBuf> = ["crates", "xtask", "tests", "benches", "docs", "scenes"]
        .map(|folder| root.join(folder))
        .to_vec();
    let (mut n_files, mut naming) = (0, Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                if path.file_name() != Some(own) && path.file_name() != Some("target".as_ref()) {
                    folders.push(path);
                }
                continue;
            }
            let Ok(text) = std::fs::read_to_string(&path) else {
                continue;
            };
            n_files += 1;
            if text.to_lowercase().contains(Unwinding.table()) {
                naming.push(path);
            }
        }
    }
    assert!(n_files > 300, "{n_files} files");
    assert!(naming.is_empty(), "{naming:?}");
}
