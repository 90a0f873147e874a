//! The rate at which the last of the energy goes.

use super::rows::{of, warnings};
use crate::data::{Sweep, series};
use crate::plot::text;
use crate::reproduction::claim::{Said, Tables, Verdict, flagged};
use std::f64::consts::PI;
use std::path::Path;
use topo_analysis::median;

/// Warnings of the discharges that were followed to the last mode, or else of the sweep.
pub fn flags_of_last(t: &Tables) -> Option<String> {
    let sweep = t.last.as_ref().map(|l| &l.sweep).or(of(t))?;
    flagged(warnings(sweep))
}

/// Rate −d ln E/dt at the end of a discharge: over the samples in which the energy fell by the last third.
fn last_rate(times: &[(f64, f64)]) -> Option<f64> {
    let (t1, e1) = *times.last()?;
    let (t0, e0) = *times.iter().rev().find(|p| p.1 > 1.3 * e1)?;
    let rate = (e0 / e1).ln() / (t1 - t0);
    (rate.is_finite() && rate > 0.0).then_some(rate)
}

/// What the discharges followed to 99.999 % say; where they were not run, those of the sweep.
pub fn to_the_last_mode(t: &Tables) -> Said {
    match &t.last {
        Some(last) => rates(&last.sweep, &last.folder),
        None => {
            let (sentence, verdict) = rates(of(t)?, &t.results.join("elastic"))?;
            Some((format!("followed to 99.9 % only: {sentence}"), verdict))
        }
    }
}

/// What the discharges of the sweep say, where those followed further are there too.
pub fn of_the_sweep(t: &Tables) -> Said {
    t.last.as_ref()?;
    rates(of(t)?, &t.results.join("elastic"))
}

fn rates(s: &Sweep, folder: &Path) -> Said {
    let mut rates = Vec::new();
    let mut n = 0;
    for case in &s.cases {
        let Ok(moments) = series(&folder.join(case.folder()).join("series.csv")) else {
            continue;
        };
        let cut = case.first().cut;
        let here = moments.iter().filter(|m| (m.cut - cut).abs() < 1e-12);
        let points: Vec<(f64, f64)> = here.map(|m| (m.time, m.energy)).collect();
        n += 1;
        rates.extend(last_rate(&points));
    }
    // the slowest bending time T_b = 2 L² η/(π² h² E_b) in T_0 = 2 L η/(h E_b), at L = 50 h
    let slowest = PI.powi(2) / 50.0;
    let near = |r: &&f64| (**r / slowest - 1.0).abs() < 0.1;
    let same = rates.iter().filter(near).count();
    let middle = median(rates.iter().copied())?;
    Some((
        format!(
            "−d ln E/dt at the end: median {} /T₀; {same} of {n} discharges end within 10 % of 1/T_b = π²h/L = {} /T₀",
            text::number(middle, 5),
            text::number(slowest, 5)
        ),
        Verdict::both(2 * same >= n, 10 * same >= 9 * n),
    ))
}
