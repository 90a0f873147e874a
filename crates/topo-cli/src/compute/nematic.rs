//! Nematic sweeps: run with progress, told as a table.

use super::report::{Failures, Reporter, tell_taken};
use super::{by_wish, estimate};
use crate::error::CliError;
use topo_analysis::Flow;
use topo_analysis::nematic_resonance;
use topo_lab::{NematicReport, NematicScene, SweepSettings, errors_of_colloids, run_nematic_sweep};

/// Runs a user's scene and prints its table.
pub fn scene(scene: &NematicScene, settings: &SweepSettings) -> Result<(), CliError> {
    let (scene, grant) = scene.granted(settings.jobs)?;
    let scene = &scene;
    if let Some(grant) = &grant {
        by_wish::tell_grant(grant, "ξ_N a cell");
    }
    estimate::tell(&estimate::of_nematic(scene, settings)?);
    let folder = scene.results(&settings.out);
    let report = sweep(scene, settings)?;
    let mut failures = Failures::default();
    failures.add(&report.failed, &folder);
    say!(
        "  q flow  F charged  F after  order  ring/R mode     t50     t90     t99   t99.9  CPU s   MB"
    );
    for r in &report.rows {
        let time = |t: Option<f64>| t.map_or_else(|| format!("{:>7}", "-"), |t| format!("{t:7.2}"));
        say!(
            "{:3} {:>4} {:10.2} {:8.2} {:6.4} {:7} {:>4} {} {} {} {} {:6.1} {:4.0}",
            r.q,
            r.flow,
            r.f_charged,
            r.f_after_switch,
            r.order_parameter,
            r.ring_radius
                .map_or_else(|| "-".to_owned(), |a| format!("{:7.3}", a / r.radius)),
            r.ring_mode
                .map_or_else(|| "-".to_owned(), |m| m.to_string()),
            time(r.t50),
            time(r.t90),
            time(r.t99),
            time(r.t999),
            r.cpu_seconds,
            r.peak_bytes as f64 / 1e6
        );
        for warning in &r.warnings {
            say!("       warning: {warning}");
        }
    }
    for flow in [Flow::Off, Flow::On] {
        let rows: Vec<_> = report
            .rows
            .iter()
            .filter(|r| r.flow == flow)
            .cloned()
            .collect();
        if rows.len() > 2 {
            let found = nematic_resonance(&rows);
            say!(
                "flow {flow}: q_c = {}, 50 % rate {}, 99.9 % rate largest at q = {}",
                found.q_c.map_or("none".to_owned(), |q| q.to_string()),
                if found.half_rate_is_monotonic {
                    "monotonic"
                } else {
                    "not monotonic"
                },
                found
                    .peak_999
                    .map_or("none".to_owned(), |(q, _)| q.to_string())
            );
        }
    }
    tell_taken(&report.estimate, report.wall_seconds);
    if let Some(grant) = &grant {
        let check = scene.check_of(grant);
        let coarser = sweep(&check, settings)?;
        failures.add(&coarser.failed, &check.results(&settings.out));
        let rows = errors_of_colloids(grant, &report.rows, &coarser.rows);
        by_wish::tell_errors(grant, &rows, &folder)?;
    }
    say!("written to {}", folder.display());
    failures.into_result()
}

/// Runs a sweep with progress.
pub fn sweep(scene: &NematicScene, settings: &SweepSettings) -> Result<NematicReport, CliError> {
    let reporter = Reporter::new("nematic");
    let report = run_nematic_sweep(scene, settings, &|event| reporter.report(event))?;
    reporter.finish(report.interrupted)?;
    Ok(report)
}
