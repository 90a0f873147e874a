//! What each command does.

mod accuracy;
mod bench;
mod buckling;
mod cargo;
mod ci;
mod compare;
mod cost;
mod determinism;
mod export;
mod figures;
mod fuzz;
mod knot;
mod packages;
mod record;
mod run;
mod stability;
mod test;
mod tradeoff;

use crate::cli::{Cli, Command, WorkArgs};
use crate::error::XtaskError;
use crate::figures::Quality;
use crate::interrupt;
use std::process::ExitCode;
use topo_lab::{Effort, SweepSettings};

/// Runs the command; only `knot identify` ends well in more ways than one.
pub fn dispatch(cli: Cli) -> Result<ExitCode, XtaskError> {
    match cli.command {
        Command::Knot(args) => return knot::run(&args),
        Command::Figures(args) => figures::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Accuracy(args) => accuracy::run(&args),
        Command::Stability(args) => stability::run(&args),
        Command::Buckling(args) => buckling::run(&args),
        Command::Tradeoff(args) => tradeoff::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Cost(args) => cost::run(&args),
        Command::Determinism(args) => determinism::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Fuzz(args) => fuzz::run(&args),
        Command::Test(args) => test::run(&args),
        Command::Ci => ci::run(),
        Command::Bench(args) => bench::run(&args),
    }
    .map(|()| ExitCode::SUCCESS)
}

/// What the options of a computation ask for.
fn settings(work: &WorkArgs) -> Result<SweepSettings, XtaskError> {
    Ok(SweepSettings {
        jobs: threads(work.jobs)?,
        fresh: work.fresh,
        interrupt: interrupt::install(),
        ..SweepSettings::new(&work.out)
    })
}

/// How much a command runs that knows no paper quality.
fn effort(quality: Quality) -> Result<Effort, XtaskError> {
    match quality {
        Quality::Draft => Ok(Effort::Draft),
        Quality::Standard => Ok(Effort::Standard),
        Quality::Paper => Err(XtaskError::Argument {
            key: "--quality",
            value: "paper".to_owned(),
            remedy: "this is made at draft or standard".to_owned(),
        }),
    }
}

/// Gives rayon `jobs` threads, or all processors, and returns the number (0 for all).
fn threads(jobs: Option<usize>) -> Result<usize, XtaskError> {
    let Some(n) = jobs else { return Ok(0) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(n);
    pool.build_global().map_err(|e| XtaskError::Argument {
        key: "--jobs",
        value: n.to_string(),
        remedy: e.to_string(),
    })?;
    Ok(n)
}
