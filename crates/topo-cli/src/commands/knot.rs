//! `topo knot`: the knot generator.

mod identify;
mod print;
mod show;
mod subject;
mod table;
mod tighten;

use crate::cli::{KnotArgs, KnotCommand};
use crate::error::CliError;
use crate::output;
pub(super) use print::print;
use std::process::ExitCode;
use topo_knots::{KnotTable, LinkTable};

pub fn run(args: &KnotArgs) -> Result<ExitCode, CliError> {
    let table = KnotTable::builtin_and(args.knots.as_deref())?;
    match &args.command {
        KnotCommand::Tighten(args) => tighten::run(args, &table)?,
        KnotCommand::Identify(args) => return identify::run(args, &table),
        KnotCommand::List => {
            let knots: Vec<_> = table.iter().map(show::facts).collect();
            output::data("knots", knots);
            let links: Vec<_> = LinkTable::builtin().iter().map(show::link_facts).collect();
            output::data("links", links);
            print(&show::list(&table));
            print(&show::list_of_links(LinkTable::builtin()));
        }
        KnotCommand::Show { name } => match (table.get(name), LinkTable::builtin().get(name)) {
            (Err(_), Ok(link)) => {
                output::data("link", show::link_facts(&link));
                print(&show::link(&link));
            }
            (knot, _) => {
                let knot = knot?;
                output::data("knot", show::facts(&knot));
                print(&show::entry(&knot));
            }
        },
    }
    Ok(ExitCode::SUCCESS)
}
