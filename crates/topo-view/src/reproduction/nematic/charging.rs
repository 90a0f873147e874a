//! What charged states say.

use super::runs::{Runs, growth, over_both_sides};
use crate::data::NematicSweep;
use crate::plot::text;
use crate::reproduction::claim::{Said, Tables, Verdict};
use topo_analysis::NematicRow;

/// Height over the radius below which a ring is flat: a fraction of any spacing.
const FLAT: f64 = 0.01;

/// Radius of the published particle, in ξ_N, and the charge at which its ring buckles.
const PUBLISHED: (f64, u32) = (52.5, 7);

/// Farthest that the charged ring of a case lies from the equator, over the radius.
fn height(sweep: &NematicSweep, row: &NematicRow) -> Option<f64> {
    let rings = sweep.rings(row).unwrap_or_default();
    let charged = rings.iter().filter(|l| l.time.is_none());
    let heights = charged.flat_map(|l| l.points.iter().map(|p| p.z.abs()));
    // tables without the points have the amplitude of the strongest mode
    let most = heights.reduce(f64::max).or(row.ring_amplitude)?;
    Some(most / row.radius)
}

pub fn flat(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    if !runs.has_both_sides() {
        return runs.one_sided();
    }
    let below = runs.below();
    let heights: Vec<f64> = below.iter().filter_map(|r| height(runs.sweep, r)).collect();
    let most = heights.iter().copied().reduce(f64::max)?;
    let n_flat = heights.iter().filter(|h| **h < FLAT).count();
    runs.said(
        format!(
            "largest distance from the equator of {} rings below the buckling at q = {}: {} R",
            heights.len(),
            runs.onset()?,
            text::number(most, 4)
        ),
        Verdict::of_all(n_flat, heights.len()),
    )
}

pub fn profiles(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let mut ranges = Vec::new();
    for row in runs.rows.iter().filter(|r| r.q > 1) {
        let Ok(rings) = runs.sweep.rings(row) else {
            continue;
        };
        let charged = rings.iter().filter(|l| l.time.is_none());
        let angles: Vec<f64> = charged
            .flat_map(|l| l.angles.iter().flatten().copied())
            .collect();
        let low = angles.iter().copied().reduce(f64::min);
        let high = angles.iter().copied().reduce(f64::max);
        let twisted = angles.iter().any(|a| (45.0..=135.0).contains(a));
        ranges.extend(low.zip(high).map(|(low, high)| (row.q, low, high, twisted)));
    }
    let all_kinds = |r: &&(u32, f64, f64, bool)| r.1 < 45.0 && r.2 > 135.0 && r.3;
    let n = ranges.iter().filter(all_kinds).count();
    let (q, low, high, _) = *ranges
        .iter()
        .max_by(|a, b| (a.2 - a.1).total_cmp(&(b.2 - b.1)))?;
    runs.said(
        format!(
            "the angle between the axis of rotation and the ring (0: +1/2, 90: twisted, 180: −1/2) runs from {} to {} degrees at q = {q}, where its range is widest; all three profiles are met on {n} of {} rings",
            text::number(low, 0),
            text::number(high, 0),
            ranges.len()
        ),
        Verdict::of_all(n, ranges.len()),
    )
}

pub fn critical(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let (Some(q), true) = (runs.onset(), runs.has_both_sides()) else {
        return runs.one_sided();
    };
    let row = runs.rows.first()?;
    let (radius, published) = PUBLISHED;
    let is_published = (row.radius - radius).abs() < 1e-9;
    let flat_before = runs.rows.iter().any(|r| r.q + 1 == q && !r.is_buckled());
    runs.said(
        format!(
            "R = {} ξ_N (published: {radius}), {}: buckled from q = {q} on",
            row.radius, row.boundary
        ),
        if is_published && q == published && flat_before {
            Verdict::Confirmed
        } else {
            Verdict::Partly
        },
    )
}

pub fn undulations(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let above = runs.above();
    let modes: Vec<(u32, u32)> = above
        .iter()
        .filter_map(|r| Some((r.q, r.ring_mode?)))
        .collect();
    if modes.is_empty() {
        return runs.one_sided();
    }
    let same = modes.iter().filter(|(q, m)| q == m).count();
    runs.said(
        format!(
            "the strongest mode of the ring’s height is q for {same} of {} buckled rings",
            modes.len()
        ),
        if same == modes.len() {
            Verdict::Confirmed
        } else {
            Verdict::both(2 * same > modes.len(), false)
        },
    )
}

pub fn amplitudes(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let above = runs.above();
    let heights: Vec<(u32, f64)> = above
        .iter()
        .filter_map(|r| Some((r.q, r.ring_amplitude? / r.radius)))
        .collect();
    let [(from, first), .., (to, last)] = heights[..] else {
        return runs.said(
            format!("{} buckled rings are too few", heights.len()),
            Verdict::NotJudged,
        );
    };
    let values: Vec<f64> = heights.iter().map(|h| h.1).collect();
    let (grows, verdict) = growth(&values);
    runs.said(
        format!(
            "from {} R at q = {from} to {} R at q = {to}; it grows in {grows} of {} steps",
            text::number(first, 3),
            text::number(last, 3),
            heights.len() - 1
        ),
        // one step is no trend
        if heights.len() < 3 {
            Verdict::NotJudged
        } else {
            verdict
        },
    )
}

pub fn order(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let (mut flat, mut wavy) = (Vec::new(), Vec::new());
    for row in &runs.rows {
        if let Some(amplitude) = row.ring_amplitude {
            let side = if amplitude < FLAT * row.radius {
                &mut flat
            } else {
                &mut wavy
            };
            side.push(row.order_parameter);
        }
    }
    let low = flat.iter().copied().reduce(f64::max);
    let high = wavy.iter().copied().reduce(f64::min);
    let (Some(low), Some(high)) = (low, high) else {
        return runs.said(
            format!(
                "{} flat and {} undulating rings only",
                flat.len(),
                wavy.len()
            ),
            Verdict::NotJudged,
        );
    };
    runs.said(
        format!(
            "at most {low:.0e} on {} flat rings, at least {} on {} undulating ones",
            flat.len(),
            text::significant(high, 2),
            wavy.len()
        ),
        if low < 0.1 * high {
            Verdict::Confirmed
        } else {
            Verdict::both(low < high, false)
        },
    )
}

pub fn energy(t: &Tables) -> Said {
    let runs = Runs::still(t)?;
    let [first, .., last] = &runs.rows[..] else {
        return runs.one_sided();
    };
    let values: Vec<f64> = runs.rows.iter().map(|r| r.f_charged).collect();
    let (grows, verdict) = growth(&values);
    runs.said(
        format!(
            "F from {} L ξ_N at q = {} to {} at q = {}; it grows in {grows} of {} steps",
            text::significant(first.f_charged, 4),
            first.q,
            text::significant(last.f_charged, 4),
            last.q,
            values.len() - 1
        ),
        // all the way: one step down is enough against it
        match verdict {
            Verdict::Confirmed => over_both_sides(&runs, verdict),
            _ => Verdict::NotConfirmed,
        },
    )
}
