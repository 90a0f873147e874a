//! What each term of a scene costs: the same run with it and without it, measured.
//!
//! Not to be mixed up with `cost`, which estimates whole sweeps before they run.

use serde::{Deserialize, Serialize};
use topo_core::Interrupt;

use crate::{LabError, Preset, with_jobs};
use topo_analysis::median;

mod nematic;
mod rod;
mod term;

use term::{Taken, Term};

/// One term of a scene, with or without: the median of several runs.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TermCost {
    /// `rod` or `nematic`.
    pub system: String,
    /// The term.
    pub term: String,
    /// Whether the scene has it: `yes` or `no`.
    pub with: String,
    /// What was run: its value, and what else the scene had.
    pub quantity: String,
    /// Runs, of which the median counts.
    pub n_runs: usize,
    /// Processor seconds of charge and discharge.
    pub cpu_seconds: f64,
    /// Over those without the term.
    pub ratio: f64,
    /// Trial steps of a rod, evaluations of a nematic's molecular field, charge and discharge together.
    pub calls: u64,
    /// Microseconds a call.
    pub microseconds_per_call: f64,
    /// Over those without the term: what the term costs where it changes the course of the run as well.
    pub ratio_per_call: f64,
    /// Largest number of bytes that the accounts of the run hold.
    pub peak_bytes: u64,
    /// Of which the term's own.
    pub term_bytes: u64,
    /// Calls of the term itself.
    pub term_calls: u64,
}

/// Runs of each scene.
const N_RUNS: usize = 5;

/// Measures every term, on one thread; `report` hears of each as it is done.
///
/// The runs with and without a term alternate, so that a machine that grows slower does not decide. An interrupt ends the measurement
/// after the present run; what is whole by then is returned.
///
/// # Errors
/// A run that its crate refuses.
///
/// # Validation
/// `law_absent_terms_of_a_rod_cost_nothing`, `law_absent_terms_of_a_nematic_cost_nothing`, `terms_are_measured_with_and_without`
pub fn term_costs(
    preset: Preset,
    interrupt: &Interrupt,
    report: &(dyn Fn(&TermCost) + Sync),
) -> Result<Vec<TermCost>, LabError> {
    let mut terms = rod::terms(preset);
    terms.extend(nematic::terms(preset));
    let measure = || -> Result<Vec<TermCost>, LabError> {
        let mut rows = Vec::new();
        for term in &terms {
            if let Some(pair) = term.measure(interrupt)? {
                pair.iter().for_each(report);
                rows.extend(pair);
            }
        }
        Ok(rows)
    };
    with_jobs(1, measure)?
}

impl Term {
    /// The rows without and with the term; none when interrupted.
    fn measure(&self, interrupt: &Interrupt) -> Result<Option<[TermCost; 2]>, LabError> {
        let mut taken = [Vec::new(), Vec::new()];
        for _ in 0..N_RUNS {
            for (with, taken) in [false, true].into_iter().zip(&mut taken) {
                let run = (self.run)(with, interrupt)?;
                if interrupt.is_requested() {
                    return Ok(None);
                }
                taken.push(run);
            }
        }
        let mut rows = [false, true].map(|with| self.row(with, &taken[usize::from(with)]));
        let (seconds, each) = (rows[0].cpu_seconds, rows[0].microseconds_per_call);
        for row in &mut rows {
            row.ratio = row.cpu_seconds / seconds;
            row.ratio_per_call = row.microseconds_per_call / each;
        }
        Ok(Some(rows))
    }

    fn row(&self, with: bool, taken: &[Taken]) -> TermCost {
        let seconds = taken.iter().map(|t| t.cpu_seconds);
        let cpu_seconds = median(seconds).unwrap_or(0.0);
        // All but the time is the same in each run.
        let one = taken.first().copied().unwrap_or_default();
        TermCost {
            system: self.system.to_owned(),
            term: self.name.to_owned(),
            with: if with { "yes" } else { "no" }.to_owned(),
            quantity: self.quantity.clone(),
            n_runs: taken.len(),
            cpu_seconds,
            calls: one.calls,
            microseconds_per_call: 1e6 * cpu_seconds / one.calls.max(1) as f64,
            peak_bytes: one.peak_bytes,
            term_bytes: one.term_bytes,
            term_calls: one.term_calls,
            ..TermCost::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    #[test]
    fn terms_are_measured_with_and_without() {
        let calls = AtomicU64::new(0);
        let calls = std::sync::Arc::new(calls);
        let seen = calls.clone();
        let term = Term {
            system: "rod",
            name: "friction",
            quantity: "eta_f/eta = 0.1".to_owned(),
            run: Box::new(move |with, _| {
                let n = seen.fetch_add(1, Ordering::Relaxed);
                // The second pair of runs is slow: the median does not mind.
                let disturbed = if n / 2 == 1 { 100.0 } else { 0.0 };
                Ok(Taken {
                    cpu_seconds: disturbed + if with { 3.0 } else { 1.0 },
                    calls: if with { 200 } else { 100 },
                    term_bytes: if with { 80 } else { 0 },
                    ..Taken::default()
                })
            }),
        };
        let interrupt = Interrupt::new();
        let [without, with] = term.measure(&interrupt).unwrap().unwrap();
        assert_eq!(calls.load(Ordering::Relaxed), 2 * N_RUNS as u64);
        assert_eq!((without.with.as_str(), with.with.as_str()), ("no", "yes"));
        assert_eq!((without.ratio, with.ratio), (1.0, 3.0));
        assert_eq!((with.ratio_per_call, with.term_bytes), (1.5, 80));
        interrupt.request();
        assert!(term.measure(&interrupt).unwrap().is_none());
    }

    #[test]
    fn every_term_of_the_two_systems_is_measured() {
        let mut terms = rod::terms(Preset::Draft);
        terms.extend(nematic::terms(Preset::Draft));
        let names: Vec<&str> = terms.iter().map(|t| t.name).collect();
        let expected = [
            "contact",
            "friction",
            "twist",
            "stretch",
            "flow",
            "second elastic constant",
            "external field",
            "second precision",
        ];
        assert_eq!(names, expected);
    }
}
