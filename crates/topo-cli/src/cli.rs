//! The command line.

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;
use topo_lab::Preset;
use topo_lab::Shard;

mod count;
mod knot;
mod quality;
mod scene;

pub use knot::{IdentifyArgs, KnotArgs, KnotCommand, TightenArgs};
use quality::OF_STUDIES;
pub use quality::{OF_FIGURES, quality};
pub use scene::{NewArgs, SceneArgs, SceneCommand};

/// Words and units that every table, figure and page uses.
pub const TERMS: &str = "Terms:
  T_0, E_0      units of fibres: 2 L eta/(h E_b) and E_b h^2 L (h radius, L length, E_b bending modulus, eta viscosity)
  xi_N, tau_N   units of colloids: correlation length and xi_N^2/(Gamma L), L the elastic constant;
                R^2/(Gamma L), for a particle of radius R, is (R/xi_N)^2 tau_N
  cut           where a fibre is opened, s/L
  t50, t99      when 50 or 99 % of the stored energy is released: of a fibre, of what it stored before the cut;
                of a colloid, of what it stores after the switch above its final state
  untied        when the knot is gone, t_untie in tables
  Wr            writhe of the fibre, in turns
  reading       how one L/h is read for knots of different length when tight";

/// Topological batteries: knotted elastic fibres and nematic colloids, charged, discharged and drawn.
#[derive(Debug, Parser)]
#[command(name = "topo", bin_name = "topo", version, about, after_help = TERMS)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Any,
    /// Print one JSON object instead of lines: command, out, tables, failed, warnings, data, and error where there is one.
    #[arg(long, global = true)]
    pub json: bool,
}

/// Any of the commands.
#[derive(Debug, Subcommand)]
pub enum Any {
    /// Experiments, pictures and knots.
    #[command(flatten)]
    Command(Command),
    /// Measurements.
    #[command(flatten)]
    Measure(Measure),
    /// Print the completions of a shell, so that it knows commands and options.
    #[command(after_help = "Where shells look for them:
  topo completions bash > ~/.local/share/bash-completion/completions/topo
  topo completions zsh > ~/.zfunc/_topo          with `fpath+=~/.zfunc` before compinit in ~/.zshrc
  topo completions fish > ~/.config/fish/completions/topo.fish
  topo completions powershell >> $PROFILE
  topo completions elvish >> ~/.config/elvish/rc.elv")]
    Completions {
        /// Which shell.
        shell: clap_complete::Shell,
    },
}

impl Any {
    /// Its name on the command line, with that of what it does to knots.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Command(command) => command.name(),
            Self::Measure(command) => command.name(),
            Self::Completions { .. } => "completions",
        }
    }
}

impl Command {
    /// Its name on the command line, with that of what it does to knots.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Figures(_) => "figures",
            Self::Run(_) => "run",
            Self::Accuracy(_) => "accuracy",
            Self::Extremes(_) => "extremes",
            Self::Compare(_) => "compare",
            Self::Export(_) => "export",
            Self::Scene(args) => match args.command {
                SceneCommand::Check { .. } => "scene check",
                SceneCommand::New(_) => "scene new",
                SceneCommand::Schema => "scene schema",
            },
            Self::Knot(args) => match args.command {
                KnotCommand::Tighten(_) => "knot tighten",
                KnotCommand::Identify(_) => "knot identify",
                KnotCommand::List => "knot list",
                KnotCommand::Show { .. } => "knot show",
            },
        }
    }
}

impl Measure {
    /// Its name on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Buckling(_) => "buckling",
            Self::Tradeoff(_) => "tradeoff",
            Self::Cost(_) => "cost",
        }
    }
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute what the published figures need and draw them, with a gallery page; or draw what a folder of results holds.
    ///
    /// Finished runs are reused; a change of quality or code recomputes what it touches. Of a folder nothing is computed: results
    /// against each setting that is swept in it, discharge curves, shapes, into FOLDER/figures with a page.
    #[command(after_help = "Examples:
  topo figures                              all figures, draft quality
  topo figures --only elastic-discharge     one of them
  topo figures --quality standard --out results-standard
  topo figures --quality paper --shard 2/4 --out part-2    every fourth case, to be merged
  topo figures --quality paper --as-is      draw the cases that are finished
  topo figures results/my-scene             a sweep of your own, also while it runs
  topo figures results                      every sweep in a folder")]
    Figures(FiguresArgs),
    /// Run the scene of a file: charge, cut, discharge.
    #[command(after_help = "Examples:
  topo scene new my-scene.toml            a scene to begin with
  topo run my-scene.toml
  topo run my-scene.toml --cuts all:8 --out my-results
  topo run scenes/elastic-quick.toml --accuracy 0.02    settings for 2 %, and the error it has
  topo run scenes/nematic-desk.toml --budget \"10 min\"
  topo run scenes/nematic-quick.toml --fields --out fields    for `topo export`")]
    Run(RunArgs),
    /// Measure the error of discharge times: 35 fixed cases against finer runs of the same cuts, or the exact discharge where that is known.
    #[command(after_help = "Examples:
  topo accuracy                       the draft preset
  topo accuracy --quality standard")]
    Accuracy(AccuracyArgs),
    /// Drive rods, nematics and the knot generator to their extremes: maps of what converges and why the rest stops.
    #[command(after_help = "Examples:
  topo extremes                       all maps, draft: minutes
  topo extremes --only nematic        those of one system
  topo extremes --quality standard    every run to its very end")]
    #[command(visible_alias = "stability")]
    Extremes(SystemsArgs),
    /// Compare the numbers of two results folders to the byte, but for times and memory.
    #[command(after_help = "Example:
  topo compare results results-again")]
    Compare(CompareArgs),
    /// Write the shapes and fields of a case for ParaView, PyVista, numpy or nemaktis.
    ///
    /// A fibre becomes a line with arc length, tangent, curvature, twist, stretch and energy density, once charged and over
    /// its discharge; a colloid becomes its defect lines, the particle's surface, the plane through its centre and, where
    /// the scene was run with --fields, Q, director, order and velocity in all of the cell.
    #[command(after_help = "Examples:
  topo export results/elastic/3_1_twist+0.00_shrunk_n200
  topo export results/nematic/q04_r20_h1.5_cut-link_f64_flow-on --format vtk --to seen
  topo run scenes/nematic-quick.toml --fields --out fields
  topo export fields/nematic-quick/q02_r15_h1.5_cut-link_f64_flow-off --format nemaktis")]
    Export(ExportArgs),
    /// The knot generator: tighten a knot, name a curve, look at the table.
    Knot(KnotArgs),
    /// Scene files: check them, begin one, describe them to an editor.
    Scene(SceneArgs),
}

/// What is measured of the programs themselves.
#[derive(Debug, Subcommand)]
pub enum Measure {
    /// Charge colloids near the critical charge under other spacings, seeds, tolerances and boundary schemes: what decides where rings buckle.
    #[command(after_help = "Examples:
  topo buckling                          R = 15 and 25: half an hour on one processor
  topo buckling --radius 52.5 --jobs 1   the published size: an hour, 2 GB")]
    Buckling(BucklingArgs),
    /// Measure what accuracy costs: the same cases under many settings, against converged references.
    #[command(after_help = "Examples:
  topo tradeoff                        draft: minutes
  topo tradeoff --only rod             one system")]
    Tradeoff(SystemsArgs),
    /// Measure what each term of a scene costs in time and bytes, with it and without it.
    #[command(after_help = "Examples:
  topo cost                       small runs: about a minute
  topo cost --quality standard")]
    Cost(CostArgs),
}

/// Options of `figures`.
#[derive(Debug, Args)]
pub struct FiguresArgs {
    /// Folder of results, of a scene or of several: what it holds is drawn, and nothing computed.
    #[arg(value_name = "FOLDER", conflicts_with_all = ["only", "quality", "shard", "as_is", "struts", "knots", "out", "jobs", "fresh"])]
    pub folder: Option<PathBuf>,
    /// Draw only this figure; may be given several times.
    #[arg(long, value_name = "NAME")]
    pub only: Vec<String>,
    /// How much to compute.
    #[arg(long, value_parser = quality(OF_FIGURES), default_value = Preset::Draft.name())]
    pub quality: Preset,
    /// Compute part I of N only and draw nothing; each part may run anywhere.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Compute nothing: draw what the folder holds of a sweep that is not finished.
    #[arg(long, conflicts_with_all = ["shard", "fresh"])]
    pub as_is: bool,
    /// Draw the tight knots of `knots-table` and links of `links-table` as thin tubes with their struts.
    #[arg(long)]
    pub struts: bool,
    /// Folder with knots of your own, one TOML file each, shown in `knots-table` besides the built-in ones.
    #[arg(long, value_name = "DIR")]
    pub knots: Option<PathBuf>,
    /// Where and how it is computed.
    #[command(flatten)]
    pub work: WorkArgs,
}

/// Options of `accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyArgs {
    /// Which preset is measured.
    #[arg(long, value_parser = quality(OF_FIGURES), default_value = Preset::Draft.name())]
    pub quality: Preset,
    /// Where and how it is computed.
    #[command(flatten)]
    pub work: WorkArgs,
}

/// Options of `run`.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// Scene in TOML.
    pub scene: PathBuf,
    /// Where to cut: `argmax`, `near-ties`, `all:K`, or places s/L such as `0.25,0.5`; instead of the scene's own.
    #[arg(long, value_name = "CUTS")]
    pub cuts: Option<String>,
    /// Largest relative error of the discharge times (t99 of a rod, t99.9 of a colloid): picks the settings, and estimates the
    /// error of each result.
    #[arg(
        long,
        value_name = "ERROR",
        conflicts_with = "budget",
        allow_negative_numbers = true
    )]
    pub accuracy: Option<f64>,
    /// Time that the scene may take, such as "10 min": picks the most accurate settings for it.
    #[arg(long, value_name = "TIME")]
    pub budget: Option<String>,
    /// Keep the whole nematic field at each time looked at, for `export` (13 files a case; 3 MB each at R = 15).
    #[arg(long)]
    pub fields: bool,
    /// Compute part I of N only; each part may run anywhere.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Seconds between checkpoints inside a case.
    #[arg(long, value_name = "SECONDS", default_value_t = 25.0)]
    pub checkpoint: f64,
    /// Folder with knots of your own, one TOML file each, besides the built-in ones.
    #[arg(long, value_name = "DIR")]
    pub knots: Option<PathBuf>,
    /// Where and how it is computed.
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
    #[arg(long, value_name = "N", value_parser = count::from(1, count::MOST_JOBS))]
    pub jobs: Option<usize>,
    /// Compute everything again.
    #[arg(long)]
    pub fresh: bool,
}

/// Options of `export`.
#[derive(Debug, Args)]
pub struct ExportArgs {
    /// Folder of a case: the one that holds run.json.
    pub case: PathBuf,
    /// Where the files go; `export` inside the case's folder when left out.
    #[arg(long, value_name = "DIR")]
    pub to: Option<PathBuf>,
    /// Which files.
    #[arg(long, value_enum, default_value_t = ExportFormat::All)]
    pub format: ExportFormat,
    /// Micrometres that one correlation length stands for in the files for nemaktis.
    #[arg(long, value_name = "UM", default_value_t = 0.006_63)]
    pub micrometres: f64,
}

/// File formats of `export`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum ExportFormat {
    /// VTK XML: .vtp, .vti, .vtu, with .pvd for time series.
    Vtk,
    /// One .npz a case, and one a field.
    Npz,
    /// .vti with the arrays n, Q and domain_mask, lengths in micrometres; needs fields.
    Nemaktis,
    /// All of them.
    All,
}

/// Options of `extremes` and `tradeoff`.
#[derive(Debug, Args)]
pub struct SystemsArgs {
    /// Only this system (rod, nematic, knots); may be given several times.
    #[arg(long, value_name = "SYSTEM", value_parser = ["rod", "nematic", "knots"])]
    pub only: Vec<String>,
    /// How much is run.
    #[arg(long, value_parser = quality(OF_STUDIES), default_value = Preset::Draft.name())]
    pub quality: Preset,
    /// Where and how it is computed.
    #[command(flatten)]
    pub work: WorkArgs,
}

impl SystemsArgs {
    /// Whether a system is among those asked for.
    pub fn takes(&self, system: topo_lab::System) -> bool {
        self.only.is_empty() || self.only.iter().any(|name| name == system.name())
    }
}

/// Options of `buckling`.
#[derive(Debug, Args)]
pub struct BucklingArgs {
    /// Radius of the particle, in xi_N: 15, 25 or 52.5; may be given several times.
    #[arg(long, value_name = "R", default_values_t = [15.0, 25.0])]
    pub radius: Vec<f64>,
    /// Where and how it is computed.
    #[command(flatten)]
    pub work: WorkArgs,
}

/// Options of `cost`.
#[derive(Debug, Args)]
pub struct CostArgs {
    /// How large the runs are.
    #[arg(long, value_parser = quality(OF_STUDIES), default_value = Preset::Draft.name())]
    pub quality: Preset,
    /// Folder of the results.
    #[arg(long, value_name = "DIR", default_value = "results")]
    pub out: PathBuf,
}

/// Options of `compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// A results folder.
    pub first: PathBuf,
    /// Another.
    pub second: PathBuf,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
        let cli = Cli::try_parse_from([
            "topo",
            "figures",
            "--only",
            "knots-table",
            "--quality",
            "paper",
            "--jobs",
            "1",
        ])
        .unwrap();
        let Any::Command(Command::Figures(f)) = cli.command else {
            panic!("not figures")
        };
        assert_eq!(
            (f.only.len(), f.quality, f.work.jobs),
            (1, Preset::Paper, Some(1))
        );
        assert!(Cli::try_parse_from(["topo", "figures", "--quality", "best"]).is_err());
    }
}
