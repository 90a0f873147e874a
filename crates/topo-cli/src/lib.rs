//! The program `topo`: its command line, and what each command does.
//!
//! A program is [`main_with`] the batteries that it knows, such as [`BATTERIES`] and one of its own; another program takes [`Command`]
//! and [`Measure`] into its own command line and calls [`commands::dispatch`] and [`commands::measure`].

// these panic when nobody reads what they write: `say!` and `note!` do not
#![deny(clippy::print_stdout, clippy::print_stderr)]

#[macro_use]
mod say;

mod batteries;
mod cli;
pub mod commands;
mod compute;
mod duration;
mod error;
mod interrupt;
pub mod output;
mod progress;

pub use batteries::{BATTERIES, Batteries};
pub use cli::{
    Any, BucklingArgs, Cli, Command, CompareArgs, CostArgs, Measure, OF_FIGURES, SystemsArgs,
    TERMS, WorkArgs, quality,
};
pub use error::CliError;
pub use interrupt::{check, install};

use std::process::ExitCode;

use clap::Parser;

/// The program: does what its command line says with these batteries, and says what went wrong.
pub fn main_with(batteries: &Batteries<'_>) -> ExitCode {
    match Cli::try_parse() {
        Ok(cli) => end(run(cli, batteries)),
        Err(error) => refuse(&error),
    }
}

/// Runs what the command line says with these batteries.
///
/// # Errors
/// What the command says, with an exit code.
pub fn run(cli: Cli, batteries: &Batteries<'_>) -> Result<ExitCode, CliError> {
    if cli.json {
        output::as_json(cli.command.name());
    }
    match cli.command {
        Any::Command(command) => commands::dispatch(command, batteries, None),
        Any::Measure(command) => commands::measure(&command).map(|()| ExitCode::SUCCESS),
        Any::Completions { shell } => {
            commands::completions(shell);
            Ok(ExitCode::SUCCESS)
        }
    }
}

/// The exit code of a command; says what went wrong, and prints the object of `--json`.
pub fn end(outcome: Result<ExitCode, CliError>) -> ExitCode {
    output::finish(outcome.as_ref().err());
    outcome.unwrap_or_else(|e| {
        note!("error: {e}");
        ExitCode::from(e.exit_code())
    })
}

/// The exit code of a command line that is refused or asks for help; says so, with `--json` as an object.
pub fn refuse(error: &clap::Error) -> ExitCode {
    let code = u8::try_from(error.exit_code()).unwrap_or(2);
    let words: Vec<String> = std::env::args().skip(1).collect();
    if error.use_stderr() && words.iter().any(|w| w == "--json") {
        let command = words.iter().find(|w| !w.starts_with('-'));
        let message = error.to_string();
        output::refused(command.map_or("", String::as_str), message.trim_end(), code);
    }
    // a reader that has gone is no fault
    let _ = error.print();
    ExitCode::from(code)
}
