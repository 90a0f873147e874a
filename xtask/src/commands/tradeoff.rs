//! `cargo xtask tradeoff`: speed against accuracy; what is measured can be kept as the table that goals choose from.

mod sets;

use crate::cli::TradeoffArgs;
use topo_cli::CliError;
use topo_cli::commands::tradeoff;
use topo_lab::Preset;

pub fn run(args: &TradeoffArgs) -> Result<(), CliError> {
    if let Some(name) = args.set.as_deref() {
        let folder = tradeoff::prepare(&args.systems)?;
        return sets::measure_set(args, name, &folder);
    }
    let quality = args.systems.quality;
    if args.record && quality == Preset::Draft {
        return Err(CliError::Argument {
            key: "--record",
            value: quality.to_string(),
            remedy: "tables are measured with --quality standard".to_owned(),
        });
    }
    tradeoff::run(&args.systems, &mut |system, rows| {
        if args.record {
            sets::record_table(system, rows)
        } else {
            Ok(())
        }
    })
}
