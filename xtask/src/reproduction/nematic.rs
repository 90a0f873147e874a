//! Claims about charged colloids.

use super::{Claim, Said, Tables, Verdict};
use crate::data::NematicSweep;
use crate::figures::nematic::discharge::sign_changes;
use crate::plot::text;
use std::f64::consts::PI;
use topo_analysis::{NematicRow, buckling, median, nematic_resonance};

const SIZE: &str = "the size of the particle and the thickness of the cell";
const SCHEME: &str = "the scheme at the particle’s surface, the thickness of the cell";

pub const CLAIMS: [Claim; 13] = [
    Claim {
        text: "Below a critical charge the defect ring is flat and lies on the equator.",
        published: "Fig. 4a, b",
        figure: "nematic-charging",
        depends: SIZE,
        rule: "the highest unbuckled ring (order parameter below the threshold of buckling) stays within 0.01 R of the equator",
        look: flat,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The cross-section of the ring changes along it between +1/2, twisted and −1/2.",
        published: "Fig. 4a",
        figure: "nematic-charging",
        depends: "how well the grid resolves the core of the ring",
        rule: "on the ring with the widest range the angle goes below 30 and above 150 degrees; in part if it does one of the two",
        look: profiles,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The ring buckles at a critical charge, published as 7.",
        published: "Fig. 4b",
        figure: "nematic-charging",
        depends: SIZE,
        rule: "R = 52.5 ξ_N and the first buckled charge is 7; in part if any ring is buckled",
        look: critical,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "A buckled ring has q maxima and minima.",
        published: "Fig. 4b",
        figure: "nematic-charging",
        depends: "nothing seen",
        rule: "the strongest mode is q on all buckled rings; in part if on more than half",
        look: undulations,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The undulations grow with q.",
        published: "text to Fig. 4",
        figure: "nematic-charging",
        depends: SIZE,
        rule: "the last ring is higher than the first and the height grows in every step; in part if one of the two",
        look: amplitudes,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The mean horizontal director is zero below the buckling and positive above.",
        published: "Fig. 4c, d",
        figure: "nematic-charging",
        depends: "the seed that breaks the symmetry",
        rule: "the largest order parameter of unbuckled states is below a tenth of the smallest of buckled ones",
        look: order,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The free energy grows with q all the way.",
        published: "Fig. 4e",
        figure: "nematic-charging",
        depends: "nothing seen",
        rule: "F grows from each q to the next",
        look: energy,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "After the switch the ring shrinks and vanishes on the particle.",
        published: "Fig. 5a",
        figure: "movie-nematic",
        depends: "whether buckled rings are counted",
        rule: "no ring is left at the end of any discharge; in part if of some",
        look: vanishing,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The discharge drives a flow that changes direction.",
        published: "Fig. 5a",
        figure: "nematic-discharge",
        depends: "where the direction is read (here above the particle)",
        rule: "the sign changes in every discharge with flow; in part if in some",
        look: reversal,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The energy falls by orders of magnitude within the relaxation time R²/ΓL.",
        published: "Fig. 5b",
        figure: "nematic-discharge",
        depends: "the thickness of the cell, for buckled states",
        rule: "t99.9 is at most R²/ΓL for all unbuckled and for all buckled states; in part if for one of the two groups",
        look: decades,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The rate at which half of the energy goes grows with q.",
        published: "Fig. 5c",
        figure: "nematic-discharge",
        depends: SCHEME,
        rule: "R²/(ΓL t50) grows from each q to the next",
        look: half,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The late rates (99 % and 99.9 %) are largest close to the critical charge.",
        published: "Fig. 5d",
        figure: "nematic-discharge",
        depends: SCHEME,
        rule: "both rates peak within 2 of the critical charge; in part if one does",
        look: resonance,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "Far above it the discharge is slow again, held up by the long mode of the horizontal director.",
        published: "Fig. 5d",
        figure: "nematic-discharge",
        depends: "the thickness of the cell (sets the slowest mode)",
        rule: "the rate at the last q is less than half its peak, and the end decays within 15 % of that mode; in part if one of the two",
        look: slow_mode,
        other: None,
        doubt: |_| None,
    },
];

fn of(t: &Tables) -> Option<&NematicSweep> {
    t.nematic.as_ref()
}

/// Rows below the buckling, and from it on.
fn sides(s: &NematicSweep) -> (Vec<&NematicRow>, Vec<&NematicRow>) {
    s.rows.iter().partition(|r| !r.is_buckled())
}

fn flat(t: &Tables) -> Said {
    let (below, _) = sides(of(t)?);
    let height = |r: &&NematicRow| r.ring_amplitude.map(|a| a / r.radius);
    let most = below.iter().filter_map(height).reduce(f64::max)?;
    Some((
        format!(
            "largest height of {} unbuckled rings: {} R",
            below.len(),
            text::number(most, 4)
        ),
        Verdict::when(most < 0.01),
    ))
}

fn profiles(t: &Tables) -> Said {
    let s = of(t)?;
    let mut ranges = Vec::new();
    for row in s.rows.iter().filter(|r| r.q > 1) {
        let Ok(rings) = s.rings(row) else { continue };
        let charged = rings.iter().filter(|l| l.time.is_none());
        let angles: Vec<f64> = charged
            .flat_map(|l| l.angles.iter().flatten().copied())
            .collect();
        let low = angles.iter().copied().reduce(f64::min);
        let high = angles.iter().copied().reduce(f64::max);
        ranges.extend(low.zip(high).map(|(low, high)| (row.q, low, high)));
    }
    let widest = ranges
        .iter()
        .max_by(|a, b| (a.2 - a.1).total_cmp(&(b.2 - b.1)))?;
    let (q, low, high) = *widest;
    let through = ranges.iter().filter(|r| r.1 < 90.0 && r.2 > 90.0).count();
    Some((
        format!(
            "the angle between the axis of rotation and the ring (0: +1/2, 90: twisted, 180: −1/2) runs from {} to {} degrees at q = {q}; it passes 90 degrees on {through} of {} rings",
            text::number(low, 0),
            text::number(high, 0),
            ranges.len()
        ),
        Verdict::both(low < 30.0, high > 150.0),
    ))
}

fn critical(t: &Tables) -> Said {
    let s = of(t)?;
    let radius = s.rows[0].radius;
    let published = (radius - 52.5).abs() < 1e-9;
    let Some(q) = buckling(&s.rows) else {
        return Some((
            format!("R = {radius} ξ_N: no ring is buckled"),
            Verdict::NotConfirmed,
        ));
    };
    Some((
        format!("R = {radius} ξ_N (published: 52.5): buckled from q = {q} on"),
        match (published, q) {
            (true, 7) => Verdict::Confirmed,
            _ => Verdict::Partly,
        },
    ))
}

fn undulations(t: &Tables) -> Said {
    let (_, above) = sides(of(t)?);
    let modes: Vec<(u32, u32)> = above
        .iter()
        .filter_map(|r| Some((r.q, r.ring_mode?)))
        .collect();
    if modes.is_empty() {
        return None;
    }
    let same = modes.iter().filter(|(q, m)| q == m).count();
    Some((
        format!(
            "the strongest mode of the ring’s height is q for {same} of {} buckled rings",
            modes.len()
        ),
        if same == modes.len() {
            Verdict::Confirmed
        } else {
            Verdict::both(2 * same > modes.len(), false)
        },
    ))
}

fn amplitudes(t: &Tables) -> Said {
    let (_, above) = sides(of(t)?);
    let heights: Vec<(u32, f64)> = above
        .iter()
        .filter_map(|r| Some((r.q, r.ring_amplitude? / r.radius)))
        .collect();
    let ((from, first), (to, last)) = (*heights.first()?, *heights.last()?);
    if heights.len() < 2 {
        return None;
    }
    let grows = heights.windows(2).filter(|w| w[1].1 > w[0].1).count();
    Some((
        format!(
            "from {} R at q = {from} to {} R at q = {to}; it grows in {grows} of {} steps",
            text::number(first, 3),
            text::number(last, 3),
            heights.len() - 1
        ),
        Verdict::both(last > first, grows == heights.len() - 1),
    ))
}

fn order(t: &Tables) -> Said {
    let (below, above) = sides(of(t)?);
    let low = below.iter().map(|r| r.order_parameter).reduce(f64::max)?;
    let high = above.iter().map(|r| r.order_parameter).reduce(f64::min);
    let Some(high) = high else {
        return Some((
            format!("at most {low:.0e} for all q: nothing is buckled"),
            Verdict::NotConfirmed,
        ));
    };
    Some((
        format!(
            "at most {low:.0e} below, at least {} above",
            text::significant(high, 2)
        ),
        Verdict::when(low < 0.1 * high),
    ))
}

fn energy(t: &Tables) -> Said {
    let s = of(t)?;
    let (first, last) = (s.rows.first()?, s.rows.last()?);
    Some((
        format!(
            "F from {} L ξ_N at q = {} to {} at q = {}",
            text::significant(first.f_charged, 4),
            first.q,
            text::significant(last.f_charged, 4),
            last.q
        ),
        Verdict::when(nematic_resonance(&s.rows).energy_is_monotonic),
    ))
}

fn vanishing(t: &Tables) -> Said {
    let s = of(t)?;
    let mut times = Vec::new();
    let mut n = 0;
    for row in &s.rows {
        let Ok(series) = s.series(row) else { continue };
        let Some(k) = series.iter().rposition(|p| p.ring_radius.is_some()) else {
            continue;
        };
        n += 1;
        times.extend(series.get(k + 1).map(|p| p.time / row.radius.powi(2)));
    }
    if n == 0 {
        return None;
    }
    let last = times.iter().copied().fold(0.0, f64::max);
    Some((
        format!(
            "gone in {} of {n} discharges, the last at {} R²/ΓL",
            times.len(),
            text::significant(last, 2)
        ),
        if times.len() == n {
            Verdict::Confirmed
        } else {
            Verdict::both(!times.is_empty(), false)
        },
    ))
}

fn reversal(t: &Tables) -> Said {
    let s = of(t)?;
    let mut told = Vec::new();
    let (mut some, mut all) = (false, true);
    for row in &s.flowing {
        let slices = s.slices(row).ok()?;
        let after: Vec<_> = slices.iter().filter(|s| s.time.is_some()).collect();
        let (swaps, n) = sign_changes(row, &after);
        if n > 1 {
            told.push(format!("{swaps} (q = {})", row.q));
            some |= swaps > 0;
            all &= swaps > 0;
        }
    }
    if told.is_empty() {
        return None;
    }
    Some((
        format!(
            "changes of sign of the vertical velocity above the particle: {}",
            told.join(", ")
        ),
        Verdict::both(some, all),
    ))
}

fn decades(t: &Tables) -> Said {
    let s = of(t)?;
    let times: Vec<(bool, f64)> = s
        .rows
        .iter()
        .filter_map(|r| Some((r.is_buckled(), r.t999? / r.radius.powi(2))))
        .collect();
    let inside = |buckled: bool| {
        let group = times.iter().filter(|t| t.0 == buckled);
        (group.clone().filter(|t| t.1 <= 1.0).count(), group.count())
    };
    let ((a, n), (b, m)) = (inside(false), inside(true));
    if n + m == 0 {
        return None;
    }
    Some((
        format!(
            "three orders of magnitude within R²/ΓL for {a} of {n} unbuckled and {b} of {m} buckled states"
        ),
        Verdict::both(a == n, b == m),
    ))
}

fn half(t: &Tables) -> Said {
    let s = of(t)?;
    let rate = |r: &NematicRow| Some(r.radius.powi(2) / r.t50?);
    let (first, last) = (s.rows.first()?, s.rows.last()?);
    Some((
        format!(
            "R²/(ΓL t50) from {} at q = {} to {} at q = {}",
            text::significant(rate(first)?, 3),
            first.q,
            text::significant(rate(last)?, 3),
            last.q
        ),
        Verdict::when(nematic_resonance(&s.rows).half_rate_is_monotonic),
    ))
}

fn resonance(t: &Tables) -> Said {
    let s = of(t)?;
    let found = nematic_resonance(&s.rows);
    let area = s.rows[0].radius.powi(2);
    let ((a, ra), (b, rb)) = (found.peak_99?, found.peak_999?);
    let Some(q) = found.q_c else {
        return Some((
            format!("no buckling; 99 % rate largest at q = {a}, 99.9 % at q = {b}"),
            Verdict::NotConfirmed,
        ));
    };
    let close = |peak: u32| peak.abs_diff(q) <= 2;
    Some((
        format!(
            "critical charge {q}; 99 % rate largest at q = {a} ({} ΓL/R²), 99.9 % at q = {b} ({} ΓL/R²)",
            text::number(ra * area, 1),
            text::number(rb * area, 1)
        ),
        Verdict::both(close(a), close(b)),
    ))
}

fn slow_mode(t: &Tables) -> Said {
    let s = of(t)?;
    let found = nematic_resonance(&s.rows);
    let (peak, fastest) = found.peak_999?;
    let last = s.rows.last().filter(|r| r.is_buckled() && r.q > peak)?;
    let drop = fastest * last.t999?;
    // plates are 30/7 of a radius apart, in an even number of cells
    let cells = 2.0 * (30.0 / 7.0 * last.radius / last.spacing / 2.0).round();
    let mode = 2.0 * (PI / (cells * last.spacing)).powi(2);
    let (_, above) = sides(s);
    let rates = above.iter().filter_map(|r| r.late_rate.map(|l| l / mode));
    let ratio = median(rates);
    let told = ratio.map_or(String::new(), |r| {
        format!(
            "; the end of buckled discharges decays at {} times the slowest mode between the plates, 2π²ΓL/L_z²",
            text::number(r, 2)
        )
    });
    Some((
        format!(
            "the 99.9 % rate at q = {} is {} times smaller than at its peak{told}",
            last.q,
            text::number(drop, 1)
        ),
        Verdict::both(drop > 2.0, ratio.is_none_or(|r| (r - 1.0).abs() < 0.15)),
    ))
}
