//! `topo scene`: scene files without a run.

mod check;
mod new;
mod schema;

use std::process::ExitCode;

use super::knot::print;
use crate::batteries::Batteries;
use crate::cli::SceneCommand;
use crate::error::CliError;
use crate::output;
pub use schema::{schema, schema_text};

pub(super) fn run(command: &SceneCommand, batteries: &Batteries<'_>) -> Result<ExitCode, CliError> {
    match command {
        SceneCommand::Check { files } => check::run(files, batteries)?,
        SceneCommand::New(args) => new::run(args, batteries)?,
        SceneCommand::Schema => {
            output::data("schema", schema(batteries));
            print(&schema_text(batteries));
        }
    }
    Ok(ExitCode::SUCCESS)
}
