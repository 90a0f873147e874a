//! `topo tradeoff`: speed against accuracy, as tables, figures and a report.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use super::settings::threads;
use crate::cli::SystemsArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use topo_analysis::{read_table, write_table};
use topo_core::Interrupt;
use topo_lab::{
    LabError, System, TradeoffEvent, TradeoffRow, TradeoffRun, TradeoffWork, compared, tradeoff,
    with_jobs, writable,
};
use topo_view::data;

/// Changes with whatever changes the numbers of a run.
const VERSION: u32 = 3;

/// Time between two writings of what is finished.
const KEEP: Duration = Duration::from_secs(10);

/// Makes the folder of the measurements.
///
/// # Errors
/// A folder that cannot be written.
pub fn prepare(args: &SystemsArgs) -> Result<PathBuf, CliError> {
    threads(args.work.jobs)?;
    writable(&args.work.out)?;
    output::out(&args.work.out);
    let folder = args.work.out.join("tradeoff");
    std::fs::create_dir_all(&folder).map_err(|source| CliError::File {
        path: folder.clone(),
        source,
    })?;
    Ok(folder)
}

/// Hears of the rows of a system as they are there.
pub type Hears<'a> = dyn FnMut(System, &[TradeoffRow]) -> Result<(), CliError> + 'a;

/// Runs it; `measured` hears of the rows of each system.
///
/// # Errors
/// A run that is refused, a folder that cannot be written, a stop, or what `measured` says.
pub fn run(args: &SystemsArgs, measured: &mut Hears<'_>) -> Result<(), CliError> {
    let folder = &prepare(args)?;
    let stop = interrupt::install();
    let mut tables = Vec::new();
    for system in System::ALL {
        if !args.takes(system) {
            continue;
        }
        let start = Instant::now();
        let kept = kept(folder, &format!("{}-{}", system.name(), args.quality));
        let runs = measure(system.name(), args, &kept, &stop, |work| {
            tradeoff(system, args.quality, work)
        })?;
        write_table(&kept, &runs)?;
        interrupt::check(&stop)?;
        let rows = compared(system, &runs);
        let table = folder.join(format!("{}.csv", system.name()));
        write_table(&table, &rows)?;
        output::table(&table);
        let picture = topo_view::tradeoff::draw(system, &rows)?;
        for (extension, bytes) in [("png", &picture.png[..]), ("svg", picture.svg.as_bytes())] {
            let path = folder.join(format!("{}.{extension}", system.name()));
            data::write(&path, bytes)?;
        }
        measured(system, &rows)?;
        say!(
            "{}: {} rows in {:.0} s",
            system.name(),
            rows.len(),
            start.elapsed().as_secs_f64()
        );
        tables.push((system, rows));
    }
    let report = topo_view::tradeoff::report(args.quality, &tables);
    let path = folder.join("tradeoff.md");
    data::write(&path, report.as_bytes())?;
    output::data("report", path.display().to_string());
    say!("report: {}", path.display());
    Ok(())
}

/// Where finished runs are kept; those of another version or quality are not taken for these.
pub fn kept(folder: &Path, stem: &str) -> PathBuf {
    folder.join(format!("{stem}-v{VERSION}.runs.csv").to_lowercase())
}

/// Runs what is not known, writing what is finished every now and then.
///
/// # Errors
/// A run that is refused.
pub fn measure(
    label: &'static str,
    args: &SystemsArgs,
    kept: &Path,
    stop: &Interrupt,
    run: impl Fn(&TradeoffWork<'_>) -> Result<Vec<TradeoffRun>, LabError> + Send + Sync,
) -> Result<Vec<TradeoffRun>, CliError> {
    let known: Vec<TradeoffRun> = if kept.exists() && !args.work.fresh {
        read_table(kept)?
    } else {
        Vec::new()
    };
    let progress: OnceLock<Progress> = OnceLock::new();
    let finished = Mutex::new((Instant::now(), Vec::<TradeoffRun>::new()));
    let report = |event: TradeoffEvent<'_>| match event {
        TradeoffEvent::Begin(n) => {
            progress.get_or_init(|| Progress::start(label, n));
        }
        TradeoffEvent::Done { name, runs } => {
            if let Some(progress) = progress.get() {
                progress.done(name);
            }
            if let Ok(mut finished) = finished.lock() {
                finished.1.extend(runs.iter().cloned());
                if finished.0.elapsed() > KEEP {
                    finished.0 = Instant::now();
                    // all is written again at the end, where an error counts
                    if let Err(error) = write_table(kept, &finished.1) {
                        tracing::warn!(%error, "finished runs are not kept");
                    }
                }
            }
        }
    };
    let work = TradeoffWork {
        out: &args.work.out,
        known: &known,
        interrupt: stop,
        peak_bytes: &|run| allocation_counter::measure(run).bytes_max,
        report: &report,
    };
    let runs = with_jobs(args.work.jobs.unwrap_or(0), || run(&work))??;
    if let Some(progress) = progress.into_inner() {
        progress.finish();
    }
    Ok(runs)
}
