//! The tables that scenes with a goal take their settings from: recorded, given their factor, checked.

use std::path::{Path, PathBuf};
use std::time::SystemTime;
use topo_cli::say;

use crate::cli::TradeoffArgs;
use crate::commands::record::record_part;
use crate::workspace::workspace;
use topo_analysis::{read_table, write_table};
use topo_cli::CliError;
use topo_cli::commands::tradeoff::{kept, measure};
use topo_lab::Preset;
use topo_lab::{
    CaseSet, CheckRow, Factor, Measured, Point, Record, Stamp, System, TradeoffRow,
    check_estimates, compared, factor_of_estimates, ladder, points, table_hash,
};
use topo_view::data;
use topo_view::provenance::commit;

/// Where the tables lie, below the workspace.
const TABLES: &str = "crates/topo-lab/data";

fn place(table: Measured, extension: &str) -> PathBuf {
    let name = format!("tradeoff-{}.{extension}", table.system().name());
    workspace().join(TABLES).join(name)
}

/// What is measured now by the present code.
fn stamp(table: Measured, n_cases: usize) -> Stamp {
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    Stamp {
        results: table.results_version(),
        commit: commit(&workspace()),
        date: now.split('T').next().unwrap_or_default().to_owned(),
        n_cases,
    }
}

fn text(path: &Path) -> Result<String, CliError> {
    std::fs::read_to_string(path).map_err(|source| CliError::File {
        path: path.to_owned(),
        source,
    })
}

fn write_record(table: Measured, record: &Record) -> Result<(), CliError> {
    let path = place(table, "json");
    let text = serde_json::to_string_pretty(record)
        .map_err(|e| CliError::Input(format!("{}: {e}", path.display())))?;
    data::write(&path, format!("{text}\n").as_bytes())?;
    say!("recorded: {}", path.display());
    Ok(())
}

/// The page on all this.
const PAGE: &str = "tradeoff.md";

/// Writes what a trade-off measured into the table of its system, which has no factor then, and into the page; knots have no
/// table.
pub fn record_table(system: System, rows: &[TradeoffRow]) -> Result<(), CliError> {
    let Some(table) = Measured::ALL.into_iter().find(|t| t.system() == system) else {
        return Ok(());
    };
    let points = points(system, rows);
    let n_cases = points.iter().map(|p| p.n_cases).max().unwrap_or(0);
    // before the files change, which would be changes to the commit
    let record = Record {
        table: stamp(table, n_cases),
        factor: None,
    };
    let path = place(table, "csv");
    write_table(&path, &points)?;
    say!("recorded: {}", path.display());
    write_record(table, &record)?;
    let text = topo_view::tradeoff::section(Preset::Standard, system, rows);
    record_part(PAGE, &format!("{} settings", system.name()), &text)
}

/// Runs the settings of goals on the cases of a set: the factor from one, how it holds from the other.
pub fn measure_set(args: &TradeoffArgs, name: &str, folder: &Path) -> Result<(), CliError> {
    let stop = topo_cli::install();
    let set = if name == CaseSet::Factor.name() {
        CaseSet::Factor
    } else {
        CaseSet::Check
    };
    let mut checked: Vec<CheckRow> = Vec::new();
    for table in Measured::ALL {
        let system = table.system();
        if !args.systems.takes(system) {
            continue;
        }
        let kept = kept(folder, &format!("{}-{name}", system.name()));
        let runs = measure(system.name(), &args.systems, &kept, &stop, |work| {
            ladder(system, set, work)
        })?;
        write_table(&kept, &runs)?;
        topo_cli::check(&stop)?;
        let rows = compared(system, &runs);
        write_table(&folder.join(format!("{}-{name}.csv", system.name())), &rows)?;
        if set == CaseSet::Factor {
            find_factor(table, &rows, args.record)?;
        } else {
            checked.extend(check_table(table, &rows)?);
        }
    }
    if set == CaseSet::Check {
        write_check(&checked, folder, args.record)?;
    }
    Ok(())
}

fn read_record(table: Measured) -> Result<Record, CliError> {
    let json = place(table, "json");
    serde_json::from_str(&text(&json)?)
        .map_err(|e| CliError::Input(format!("{}: {e}", json.display())))
}

/// The factor between differences and estimates, reported and recorded if asked for.
fn find_factor(table: Measured, rows: &[TradeoffRow], is_recorded: bool) -> Result<(), CliError> {
    let system = table.system();
    let points: Vec<Point> = read_table(&place(table, "csv"))?;
    let mut record = read_record(table)?;
    let cover = factor_of_estimates(system, &points, rows)
        .ok_or_else(|| CliError::Input(format!("no case of {} ran", system.name())))?;
    say!(
        "{}: {:.3} times the raw estimate covers {:.1} % of the errors of {} cases",
        system.name(),
        cover.scale,
        100.0 * cover.share,
        cover.n_cases
    );
    if is_recorded {
        record.factor = Some(Factor {
            table: table_hash(&text(&place(table, "csv"))?),
            share: cover.share,
            scale: cover.scale,
            measured: stamp(table, cover.n_cases),
        });
        write_record(table, &record)?;
    }
    Ok(())
}

/// How promises and estimates of a table hold.
fn check_table(table: Measured, rows: &[TradeoffRow]) -> Result<Vec<CheckRow>, CliError> {
    let points: Vec<Point> = read_table(&place(table, "csv"))?;
    let factor = read_record(table)?.factor.ok_or_else(|| {
        CliError::Input(format!(
            "{} has no factor yet: run `cargo xtask tradeoff --set factor --record` first",
            place(table, "json").display()
        ))
    })?;
    Ok(check_estimates(table.system(), &points, factor.scale, rows))
}

/// The table and the report of a check, reported and recorded if asked for.
fn write_check(checked: &[CheckRow], folder: &Path, is_recorded: bool) -> Result<(), CliError> {
    write_table(&folder.join("check.csv"), checked)?;
    let report = topo_view::tradeoff::check_report(checked);
    data::write(&folder.join("check.md"), report.as_bytes())?;
    say!("{report}");
    if !is_recorded {
        return Ok(());
    }
    for table in Measured::ALL {
        let name = table.system().name();
        let of: Vec<CheckRow> = checked
            .iter()
            .filter(|r| r.system == name)
            .cloned()
            .collect();
        if !of.is_empty() {
            record_part(
                PAGE,
                &format!("{name} check"),
                &topo_view::tradeoff::check_report(&of),
            )?;
        }
    }
    Ok(())
}
