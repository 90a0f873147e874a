//! Slow untwisted knots, and what their slowness depends on.

use super::rows::{of, warnings};
use super::times::{Share, Site, untwisted};
use crate::data::Cut;
use crate::data::Sweep;
use crate::plot::text;
use crate::reproduction::claim::{Said, Tables, Verdict, flagged};

/// A knot is slow from this factor over the median at its twist on.
const SLOW: f64 = 1.5;
const T90: Share = |r: &Cut| r.t90;
const T99: Share = |r: &Cut| r.t99;

/// Warnings of the sweep and of the runs under other choices.
pub fn flags_of_choices(t: &Tables) -> Option<String> {
    let others = t.choices.iter().flat_map(|c| warnings(&c.sweep));
    flagged(warnings(of(t)?).chain(others))
}

pub fn slow_pair(t: &Tables, site: Site) -> Said {
    let s = of(t)?;
    let pair = |share| {
        let all = untwisted(s, site, share);
        let find = |knot| all.iter().find(|k| k.0 == knot).copied();
        Some([find("3_1")?, find("7_4")?])
    };
    let ([a, b], [a90, b90]) = (pair(T99)?, pair(T90)?);
    let all = untwisted(s, site, T99);
    let slowest = all.iter().max_by(|x, y| x.1.total_cmp(&y.1))?;
    let slow = |pair: [(&str, f64, f64); 2]| pair.iter().filter(|k| k.2 > SLOW).count();
    let (n99, n90) = (slow([a, b]), slow([a90, b90]));
    Some((
        format!(
            "t99 = {} T₀ (3₁) and {} T₀ (7₄), {} and {} times the median of the knots, t90 {} and {} times; the slowest is {} with {} T₀",
            text::number(a.1, 1),
            text::number(b.1, 1),
            text::number(a.2, 2),
            text::number(b.2, 2),
            text::number(a90.2, 2),
            text::number(b90.2, 2),
            text::knot_name(slowest.0),
            text::number(slowest.1, 1)
        ),
        match (n99, n90) {
            (2, _) => Verdict::Confirmed,
            (1, _) | (0, 2) => Verdict::Partly,
            _ => Verdict::NotConfirmed,
        },
    ))
}

/// A slow knot, its factor, and the names of the choices under which it is not slow.
struct Slow<'a> {
    knot: &'a str,
    factor: f64,
    not_under: Vec<&'a str>,
}

impl Slow<'_> {
    fn text_of(&self) -> String {
        let (knot, factor) = (text::knot_name(self.knot), text::number(self.factor, 1));
        if self.not_under.is_empty() {
            format!("{knot} ({factor})")
        } else {
            format!("{knot} ({factor}; not under {})", self.not_under.join(", "))
        }
    }
}

/// Knots that are slow by default, slowest first.
fn slow<'a>(t: &'a Tables, s: &'a Sweep, site: Site, share: Share) -> Vec<Slow<'a>> {
    let names = |s: &'a Sweep| {
        let all = untwisted(s, site, share).into_iter();
        all.filter(|k| k.2 > SLOW).collect::<Vec<_>>()
    };
    let mut found = names(s);
    found.sort_by(|a, b| b.2.total_cmp(&a.2));
    let slow = found.into_iter().map(|(knot, _, factor)| {
        let not_under = t.choices.iter().filter(|c| {
            let there = names(&c.sweep);
            there.iter().all(|k| k.0 != knot)
        });
        Slow {
            knot,
            factor,
            not_under: not_under.map(|c| c.name.as_str()).collect(),
        }
    });
    slow.collect()
}

pub fn robust(t: &Tables, site: Site) -> Said {
    let s = of(t)?;
    if t.choices.is_empty() {
        return None;
    }
    let list = |found: &[Slow<'_>], robust: bool| {
        let some = found.iter().filter(|k| k.not_under.is_empty() == robust);
        let named: Vec<String> = some.map(Slow::text_of).collect();
        match &named[..] {
            [] => "none".to_owned(),
            named => named.join(", "),
        }
    };
    let (by_99, by_90) = (slow(t, s, site, T99), slow(t, s, site, T90));
    let choices: Vec<&str> = t.choices.iter().map(|c| c.name.as_str()).collect();
    let is_robust = by_99.iter().any(|k| k.not_under.is_empty());
    Some((
        format!(
            "untwisted, more than {SLOW} times the median t99 (factor in brackets) by default and under {}: {}; under some of these choices only: {}. By t90: {}; {}",
            choices.join(", "),
            list(&by_99, true),
            list(&by_99, false),
            list(&by_90, true),
            list(&by_90, false)
        ),
        Verdict::both(!by_99.is_empty(), is_robust),
    ))
}
