//! Rows of the elastic sweep that claims look at.

use crate::data::Sweep;
use crate::reproduction::claim::{Tables, flagged};
use topo_analysis::Warnings;

/// How many of the runs of the sweep carry warnings.
pub(super) fn flags(t: &Tables) -> Option<String> {
    flagged(warnings(of(t)?))
}

pub(super) fn warnings(s: &Sweep) -> impl Iterator<Item = &Warnings> {
    let rows = s.cases.iter().flat_map(|c| &c.cuts);
    rows.map(|r| &r.warnings)
}

pub(super) fn of(t: &Tables) -> Option<&Sweep> {
    t.elastic.as_ref()
}

/// Largest twist that has both signs.
pub(super) fn top(s: &Sweep) -> Option<f64> {
    let twists = s.twists();
    let high = twists.iter().copied().fold(0.0, f64::max);
    let both = high > 0.0 && twists.iter().any(|t| (t + high).abs() < 1e-9);
    both.then_some(high)
}
