//! The command line.

use crate::figures::Quality;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

mod knot;

pub use knot::{IdentifyArgs, KnotArgs, KnotCommand, KnotQuality, TightenArgs};

/// Commands of the topo workspace.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version, about)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute what figures need and draw them, with a gallery page.
    ///
    /// Finished runs are reused; a change of quality or code recomputes what it touches.
    #[command(after_help = "Examples:
  cargo xtask figures                              all figures, draft quality
  cargo xtask figures --only elastic-discharge     one of them
  cargo xtask figures --quality standard --out results-standard")]
    Figures(FiguresArgs),
    /// Run the scene of a file: charge, cut, discharge.
    #[command(after_help = "Examples:
  cargo xtask run scenes/trefoil.toml
  cargo xtask run scenes/trefoil.toml --cuts all:8 --out my-results")]
    Run(RunArgs),
    /// Measure the error of discharge times: 34 fixed cases against finer runs of the same cuts.
    #[command(after_help = "Examples:
  cargo xtask accuracy                       the draft preset
  cargo xtask accuracy --quality standard")]
    Accuracy(AccuracyArgs),
    /// Compare the numbers of two results folders to the byte, but for what tells how long they took.
    #[command(after_help = "Example:
  cargo xtask compare results results-again")]
    Compare(CompareArgs),
    /// The knot generator: tighten a knot, name a curve, look at the table.
    Knot(KnotArgs),
    /// Run every test, doc test and example of the workspace.
    #[command(after_help = "Examples:
  cargo xtask test           everything but the long tests
  cargo xtask test --long    those too")]
    Test(TestArgs),
    /// Everything that must pass before a change lands: fmt, clippy, docs, packages, tests.
    Ci,
    /// Run the benchmarks and print a table.
    #[command(after_help = "Examples:
  cargo xtask bench
  cargo xtask bench contact    those whose name contains a word")]
    Bench(BenchArgs),
}

/// Options of `figures`.
#[derive(Debug, Args)]
pub struct FiguresArgs {
    /// Draw only this figure; may be given several times.
    #[arg(long, value_name = "NAME")]
    pub only: Vec<String>,
    /// How much to compute.
    #[arg(long, value_enum, default_value_t = Quality::Draft)]
    pub quality: Quality,
    #[command(flatten)]
    pub work: WorkArgs,
}

/// Options of `accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyArgs {
    /// Which preset is measured.
    #[arg(long, value_enum, default_value_t = Quality::Draft)]
    pub quality: Quality,
    #[command(flatten)]
    pub work: WorkArgs,
}

/// Options of `run`.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// Scene in TOML.
    pub scene: PathBuf,
    /// Where to cut: `argmax`, `near-ties` or `all:K`; instead of the scene's own.
    #[arg(long, value_name = "CUTS")]
    pub cuts: Option<String>,
    #[command(flatten)]
    pub work: WorkArgs,
}

/// Options that every computation has.
#[derive(Debug, Args)]
pub struct WorkArgs {
    /// Folder of the results.
    #[arg(long, value_name = "DIR", default_value = "results")]
    pub out: PathBuf,
    /// Number of threads; all processors when left out.
    #[arg(long, value_name = "N")]
    pub jobs: Option<usize>,
    /// Compute everything anew.
    #[arg(long)]
    pub fresh: bool,
}

/// Options of `compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// A results folder.
    pub first: PathBuf,
    /// Another.
    pub second: PathBuf,
}

/// Options of `test`.
#[derive(Debug, Args)]
pub struct TestArgs {
    /// Also run the ignored tests whose names start with `long_`.
    #[arg(long)]
    pub long: bool,
}

/// Options of `bench`.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// Only benchmarks whose name contains this.
    pub filter: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
        let cli = Cli::try_parse_from([
            "xtask",
            "figures",
            "--only",
            "knots-table",
            "--quality",
            "paper",
            "--jobs",
            "1",
        ])
        .unwrap();
        let Command::Figures(f) = cli.command else {
            panic!("not figures")
        };
        assert_eq!(
            (f.only.len(), f.quality, f.work.jobs),
            (1, Quality::Paper, Some(1))
        );
        assert!(Cli::try_parse_from(["xtask", "figures", "--quality", "best"]).is_err());
    }
}
