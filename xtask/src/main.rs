//! The commands of the topo workspace: `cargo xtask --help` lists them.

// these panic when nobody reads what they write: `say!` and `note!` do not
#![deny(clippy::print_stdout, clippy::print_stderr)]

#[macro_use]
mod say;

mod cli;
mod commands;
mod compute;
mod data;
mod error;
mod export;
mod figures;
mod gallery;
mod interrupt;
mod movies;
mod outside;
mod plot;
mod progress;
mod provenance;
mod reproduction;
mod scenes;
mod stability;
#[cfg(test)]
mod synthetic;
mod tradeoff;
mod viewer;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    match commands::dispatch(cli::Cli::parse()) {
        Ok(code) => code,
        Err(e) => {
            note!("error: {e}");
            ExitCode::from(e.exit_code())
        }
    }
}
