//! Times of a state by the cuts that count.

use super::rows::of;
use crate::data::{Case, Cut, Sweep};
use crate::reproduction::claim::{Said, Tables};
use topo_analysis::median;

/// Which cuts of a state count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Site {
    /// The one at the largest energy density, as published: the first of the table.
    Largest,
    /// All near ties, by their mean.
    NearTies,
}

/// A discharge time of a row.
pub type Share = fn(&Cut) -> Option<f64>;

/// A discharge time of a state.
pub fn time(case: &Case, site: Site, share: Share) -> Option<f64> {
    match site {
        Site::Largest => share(case.first()),
        Site::NearTies => case.spread(share).map(|[mean, ..]| mean),
    }
}

/// What near ties say; `None` where each state was cut once.
pub fn tied(t: &Tables, look: fn(&Tables, Site) -> Said) -> Said {
    let cases = &of(t)?.cases;
    let more = cases.iter().any(|c| c.cuts.len() > 1);
    more.then(|| look(t, Site::NearTies)).flatten()
}

/// Knots, their times without twist, and these over the median of the knots.
pub fn untwisted(s: &Sweep, site: Site, share: Share) -> Vec<(&str, f64, f64)> {
    let each = |k| Some((k, time(s.at(k, 0.0)?, site, share)?));
    let times: Vec<(&str, f64)> = s.knots().into_iter().filter_map(each).collect();
    let Some(middle) = median(times.iter().map(|t| t.1)) else {
        return Vec::new();
    };
    let over = |(k, t): (_, f64)| (k, t, t / middle);
    times.into_iter().map(over).collect()
}
