//! What each command does.

pub mod accuracy;
pub mod buckling;
pub mod compare;
pub mod cost;
mod export;
mod extremes;
mod figures;
mod folder;
mod knot;
mod run;
pub mod scene;
mod settings;
pub mod tradeoff;

use std::path::Path;
use std::process::ExitCode;

use clap::CommandFactory;

use crate::batteries::Batteries;
use crate::cli::{Cli, Command, Measure};
use crate::error::CliError;
use crate::output;

/// Runs a command of a program that knows these batteries; only `knot identify` ends well in more ways than one. Figures note the
/// commit of `workspace`, if there is one.
///
/// # Errors
/// What the command says, with an exit code.
pub fn dispatch(
    command: Command,
    batteries: &Batteries<'_>,
    workspace: Option<&Path>,
) -> Result<ExitCode, CliError> {
    match command {
        Command::Knot(args) => return knot::run(&args),
        Command::Scene(args) => return scene::run(&args.command, batteries),
        Command::Figures(args) => match &args.folder {
            Some(folder) => folder::run(folder, batteries),
            None => figures::run(&args, workspace),
        },
        Command::Run(args) => run::run(&args, batteries),
        Command::Accuracy(args) => accuracy::run(&args),
        Command::Extremes(args) => extremes::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Export(args) => export::run(&args, batteries),
    }
    .map(|()| ExitCode::SUCCESS)
}

/// Runs a measurement and keeps its tables below the results.
///
/// # Errors
/// What the command says, with an exit code.
pub fn measure(command: &Measure) -> Result<(), CliError> {
    match command {
        Measure::Buckling(args) => buckling::run(args).map(drop),
        Measure::Tradeoff(args) => tradeoff::run(args, &mut |_, _| Ok(())),
        Measure::Cost(args) => cost::run(args).map(drop),
    }
}

/// Prints the completions of a shell for the program `topo`.
pub(crate) fn completions(shell: clap_complete::Shell) {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "topo", &mut text);
    let text = String::from_utf8_lossy(&text);
    output::data("completions", &text);
    say!("{text}");
}
