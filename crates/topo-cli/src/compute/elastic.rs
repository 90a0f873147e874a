//! Elastic sweeps: run with progress, printed as a table.

use super::report::{Failures, Reporter, tell_taken};
use super::{by_wish, estimate};
use crate::error::CliError;
use topo_knots::KnotTable;
use topo_lab::{Cuts, ElasticReport, ElasticScene, SweepSettings, errors_of_rods, run_sweep};

/// Runs a user's scene and prints its table.
pub fn scene(
    mut scene: ElasticScene,
    cuts: Option<&str>,
    settings: &SweepSettings,
) -> Result<(), CliError> {
    if let Some(text) = cuts {
        let chosen = Cuts::try_from(text.to_owned()).and_then(|cuts| scene.with_cuts(cuts));
        scene = chosen.map_err(|remedy| CliError::Argument {
            key: "--cuts",
            value: text.to_owned(),
            remedy,
        })?;
    }
    let table = &scene.knot_table()?;
    let (scene, grant) = scene.granted(table, settings.jobs)?;
    if let Some(grant) = &grant {
        by_wish::tell_grant(grant, "edges");
    }
    estimate::tell(&estimate::of_elastic(&scene, table, settings)?);
    let folder = scene.results(&settings.out);
    let report = sweep(&scene, table, settings)?;
    let mut failures = Failures::default();
    failures.add(&report.failed, &folder);
    say!("knot    theta'h     cut    E/E0      Wr     t50     t90     t95     t99  untied");
    let cell = |t: Option<f64>| t.map_or_else(|| format!("{:>7}", "-"), |t| format!("{t:7.3}"));
    for r in &report.rows {
        say!(
            "{:6} {:+8.3} {:7.4} {:7.4} {:+7.3} {} {} {} {} {}",
            r.knot,
            r.twist,
            r.cut,
            r.energy,
            r.writhe,
            cell(r.t50),
            cell(r.t90),
            cell(r.t95),
            cell(r.t99),
            cell(r.t_untie)
        );
        for warning in &r.warnings {
            say!("       warning: {warning}");
        }
    }
    tell_taken(&report.estimate, report.wall_seconds);
    if let Some(grant) = &grant {
        let check = scene.check_of(table, grant, &report.rows)?;
        let coarser = sweep(&check, table, settings)?;
        let rows = errors_of_rods(grant, &report.rows, &coarser.rows);
        by_wish::tell_errors(grant, &rows, &folder)?;
        failures.add(&coarser.failed, &check.results(&settings.out));
    }
    say!("written to {}", folder.display());
    failures.into_result()
}

/// Runs a sweep with progress.
pub fn sweep(
    scene: &ElasticScene,
    table: &KnotTable,
    settings: &SweepSettings,
) -> Result<ElasticReport, CliError> {
    let reporter = Reporter::new("elastic");
    let report = run_sweep(scene, table, settings, &|event| reporter.report(event))?;
    reporter.finish(report.interrupted)?;
    Ok(report)
}
