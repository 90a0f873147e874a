//! The command line of `topo scene`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

/// Options of `scene`.
#[derive(Debug, Args)]
pub struct SceneArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: SceneCommand,
}

/// What to do with scene files.
#[derive(Debug, Subcommand)]
pub enum SceneCommand {
    /// List all that is wrong with scene files, without running them: a table of file, line, column, key, found, expected.
    #[command(after_help = "Examples:
  topo scene check my-scene.toml
  topo scene check scenes/*.toml --json

Exit code: 0 nothing found, 2 something is wrong.")]
    Check {
        /// Scenes in TOML.
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
    },
    /// Write a scene that runs as it is, with every key: those that can be left out as comments.
    #[command(after_help = "Examples:
  topo scene new                                 scene.toml, of a knotted fibre
  topo scene new --battery nematic colloid.toml
  topo run colloid.toml")]
    New(NewArgs),
    /// Print the JSON schema of scene files, for editors.
    #[command(after_help = "Example:
  topo scene schema > scene.schema.json    then `#:schema scene.schema.json` as the first line of a scene")]
    Schema,
}

/// Options of `scene new`.
#[derive(Debug, Args)]
pub struct NewArgs {
    /// Which battery: elastic or nematic.
    #[arg(long, value_name = "NAME", default_value = "elastic")]
    pub battery: String,
    /// Where the scene goes.
    #[arg(value_name = "FILE", default_value = "scene.toml")]
    pub file: PathBuf,
    /// Write over a file that is there.
    #[arg(long)]
    pub force: bool,
}
