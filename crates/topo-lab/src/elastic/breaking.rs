//! What is said of fibres that may break by themselves.

use topo_analysis::SweepRow;
use topo_rod::{Breaking, ChargedRod};

/// Columns of rows of scenes with a break: the largest value of the criterion after the charge, in its unit, and the time of the
/// break, in T_0, if there was one.
const VALUE: &str = "break_value";
const TIME: &str = "break_time";

fn largest(bears: Breaking, charged: &ChargedRod) -> f64 {
    let found = charged.cut_candidates_by(bears.criterion, 0.0);
    found.first().map_or(0.0, |site| site.density)
}

/// What it bore, and when it broke.
pub(super) fn columns(
    bears: Breaking,
    charged: &ChargedRod,
) -> impl Iterator<Item = (&'static str, f64)> {
    let broken = charged.broken();
    let time = broken.map(|broken| (TIME, broken.time));
    let value = broken.map_or_else(|| largest(bears, charged), |b| b.site.density);
    std::iter::once((VALUE, value)).chain(time)
}

/// Whether the fibre of a row broke by itself.
pub(super) fn is_broken(row: &SweepRow) -> bool {
    row.further.of(TIME).is_some()
}

/// What is said of a fibre that did not break.
pub(super) fn unbroken(bears: Breaking, charged: &ChargedRod) -> Option<String> {
    if charged.broken().is_some() {
        return None;
    }
    let Breaking {
        criterion,
        threshold,
    } = bears;
    let (value, unit) = (largest(bears, charged), criterion.unit());
    Some(format!(
        "not broken, not discharged: after the charge {criterion} is at most {value:.4} {unit} of {threshold} {unit}"
    ))
}

/// A line that says when and where the fibre of a row broke.
pub(super) fn line(bears: Breaking, row: &SweepRow) -> Option<String> {
    let (time, value) = (row.further.of(TIME)?, row.further.of(VALUE)?);
    let (criterion, unit) = (bears.criterion, bears.criterion.unit());
    Some(format!(
        "{} {:+} broke after {time:.4} T0 of its charge at s/L = {:.4}: {criterion} {value:.4} {unit}",
        row.knot, row.twist, row.cut
    ))
}
