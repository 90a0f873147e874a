//! `topo accuracy`: the error of discharge times, against finer runs of the same cuts or the exact discharge.

use super::settings::settings;
use crate::cli::AccuracyArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use topo_analysis::{quantile, write_table};
use topo_knots::KnotTable;
use topo_lab::{
    ACCURACY_CASES, AccuracyRow, ElasticScene, Event, Preset, SweepSettings, measure_accuracy,
    tight_shapes, with_jobs,
};

/// Runs it.
pub(super) fn run(args: &AccuracyArgs) -> Result<(), CliError> {
    accuracy(args.quality, &settings(&args.work)?)
}

/// Compares the discharge times of a preset with much finer runs of the same cuts, prints and writes the table.
fn accuracy(preset: Preset, settings: &SweepSettings) -> Result<(), CliError> {
    let scene = ElasticScene::published(preset);
    let table = KnotTable::builtin();
    topo_lab::writable(&settings.out)?;
    let mut names: Vec<String> = Vec::new();
    for (knot, _) in ACCURACY_CASES {
        if names.iter().all(|name| name != knot) {
            names.push(knot.to_owned());
        }
    }
    let stop = &settings.interrupt;
    let progress = Progress::start("accuracy", names.len() + ACCURACY_CASES.len());
    let report = |event: Event<'_>| match event {
        Event::Knot { name, .. } | Event::Case { name, .. } => progress.done(name),
        _ => {}
    };
    let rows = with_jobs(settings.jobs, || {
        let shapes = tight_shapes(&names, &table, &scene.tighten, &settings.out, stop, &report)?;
        measure_accuracy(&scene, &ACCURACY_CASES, &table, &shapes, stop, &report)
    })??;
    progress.finish();
    interrupt::check(stop)?;
    let path = settings.out.join("accuracy.csv");
    write_table(&path, &rows)?;
    output::out(&settings.out);
    output::table(&path);
    output::data("cases", &rows);
    show(&rows);
    say!("written to {}", path.display());
    Ok(())
}

/// Prints the rows, and how large their errors are.
fn show(rows: &[AccuracyRow]) {
    say!(
        "knot    theta'h     cut     t50   error      t99   error  E/E_ref   CPU s  CPU s of reference"
    );
    for r in rows {
        let cell = |t: Option<f64>| t.map_or_else(|| "      -".to_owned(), |t| format!("{t:7.3}"));
        let error =
            |e: Option<f64>| e.map_or_else(|| "      -".to_owned(), |e| format!("{e:+6.2}%"));
        say!(
            "{:6} {:+8.2} {:7.4} {} {}  {} {} {:8.4} {:7.2} {:7.2}",
            r.knot,
            r.twist,
            r.cut,
            cell(r.t50),
            error(r.t50_error_percent),
            cell(r.t99),
            error(r.t99_error_percent),
            r.energy_ratio,
            r.cpu_seconds,
            r.cpu_seconds_reference
        );
    }
    let of = |error: fn(&AccuracyRow) -> Option<f64>| -> Vec<f64> {
        rows.iter().filter_map(error).collect()
    };
    for (name, errors) in [
        ("t50", of(|r| r.t50_error_percent)),
        ("t99", of(|r| r.t99_error_percent)),
    ] {
        let sizes = || errors.iter().map(|e| e.abs());
        if let (Some(median), Some(most)) = (quantile(sizes(), 0.5), quantile(sizes(), 0.9)) {
            say!(
                "{name}: error of {} cases, median {median:.2} %, 90th percentile {most:.2} %",
                errors.len()
            );
        }
    }
}
