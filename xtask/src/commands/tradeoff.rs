//! `cargo xtask tradeoff`: speed against accuracy, as tables, figures and a report.

mod sets;

use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

use super::threads;
use crate::cli::{SystemsArgs, TradeoffArgs};
use crate::error::XtaskError;
use crate::progress::Progress;
use crate::{data, interrupt};
use topo_analysis::{read_table, write_table};
use topo_core::Interrupt;
use topo_lab::{
    Effort, LabError, System, TradeoffEvent, TradeoffRun, TradeoffWork, compared, tradeoff,
    with_jobs, writable,
};

/// Changes with whatever changes the numbers of a run.
const VERSION: u32 = 3;

/// Time between two writings of what is finished.
const KEEP: Duration = Duration::from_secs(10);

pub fn run(args: &TradeoffArgs) -> Result<(), XtaskError> {
    let work = &args.systems.work;
    threads(work.jobs)?;
    writable(&work.out)?;
    let folder = work.out.join("tradeoff");
    std::fs::create_dir_all(&folder).map_err(|source| XtaskError::File {
        path: folder.clone(),
        source,
    })?;
    match args.set.as_deref() {
        None => measure_all(args, &folder),
        Some(name) => sets::measure_set(args, name, &folder),
    }
}

fn measure_all(args: &TradeoffArgs, folder: &Path) -> Result<(), XtaskError> {
    let TradeoffArgs {
        systems: args,
        record,
        ..
    } = args;
    let effort = super::effort(args.quality)?;
    if *record && effort != Effort::Standard {
        return Err(XtaskError::Argument {
            key: "--record",
            value: args.quality.to_string(),
            remedy: "tables are measured with --quality standard".to_owned(),
        });
    }
    let stop = interrupt::install();
    let mut tables = Vec::new();
    for system in System::ALL {
        if !args.takes(system) {
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
        if *record {
            sets::record_table(system, &rows)?;
        }
        say!(
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
    say!("report: {}", path.display());
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
    run: impl Fn(&TradeoffWork<'_>) -> Result<Vec<TradeoffRun>, LabError> + Send + Sync,
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
