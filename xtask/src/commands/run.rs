//! `cargo xtask run SCENE.toml`: one scene of the user's own.

use crate::cli::RunArgs;
use crate::compute;
use crate::error::XtaskError;
use crate::interrupt;
use topo_analysis::SweepSettings;

pub fn run(args: &RunArgs) -> Result<(), XtaskError> {
    let settings = SweepSettings {
        out: args.work.out.clone(),
        jobs: super::threads(args.work.jobs)?,
        fresh: args.work.fresh,
        interrupt: interrupt::install(),
    };
    compute::scene(&args.scene, args.cuts.as_deref(), &settings)
}
