//! Stored energy: how it depends on the knot, and which part leads.

use super::rows::{of, top};
use crate::data::{Cut, Sweep};
use crate::plot::text;
use crate::reproduction::claim::{Said, Tables, Verdict};
use topo_analysis::{Spread, crossover, median};

/// Largest over smallest energy of the knots at one twist.
fn span(s: &Sweep, twist: f64) -> Option<f64> {
    let each = |k| Some(s.at(k, twist)?.first().energy);
    let spread = Spread::of(s.knots().into_iter().filter_map(each))?;
    (spread.n > 1 && spread.min > 0.0).then_some(spread.max / spread.min)
}

pub fn energies(t: &Tables) -> Said {
    let s = of(t)?;
    let twist = top(s)?;
    let low = span(s, 0.0)?;
    let high = span(s, twist)?.max(span(s, -twist)?);
    Some((
        format!(
            "largest over smallest energy of the knots: {} without twist, {} at θ′h = ±{twist}",
            text::number(low, 2),
            text::number(high, 2)
        ),
        Verdict::both(high < low, high - 1.0 < (low - 1.0) / 3.0),
    ))
}

pub fn takeover(t: &Tables) -> Said {
    let s = of(t)?;
    top(s)?;
    let rows: Vec<Cut> = s.cases.iter().map(|c| c.first().clone()).collect();
    let mut found = Vec::new();
    for knot in s.knots() {
        let hands = [1.0, -1.0].into_iter();
        found.extend(hands.filter_map(|sign| crossover(&rows, knot, sign)));
    }
    let n = 2 * s.knots().len();
    let (Some(spread), Some(middle)) = (
        Spread::of(found.iter().copied()),
        median(found.iter().copied()),
    ) else {
        let sentence =
            format!("twist energy passes bending energy for none of {n} knots and hands");
        return Some((sentence, Verdict::NotConfirmed));
    };
    let about_one = (0.75..=1.25).contains(&middle);
    let instead = if about_one { "" } else { " instead of about 1" };
    Some((
        format!(
            "twist energy passes bending energy at |θ′h| = {}{instead} (median of {} of {n} knots and hands; {} to {})",
            text::number(middle, 2),
            spread.n,
            text::number(spread.min, 2),
            text::number(spread.max, 2)
        ),
        Verdict::both(2 * spread.n > n, about_one),
    ))
}
