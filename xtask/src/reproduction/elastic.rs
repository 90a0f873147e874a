//! Claims about knotted fibres.

use super::{Claim, Said, Tables, Verdict, flagged};
use crate::data::{Case, Curve, Cut, Sweep, series};
use crate::plot::text;
use topo_analysis::{Spread, crossover, median, quantile, resonances};

const BRANCH: &str = "the branch that a start shape settles in (θ′h near ±1)";
const CUT: &str = "the cut site, the range of friction, how L/h is read";
/// Knots that are their own mirror images.
const AMPHICHIRAL: [&str; 2] = ["4_1", "6_3"];
/// A knot is slow from this factor over the median at its twist on.
const SLOW: f64 = 1.5;

pub const CLAIMS: [Claim; 15] = [
    Claim {
        text: "Fourteen knots at seventeen twists can be charged and hold their energy as long as they are closed.",
        published: "Fig. 1",
        figure: "elastic-configurations",
        depends: "nothing seen",
        rule: "all states are there, none changed its knot type, and the linking number moved by less than 1e-6 turns",
        look: charged,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "The trefoil, being chiral, buckles differently under right- and left-handed twist.",
        published: "Fig. 2a",
        figure: "elastic-charging",
        depends: BRANCH,
        rule: "the energies differ by more than 0.5 %",
        look: |t| handed(t, "3_1", true),
        other: None,
        doubt: flags,
    },
    Claim {
        text: "The figure-eight knot, being its own mirror image, does not care for the hand of the twist.",
        published: "Fig. 2a",
        figure: "elastic-charging",
        depends: BRANCH,
        rule: "the energies differ by at most 0.5 %",
        look: |t| handed(t, "4_1", false),
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Chiral knots in general buckle by the hand of the twist, and amphichiral ones do not.",
        published: "text to Fig. 2",
        figure: "elastic-charging",
        depends: "amphichiral knots being started from the better of two mirror images",
        rule: "every chiral knot is above three times the median of the amphichiral ones; in part if the median of the chiral knots is",
        look: chirality,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "The energy density along a trefoil differs between θ′h = +2 and −2.",
        published: "Fig. 2b",
        figure: "elastic-charging",
        depends: "nothing seen",
        rule: "the two ratios differ by more than 5 %",
        look: profiles,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Buckling turns twist into writhe: less twist is left than was supplied.",
        published: "text to Fig. 2",
        figure: "elastic-charging",
        depends: "how L/h is read (sets the twist supplied)",
        rule: "all twisted states hold less twist; in part if more than half do",
        look: twist_left,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "At low twist the stored energy depends on the knot, at high twist it does not.",
        published: "Fig. 3b",
        figure: "elastic-discharge",
        depends: "how L/h is read (sets the energy of an untwisted knot)",
        rule: "the excess over 1 of the ratio falls to a third",
        look: energies,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Twist takes over from bending at θ′h of about 1.",
        published: "Fig. 3b–e",
        figure: "elastic-discharge",
        depends: "how L/h is read",
        rule: "the median lies between 0.5 and 1.5",
        look: takeover,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Energy is released in phases, as intermediate knots form and untie (7₄ over others to the unknot).",
        published: "Fig. 3c",
        figure: "elastic-discharge",
        depends: "the cut site",
        rule: "7₄ passes through another knot and more than half of the knots do; in part if one of the two",
        look: phases,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Without twist 3₁ and 7₄ untie more slowly than others.",
        published: "Fig. 3c",
        figure: "elastic-discharge",
        depends: CUT,
        rule: "both are more than 1.5 times slower than the median; in part if one is",
        look: slow_pair,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Some knots are superslow for a reason of topology.",
        published: "Fig. 3d, e",
        figure: "elastic-discharge",
        depends: CUT,
        rule: "a knot is slow under every choice; in part if one is slow under the default only",
        look: robust,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Superslow states lie at low twist.",
        published: "Fig. 3d",
        figure: "elastic-discharge",
        depends: "the cut site",
        rule: "at least nine in ten of the slow states have |θ′h| ≤ 1; in part if two in three",
        look: slow_at_low_twist,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "High twist makes every knot discharge fast.",
        published: "Fig. 3d, e",
        figure: "elastic-discharge",
        depends: "the cut site",
        rule: "all are faster than the untwisted median; in part if nine in ten are",
        look: fast_at_high_twist,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "At high twist the knot no longer matters for the discharge time.",
        published: "Fig. 3e",
        figure: "elastic-discharge",
        depends: "the measure of spread; 7₁ stays slow at high twist",
        rule: "90th over 10th percentile falls by a fifth and slowest over fastest to below 1.5; in part if one of the two",
        look: knots_washed_out,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "The last of the energy goes at a rate set by the relaxed length, the same for all.",
        published: "text to Fig. 3c",
        figure: "elastic-discharge",
        depends: "how long the discharge is followed (here to 99.9 %), how L/h is read",
        rule: "nine in ten end within 10 %; in part if half do",
        look: final_rates,
        other: None,
        doubt: flags,
    },
];

/// Warnings of the runs.
fn flags(t: &Tables) -> Option<String> {
    let rows = of(t)?.cases.iter().flat_map(|c| &c.cuts);
    flagged(rows.map(|r| r.warnings.as_str()))
}

fn of(t: &Tables) -> Option<&Sweep> {
    t.elastic.as_ref()
}

/// Largest twist that has both signs.
fn top(s: &Sweep) -> Option<f64> {
    let twists = s.twists();
    let high = twists.iter().copied().fold(0.0, f64::max);
    let both = high > 0.0 && twists.iter().any(|t| (t + high).abs() < 1e-9);
    both.then_some(high)
}

fn charged(t: &Tables) -> Said {
    let s = of(t)?;
    let drift = s.cases.iter().filter_map(|c| c.first().link_drift);
    let drift = drift.fold(0.0, f64::max);
    let other = |c: &&Case| c.cuts.iter().any(|r| r.warnings.contains("tied as"));
    let retied = s.cases.iter().filter(other).count();
    Some((
        format!(
            "{} states of {} knots at {} twists charged; {retied} changed their knot type; largest change of the linking number {drift:.0e} turns",
            s.cases.len(),
            s.knots().len(),
            s.twists().len()
        ),
        Verdict::when(
            retied == 0 && drift < 1e-6 && s.cases.len() == s.knots().len() * s.twists().len(),
        ),
    ))
}

/// Relative difference of the energies at +θ′ and −θ′.
fn asymmetry(s: &Sweep, knot: &str, twist: f64) -> Option<f64> {
    let e = |sign: f64| Some(s.at(knot, sign * twist)?.first().energy);
    let (plus, minus) = (e(1.0)?, e(-1.0)?);
    Some(2.0 * (plus - minus) / (plus + minus))
}

fn handed(t: &Tables, knot: &str, expected: bool) -> Said {
    let s = of(t)?;
    let twist = top(s)?;
    let (plus, minus) = (s.at(knot, twist)?.first(), s.at(knot, -twist)?.first());
    let difference = asymmetry(s, knot, twist)?;
    let differs = difference.abs() > 5e-3;
    Some((
        format!(
            "{} at θ′h = ±{twist}: energy {} and {} E₀ ({} %), writhe {} and {}",
            text::knot_name(knot),
            text::significant(plus.energy, 4),
            text::significant(minus.energy, 4),
            text::number(100.0 * difference, 2),
            text::number(plus.writhe, 2),
            text::number(minus.writhe, 2)
        ),
        Verdict::when(differs == expected),
    ))
}

fn chirality(t: &Tables) -> Said {
    let s = of(t)?;
    let twists: Vec<f64> = s.twists().into_iter().filter(|t| *t > 0.0).collect();
    let of_knot = |knot: &str| {
        let each = twists.iter().filter_map(|t| asymmetry(s, knot, *t));
        median(each.map(f64::abs).collect::<Vec<_>>())
    };
    let (mut chiral, mut mirror) = (Vec::new(), Vec::new());
    for knot in s.knots() {
        let Some(a) = of_knot(knot) else { continue };
        if AMPHICHIRAL.contains(&knot) {
            mirror.push(a);
        } else {
            chiral.push(a);
        }
    }
    let (c, m) = (
        median(chiral.iter().copied())?,
        median(mirror.iter().copied())?,
    );
    let above = chiral.iter().filter(|a| **a > 3.0 * m).count();
    Some((
        format!(
            "median |E(+) − E(−)|/E over twists: {} % over {} chiral knots, {} % over {} amphichiral ones; {above} chiral knots are above three times the latter",
            text::number(100.0 * c, 2),
            chiral.len(),
            text::number(100.0 * m, 3),
            mirror.len()
        ),
        if above == chiral.len() {
            Verdict::Confirmed
        } else {
            Verdict::both(c > 3.0 * m, false)
        },
    ))
}

fn profiles(t: &Tables) -> Said {
    let s = of(t)?;
    let twist = top(s)?;
    let peak = |sign: f64| {
        let case = s.at("3_1", sign * twist)?;
        let path = t.results.join("elastic").join(case.folder());
        let curve = Curve::read(&path.join("charged.csv")).ok()?;
        let mean = curve.density.iter().sum::<f64>() / curve.density.len() as f64;
        Some(curve.density.iter().copied().fold(0.0, f64::max) / mean)
    };
    let (plus, minus) = (peak(1.0)?, peak(-1.0)?);
    Some((
        format!(
            "3₁: largest over mean density {} at θ′h = +{twist}, {} at −{twist}",
            text::number(plus, 2),
            text::number(minus, 2)
        ),
        Verdict::when((plus / minus).ln().abs() > 0.05),
    ))
}

fn twist_left(t: &Tables) -> Said {
    let s = of(t)?;
    // L = 50 h but in the reading that keeps each knot's own length
    if s.cases.iter().any(|c| c.first().reading == "own-length") {
        return None;
    }
    let share = |r: &Cut| r.total_twist / (r.twist * 50.0 / std::f64::consts::TAU);
    let twisted: Vec<f64> = s
        .cases
        .iter()
        .map(|c| c.first())
        .filter(|r| r.twist != 0.0)
        .map(share)
        .collect();
    let less = twisted.iter().filter(|x| x.abs() < 1.0).count();
    let middle = median(twisted.iter().copied())?;
    Some((
        format!(
            "{less} of {} twisted states hold less twist than was supplied; median share left {}",
            twisted.len(),
            text::number(middle, 2)
        ),
        if less == twisted.len() {
            Verdict::Confirmed
        } else {
            Verdict::both(2 * less > twisted.len(), false)
        },
    ))
}

/// Largest over smallest of a measure over the knots at one twist.
fn span(s: &Sweep, twist: f64, of: impl Fn(&Case) -> Option<f64>) -> Option<f64> {
    let values = s.knots().into_iter().filter_map(|k| of(s.at(k, twist)?));
    let spread = Spread::of(values)?;
    (spread.n > 1 && spread.min > 0.0).then_some(spread.max / spread.min)
}

fn energies(t: &Tables) -> Said {
    let s = of(t)?;
    let twist = top(s)?;
    let energy = |c: &Case| Some(c.first().energy);
    let low = span(s, 0.0, energy)?;
    let high = span(s, twist, energy)?.max(span(s, -twist, energy)?);
    Some((
        format!(
            "largest over smallest energy of the knots: {} without twist, {} at θ′h = ±{twist}",
            text::number(low, 2),
            text::number(high, 2)
        ),
        Verdict::when(low - 1.0 > 3.0 * (high - 1.0)),
    ))
}

fn takeover(t: &Tables) -> Said {
    let s = of(t)?;
    let rows: Vec<Cut> = s.cases.iter().map(|c| c.first().clone()).collect();
    let mut found = Vec::new();
    for knot in s.knots() {
        found.extend(
            [1.0, -1.0]
                .iter()
                .filter_map(|sign| crossover(&rows, knot, *sign)),
        );
    }
    let spread = Spread::of(found.iter().copied())?;
    let middle = median(found.iter().copied())?;
    Some((
        format!(
            "twist energy passes bending energy at |θ′h| = {} (median of {}; {} to {})",
            text::number(middle, 2),
            spread.n,
            text::number(spread.min, 2),
            text::number(spread.max, 2)
        ),
        Verdict::when((0.5..=1.5).contains(&middle)),
    ))
}

fn phases(t: &Tables) -> Said {
    let s = of(t)?;
    let mut through = 0;
    let mut n = 0;
    let mut shown = String::new();
    for knot in s.knots() {
        let Some(case) = s.at(knot, 0.0) else {
            continue;
        };
        let path = t.results.join("elastic").join(case.folder());
        let Ok(moments) = series(&path.join("series.csv")) else {
            continue;
        };
        let cut = case.first().cut;
        let mut types: Vec<String> = moments
            .into_iter()
            .filter(|m| (m.cut - cut).abs() < 1e-12)
            .filter_map(|m| m.knot.filter(|k| !k.is_empty()))
            .collect();
        types.dedup();
        n += 1;
        let between = types.iter().any(|k| k != knot && k != "0_1");
        through += usize::from(between);
        if knot == "7_4" {
            shown = types
                .iter()
                .map(|k| text::knot_name(k))
                .collect::<Vec<_>>()
                .join(" → ");
        }
    }
    if n == 0 {
        return None;
    }
    let others = shown.matches('→').count() >= 2;
    let shown = if shown.is_empty() {
        String::new()
    } else {
        format!("7₄: {shown}; ")
    };
    Some((
        format!("{shown}{through} of {n} untwisted knots pass through others"),
        Verdict::both(others, 2 * through > n),
    ))
}

fn mean_t99(c: &Case) -> Option<f64> {
    c.spread(|r| r.t99).map(|s| s[0])
}

/// Discharge time of a knot over the median of all, at one twist.
fn slowness(s: &Sweep, knot: &str, twist: f64) -> Option<(f64, f64)> {
    let all = s
        .knots()
        .into_iter()
        .filter_map(|k| mean_t99(s.at(k, twist)?));
    let middle = median(all.collect::<Vec<_>>())?;
    let time = mean_t99(s.at(knot, twist)?)?;
    Some((time, time / middle))
}

fn slow_pair(t: &Tables) -> Said {
    let s = of(t)?;
    let ((a, ra), (b, rb)) = (slowness(s, "3_1", 0.0)?, slowness(s, "7_4", 0.0)?);
    let slowest = s
        .knots()
        .into_iter()
        .filter_map(|k| Some((k, mean_t99(s.at(k, 0.0)?)?)))
        .max_by(|x, y| x.1.total_cmp(&y.1))?;
    Some((
        format!(
            "t99 = {} T₀ (3₁) and {} T₀ (7₄): {} and {} times the median of the knots; the slowest is {} with {} T₀",
            text::number(a, 1),
            text::number(b, 1),
            text::number(ra, 2),
            text::number(rb, 2),
            text::knot_name(slowest.0),
            text::number(slowest.1, 1)
        ),
        Verdict::both(ra > SLOW, rb > SLOW),
    ))
}

fn robust(t: &Tables) -> Said {
    let s = of(t)?;
    if t.variants.is_empty() {
        return None;
    }
    let untwisted = |c: &&Case| c.first().twist.abs() < 1e-9;
    let rows: Vec<Cut> = s
        .cases
        .iter()
        .filter(untwisted)
        .flat_map(|c| c.cuts.clone())
        .collect();
    let others: Vec<&[Cut]> = t.variants.iter().map(|v| v.1.as_slice()).collect();
    let found = resonances(&rows, SLOW, &others);
    let name = |robust: bool| {
        let each = found.iter().filter(|r| r.robust == robust);
        let words: Vec<String> = each
            .map(|r| {
                format!(
                    "{} ({})",
                    text::knot_name(&r.knot),
                    text::number(r.ratio, 1)
                )
            })
            .collect();
        if words.is_empty() {
            "none".to_owned()
        } else {
            words.join(", ")
        }
    };
    let readings: Vec<&str> = t.variants.iter().map(|v| v.0).collect();
    Some((
        format!(
            "untwisted, at least {SLOW} times the median t99 (factor in brackets): {} also under {}; {} under the default only",
            name(true),
            readings.join(" and "),
            name(false)
        ),
        match (found.iter().any(|r| r.robust), found.is_empty()) {
            (true, _) => Verdict::Confirmed,
            (false, false) => Verdict::Partly,
            (false, true) => Verdict::NotConfirmed,
        },
    ))
}

fn slow_at_low_twist(t: &Tables) -> Said {
    let s = of(t)?;
    let times: Vec<(f64, f64)> = s
        .cases
        .iter()
        .filter_map(|c| Some((c.first().twist.abs(), mean_t99(c)?)))
        .collect();
    let middle = median(times.iter().map(|t| t.1))?;
    let slow: Vec<f64> = times
        .iter()
        .filter(|t| t.1 > 2.0 * middle)
        .map(|t| t.0)
        .collect();
    let low = slow.iter().filter(|t| **t <= 1.0).count();
    if slow.is_empty() {
        return Some((
            format!(
                "no state takes twice the median t99 of all ({} T₀)",
                text::number(middle, 1)
            ),
            Verdict::NotConfirmed,
        ));
    }
    Some((
        format!(
            "{low} of the {} states that take more than twice the median t99 of all ({} T₀) have |θ′h| ≤ 1",
            slow.len(),
            text::number(middle, 1)
        ),
        if 10 * low >= 9 * slow.len() {
            Verdict::Confirmed
        } else {
            Verdict::both(3 * low >= 2 * slow.len(), false)
        },
    ))
}

fn fast_at_high_twist(t: &Tables) -> Said {
    let s = of(t)?;
    let times = |pick: &dyn Fn(f64) -> bool| -> Vec<(String, f64)> {
        s.cases
            .iter()
            .filter(|c| pick(c.first().twist.abs()))
            .filter_map(|c| Some((c.first().knot.clone(), mean_t99(c)?)))
            .collect()
    };
    let (low, high) = (times(&|x| x < 1e-9), times(&|x| x >= 1.5));
    let middle = median(low.iter().map(|t| t.1))?;
    let middle_high = median(high.iter().map(|t| t.1))?;
    let slowest = high.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let faster = high.iter().filter(|t| t.1 < middle).count();
    Some((
        format!(
            "median t99 {} T₀ without twist, {} T₀ at |θ′h| ≥ 1.5; {faster} of {} strongly twisted states are faster than the untwisted median, the slowest is {} with {} T₀",
            text::number(middle, 1),
            text::number(middle_high, 1),
            high.len(),
            text::knot_name(&slowest.0),
            text::number(slowest.1, 1)
        ),
        if faster == high.len() {
            Verdict::Confirmed
        } else {
            Verdict::both(10 * faster >= 9 * high.len(), false)
        },
    ))
}

fn knots_washed_out(t: &Tables) -> Said {
    let s = of(t)?;
    let twist = top(s)?;
    let low = span(s, 0.0, mean_t99)?;
    let high = span(s, twist, mean_t99)?.max(span(s, -twist, mean_t99)?);
    let inner = |twist: f64| {
        let times: Vec<f64> = s
            .knots()
            .into_iter()
            .filter_map(|k| mean_t99(s.at(k, twist)?))
            .collect();
        let at = |q| quantile(times.iter().copied(), q);
        Some(at(0.9)? / at(0.1)?)
    };
    let (l, h) = (inner(0.0)?, inner(twist)?.max(inner(-twist)?));
    Some((
        format!(
            "slowest over fastest knot: {} without twist, {} at θ′h = ±{twist}; 90th over 10th percentile {} and {}",
            text::number(low, 1),
            text::number(high, 1),
            text::number(l, 1),
            text::number(h, 1)
        ),
        Verdict::both(h < 0.8 * l, high < 1.5),
    ))
}

/// Rate −d ln E/dt at the end of a discharge: over the samples in which the energy fell by the last third.
fn last_rate(times: &[(f64, f64)]) -> Option<f64> {
    let (t1, e1) = *times.last()?;
    let (t0, e0) = *times.iter().rev().find(|p| p.1 > 1.3 * e1)?;
    let rate = (e0 / e1).ln() / (t1 - t0);
    (rate.is_finite() && rate > 0.0).then_some(rate)
}

fn final_rates(t: &Tables) -> Said {
    let s = of(t)?;
    let mut rates = Vec::new();
    for case in &s.cases {
        let path = t.results.join("elastic").join(case.folder());
        let Ok(moments) = series(&path.join("series.csv")) else {
            continue;
        };
        let cut = case.first().cut;
        let here = moments.iter().filter(|m| (m.cut - cut).abs() < 1e-12);
        let points: Vec<(f64, f64)> = here.map(|m| (m.time, m.energy)).collect();
        rates.extend(last_rate(&points));
    }
    // the slowest bending time T_b = 2 L² η/(π² h² E_b) in T_0 = 2 L η/(h E_b), at L = 50 h
    let slowest = std::f64::consts::PI.powi(2) / 50.0;
    let near = |r: &&f64| (**r / slowest - 1.0).abs() < 0.1;
    let same = rates.iter().filter(near).count();
    let middle = median(rates.iter().copied())?;
    Some((
        format!(
            "−d ln E/dt at the end: median {} /T₀; {same} of {} discharges end within 10 % of 1/T_b = π²h/L = {} /T₀, the others faster or not yet there",
            text::number(middle, 3),
            rates.len(),
            text::number(slowest, 3)
        ),
        if 10 * same >= 9 * rates.len() {
            Verdict::Confirmed
        } else {
            Verdict::both(2 * same >= rates.len(), false)
        },
    ))
}
