//! The program `topo`: `topo --help` lists its commands.

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    topo_cli::end(topo_cli::run(topo_cli::Cli::parse()))
}
