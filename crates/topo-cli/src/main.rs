//! The program `topo`: `topo --help` lists its commands.

use std::process::ExitCode;

fn main() -> ExitCode {
    topo_cli::main_with(&topo_cli::BATTERIES)
}
