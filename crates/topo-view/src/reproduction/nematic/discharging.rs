//! What discharges say.

use super::runs::{Runs, charges, growth, over_both_sides};
use crate::plot::text;
use crate::reproduction::claim::{Said, Tables, Verdict};
use std::f64::consts::PI;
use topo_analysis::{NematicRow, median, nematic_resonance};

/// Distance from the particle's radius, over it, within which a ring that is about to vanish lies on the particle.
const ON_PARTICLE: f64 = 0.1;

/// By how much the flow speeds the slowest mode between the plates: the root of tan(φ)/φ = 1 + 1/β for the published material.
const FASTER_WITH_FLOW: f64 = 1.105_707;

pub fn vanishing(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let (mut n, mut n_gone, mut n_shrunk, mut n_both) = (0, 0, 0, 0);
    let (mut last, mut farthest) = (0.0_f64, 0.0_f64);
    for row in &runs.rows {
        let Ok(series) = runs.sweep.series(row) else {
            continue;
        };
        let radii: Vec<f64> = series.iter().filter_map(|p| p.ring_radius).collect();
        let Some(k) = series.iter().rposition(|p| p.ring_radius.is_some()) else {
            continue;
        };
        n += 1;
        let end = radii[radii.len() - 1];
        let off = (end / row.radius - 1.0).abs();
        let gone = series.get(k + 1).map(|p| p.time / row.radius.powi(2));
        let shrunk = end < radii[0] && off < ON_PARTICLE;
        n_gone += usize::from(gone.is_some());
        n_shrunk += usize::from(shrunk);
        n_both += usize::from(gone.is_some() && shrunk);
        last = last.max(gone.unwrap_or(0.0));
        farthest = farthest.max(off);
    }
    if n == 0 {
        return None;
    }
    runs.said(
        format!(
            "gone in {n_gone} of {n} discharges, the last at {} R²/ΓL; shrunk on to the particle in {n_shrunk}, last seen at most {} R off its radius",
            text::significant(last, 2),
            text::significant(farthest, 2)
        ),
        Verdict::of_all(n_both, n),
    )
}

pub fn reversal(t: &Tables) -> Said {
    let runs = Runs::flowing(t)?;
    let mut least: Vec<(u32, f64)> = Vec::new();
    for row in &runs.rows {
        let series = runs.sweep.series(row).unwrap_or_default();
        let found = series.iter().filter_map(|p| p.flow_correlation);
        least.extend(found.reduce(f64::min).map(|c| (row.q, c)));
    }
    if least.is_empty() {
        return runs.said(
            "the correlation of the flow was not recorded".to_owned(),
            Verdict::NotJudged,
        );
    }
    let sentence: Vec<String> = least
        .iter()
        .map(|(q, c)| format!("{} (q = {q})", text::number(*c, 2)))
        .collect();
    let n_turning = least.iter().filter(|l| l.1 < 0.0).count();
    runs.said(
        format!(
            "least correlation of the velocity with the first: {}; it turns in {n_turning} of {}",
            sentence.join(", "),
            least.len()
        ),
        Verdict::of_all(n_turning, least.len()),
    )
}

pub fn decades(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let inside = |group: Vec<&NematicRow>| {
        let times = group
            .iter()
            .filter_map(|r| Some(r.t999? / r.radius.powi(2)));
        let times: Vec<f64> = times.collect();
        (times.iter().filter(|t| **t <= 1.0).count(), times.len())
    };
    let ((a, n), (b, m)) = (inside(runs.below()), inside(runs.above()));
    runs.said(
        format!(
            "three orders of magnitude within R²/ΓL for {a} of {n} unbuckled states; beside them for {b} of {m} buckled ones"
        ),
        if n == 0 {
            Verdict::NotJudged
        } else {
            Verdict::of_all(a, n)
        },
    )
}

pub fn half(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let rates: Vec<(u32, f64)> = runs
        .rows
        .iter()
        .filter_map(|r| Some((r.q, r.radius.powi(2) / r.t50?)))
        .collect();
    let [(from, first), .., (to, last)] = rates[..] else {
        return runs.one_sided();
    };
    let values: Vec<f64> = rates.iter().map(|r| r.1).collect();
    let (grows, verdict) = growth(&values);
    runs.said(
        format!(
            "R²/(ΓL t50) from {} at q = {from} to {} at q = {to}; it grows in {grows} of {} steps",
            text::significant(first, 3),
            text::significant(last, 3),
            rates.len() - 1
        ),
        over_both_sides(&runs, verdict),
    )
}

pub fn resonance(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let (Some(q), true) = (runs.onset(), runs.has_both_sides()) else {
        return runs.one_sided();
    };
    let found = nematic_resonance(&runs.rows);
    let area = runs.rows[0].radius.powi(2);
    let ((a, ra), (b, rb)) = (found.peak_99?, found.peak_999?);
    let ends = [runs.rows[0].q, runs.rows[runs.rows.len() - 1].q];
    let close = |peak: u32| peak.abs_diff(q) <= 1;
    // where the range ends at the peak, faster charges may lie beyond
    let is_cut_off = [a, b].iter().any(|p| close(*p) && ends.contains(p));
    runs.said(
        format!(
            "critical charge {q}, {} run; 99 % rate largest at q = {a} ({} ΓL/R²), 99.9 % at q = {b} ({} ΓL/R²)",
            charges(&runs.rows.iter().map(|r| r.q).collect::<Vec<_>>()),
            text::number(ra * area, 1),
            text::number(rb * area, 1)
        ),
        if is_cut_off {
            Verdict::NotJudged
        } else {
            Verdict::both(close(a), close(b))
        },
    )
}

pub fn slow_mode(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let (Some(onset), true) = (runs.onset(), runs.has_both_sides()) else {
        return runs.one_sided();
    };
    let last = runs.rows.last()?;
    if last.q < onset + 2 {
        return runs.said(
            format!(
                "buckled from q = {onset} on and run to q = {} only: not far above",
                last.q
            ),
            Verdict::NotJudged,
        );
    }
    let (_, fastest) = nematic_resonance(&runs.rows).peak_999?;
    let drop = fastest * last.t999?;
    let ratio = median(
        runs.above()
            .iter()
            .filter_map(|r| Some(r.late_rate? / mode(r))),
    );
    let sentence = ratio.map_or(String::new(), |r| {
        let with_flow = if last.flow.is_on() {
            format!(", and {} times as fast with flow", text::number(FASTER_WITH_FLOW, 3))
        } else {
            String::new()
        };
        format!(
            "; the end of buckled discharges decays at {} times the rate of the slowest mode between the plates (2π²ΓL/L_z²{with_flow})",
            text::number(r, 2)
        )
    });
    runs.said(
        format!(
            "the 99.9 % rate at q = {} is {} times smaller than at its peak{sentence}",
            last.q,
            text::number(drop, 1)
        ),
        Verdict::both(drop > 2.0, ratio.is_some_and(|r| (r - 1.0).abs() < 0.15)),
    )
}

/// Rate at which the energy of the slowest mode of the director between the plates decays.
fn mode(row: &NematicRow) -> f64 {
    // plates are 30/7 of a radius apart, in an even number of cells
    let cells = 2.0 * (30.0 / 7.0 * row.radius / row.spacing / 2.0).round();
    let still = 2.0 * (PI / (cells * row.spacing)).powi(2);
    if row.flow.is_on() {
        FASTER_WITH_FLOW * still
    } else {
        still
    }
}
