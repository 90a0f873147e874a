//! `cargo xtask run SCENE.toml`: one scene of the user's own.

use crate::cli::RunArgs;
use crate::compute;
use crate::error::XtaskError;

pub fn run(args: &RunArgs) -> Result<(), XtaskError> {
    let settings = super::settings(&args.work)?;
    compute::scene(&args.scene, args.cuts.as_deref(), &settings)
}
