//! `topo extremes`: runs at the extremes, as tables, maps and a report.

use std::path::Path;
use std::time::Instant;

use super::settings::threads;
use crate::cli::SystemsArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use topo_analysis::{read_table, write_table};
use topo_lab::{StabilityRow, System, n_extremes, with_jobs};
use topo_view::{data, stability};

/// Changes with whatever changes the outcome of a run.
const VERSION: u32 = 3;

/// The rows of a table; none if it is not there.
fn rows_in(path: &Path) -> Result<Vec<StabilityRow>, CliError> {
    if path.exists() {
        Ok(read_table(path)?)
    } else {
        Ok(Vec::new())
    }
}

/// Writes the table and the picture of a system's map.
fn write_map(folder: &Path, system: &str, rows: &[StabilityRow]) -> Result<(), CliError> {
    let table = folder.join(format!("{system}.csv"));
    write_table(&table, rows)?;
    output::table(&table);
    let picture = stability::draw(rows)?;
    for (extension, bytes) in [("png", &picture.png[..]), ("svg", picture.svg.as_bytes())] {
        data::write(&folder.join(format!("{system}.{extension}")), bytes)?;
    }
    Ok(())
}

pub fn run(args: &SystemsArgs) -> Result<(), CliError> {
    let jobs = threads(args.work.jobs)?;
    let stop = interrupt::install();
    let folder = args.work.out.join("stability");
    output::out(&args.work.out);
    std::fs::create_dir_all(&folder).map_err(|source| CliError::File {
        path: folder.clone(),
        source,
    })?;
    let mut maps = Vec::new();
    for system in System::ALL {
        if !args.only.is_empty() && !args.only.iter().any(|name| name == system.name()) {
            continue;
        }
        let start = Instant::now();
        // Runs of another version or quality are not taken for these.
        let kept = format!("{}-{}-v{VERSION}.runs.csv", system.name(), args.quality);
        let kept = folder.join(kept.to_lowercase());
        let known = if args.work.fresh {
            Vec::new()
        } else {
            rows_in(&kept)?
        };
        let n_runs = n_extremes(system);
        let progress = Progress::start(system.name(), n_runs);
        let report = |row: &StabilityRow| {
            progress.done(&format!(
                "{} = {}, {} = {}",
                row.axis_x, row.x, row.axis_y, row.y
            ));
        };
        let rows = with_jobs(jobs, || {
            topo_lab::stability(system, args.quality, &known, &stop, &report)
        })?;
        write_table(&kept, &rows)?;
        if rows.len() < n_runs {
            return Err(CliError::Interrupted);
        }
        progress.finish();
        write_map(&folder, system.name(), &rows)?;
        let wall = format!("{:.0} s", start.elapsed().as_secs_f64());
        let summary = stability::summary(system.name(), &rows, &wall);
        output::one_more("summaries", &summary);
        say!("{summary}");
        maps.push((system.name(), rows));
    }
    let report = stability::report(args.quality, &maps);
    let path = folder.join("stability.md");
    data::write(&path, report.as_bytes())?;
    output::data("report", path.display().to_string());
    say!("report: {}", path.display());
    // Rows carry where runs must converge.
    let broken: usize = maps.iter().map(|(_, rows)| stability::n_broken(rows)).sum();
    if broken > 0 {
        return Err(CliError::Step(format!(
            "{broken} runs broke a rule; see the tables in {}",
            folder.display()
        )));
    }
    Ok(())
}
