//! What each command does.

mod bench;
mod cargo;
mod ci;
mod dependencies;
mod determinism;
mod fuzz;
mod packages;
mod python;
mod record;
mod rustdoc;
mod scenes;
mod test;
mod tradeoff;

use crate::cli::{Cli, Command};
use crate::workspace::workspace;
use record::record;
use std::path::Path;
use std::process::ExitCode;
use topo_cli::CliError;
use topo_cli::commands::{buckling, cost};

/// Runs the command; only `knot identify` ends well in more ways than one.
pub fn dispatch(cli: Cli) -> Result<ExitCode, CliError> {
    match cli.command {
        Command::Topo(command) => {
            let batteries = &topo_cli::BATTERIES;
            return topo_cli::commands::dispatch(command, batteries, Some(&workspace()));
        }
        Command::Buckling(args) => {
            let text = buckling::run(&args.measured)?;
            kept(args.record, "nematic-model.md", &text)
        }
        Command::Tradeoff(args) => tradeoff::run(&args),
        Command::Cost(args) => {
            let text = cost::run(&args.measured)?;
            kept(args.record, "cost.md", &text)
        }
        Command::Determinism(args) => determinism::run(&args),
        Command::Fuzz(args) => fuzz::run(&args),
        Command::Test(args) => test::run(&args),
        Command::Ci => ci::run(),
        Command::Scenes => scenes::run(),
        Command::Docs => docs(&cargo::target()),
        Command::Bench(args) => bench::run(&args),
    }
    .map(|()| ExitCode::SUCCESS)
}

/// Builds the pages of rustdoc, and the site where there is a Python for it.
fn docs(target: &Path) -> Result<(), CliError> {
    if !cargo::step("rustdoc", rustdoc::command(), |_| {})? {
        return Err(CliError::Step("rustdoc failed".to_owned()));
    }
    rustdoc::place_katex(target)?;
    topo_cli::say!(
        "written to {}",
        target.join("doc/topo_core/index.html").display()
    );
    python::docs(target)
}

/// Puts a table into a page of `docs`, if asked for.
fn kept(is_asked: bool, page: &str, text: &str) -> Result<(), CliError> {
    if is_asked { record(page, text) } else { Ok(()) }
}
