//! `cargo xtask tradeoff`: speed against accuracy, as tables, figures and a report.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use super::threads;
use crate::cli::{SystemsArgs, TradeoffArgs};
use crate::error::XtaskError;
use crate::progress::Progress;
use crate::provenance::workspace;
use crate::{data, interrupt};
use topo_analysis::{
    AnalysisError, System, TradeoffEvent, TradeoffRun, TradeoffWork, compared, held_back, points,
    read_table, tradeoff, with_jobs, writable, write_table,
};
use topo_core::Interrupt;

/// Changes with whatever changes the numbers of a run.
const VERSION: u32 = 2;

/// Time between two writings of what is finished.
const KEEP: Duration = Duration::from_secs(10);

/// The tables that scenes by wish take their settings from, below the workspace.
const TABLES: &str = "crates/topo-analysis/data";

pub fn run(args: &TradeoffArgs) -> Result<(), XtaskError> {
    let work = &args.systems.work;
    threads(work.jobs)?;
    writable(&work.out)?;
    let folder = work.out.join("tradeoff");
    std::fs::create_dir_all(&folder).map_err(|source| XtaskError::File {
        path: folder.clone(),
        source,
    })?;
    if args.held_back {
        check_estimates(&args.systems, &folder)
    } else {
        measure_all(args, &folder)
    }
}

fn measure_all(args: &TradeoffArgs, folder: &Path) -> Result<(), XtaskError> {
    let TradeoffArgs {
        systems: args,
        record,
        ..
    } = args;
    let effort = super::effort(args.quality)?;
    let stop = interrupt::install();
    let mut tables = Vec::new();
    for system in System::ALL {
        if !args.only.is_empty() && !args.only.iter().any(|name| name == system.name()) {
            continue;
        }
        let start = Instant::now();
        let kept = kept(folder, &format!("{}-{}", system.name(), args.quality));
        let runs = measure(system.name(), args, &kept, &stop, |work| {
            tradeoff(system, effort, work)
        })?;
        write_table(&kept, &runs)?;
        interrupt::check(&stop)?;
        let rows = compared(system, &runs);
        write_table(&folder.join(format!("{}.csv", system.name())), &rows)?;
        let picture = crate::tradeoff::draw(system, &rows)?;
        for (extension, bytes) in [("png", &picture.png[..]), ("svg", picture.svg.as_bytes())] {
            let path = folder.join(format!("{}.{extension}", system.name()));
            data::write(&path, bytes)?;
        }
        let points = points(system, &rows);
        if *record && !points.is_empty() {
            let path = workspace()
                .join(TABLES)
                .join(format!("tradeoff-{}.csv", system.name()));
            write_table(&path, &points)?;
            println!("recorded: {}", path.display());
        }
        println!(
            "{}: {} rows in {:.0} s",
            system.name(),
            rows.len(),
            start.elapsed().as_secs_f64()
        );
        tables.push((system, rows));
    }
    let report = crate::tradeoff::report(args.quality, &tables);
    let path = folder.join("tradeoff.md");
    data::write(&path, report.as_bytes())?;
    println!("report: {}", path.display());
    Ok(())
}

/// Runs by wish on cases held back from the table: how often and how well their estimates cover the error.
fn check_estimates(args: &SystemsArgs, folder: &Path) -> Result<(), XtaskError> {
    let stop = interrupt::install();
    let kept = kept(folder, "held-back");
    let rows = Mutex::new(Vec::new());
    let runs = measure("held back", args, &kept, &stop, |work| {
        let (runs, found) = held_back(work)?;
        if let Ok(mut rows) = rows.lock() {
            *rows = found;
        }
        Ok(runs)
    })?;
    write_table(&kept, &runs)?;
    interrupt::check(&stop)?;
    let rows = rows.into_inner().unwrap_or_default();
    write_table(&folder.join("held-back.csv"), &rows)?;
    let report = crate::tradeoff::held_back_report(&rows);
    data::write(&folder.join("held-back.md"), report.as_bytes())?;
    println!("{report}");
    Ok(())
}

/// Where finished runs are kept; those of another version or quality are not taken for these.
fn kept(folder: &Path, stem: &str) -> PathBuf {
    folder.join(format!("{stem}-v{VERSION}.runs.csv").to_lowercase())
}

/// Runs what is not known, writing what is finished every now and then.
fn measure(
    label: &'static str,
    args: &SystemsArgs,
    kept: &Path,
    stop: &Interrupt,
    run: impl Fn(&TradeoffWork<'_>) -> Result<Vec<TradeoffRun>, AnalysisError> + Send + Sync,
) -> Result<Vec<TradeoffRun>, XtaskError> {
    let known: Vec<TradeoffRun> = if kept.exists() && !args.work.fresh {
        read_table(kept)?
    } else {
        Vec::new()
    };
    let progress: OnceLock<Progress> = OnceLock::new();
    let finished = Mutex::new((Instant::now(), Vec::<TradeoffRun>::new()));
    let told = |event: TradeoffEvent<'_>| match event {
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
        told: &told,
    };
    let runs = with_jobs(args.work.jobs.unwrap_or(0), || run(&work))??;
    if let Some(progress) = progress.into_inner() {
        progress.finish();
    }
    Ok(runs)
}
