//! `topo run SCENE.toml`: one scene of the user's own.

use super::settings::settings;
use crate::batteries::Batteries;
use crate::cli::RunArgs;
use crate::compute;
use crate::error::CliError;
use topo_lab::{Goal, Options, SweepSettings};

pub fn run(args: &RunArgs, batteries: &Batteries<'_>) -> Result<(), CliError> {
    if !(0.0..=1e9).contains(&args.checkpoint) {
        return Err(CliError::Argument {
            key: "--checkpoint",
            value: args.checkpoint.to_string(),
            remedy: "seconds up to 1e9 are needed, such as 25".to_owned(),
        });
    }
    let settings = SweepSettings {
        checkpoint_seconds: args.checkpoint,
        shard: args.shard,
        keep_fields: args.fields,
        ..settings(&args.work)?
    };
    let options = Options {
        cuts: args.cuts.as_deref(),
        knots: args.knots.as_deref(),
        fields: args.fields,
        goal: goal(args)?,
    };
    compute::scene(batteries, &args.scene, &options, &settings)
}

/// What the options ask for instead of settings.
fn goal(args: &RunArgs) -> Result<Option<Goal>, CliError> {
    let refused = |key, value: String| move |remedy| CliError::Argument { key, value, remedy };
    match (args.accuracy, &args.budget) {
        (Some(error), _) => Goal::accuracy(error)
            .map(Some)
            .map_err(refused("--accuracy", error.to_string())),
        (None, Some(text)) => Goal::budget(text)
            .map(Some)
            .map_err(refused("--budget", text.clone())),
        (None, None) => Ok(None),
    }
}
