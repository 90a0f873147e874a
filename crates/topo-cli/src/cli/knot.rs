//! The command line of `topo knot`.

use super::count;
use super::quality::{OF_SHAPES, quality};
use clap::{Args, Subcommand};
use std::path::PathBuf;
use topo_knots::{CurveFormat, FrameChoice, KnotError};
use topo_lab::Preset;

/// Options of `knot`.
#[derive(Debug, Args)]
pub struct KnotArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: KnotCommand,
    /// Folder with knots of your own, one TOML file each, besides the built-in ones.
    #[arg(long, value_name = "DIR", global = true)]
    pub knots: Option<PathBuf>,
}

/// What to do with knots.
#[derive(Debug, Subcommand)]
pub enum KnotCommand {
    /// Find the tight shape of a knot or a link and certify it.
    #[command(after_help = "Examples:
  topo knot tighten 6_3 --quality paper
  topo knot tighten all --quality paper       the whole table
  topo knot tighten --braid \"1 -2 1 -2\"
  topo knot tighten --curve my-knot.vect --format xyz
  topo knot tighten --link whitehead --check
  topo knot tighten --link \"chain(3)\" --link \"T(4,4)\" --quality paper
  topo knot tighten --link all                all links of the table
  topo knot tighten --braid \"1 1 2 2\"       a word or a file may be a link")]
    Tighten(TightenArgs),
    /// Name the knot that a curve in a file is tied as, or the link of several.
    #[command(after_help = "Examples:
  topo knot identify curve.vect
  topo knot identify rings.vect               several closed components: a link
  topo knot identify chain.xyz --open --closures 200
  topo knot identify results/elastic/CASE/snapshots.csv --frame 3
  topo knot identify trajectory.xyz --frame last --json
  gunzip -c curve.xyz.gz | topo knot identify - --format xyz

Files: x, y, z a line between blanks, commas or semicolons, or VECT. A header, also
after #, names the columns: x y z, and where wanted component, frame or time, closed.
A blank line or NaN NaN NaN starts another component. What is no coordinate is said or
refused. A curve whose ends are farther apart than twice its longest edge is taken for
open unless the file says otherwise.

Exit code: 0 named for certain, 3 one of several or consistent with a name, 2 refused.")]
    Identify(IdentifyArgs),
    /// List the knots and the links of the table.
    List,
    /// Show all that the table knows of a knot or a link.
    #[command(after_help = "Examples:
  topo knot show 8_19
  topo knot show borromean")]
    Show {
        /// Name or alias, `m` before it for the mirror image.
        name: String,
    },
}

/// Options of `knot tighten`.
#[derive(Debug, Args)]
#[group(skip)]
pub struct TightenArgs {
    /// Knots of the table, or `all`.
    #[arg(value_name = "NAME", required_unless_present_any = ["braid", "curve", "links"], conflicts_with_all = ["braid", "curve", "links"])]
    pub names: Vec<String>,
    /// Links of the table, such as L6a4, whitehead, chain(3) or T(3,3), or `all`; may be given several times.
    #[arg(long = "link", value_name = "NAME", conflicts_with_all = ["braid", "curve"])]
    pub links: Vec<String>,
    /// A braid word whose closure to tighten, a knot or a link: generators from 1, negative ones inverse.
    #[arg(
        long,
        value_name = "WORD",
        allow_hyphen_values = true,
        conflicts_with = "curve"
    )]
    pub braid: Option<String>,
    /// A closed curve to start from, or several: .csv, .xyz or .vect.
    #[arg(long, value_name = "FILE")]
    pub curve: Option<PathBuf>,
    /// How fine.
    #[arg(long, value_parser = quality(OF_SHAPES), default_value = Preset::Standard.name())]
    pub quality: Preset,
    /// Start also from this number of inversions in spheres around random points: for knots that end in a poor minimum.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = count::from(0, MOST_STARTS))]
    pub inversions: usize,
    /// Search by this number of hops between basins from random words of the braid instead: half a second each, uphill too.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = count::from(0, MOST_STARTS), conflicts_with_all = ["curve", "inversions"])]
    pub hops: usize,
    /// Seed of the random choices of the search.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Tighten each once more by the second method, from a loosened start: about a minute a knot at standard quality.
    #[arg(long)]
    pub check: bool,
    /// Folder of the curves, their certificates and the table.
    #[arg(long, value_name = "DIR", default_value = "results/tight")]
    pub out: PathBuf,
    /// Format of the curves: csv, xyz or vect.
    #[arg(long, value_name = "FORMAT", default_value = "vect", value_parser = ["csv", "xyz", "vect"])]
    pub format: String,
    /// Number of threads; all processors when left out.
    #[arg(long, value_name = "N", value_parser = count::from(1, count::MOST_JOBS))]
    pub jobs: Option<usize>,
    /// Compute everything again.
    #[arg(long)]
    pub fresh: bool,
}

/// Options of `knot identify`.
#[derive(Debug, Args)]
pub struct IdentifyArgs {
    /// The curve: .csv, .xyz or .vect; `-` for the standard input.
    pub file: PathBuf,
    /// Treat the curve as open, whatever the file says: report the types of many closures.
    #[arg(long, conflicts_with = "closed")]
    pub open: bool,
    /// Treat the curve as closed, whatever the file says.
    #[arg(long)]
    pub closed: bool,
    /// Closures of an open curve.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = count::from(1, MOST_CLOSURES))]
    pub closures: usize,
    /// Which frame of a file with several: its number from 1, or `last`.
    #[arg(long, value_name = "N", value_parser = frame, help = "Which frame of a file with several: its number from 1, or `last` [default: last]")]
    pub frame: Option<FrameChoice>,
    /// Format of the file, if its extension does not tell: csv, xyz or vect.
    #[arg(long, value_name = "FORMAT", value_parser = format)]
    pub format: Option<CurveFormat>,
}

/// Most inversions or hops of a search: half a second each.
const MOST_STARTS: usize = 100_000;
/// Most closures of a curve.
const MOST_CLOSURES: usize = 100_000;

fn frame(text: &str) -> Result<FrameChoice, String> {
    match text.parse() {
        _ if text == "last" => Ok(FrameChoice::Last),
        Ok(number) if number > 0 => Ok(FrameChoice::Number(number)),
        _ => Err("give a number from 1 or `last`".to_owned()),
    }
}

fn format(text: &str) -> Result<CurveFormat, String> {
    text.parse().map_err(|e: KnotError| e.to_string())
}

#[cfg(test)]
mod tests {
    use crate::cli::{Any, Cli, Command, KnotCommand};
    use clap::Parser;

    fn parse(words: &[&str]) -> Result<Cli, clap::Error> {
        Cli::try_parse_from(["topo", "knot"].iter().chain(words))
    }

    #[test]
    fn words_with_negative_letters_are_values() {
        let cli = parse(&["tighten", "--braid", "-1 2 -1 2", "--knots", "mine"]).unwrap();
        let Any::Command(Command::Knot(args)) = cli.command else {
            panic!("not knot")
        };
        assert_eq!(args.knots.unwrap().to_str(), Some("mine"));
        let KnotCommand::Tighten(tighten) = args.command else {
            panic!("not tighten")
        };
        assert_eq!(tighten.braid.as_deref(), Some("-1 2 -1 2"));
    }

    #[test]
    fn one_source_of_a_knot_is_needed() {
        assert!(parse(&["tighten"]).is_err());
        assert!(parse(&["tighten", "3_1", "--braid", "1 1 1"]).is_err());
        assert!(parse(&["tighten", "--curve", "a.csv", "--braid", "1 1 1"]).is_err());
        assert!(parse(&["tighten", "--link", "hopf", "--curve", "a.csv"]).is_err());
        assert!(parse(&["tighten", "--link", "hopf", "--braid", "1 1"]).is_err());
        assert!(parse(&["tighten", "3_1", "--link", "hopf"]).is_err());
        assert!(parse(&["tighten", "--link", "hopf", "--link", "L4a1"]).is_ok());
        assert!(parse(&["tighten", "3_1", "4_1", "--quality", "fine"]).is_ok());
        assert!(parse(&["identify", "a.csv", "--open", "--closed"]).is_err());
    }
}
