//! Charging: knot types, the hand of the twist, twist that became writhe.

use super::rows::{of, top};
use crate::data::{Case, Curve, Cut, KNOTS, Sweep};
use crate::plot::text;
use crate::reproduction::claim::{Said, Tables, Verdict};
use topo_analysis::Warning;
use topo_analysis::{Spread, median};

/// Knots that are their own mirror images.
const AMPHICHIRAL: [&str; 2] = ["4_1", "6_3"];
/// Largest change of the linking number of a closed rod that passes as none, in turns; rounding leaves about 4e-14.
const LINK_DRIFT: f64 = 1e-10;
/// Relative difference of energies from which on the hand of the twist is seen.
const SEEN: f64 = 5e-3;
const NO_OTHER_IMAGE: &str = "the energy of the other image is not in the table, and the better of two images stores the same under either hand by construction";

pub fn charged(t: &Tables) -> Said {
    let s = of(t)?;
    let warned =
        |c: &Case, of: fn(&Warning) -> bool| c.cuts.iter().any(|r| r.warnings.iter().any(of));
    let retied = |c: &Case| warned(c, |w| matches!(w, Warning::Retied { .. }));
    let stopped = |c: &Case| warned(c, |w| matches!(w, Warning::ChargeStopped { .. }));
    let drift = |c: &Case| c.first().link_drift;
    let largest = Spread::of(s.cases.iter().filter_map(drift)).map(|d| d.max);
    let holds =
        |c: &&Case| !retied(c) && !stopped(c) && drift(c).is_some_and(|drift| drift <= LINK_DRIFT);
    let count = |of: &dyn Fn(&Case) -> bool| s.cases.iter().filter(|c| of(c)).count();
    let (n, held) = (s.cases.len(), s.cases.iter().filter(holds).count());
    let all = s.knots().len() == KNOTS.len() && s.twists().len() == 17 && n == KNOTS.len() * 17;
    Some((
        format!(
            "{n} states of {} knots at {} twists charged, {held} of which hold; {} changed their knot type, {} stopped early; largest change of the linking number {} turns",
            s.knots().len(),
            s.twists().len(),
            count(&retied),
            count(&stopped),
            largest.map_or("not recorded".to_owned(), |d| format!("{d:.0e}"))
        ),
        if held == n {
            Verdict::both(true, all)
        } else {
            Verdict::both(10 * held >= 9 * n, false)
        },
    ))
}

/// Relative difference of the energies at +θ′ and −θ′.
fn asymmetry(s: &Sweep, knot: &str, twist: f64) -> Option<f64> {
    let energy = |sign: f64| Some(s.at(knot, sign * twist)?.first().energy);
    Some(relative(energy(1.0)?, energy(-1.0)?))
}

fn relative(a: f64, b: f64) -> f64 {
    2.0 * (a - b) / (a + b)
}

/// Relative difference of the energies of an amphichiral knot under the two hands of a twist, if started from one of its two
/// images alone: the other image stores what the image kept would store under the opposite twist.
fn of_one_image(s: &Sweep, knot: &str, twist: f64) -> Option<f64> {
    let sides = [twist, -twist].into_iter();
    let mut each = sides.filter_map(|twist| {
        let row = s.at(knot, twist)?.first();
        Some(relative(row.energy, row.energy_other_image?).abs())
    });
    each.next()
}

/// Twists of positive hand.
fn positive(s: &Sweep) -> Vec<f64> {
    s.twists().into_iter().filter(|t| *t > 0.0).collect()
}

/// Energies and writhes of a knot at the largest twist of either hand, and the relative difference of the former.
fn both_hands(s: &Sweep, knot: &str) -> Option<(String, f64)> {
    let twist = top(s)?;
    let (plus, minus) = (s.at(knot, twist)?.first(), s.at(knot, -twist)?.first());
    let difference = asymmetry(s, knot, twist)?;
    let sentence = format!(
        "{} at θ′h = ±{twist}: energy {} and {} E₀ ({} %), writhe {} and {}",
        text::knot_name(knot),
        text::significant(plus.energy, 4),
        text::significant(minus.energy, 4),
        text::number(100.0 * difference, 2),
        text::number(plus.writhe, 2),
        text::number(minus.writhe, 2)
    );
    Some((sentence, difference.abs()))
}

pub fn trefoil(t: &Tables) -> Said {
    let (sentence, difference) = both_hands(of(t)?, "3_1")?;
    Some((sentence, Verdict::when(difference > SEEN)))
}

pub fn figure_eight(t: &Tables) -> Said {
    let s = of(t)?;
    let (sentence, kept) = both_hands(s, "4_1")?;
    if kept > SEEN {
        return Some((sentence, Verdict::NotConfirmed));
    }
    let twists = positive(s).into_iter();
    let single = twists.filter_map(|twist| of_one_image(s, "4_1", twist));
    let (Some(at_top), Some(all)) = (of_one_image(s, "4_1", top(s)?), Spread::of(single)) else {
        return Some((format!("{sentence}; {NO_OTHER_IMAGE}"), Verdict::NotJudged));
    };
    Some((
        format!(
            "{sentence}, of the better of two images; from one image alone they differ by {} %, at other twists by {} % at most",
            text::significant(100.0 * at_top, 2),
            text::significant(100.0 * all.max, 2)
        ),
        Verdict::both(at_top <= SEEN, all.max <= SEEN),
    ))
}

/// How much the knots see the hand of the twist, over the twists by `over`.
fn chirality(t: &Tables, name: &str, over: fn(Vec<f64>) -> Option<f64>) -> Said {
    let s = of(t)?;
    let twists = positive(s);
    let all = |of: &dyn Fn(f64) -> Option<f64>| -> Option<f64> {
        over(twists.iter().filter_map(|t| of(*t)).collect())
    };
    let percent = |x: f64| text::significant(100.0 * x, 2);
    let (mut chiral, mut mirror, mut sentence) = (Vec::new(), Vec::new(), Vec::new());
    for knot in s.knots() {
        if !AMPHICHIRAL.contains(&knot) {
            let seen = all(&|t| Some(asymmetry(s, knot, t)?.abs()));
            chiral.extend(seen.map(|a| (knot, a)));
        } else if let Some(a) = all(&|t| of_one_image(s, knot, t)) {
            mirror.push(a);
            sentence.push(format!("{} {} %", text::knot_name(knot), percent(a)));
        }
    }
    let c = median(chiral.iter().map(|k| k.1))?;
    let chiral_said = format!(
        "{name} |E(+) − E(−)|/E over twists: {} % for the median of {} chiral knots",
        percent(c),
        chiral.len()
    );
    let Some(m) = median(mirror) else {
        let sentence = format!("{chiral_said}; of amphichiral knots {NO_OTHER_IMAGE}");
        return Some((sentence, Verdict::NotJudged));
    };
    let below = chiral.iter().filter(|k| k.1 <= 3.0 * m);
    let below: Vec<String> = below
        .map(|k| format!("{} {} %", text::knot_name(k.0), percent(k.1)))
        .collect();
    let but = match &below[..] {
        [] => String::new(),
        below => format!(" (not {})", below.join(", ")),
    };
    Some((
        format!(
            "{chiral_said}; from one image alone {}; {} chiral knots are above three times the median of these{but}",
            sentence.join(" and "),
            chiral.len() - below.len()
        ),
        Verdict::both(c > 3.0 * m, below.is_empty()),
    ))
}

pub fn chirality_by_median(t: &Tables) -> Said {
    chirality(t, "median", median)
}

/// The difference of the energies may change its sign with the twist, as that of 6_2 and 7_7 near θ'h = 1.25, which the largest
/// one does not see.
pub fn chirality_by_largest(t: &Tables) -> Said {
    chirality(t, "largest", |all| Spread::of(all).map(|s| s.max))
}

pub fn profiles(t: &Tables) -> Said {
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

pub fn twist_left(t: &Tables) -> Said {
    let s = of(t)?;
    // L = 50 h but in the reading that keeps each knot's own length
    if s.cases.iter().any(|c| c.first().reading == "own-length") {
        return None;
    }
    let share = |r: &Cut| (r.total_twist / (r.twist * 50.0 / std::f64::consts::TAU)).abs();
    let of_hand = |sign: f64| -> Vec<f64> {
        let rows = s.cases.iter().map(|c| c.first());
        rows.filter(|r| r.twist * sign > 0.0).map(share).collect()
    };
    let (right, left) = (of_hand(1.0), of_hand(-1.0));
    let less = |hand: &[f64]| hand.iter().filter(|x| **x < 1.0).count();
    let most = |hand: &[f64]| 2 * less(hand) > hand.len();
    let (r, l) = (
        median(right.iter().copied())?,
        median(left.iter().copied())?,
    );
    Some((
        format!(
            "{} of {} states twisted to the right and {} of {} to the left hold less twist than was supplied; median share left {} and {}",
            less(&right),
            right.len(),
            less(&left),
            left.len(),
            text::number(r, 3),
            text::number(l, 3)
        ),
        Verdict::both(most(&right), most(&left)),
    ))
}
