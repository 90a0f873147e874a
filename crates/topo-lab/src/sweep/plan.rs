//! What of a scene is finished, what is computed now, in which order, and what that will take.

use super::experiment::Experiment;
use super::mark;
use super::row::Row;
use crate::LabError;
use crate::cost::{Estimate, Speed, estimate, threads};
use crate::folder::{Earlier, finished};
use crate::progress::SweepSettings;

/// Cases that hold more than this each run one after another, all threads in each.
const BIG_CASE: u64 = 1 << 30;

/// The cases of a scene and what becomes of them.
pub(super) struct Plan<E: Experiment> {
    pub cases: Vec<E::Case>,
    /// Their folders.
    pub names: Vec<String>,
    /// What tells their numbers apart.
    pub fingerprints: Vec<String>,
    /// What earlier runs left of them.
    pub found: Vec<Earlier<E::Row>>,
    /// Whether cases run side by side.
    pub is_side_by_side: bool,
    pub estimate: Estimate,
    /// Cases to be computed with the seconds each is expected to take.
    todo: Vec<(usize, f64)>,
}

impl<E: Experiment> Plan<E> {
    /// Looks at what is there; only names of an earlier program are changed.
    pub fn of(experiment: &E, settings: &SweepSettings) -> Result<Self, LabError> {
        let folder = settings.out.join(experiment.folder());
        let cases = experiment.cases()?;
        let mut known: Vec<(String, String)> = Vec::with_capacity(cases.len());
        for case in &cases {
            known.push((experiment.name(case), experiment.fingerprint(case)?));
        }
        let battery = experiment.battery();
        let version = battery.results();
        mark::check(&folder, &experiment.text(), &known, version)?;
        let mut found = Vec::with_capacity(cases.len());
        for (k, (name, fingerprint)) in known.iter().enumerate() {
            let place = folder.join(name);
            let is_usable =
                !(settings.fresh && settings.takes(k)) && experiment.has_all(&place, settings);
            found.push(if is_usable {
                finished(&place, fingerprint, version)
            } else {
                Earlier::None
            });
        }
        let (mut todo, mut costs, mut taken) = (Vec::new(), Vec::new(), Vec::new());
        for (k, case) in cases.iter().enumerate() {
            if let Earlier::Finished(outcome) = &found[k] {
                let cost = experiment.cost(case, Some(outcome.rows.len()))?;
                let seconds = outcome.rows.iter().map(Row::cpu_seconds).sum();
                taken.push((cost.seconds, seconds));
            } else if settings.takes(k) {
                let cost = experiment.cost(case, None)?;
                todo.push((k, cost.seconds));
                costs.push(cost);
            }
        }
        let largest = costs.iter().map(|c| c.bytes).max().unwrap_or(0);
        let is_side_by_side =
            !experiment.uses_all_threads() || (largest <= BIG_CASE && costs.len() > 1);
        // with all threads in a case, its own seconds are not those of all threads
        let finished: &[_] = if is_side_by_side { &taken } else { &[] };
        let speed = Speed::of(battery.probe(), finished);
        let estimate = estimate(&costs, speed, threads(settings.jobs), is_side_by_side);
        let (names, fingerprints) = known.into_iter().unzip();
        Ok(Self {
            cases,
            names,
            fingerprints,
            found,
            is_side_by_side,
            estimate,
            todo,
        })
    }

    /// Cases finished earlier.
    pub fn n_finished(&self) -> usize {
        self.found.iter().filter(|f| f.is_finished()).count()
    }

    /// Cases to be computed, in the order of the scene.
    pub fn todo(&self) -> impl Iterator<Item = usize> {
        self.todo.iter().map(|(k, _)| *k)
    }

    /// The same in the order of the work, with the seconds each is expected to take: side by side the longest go first, so that no thread waits for them at the end.
    pub fn order(&self) -> Vec<(usize, f64)> {
        let mut todo = self.todo.clone();
        if self.is_side_by_side {
            todo.sort_by(|a, b| b.1.total_cmp(&a.1));
        }
        todo
    }
}
