//! What a scene asks for, over all its keys: each run twice, in parts, and killed once, all into one output folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

const ROD: &str = "[charge]\nduration = 0.05\n[discharge]\nuntil_released = 0.3\nclosures = 2\n";
const COLLOID: &str = "[charge]\ntolerance = 1e-4\n";

/// A rod with keys of `[rod]`, tables below it, keys of `[discharge]` and of `[accuracy]`.
fn rod(keys: &str, tables: &str, discharge: &str, accuracy: &str) -> String {
    format!(
        "[rod]\n{keys}\n{tables}\n{ROD}{discharge}\n[accuracy]\nedges = 60\ntolerance = 1e-2\n{accuracy}\n"
    )
}

/// A colloid with keys of `[nematic]` and further tables.
fn colloid(keys: &str, tables: &str) -> String {
    format!(
        "[nematic]\n{keys}\n{COLLOID}[discharge]\nuntil_released = 0.9\n[accuracy]\ntolerance = 1e-3\n{tables}\n"
    )
}

/// A scene by name, with its number of rows.
type Named = (&'static str, String, usize);

fn scenes() -> Vec<Named> {
    [rod_sweeps(), single_rods(), colloids()].concat()
}

const CONTACT_AND_FRICTION: &str = "[rod.contact]\n[rod.friction]";

/// Rods with several values of a setting.
fn rod_sweeps() -> Vec<Named> {
    let both = CONTACT_AND_FRICTION;
    vec![
        (
            "close-twists",
            rod("knot = \"3_1\"\ntwist = [1.001, 1.004]", both, "", ""),
            2,
        ),
        (
            "fine-twists",
            rod(
                "knot = \"3_1\"\ntwist = { from = -0.01, to = 0.01, n = 9 }",
                "",
                "",
                "",
            ),
            9,
        ),
        (
            "untwisted",
            rod("knot = [\"3_1\", \"m3_1\"]", "", "", ""),
            2,
        ),
        (
            "friction",
            rod(
                "knot = \"3_1\"",
                "[rod.contact]\n[rod.friction]\nratio = [0.1, 0.2]",
                "",
                "",
            ),
            2,
        ),
        (
            "stiffness",
            rod(
                "knot = \"3_1\"",
                "[rod.contact]\nstiffness = { from = 10, to = 20, n = 3 }",
                "",
                "",
            ),
            3,
        ),
        (
            "slenderness",
            rod(
                "knot = \"3_1\"\nslenderness = [45, 50]\nstretch_ratio = [4.0, 5.0]",
                both,
                "",
                "",
            ),
            4,
        ),
    ]
}

/// Rods by their material, ends, cuts and seeds.
fn single_rods() -> Vec<Named> {
    let both = CONTACT_AND_FRICTION;
    vec![
        (
            "material",
            rod(
                "knot = \"3_1\"\nreading = \"hard\"\npoisson_ratio = 0.4\ntwist = 1",
                "",
                "",
                "",
            ),
            1,
        ),
        (
            "ends",
            rod(
                "knot = \"3_1\"",
                both,
                "[discharge.ends]\nconditions = [\"clamped\", \"free\"]",
                "",
            ),
            1,
        ),
        (
            "given-cuts",
            rod("knot = \"3_1\"", both, "cuts = [0.1, 0.6]", ""),
            2,
        ),
        (
            "seeds",
            rod(
                "knot = \"3_1\"\nimperfection = 0.01\nseed = [1, 2]",
                both,
                "",
                "",
            ),
            2,
        ),
        (
            "friction-range",
            rod(
                "knot = \"3_1\"",
                "[rod.contact]\n[rod.friction]\nrange = \"contact\"",
                "",
                "reuse = 1",
            ),
            1,
        ),
    ]
}

fn colloids() -> Vec<Named> {
    let of = |radius: &str, keys: &str, tables: &str| {
        colloid(
            &format!("radius = {radius}\nspacing = 1.25\n{keys}"),
            tables,
        )
    };
    let planar = "pattern = { planar = { axis = [0.0, 0.0, 1.0] } }";
    let field = "particle = false\nfield = { vector = [0.0, 0.0, 1.0], anisotropy = 0.01 }";
    let viscosities = "[material]\nviscosity = [1.0, 1.38]\n[flow]";
    let weak = "q = 1\nanchoring = { weak = 1.0 }";
    let radii = "q = 1\nboundary = \"node-mask\"";
    let cell = "q = 1\ncell = [4.0, 4.0, 3.0]";
    vec![
        ("charges", of("5", "q = [1, 2]", "[flow]\nq = 2"), 3),
        ("homeotropic", of("5", "pattern = \"homeotropic\"", ""), 1),
        ("planar", of("5", planar, ""), 1),
        ("anchoring", of("5", weak, ""), 1),
        ("no-particle", of("5", field, "[switch]\nto = \"keep\""), 1),
        ("viscosities", of("5", "q = 1", viscosities), 2),
        ("radii", of("[4, 5]", radii, ""), 2),
        ("ramp", of("5", "q = 2", "[switch]\nramp = 1.0"), 1),
        ("cell", of("5", cell, ""), 1),
    ]
}

/// Words of a run into `out`, on one thread.
fn run(scene: &Path, out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_topo"));
    command.arg("run").arg(scene).arg("--out").arg(out);
    command.args(["--checkpoint", "0.05"]).args(more);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn done(output: &Output) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
}

/// The table of a scene without what tells how long it took.
fn table(folder: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(folder.join("sweep.csv")).unwrap();
    let rows = reader.deserialize::<BTreeMap<String, String>>();
    rows.map(|row| {
        let mut row = row.unwrap();
        row.retain(|key, _| key != "cpu_seconds" && key != "peak_bytes");
        row
    })
    .collect()
}

fn cases(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path());
    entries.filter(|path| path.is_dir()).collect()
}

/// Puts the cases of one folder into another.
fn merge(from: &Path, to: &Path) {
    for case in cases(from) {
        let place = to.join(case.file_name().unwrap());
        std::fs::create_dir_all(&place).unwrap();
        for file in std::fs::read_dir(&case).unwrap() {
            let file = file.unwrap();
            std::fs::copy(file.path(), place.join(file.file_name())).unwrap();
        }
    }
}

/// Starts a command and kills it after a while, of two seconds at most.
fn kill(mut command: Command, after: Duration) {
    let mut child = command.spawn().unwrap();
    std::thread::sleep(after.min(Duration::from_secs(2)));
    let _ = child.kill();
    let _ = child.wait();
}

/// Every row has the folder of its case, which no other case has.
fn check_folders(name: &str, folder: &Path, rows: &[BTreeMap<String, String>]) {
    let mut folders: Vec<&String> = rows.iter().map(|row| &row["case"]).collect();
    folders.dedup();
    let n_cases = folders.len();
    folders.sort();
    folders.dedup();
    assert_eq!(folders.len(), n_cases, "{name}: cases share a folder");
    assert_eq!(cases(folder).len(), n_cases, "{name}");
    let is_finished = |case: &&String| folder.join(case).join("run.json").exists();
    assert!(folders.iter().all(is_finished));
}

/// Runs scenes `which`; every way to run one gives the same table, and no two cases share a folder.
fn all_ways_agree(which: &[&str]) {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let mut n_rows = 0;
    for (name, text, expected) in scenes() {
        if !(which.is_empty() || which.contains(&name)) {
            continue;
        }
        let scene = dir.path().join(format!("{name}.toml"));
        std::fs::write(&scene, text).unwrap();
        let start = Instant::now();
        done(&run(&scene, &out, &[]).output().unwrap());
        let whole = start.elapsed();
        let folder = out.join(name);
        let first = table(&folder);
        assert_eq!(first.len(), expected, "{name}");
        n_rows += first.len();
        // twice
        let again = run(&scene, &out, &[]).output().unwrap();
        done(&again);
        let said = String::from_utf8_lossy(&again.stderr);
        assert!(
            said.contains("are finished already") || said.contains("is finished already"),
            "{name}: {said}"
        );
        assert_eq!(table(&folder), first, "{name}: run twice");
        // in two parts, elsewhere
        let merged = dir.path().join("merged");
        for (part, place) in [("1/2", "one"), ("2/2", "two")] {
            let place = dir.path().join(place);
            done(&run(&scene, &place, &["--shard", part]).output().unwrap());
            merge(&place.join(name), &merged.join(name));
        }
        done(&run(&scene, &merged, &[]).output().unwrap());
        assert_eq!(table(&merged.join(name)), first, "{name}: in parts");
        let torn = dir.path().join("torn");
        kill(run(&scene, &torn, &[]), whole.mul_f64(0.6));
        done(&run(&scene, &torn, &[]).output().unwrap());
        assert_eq!(table(&torn.join(name)), first, "{name}: killed");
        check_folders(name, &folder, &first);
        // the scene beside the table is the scene
        let own = dir.path().join("own").join(format!("{name}.toml"));
        std::fs::create_dir_all(own.parent().unwrap()).unwrap();
        std::fs::copy(folder.join("scene.toml"), &own).unwrap();
        done(&run(&own, &out, &[]).output().unwrap());
        assert_eq!(table(&folder), first, "{name}: from its own scene.toml");
    }
    assert!(n_rows > 0);
}

#[test]
fn every_way_to_run_a_scene_gives_the_same_table() {
    all_ways_agree(&["close-twists", "charges"]);
}

#[test]
#[ignore = "long: twenty scenes over all keys, each run six times"]
fn long_every_way_to_run_twenty_scenes_gives_the_same_table() {
    assert_eq!(scenes().len(), 20);
    all_ways_agree(&[]);
}

/// A scene that differs is refused where another one's results are, and what is there stays.
#[test]
fn another_scene_does_not_touch_what_is_there() {
    let dir = tempfile::tempdir().unwrap();
    let (scene, out) = (dir.path().join("scene.toml"), dir.path().join("out"));
    let text = rod("knot = \"3_1\"\ntwist = [0.0, 1.0]", "", "", "");
    std::fs::write(&scene, &text).unwrap();
    done(&run(&scene, &out, &[]).output().unwrap());
    let before = table(&out.join("scene"));
    for (other, key) in [
        (
            text.replace("1e-2", "2e-2"),
            "accuracy.tolerance = 0.01 there, 0.02 here",
        ),
        (
            text.replace("[0.0, 1.0]", "0.0"),
            "rod.twist = [0.0,1.0] there, [0.0] here",
        ),
    ] {
        std::fs::write(&scene, other).unwrap();
        let refused = run(&scene, &out, &[]).output().unwrap();
        let said = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(said.contains(key) && said.contains("--out"), "{said}");
        assert_eq!(table(&out.join("scene")), before);
    }
}

/// A case that fails leaves the others alone, is listed with its reason, and fails the command, also when it is run again.
#[test]
fn a_failed_case_fails_the_command() {
    let dir = tempfile::tempdir().unwrap();
    let (scene, out) = (dir.path().join("scene.toml"), dir.path().join("out"));
    std::fs::write(
        &scene,
        rod(
            "knot = \"3_1\"\ntwist = [0.0, 20.0]",
            "[rod.contact]\n[rod.friction]",
            "",
            "",
        ),
    )
    .unwrap();
    for _ in 0..2 {
        let failed = run(&scene, &out, &[]).output().unwrap();
        let said = String::from_utf8_lossy(&failed.stderr);
        assert_eq!(failed.status.code(), Some(1), "{said}");
        assert!(
            said.contains("failed.csv") && said.contains("twist+20.00"),
            "{said}"
        );
        let mut reader = csv::Reader::from_path(out.join("scene/failed.csv")).unwrap();
        assert_eq!(reader.headers().unwrap(), vec!["case", "reason"]);
        let rows: Vec<(String, String)> = reader.deserialize().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 1, "{rows:?}");
        assert!(
            rows[0].0.contains("twist+20.00") && rows[0].1.contains("stopped"),
            "{rows:?}"
        );
        assert!(
            table(&out.join("scene"))
                .iter()
                .any(|row| row["twist"] == "0.0")
        );
    }
}

/// What an option asks for and a scene cannot have is refused.
#[test]
fn options_that_mean_nothing_to_a_scene_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    for (text, option, words) in [
        (
            rod("knot = \"3_1\"", "", "", ""),
            &["--fields"][..],
            ["--fields", "fibre"],
        ),
        (
            colloid("radius = 5\nspacing = 1.25\nq = 1", ""),
            &["--cuts", "argmax"],
            ["--cuts", "nothing to cut"],
        ),
        (
            colloid("radius = 5\nspacing = 1.25\nq = 1", ""),
            &["--knots", "."],
            ["--knots", "no knot"],
        ),
        (
            rod("knot = \"3_1\"", "", "", ""),
            &["--cuts", "1.5"],
            ["--cuts", "1.5"],
        ),
    ] {
        let scene = dir.path().join("scene.toml");
        std::fs::write(&scene, text).unwrap();
        let refused = run(&scene, &out, option).output().unwrap();
        let said = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(words.iter().all(|w| said.contains(w)), "{said}");
    }
    assert!(!out.exists());
}
