//! The program `topo`: its command line, and what each command does.
//!
//! A program is [`Cli`] parsed and [`end`] of [`run`]; another program takes [`Command`] and [`Measure`] into its own command line and
//! calls [`commands::dispatch`] and [`commands::measure`].

// these panic when nobody reads what they write: `say!` and `note!` do not
#![deny(clippy::print_stdout, clippy::print_stderr)]

#[macro_use]
mod say;

mod cli;
pub mod commands;
mod compute;
mod duration;
mod error;
mod interrupt;
mod progress;

pub use cli::{
    Any, BucklingArgs, Cli, Command, CompareArgs, CostArgs, Measure, OF_FIGURES, SystemsArgs,
    WorkArgs, quality,
};
pub use error::CliError;
pub use interrupt::{check, install};

use std::process::ExitCode;

/// Runs what the command line says.
///
/// # Errors
/// What the command says, with an exit code.
pub fn run(cli: Cli) -> Result<ExitCode, CliError> {
    match cli.command {
        Any::Command(command) => commands::dispatch(command, None),
        Any::Measure(command) => commands::measure(&command).map(|()| ExitCode::SUCCESS),
    }
}

/// The exit code of a command; says what went wrong.
pub fn end(outcome: Result<ExitCode, CliError>) -> ExitCode {
    outcome.unwrap_or_else(|e| {
        note!("error: {e}");
        ExitCode::from(e.exit_code())
    })
}
