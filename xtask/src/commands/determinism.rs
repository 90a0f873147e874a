//! `cargo xtask determinism`: the same numbers from one thread, from two, and from runs killed at random moments.

use crate::cli::DeterminismArgs;
use crate::workspace::at;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use topo_cli::CliError;
use topo_cli::commands::compare;
use topo_cli::{note, say};

/// The account of bytes in the report of a run: each thread has room of its own.
const BYTES: &str = "bytes";

/// How often a killed run is looked at.
const POLL: Duration = Duration::from_millis(20);

pub fn run(args: &DeterminismArgs) -> Result<(), CliError> {
    let stop = topo_cli::install();
    let folder = args.out.join("determinism");
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(at(&folder))?;
    }
    let place = |name: &str| folder.join(name);
    let start = Instant::now();
    finish(&args.work("1", &place("one-thread")))?;
    topo_cli::check(&stop)?;
    note!("one thread: {:.0} s", start.elapsed().as_secs_f64());
    let start = Instant::now();
    finish(&args.work("2", &place("two-threads")))?;
    topo_cli::check(&stop)?;
    let whole = start.elapsed();
    note!("two threads: {:.0} s", whole.as_secs_f64());
    let mut moments = Pcg64::seed_from_u64(args.seed);
    let n_kills = torn(args, &place("killed"), whole, &mut moments)?;
    topo_cli::check(&stop)?;
    let mut n_differences = 0;
    let dropped = [&compare::DROPPED[..], &[BYTES]].concat();
    for other in ["two-threads", "killed"] {
        let differences = compare::differences(&place("one-thread"), &place(other), &dropped)?;
        let n_files = compare::files(&place("one-thread"))?.len();
        say!(
            "one-thread and {other}: {n_files} files, {} differ",
            differences.len()
        );
        for line in differences.iter().take(20) {
            say!("  {line}");
        }
        n_differences += differences.len();
    }
    say!(
        "killed {n_kills} times, {} s without kills",
        whole.as_secs()
    );
    if n_differences == 0 {
        Ok(())
    } else {
        Err(CliError::Step(format!("{n_differences} files differ")))
    }
}

impl DeterminismArgs {
    /// What is computed, by this very program: the scene, or all that the figures draw.
    fn work(&self, jobs: &str, out: &Path) -> Vec<String> {
        let out = out.display().to_string();
        let quality = self.quality.to_string().to_lowercase();
        let words: Vec<String> = match &self.scene {
            Some(scene) => vec!["run".to_owned(), scene.display().to_string()],
            // The whole as one part of one: nothing is drawn.
            None => ["figures", "--quality", &quality, "--shard", "1/1"]
                .map(str::to_owned)
                .to_vec(),
        };
        let rest = ["--jobs", jobs, "--out", &out].map(str::to_owned);
        words.into_iter().chain(rest).collect()
    }
}

fn command(words: &[String]) -> Result<Command, CliError> {
    let own = std::env::current_exe().map_err(|e| CliError::Step(e.to_string()))?;
    let mut command = Command::new(own);
    command
        .args(words)
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    Ok(command)
}

/// Runs to the end.
fn finish(words: &[String]) -> Result<(), CliError> {
    let failed = |what: String| CliError::Step(format!("{}: {what}", words.join(" ")));
    let status = command(words)?
        .status()
        .map_err(|e| failed(e.to_string()))?;
    if status.success() {
        Ok(())
    } else {
        Err(failed(status.to_string()))
    }
}

/// Runs to the end on two threads, killed on the way as often as asked; gives how often it was.
fn torn(
    args: &DeterminismArgs,
    out: &Path,
    whole: Duration,
    moments: &mut Pcg64,
) -> Result<u32, CliError> {
    let words = args.work("2", out);
    let failed = |e: std::io::Error| CliError::Step(e.to_string());
    // On average all kills take the time of one whole run, so that it is met at every stage.
    let mean = whole.as_secs_f64() / f64::from(args.kills.max(1));
    let mut n_kills = 0;
    while n_kills < args.kills {
        let mut child = command(&words)?.spawn().map_err(failed)?;
        let end = Instant::now() + Duration::from_secs_f64(2.0 * mean * moments.random::<f64>());
        while Instant::now() < end && child.try_wait().map_err(failed)?.is_none() {
            std::thread::sleep(POLL);
        }
        if child.try_wait().map_err(failed)?.is_some() {
            break;
        }
        child.kill().map_err(failed)?;
        child.wait().map_err(failed)?;
        n_kills += 1;
        note!("killed {n_kills} of {}", args.kills);
    }
    finish(&words)?;
    Ok(n_kills)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    #[test]
    fn the_whole_is_computed_and_nothing_drawn() {
        let mut args = DeterminismArgs {
            scene: None,
            quality: topo_lab::Preset::Draft,
            kills: 3,
            seed: 1,
            out: PathBuf::from("results"),
        };
        let words = args.work("2", Path::new("x"));
        let expected = "figures --quality draft --shard 1/1 --jobs 2 --out x";
        assert_eq!(words.join(" "), expected);
        args.scene = Some(PathBuf::from("a.toml"));
        assert_eq!(
            args.work("1", Path::new("y")).join(" "),
            "run a.toml --jobs 1 --out y"
        );
    }
}
