//! `topo knot`: the knot generator.

mod identify;
mod print;
mod show;
mod table;
mod tighten;

use crate::cli::{KnotArgs, KnotCommand};
use crate::error::CliError;
use crate::output;
pub(super) use print::print;
use std::process::ExitCode;
use topo_knots::KnotTable;

pub fn run(args: &KnotArgs) -> Result<ExitCode, CliError> {
    let table = KnotTable::builtin_and(args.knots.as_deref())?;
    match &args.command {
        KnotCommand::Tighten(args) => tighten::run(args, &table)?,
        KnotCommand::Identify(args) => return identify::run(args, &table),
        KnotCommand::List => {
            let knots: Vec<_> = table.iter().map(show::facts).collect();
            output::data("knots", knots);
            print(&show::list(&table));
        }
        KnotCommand::Show { name } => {
            let knot = table.get(name)?;
            output::data("knot", show::facts(&knot));
            print(&show::entry(&knot));
        }
    }
    Ok(ExitCode::SUCCESS)
}
