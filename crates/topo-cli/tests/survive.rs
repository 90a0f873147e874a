//! Sweeps that are killed without warning, as by `kill -9` or a power cut, and started again.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const ELASTIC: &str = "[rod]\nknot = \"3_1\"\ntwist = { from = -1, to = 1, n = 9 }\n[rod.contact]\n[rod.friction]\n[charge]\nduration = 0.1\n[discharge]\nuntil_released = 0.7\nclosures = 4\n[accuracy]\nedges = 80\ntolerance = 4e-3\n";
/// Without flow, and one q with it besides.
const NEMATIC: &str = "[nematic]\nradius = 6\nspacing = 1.0\nq = [1, 2, 3]\n[charge]\ntolerance = 1e-5\n[discharge]\nuntil_released = 0.99\n[flow]\nq = 2\n[accuracy]\ntolerance = 1e-4\n";

fn xtask() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_topo"));
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

fn sweep(scene: &Path, out: &Path) -> Command {
    let mut command = xtask();
    command.arg("run").arg(scene).arg("--out").arg(out);
    // checkpoints much closer than a user wants them, so that kills meet every stage
    command.args(["--checkpoint", "0.05"]);
    command
}

/// Kills a sweep `n_kills` times, each time going on in what it left, and compares what is there in the end with an
/// undisturbed run.
fn survives(text: &str, n_kills: usize, seed: u64) {
    let dir = tempfile::tempdir().unwrap();
    let scene = dir.path().join("scene.toml");
    std::fs::write(&scene, text).unwrap();
    let calm = dir.path().join("calm");
    let start = Instant::now();
    assert!(sweep(&scene, &calm).status().unwrap().success());
    let whole = start.elapsed().as_secs_f64();
    let mut moments = Pcg64::seed_from_u64(seed);
    let (mut kills, mut round) = (0, 0);
    while kills < n_kills {
        round += 1;
        assert!(round < 100, "{kills} kills in {round} rounds");
        let torn = dir.path().join(format!("torn-{round}"));
        // a sweep that gets to its end is followed by another in a folder of its own
        loop {
            let mut child = sweep(&scene, &torn).spawn().unwrap();
            std::thread::sleep(Duration::from_secs_f64(
                0.6 * whole * moments.random::<f64>(),
            ));
            let finished = child.try_wait().unwrap().is_some();
            if !finished && kills < n_kills {
                child.kill().unwrap();
                child.wait().unwrap();
                kills += 1;
                continue;
            }
            assert!(child.wait().unwrap().success());
            break;
        }
        let compared = xtask()
            .arg("compare")
            .args([&calm, &torn])
            .stdout(Stdio::piped())
            .output()
            .unwrap();
        assert!(
            compared.status.success(),
            "{}",
            String::from_utf8_lossy(&compared.stdout)
        );
        std::fs::remove_dir_all(&torn).unwrap();
    }
}

#[test]
fn a_killed_elastic_sweep_ends_as_an_undisturbed_one() {
    survives(ELASTIC, 2, 1);
}

#[test]
fn a_killed_nematic_sweep_ends_as_an_undisturbed_one() {
    survives(NEMATIC, 2, 2);
}

#[test]
#[ignore = "long: ten kills of either sweep"]
fn long_ten_kills_change_nothing() {
    survives(ELASTIC, 10, 3);
    survives(NEMATIC, 10, 4);
}

/// A rod of four thousand edges, about a minute of work in few cases.
const LONG_ROD: &str = "[rod]\nknot = \"3_1\"\ntwist = 1.0\n[rod.contact]\n[rod.friction]\n[charge]\nduration = 0.05\n[discharge]\nuntil_released = 0.2\nclosures = 4\n[accuracy]\nedges = 4000\ntolerance = 4e-3\n";

/// All files of a case as text, but for what depends on the clock.
fn files(case: &Path) -> Vec<(String, String)> {
    let entries = std::fs::read_dir(case).unwrap();
    let mut files: Vec<_> = entries
        .map(|entry| {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let text = std::fs::read_to_string(&path).unwrap();
            let timeless = |line: &&str| !line.contains("cpu_seconds");
            let text: String = text.lines().filter(timeless).collect();
            (name, text)
        })
        .collect();
    files.sort();
    files
}

/// The only case of a sweep.
fn only_case(out: &Path) -> std::path::PathBuf {
    let entries = std::fs::read_dir(out.join("scene")).unwrap();
    let mut cases = entries.map(|e| e.unwrap().path()).filter(|p| p.is_dir());
    cases.next().unwrap()
}

#[test]
#[ignore = "long: a rod of 4000 edges, three times"]
fn long_a_long_rod_survives_kills_to_the_bit() {
    let dir = tempfile::tempdir().unwrap();
    let scene = dir.path().join("scene.toml");
    std::fs::write(&scene, LONG_ROD).unwrap();
    let run = |out: &Path, checkpoint: &str| {
        let mut command = xtask();
        command.arg("run").arg(&scene).arg("--out").arg(out);
        command.args(["--checkpoint", checkpoint]);
        command
    };
    let [calm, torn] = ["calm", "torn"].map(|name| dir.path().join(name));
    let start = Instant::now();
    assert!(run(&calm, "1e9").status().unwrap().success());
    let whole = start.elapsed();
    println!("undisturbed: {:.1} s", whole.as_secs_f64());
    // the second run goes on from where the first was killed: together less than the whole
    for share in [0.4, 0.3] {
        let mut child = run(&torn, "1").spawn().unwrap();
        std::thread::sleep(whole.mul_f64(share));
        assert!(
            child.try_wait().unwrap().is_none(),
            "not killed inside the rod"
        );
        child.kill().unwrap();
        child.wait().unwrap();
        let left = std::fs::read_dir(only_case(&torn)).unwrap();
        let names: Vec<_> = left.map(|e| e.unwrap().file_name()).collect();
        assert!(!names.is_empty(), "no checkpoint");
        println!(
            "killed after {:.1} s, left {names:?}",
            whole.as_secs_f64() * share
        );
    }
    let start = Instant::now();
    assert!(run(&torn, "1").status().unwrap().success());
    let rest = start.elapsed();
    println!("gone on with: {:.1} s", rest.as_secs_f64());
    let [calm, torn] = [calm, torn].map(|out| files(&only_case(&out)));
    let names = |files: &[(String, String)]| files.iter().map(|f| f.0.clone()).collect::<Vec<_>>();
    assert_eq!(names(&calm), names(&torn));
    for ((name, a), (_, b)) in calm.iter().zip(&torn) {
        assert!(a == b, "{name} differs");
    }
}

/// Presses Ctrl-C for a child.
#[cfg(unix)]
fn press_ctrl_c(child: &std::process::Child) {
    let pressed = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(pressed.unwrap().success());
}

#[cfg(unix)]
#[test]
fn the_first_ctrl_c_ends_a_tightening_and_keeps_its_best_curve() {
    let dir = tempfile::tempdir().unwrap();
    let tighten = |out: &Path, quality: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_topo"));
        command.args(["knot", "tighten", "7_4", "--quality", quality, "--out"]);
        command
            .arg(out)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command
    };
    let out = dir.path().join("tight");
    let child = tighten(&out, "fine").spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    press_ctrl_c(&child);
    let end = child.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&end.stdout);
    assert_eq!(end.status.code(), Some(130), "{said}");
    assert!(
        said.contains("INTERRUPTED: the best curve so far is kept"),
        "{said}"
    );
    let record = std::fs::read_to_string(out.join("7_4.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    assert_eq!(record["certificate"]["converged"], false);
    assert!(record["length_over_radius"].as_f64().unwrap() > 60.0);
    assert!(out.join("7_4.vect").exists() && out.join("table.md").exists());
    // what was cut short is not taken for the tight shape, nor does it take the place of one
    assert!(!out.join("cache").exists());
}
