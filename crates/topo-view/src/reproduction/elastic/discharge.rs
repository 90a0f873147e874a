//! Discharge times over all twists.

use super::rows::{of, top};
use super::times::{Share, Site, time};
use crate::data::Cut;
use crate::data::Sweep;
use crate::plot::text;
use crate::reproduction::claim::{Said, Tables, Verdict};
use topo_analysis::{Spread, median, standard_deviation};

const T99: Share = |r: &Cut| r.t99;

pub fn slow_at_low_twist(t: &Tables, site: Site) -> Said {
    let s = of(t)?;
    let of_case = |c| Some((c, time(c, site, T99)?));
    let times: Vec<(f64, f64)> = s
        .cases
        .iter()
        .filter_map(of_case)
        .map(|(c, t99)| (c.first().twist.abs(), t99))
        .collect();
    let middle = median(times.iter().map(|t| t.1))?;
    let slow = times.iter().filter(|t| t.1 > 2.0 * middle);
    let (n, low) = (slow.clone().count(), slow.filter(|t| t.0 <= 1.0).count());
    let middle = text::number(middle, 1);
    if n == 0 {
        let sentence = format!("no state takes twice the median t99 of all ({middle} T₀)");
        return Some((sentence, Verdict::NotConfirmed));
    }
    Some((
        format!(
            "{low} of the {n} states that take more than twice the median t99 of all ({middle} T₀) have |θ′h| ≤ 1"
        ),
        Verdict::both(3 * low >= 2 * n, 10 * low >= 9 * n),
    ))
}

pub fn fast_at_high_twist(t: &Tables, site: Site) -> Said {
    let s = of(t)?;
    let times = |pick: &dyn Fn(f64) -> bool| -> Vec<(&str, f64)> {
        let cases = s.cases.iter().filter(|c| pick(c.first().twist.abs()));
        cases
            .filter_map(|c| Some((c.first().knot.as_str(), time(c, site, T99)?)))
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
            text::knot_name(slowest.0),
            text::number(slowest.1, 1)
        ),
        Verdict::both(10 * faster >= 9 * high.len(), faster == high.len()),
    ))
}

/// How a time spreads over the knots at one twist.
struct OverKnots {
    deviation: f64,
    mean: f64,
    slowest_over_fastest: f64,
}

impl OverKnots {
    fn at(s: &Sweep, twist: f64, site: Site, share: Share) -> Option<Self> {
        let each = |k| time(s.at(k, twist)?, site, share);
        let times: Vec<f64> = s.knots().into_iter().filter_map(each).collect();
        let spread = Spread::of(times.iter().copied())?;
        Some(Self {
            deviation: standard_deviation(times)?,
            mean: spread.mean,
            slowest_over_fastest: spread.max / spread.min,
        })
    }

    fn relative(&self) -> f64 {
        self.deviation / self.mean
    }

    fn text_of(&self, place: &str) -> String {
        format!(
            "{} T₀ {place} ({} of the mean, slowest over fastest {})",
            text::number(self.deviation, 2),
            text::number(self.relative(), 2),
            text::number(self.slowest_over_fastest, 1)
        )
    }
}

pub fn knots_washed_out(t: &Tables, name: &str, share: Share) -> Said {
    let s = of(t)?;
    let twist = top(s)?;
    let at = |twist| OverKnots::at(s, twist, Site::Largest, share);
    let (zero, right, left) = (at(0.0)?, at(twist)?, at(-twist)?);
    let falls = |hand: &OverKnots| {
        hand.deviation < zero.deviation / 3.0 && hand.relative() < zero.relative() / 2.0
    };
    // falls in one kind of cut may be a matter of the site: tell the mean of near ties too
    let ties = |twist| Some(OverKnots::at(s, twist, Site::NearTies, share)?.deviation);
    let mut sentence = format!(
        "standard deviation of {name} over the knots {}, {}, {}",
        zero.text_of("without twist"),
        right.text_of(&format!("at θ′h = +{twist}")),
        left.text_of(&format!("at −{twist}"))
    );
    if s.cases.iter().any(|c| c.cuts.len() > 1) {
        let [a, b, c] = [0.0, twist, -twist].map(ties);
        let number = |x| text::number(x, 2);
        sentence += &format!(
            "; of the mean over near-tied cuts {}, {}, {} T₀",
            number(a?),
            number(b?),
            number(c?)
        );
    }
    Some((sentence, Verdict::both(falls(&right), falls(&left))))
}
