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
