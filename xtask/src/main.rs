//! The commands of the topo workspace: `cargo xtask --help` lists them.

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
    // A closed pipe (`| head`) is no reason to panic, and so errors of writing are dropped.
    match commands::dispatch(cli::Cli::parse()) {
        Ok(code) => code,
        Err(e) => {
            eprintln!("error: {e}");
            ExitCode::from(e.exit_code())
        }
    }
}
