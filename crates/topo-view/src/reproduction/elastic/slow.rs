//! Slow untwisted knots, and what their slowness depends on.

use super::rows::{of, warnings};
use super::times::{Share, Site, untwisted};
use crate::data::Cut;
use crate::data::Sweep;
use crate::plot::text;
use crate::reproduction::claim::{ByCriterion, Said, Tables, Verdict, flagged};
use topo_rod::Criterion;

/// A knot is slow from this factor over the median at its twist on.
pub const SLOW: f64 = 1.5;
const T90: Share = |r: &Cut| r.t90;
const T99: Share = |r: &Cut| r.t99;

/// Warnings of the sweep and of the runs cut by other criteria.
pub fn flags_of_criteria(t: &Tables) -> Option<String> {
    flagged(warnings(of(t)?).chain(others(t).flat_map(|c| warnings(&c.sweep))))
}

/// Warnings of these and of the runs under other choices.
pub fn flags_of_choices(t: &Tables) -> Option<String> {
    let choices = t.choices.iter().flat_map(|c| warnings(&c.sweep));
    let criteria = others(t).flat_map(|c| warnings(&c.sweep));
    flagged(warnings(of(t)?).chain(choices).chain(criteria))
}

/// The readings of "the point of maximum stress" besides the largest energy density, where the sweep itself is cut.
fn others(t: &Tables) -> impl Iterator<Item = &ByCriterion> {
    let all = t.criteria.iter();
    all.filter(|c| c.criterion != Criterion::Energy)
}

/// A criterion in words.
pub fn words(criterion: Criterion) -> &'static str {
    match criterion {
        Criterion::Energy => "energy density",
        Criterion::Curvature => "curvature",
        Criterion::Tension => "tension",
        Criterion::VonMises => "von Mises stress",
    }
}

/// 3_1 and 7_4 without twist: t99 and t90, with their factors over the median of the knots.
struct Pair<'a> {
    t99: [(&'a str, f64, f64); 2],
    t90: [(&'a str, f64, f64); 2],
}

impl<'a> Pair<'a> {
    fn of(s: &'a Sweep, site: Site) -> Option<Self> {
        let pair = |share| {
            let all = untwisted(s, site, share);
            let find = |knot| all.iter().find(|k| k.0 == knot).copied();
            Some([find("3_1")?, find("7_4")?])
        };
        Some(Self {
            t99: pair(T99)?,
            t90: pair(T90)?,
        })
    }

    fn verdict(&self) -> Verdict {
        let slow = |pair: [(&str, f64, f64); 2]| pair.iter().filter(|k| k.2 > SLOW).count();
        match (slow(self.t99), slow(self.t90)) {
            (2, _) => Verdict::Confirmed,
            (1, _) | (0, 2) => Verdict::Partly,
            _ => Verdict::NotConfirmed,
        }
    }
}

pub fn slow_pair(t: &Tables, site: Site) -> Said {
    let s = of(t)?;
    let pair = Pair::of(s, site)?;
    let ([a, b], [a90, b90]) = (pair.t99, pair.t90);
    let all = untwisted(s, site, T99);
    let slowest = all.iter().max_by(|x, y| x.1.total_cmp(&y.1))?;
    let mut sentence = format!(
        "t99 = {} T₀ (3₁) and {} T₀ (7₄), {} and {} times the median of the knots, t90 {} and {} times; the slowest is {} with {} T₀",
        text::number(a.1, 1),
        text::number(b.1, 1),
        text::number(a.2, 2),
        text::number(b.2, 2),
        text::number(a90.2, 2),
        text::number(b90.2, 2),
        text::knot_name(slowest.0),
        text::number(slowest.1, 1)
    );
    let mut verdicts = vec![pair.verdict()];
    // the near ties are those of the energy density
    for other in others(t).filter(|_| site == Site::Largest) {
        let pair = Pair::of(&other.sweep, site)?;
        let [a, b] = pair.t99;
        sentence += &format!(
            "; cut at the largest {}: 3₁ {} and 7₄ {} times, slow: {}",
            words(other.criterion),
            text::number(a.2, 2),
            text::number(b.2, 2),
            names_of(&slow_knots(&other.sweep, site, T99))
        );
        verdicts.push(pair.verdict());
    }
    let all = |of: Verdict| verdicts.iter().all(|v| *v == of);
    let verdict = match (all(Verdict::Confirmed), all(Verdict::NotConfirmed)) {
        (true, _) => Verdict::Confirmed,
        (_, true) => Verdict::NotConfirmed,
        _ => Verdict::Partly,
    };
    Some((sentence, verdict))
}

/// Untwisted knots that are slow, slowest first, with their factor.
fn slow_knots(s: &Sweep, site: Site, share: Share) -> Vec<(&str, f64)> {
    let all = untwisted(s, site, share).into_iter();
    let mut slow: Vec<_> = all.filter(|k| k.2 > SLOW).map(|k| (k.0, k.2)).collect();
    slow.sort_by(|a, b| b.1.total_cmp(&a.1));
    slow
}

/// Knots with their factors.
fn names_of(slow: &[(&str, f64)]) -> String {
    let named = |(knot, factor): &(&str, f64)| {
        format!("{} {}", text::knot_name(knot), text::number(*factor, 1))
    };
    match slow {
        [] => "none".to_owned(),
        slow => slow.iter().map(named).collect::<Vec<_>>().join(", "),
    }
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

/// What is chosen differently, in words, with the knots that are slow then.
type Other<'a> = (String, Vec<(&'a str, f64)>);

/// The other choices of friction and reading and, of single cuts, the other criteria.
fn choices(t: &Tables, site: Site, share: Share) -> Vec<Other<'_>> {
    let readings = t.choices.iter();
    let readings = readings.map(|c| (c.name.clone(), slow_knots(&c.sweep, site, share)));
    let criteria = others(t).filter(|_| site == Site::Largest).map(|c| {
        let name = format!("cut at the largest {}", words(c.criterion));
        (name, slow_knots(&c.sweep, site, share))
    });
    readings.chain(criteria).collect()
}

/// Knots that are slow by default, slowest first.
fn slow<'a>(s: &'a Sweep, site: Site, share: Share, others: &'a [Other<'a>]) -> Vec<Slow<'a>> {
    let found = slow_knots(s, site, share).into_iter();
    let slow = found.map(|(knot, factor)| {
        let not_under = others
            .iter()
            .filter(|(_, slow)| slow.iter().all(|k| k.0 != knot));
        Slow {
            knot,
            factor,
            not_under: not_under.map(|(name, _)| name.as_str()).collect(),
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
    let (others_99, others_90) = (choices(t, site, T99), choices(t, site, T90));
    let by_99 = slow(s, site, T99, &others_99);
    let by_90 = slow(s, site, T90, &others_90);
    let names: Vec<&str> = others_99.iter().map(|(name, _)| name.as_str()).collect();
    let is_robust = by_99.iter().any(|k| k.not_under.is_empty());
    Some((
        format!(
            "untwisted, more than {SLOW} times the median t99 (factor in brackets) by default and under {}: {}; under some of these choices only: {}. By t90: {}; {}",
            names.join(", "),
            list(&by_99, true),
            list(&by_99, false),
            list(&by_90, true),
            list(&by_90, false)
        ),
        Verdict::both(!by_99.is_empty(), is_robust),
    ))
}
