//! Every experiment can be estimated, run and printed, whatever its battery.

use std::path::{Path, PathBuf};

use super::experiment::Experiment;
use super::failed::FailedCase;
use super::row::Row;
use super::{SweepReport, estimate, run};
use crate::LabError;
use crate::battery::{Checked, Stage, Sweep, Swept};
use crate::cost::Estimate;
use crate::goal::Choice;
use crate::progress::{Event, SweepSettings};

impl<E: Experiment> Sweep for E {
    fn label(&self) -> &'static str {
        self.battery().name()
    }

    fn results(&self, out: &Path) -> PathBuf {
        out.join(self.folder())
    }

    fn choose(&mut self, jobs: usize) -> Result<Option<Choice>, LabError> {
        self.choose_settings(jobs)
    }

    fn stages(&self, settings: &SweepSettings) -> Result<Vec<Stage>, LabError> {
        let cases = Stage::cases(estimate(self, settings)?);
        if cases.estimate.n_cases == 0 {
            return Ok(Vec::new());
        }
        let mut stages = self.stages_before(settings)?;
        stages.retain(|stage| stage.estimate.n_cases > 0);
        stages.push(cases);
        Ok(stages)
    }

    fn sweep(
        &self,
        settings: &SweepSettings,
        progress: &(dyn Fn(Event<'_>) + Sync),
    ) -> Result<Box<dyn Swept + '_>, LabError> {
        let report = run(self, settings, progress)?;
        Ok(Box::new(Finished {
            experiment: self,
            report,
        }))
    }
}

/// An experiment with what its sweep left behind.
struct Finished<'a, E: Experiment> {
    experiment: &'a E,
    report: SweepReport<E::Row>,
}

impl<E: Experiment> Swept for Finished<'_, E> {
    fn failed(&self) -> &[FailedCase] {
        &self.report.failed
    }

    fn n_computed(&self) -> usize {
        self.report.n_computed
    }

    fn n_reused(&self) -> usize {
        self.report.n_reused
    }

    fn is_interrupted(&self) -> bool {
        self.report.interrupted
    }

    fn estimate(&self) -> &Estimate {
        &self.report.estimate
    }

    fn wall_seconds(&self) -> f64 {
        self.report.wall_seconds
    }

    fn lines(&self) -> Vec<String> {
        let mut lines = vec![self.experiment.header()];
        for row in &self.report.rows {
            lines.push(self.experiment.line(row));
            let warnings = row.warnings().iter();
            lines.extend(warnings.map(|warning| format!("       warning: {warning}")));
        }
        lines.extend(self.experiment.findings(&self.report.rows));
        if !self.report.rows.is_empty() {
            lines.extend(self.experiment.legend().iter().map(ToString::to_string));
        }
        lines
    }

    fn warnings(&self) -> Vec<String> {
        let rows = self.report.rows.iter();
        rows.flat_map(|row| row.warnings().iter().map(ToString::to_string))
            .collect()
    }

    fn check(
        &self,
        choice: &Choice,
        settings: &SweepSettings,
        progress: &(dyn Fn(Event<'_>) + Sync),
    ) -> Result<Option<Checked>, LabError> {
        let rows = &self.report.rows;
        let Some(coarser) = self.experiment.coarser(choice, rows)? else {
            return Ok(None);
        };
        let report = run(&coarser, settings, progress)?;
        Ok(Some(Checked {
            errors: self.experiment.errors(choice, rows, &report.rows),
            failed: report.failed,
            folder: coarser.results(&settings.out),
            is_interrupted: report.interrupted,
        }))
    }
}
