//! `cargo xtask knot`: the knot generator.

mod identify;
mod show;
mod table;
mod tighten;

use crate::cli::{KnotArgs, KnotCommand};
use crate::error::XtaskError;
use std::io::Write as _;
use std::process::ExitCode;
use topo_knots::{KnotError, KnotTable};

pub fn run(args: &KnotArgs) -> Result<ExitCode, XtaskError> {
    let table = KnotTable::builtin_and(args.knots.as_deref())?;
    match &args.command {
        KnotCommand::Tighten(args) => tighten::run(args, &table)?,
        KnotCommand::Identify(args) => return identify::run(args, &table),
        KnotCommand::List => print(&show::list(&table)),
        KnotCommand::Show { name } => print(&show::entry(&*table.get(name)?)),
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes to the terminal; a closed pipe (`| head`) is no fault.
fn print(text: &str) {
    let _ = std::io::stdout().write_all(text.as_bytes());
}

impl From<KnotError> for XtaskError {
    fn from(e: KnotError) -> Self {
        Self::Input(e.to_string())
    }
}
