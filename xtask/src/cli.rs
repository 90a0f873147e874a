//! The command line.

use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand};
use std::path::PathBuf;
use topo_cli::{OF_FIGURES, SystemsArgs, TERMS, quality};
use topo_lab::Preset;

/// How this program is called.
pub const NAME: &str = "cargo xtask";

/// Commands of the topo workspace.
#[derive(Debug, Parser)]
#[command(name = NAME, bin_name = NAME, version, about, after_help = TERMS)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Print one JSON object instead of lines: command, out, tables, failed, warnings, data, and error where there is one.
    #[arg(long, global = true)]
    pub json: bool,
}

impl Command {
    /// Its name on the command line.
    fn name(&self) -> &'static str {
        match self {
            Self::Topo(command) => command.name(),
            Self::Buckling(_) => "buckling",
            Self::Tradeoff(_) => "tradeoff",
            Self::Cost(_) => "cost",
            Self::Determinism(_) => "determinism",
            Self::Fuzz(_) => "fuzz",
            Self::Test(_) => "test",
            Self::Ci => "ci",
            Self::Scenes => "scenes",
            Self::Docs => "docs",
            Self::Bench(_) => "bench",
        }
    }
}

/// The command line of this call.
pub fn parse() -> Result<Cli, clap::Error> {
    let matches = renamed(Cli::command()).try_get_matches()?;
    let cli = Cli::from_arg_matches(&matches)?;
    if cli.json {
        topo_cli::output::as_json(cli.command.name());
    }
    Ok(cli)
}

/// Examples of `topo`'s commands with the name of this program.
fn renamed(command: clap::Command) -> clap::Command {
    let help = command.get_after_help().map(ToString::to_string);
    let command = match help {
        Some(text) => {
            let name = |before: &str, text: &str| {
                text.replace(&format!("{before}topo "), &format!("{before}{NAME} "))
            };
            command.after_help(name("`", &name("| ", &name("  ", &text))))
        }
        None => command,
    };
    command.mut_subcommands(renamed)
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    #[command(flatten)]
    Topo(topo_cli::Command),
    /// Charge colloids near the critical charge under other spacings, seeds, tolerances and boundary schemes: what decides where rings buckle.
    #[command(after_help = "Examples:
  cargo xtask buckling                          R = 15 and 25: half an hour on one processor
  cargo xtask buckling --radius 52.5 --jobs 1   the published size: an hour, 2 GB
  cargo xtask buckling --record                 puts the tables into docs/nematic-model.md")]
    Buckling(BucklingArgs),
    /// Measure what accuracy costs: the same cases under many settings, against converged references.
    #[command(after_help = "Examples:
  cargo xtask tradeoff                        draft: minutes
  cargo xtask tradeoff --only rod             one system
  cargo xtask tradeoff --quality standard     the settings of `run --accuracy` on more cases; --record keeps them
  cargo xtask tradeoff --set factor           what scales the error estimates of such runs; --record keeps it
  cargo xtask tradeoff --set check            do these estimates hold, on cases used for neither?
  cargo xtask tradeoff --set check --record   the same, put into docs/tradeoff.md")]
    Tradeoff(TradeoffArgs),
    /// Measure what each term of a scene costs in time and bytes, with it and without it.
    #[command(after_help = "Examples:
  cargo xtask cost                       small runs: about a minute
  cargo xtask cost --quality standard")]
    Cost(CostArgs),
    /// Compute on one thread, on two, and killed at random moments, and compare the numbers to the byte.
    #[command(after_help = "Examples:
  cargo xtask determinism                           all that the draft figures draw: three times some minutes
  cargo xtask determinism scenes/elastic-quick.toml    a scene instead")]
    Determinism(DeterminismArgs),
    /// Feed every parser with generated files: needs cargo-fuzz.
    #[command(after_help = "Examples:
  cargo xtask fuzz                        ten minutes for each parser
  cargo xtask fuzz --minutes 60 vect xyz  an hour for each of two")]
    Fuzz(FuzzArgs),
    /// Run every test, doc test and example of the workspace.
    #[command(after_help = "Examples:
  cargo xtask test           everything but the long tests
  cargo xtask test --long    those too")]
    Test(TestArgs),
    /// Everything that must pass before a change lands: fmt, clippy, docs, packages, tests.
    Ci,
    /// Write the reference of scene files (docs/scenes.md, docs/scene.schema.json) from the types that read them.
    Scenes,
    /// Build the documentation: rustdoc with typeset equations into target/doc, and the site (tutorial, pages, Python API, search) into target/site.
    Docs,
    /// Run the benchmarks and print a table.
    #[command(after_help = "Examples:
  cargo xtask bench
  cargo xtask bench contact    those whose name contains a word")]
    Bench(BenchArgs),
}

/// Options of `buckling`.
#[derive(Debug, Args)]
pub struct BucklingArgs {
    #[command(flatten)]
    pub measured: topo_cli::BucklingArgs,
    /// Put the tables into docs/nematic-model.md.
    #[arg(long)]
    pub record: bool,
}

/// Options of `cost`.
#[derive(Debug, Args)]
pub struct CostArgs {
    #[command(flatten)]
    pub measured: topo_cli::CostArgs,
    /// Put the table into docs/cost.md.
    #[arg(long)]
    pub record: bool,
}

/// Options of `tradeoff`.
#[derive(Debug, Args)]
pub struct TradeoffArgs {
    #[command(flatten)]
    pub systems: SystemsArgs,
    /// Run the settings of scenes with a goal on another set of cases: `factor` (which scales their estimates of the error) or `check` (how well these hold).
    #[arg(long, value_name = "SET", value_parser = ["factor", "check"], conflicts_with = "quality")]
    pub set: Option<String>,
    /// Keep what was measured: the table from which scenes with `accuracy` or `budget` take their settings (with --quality standard), the factor of their estimates (with --set factor), and the tables of docs/tradeoff.md.
    #[arg(long)]
    pub record: bool,
}

/// Options of `determinism`.
#[derive(Debug, Args)]
pub struct DeterminismArgs {
    /// A scene, instead of all that figures draw.
    pub scene: Option<PathBuf>,
    /// How much to compute.
    #[arg(long, value_parser = quality(OF_FIGURES), default_value = Preset::Draft.name())]
    pub quality: Preset,
    /// How often one of the runs is killed.
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub kills: u32,
    /// Seed of the moments.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Folder of the results.
    #[arg(long, value_name = "DIR", default_value = "results")]
    pub out: PathBuf,
}

/// Options of `fuzz`.
#[derive(Debug, Args)]
pub struct FuzzArgs {
    /// Only these parsers, by the names in `fuzz/Cargo.toml`.
    #[arg(value_name = "TARGET")]
    pub targets: Vec<String>,
    /// Minutes for each.
    #[arg(long, value_name = "M", default_value_t = 10.0)]
    pub minutes: f64,
    /// Only make the table, from what earlier runs printed.
    #[arg(long)]
    pub report: bool,
    /// Put the table into docs/fuzzing.md.
    #[arg(long)]
    pub record: bool,
    /// Folder of the results.
    #[arg(long, value_name = "DIR", default_value = "results")]
    pub out: PathBuf,
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

    #[test]
    fn the_command_line_is_consistent() {
        renamed(Cli::command()).debug_assert();
    }

    #[test]
    fn examples_name_this_program() {
        let help = |words: &[&str]| {
            let words = [NAME].iter().chain(words).chain(&["--help"]);
            let said = renamed(Cli::command()).try_get_matches_from(words);
            said.unwrap_err().to_string()
        };
        let figures = help(&["figures"]);
        assert!(
            figures.contains("  cargo xtask figures --quality paper"),
            "{figures}"
        );
        let identify = help(&["knot", "identify"]);
        assert!(
            identify.contains("| cargo xtask knot identify -"),
            "{identify}"
        );
        assert!(!identify.contains(" topo "), "{identify}");
        assert!(help(&["run"]).contains("`cargo xtask export`"));
    }

    #[test]
    fn counts_out_of_range_are_refused_with_option_and_number() {
        let parse = |number| Cli::try_parse_from(["xtask", "determinism", "--kills", number]);
        assert!(parse("7").is_ok());
        for number in ["1000000000000", "99999999999999999999999", "1.5", "many"] {
            let error = parse(number).unwrap_err();
            let said = error.to_string();
            assert_eq!(error.exit_code(), 2);
            assert!(said.contains("--kills") && said.contains(number), "{said}");
        }
    }
}
