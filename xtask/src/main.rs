//! The commands of the topo workspace: `cargo xtask --help` lists them.

// these panic when nobody reads what they write: `say!` and `note!` do not
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod cli;
mod commands;
mod workspace;

use std::process::ExitCode;

fn main() -> ExitCode {
    topo_view::call_program(cli::NAME);
    match cli::parse() {
        Ok(cli) => topo_cli::end(commands::dispatch(cli)),
        Err(error) => topo_cli::refuse(&error),
    }
}
