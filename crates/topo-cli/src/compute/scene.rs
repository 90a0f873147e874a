//! A user's own scene, whatever its battery: settings, estimate, run, table, errors.

use std::path::Path;

use super::report::{Failures, Reporter, print_taken};
use super::{by_goal, estimate};
use crate::batteries::Batteries;
use crate::error::CliError;
use crate::output;
use crate::progress::waiting;
use topo_lab::{LabError, Options, Sweep, SweepSettings, Swept, read_scene};

/// Runs a user's scene and prints its table; `options` stand above what the file says.
pub fn scene(
    batteries: &Batteries<'_>,
    file: &Path,
    options: &Options<'_>,
    settings: &SweepSettings,
) -> Result<(), CliError> {
    let placed = |e: LabError| e.in_file(file);
    let mut scene = read_scene(batteries, file)?;
    scene.change(options)?;
    let mut experiment = scene.experiment()?;
    let choice = experiment.choose(settings.jobs).map_err(placed)?;
    if let Some(choice) = &choice {
        by_goal::report_choice(choice);
    }
    let stages = waiting("estimating the work", || experiment.stages(settings));
    estimate::print(&stages.map_err(placed)?);
    let folder = experiment.results(&settings.out);
    let swept = sweep(&*experiment, settings)?;
    let mut failures = Failures::default();
    failures.add(swept.failed(), &folder);
    output::out(&folder);
    output::table(&folder.join("sweep.csv"));
    swept
        .warnings()
        .iter()
        .for_each(|w| output::warning(w.as_str()));
    for line in swept.lines() {
        say!("{line}");
    }
    print_taken(swept.estimate(), swept.wall_seconds());
    if let Some(choice) = &choice {
        let reporter = Reporter::new(experiment.label());
        let checked = swept.check(choice, settings, &|event| reporter.report(event))?;
        reporter.finish(checked.as_ref().is_some_and(|c| c.is_interrupted))?;
        if let Some(checked) = checked {
            let path = checked.write(&folder)?;
            by_goal::report_errors(choice, &checked.errors, &path);
            failures.add(&checked.failed, &checked.folder);
        }
    }
    say!("written to {}", folder.display());
    failures.into_result()
}

/// Runs a sweep with progress.
pub fn sweep<'a>(
    experiment: &'a dyn Sweep,
    settings: &SweepSettings,
) -> Result<Box<dyn Swept + 'a>, CliError> {
    let reporter = Reporter::new(experiment.label());
    let swept = experiment.sweep(settings, &|event| reporter.report(event))?;
    reporter.finish(swept.is_interrupted())?;
    Ok(swept)
}
