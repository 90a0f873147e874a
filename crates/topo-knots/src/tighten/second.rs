//! A second opinion on a tight knot, by another method from a loosened start.

use serde::{Deserialize, Serialize};
use topo_core::{CpuClock, Interrupt, Polyline};

use super::augmented::settle;
use super::origin::Tight;
use super::shape::refined;
use super::stop::Stop;
use super::topology::{Topology, check_type};
use super::{TightKnot, TightLink};
use crate::KnotError;
use crate::curves::Curves;

/// Vertices per unit of ropelength of the loosened start.
const COARSE: f64 = 4.0;
/// Passes of the binomial filter that take the start out of its tight state.
const LOOSENING: usize = 12;
/// Violation of constraints, in tube radii, that is let pass on a coarse level and on the last.
const ROUGH: f64 = 1e-3;
const FINE: f64 = 2e-5;

/// What the second method says of a tight knot, or of a link whose curves it holds as a list.
///
/// # Validation
/// `val_two_methods_agree_on_tight_knots`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SecondOpinion<C = Polyline> {
    /// The curve or the curves, scaled to thickness 1.
    pub curve: C,
    /// Its length over its thickness, which is found by brute force, in units of the tube radius.
    pub length_over_radius: f64,
    /// Ropelength of the loosened curve that the method started from, in tube radii.
    pub start_length_over_radius: f64,
    /// Whether it came to rest.
    pub converged: bool,
    /// Evaluations of energy and gradient.
    pub n_evaluations: usize,
    /// Processor time, in seconds.
    pub cpu_seconds: f64,
}

/// Tightens the shape of a knot once more, by the augmented Lagrangian and quasi-Newton steps.
///
/// The curve is resampled to four vertices per unit and smoothed, which makes it some percent longer, and from there the
/// method has only the knot's basin in common with the sequence of quadratic programs. It ends at the curve's own number of
/// vertices, so that the two lengths can be compared.
///
/// # Errors
/// [`KnotError::NotTightened`] if the method fails, [`KnotError::PassedThroughItself`] if it changed the type.
pub fn second_opinion(tight: &TightKnot) -> Result<SecondOpinion, KnotError> {
    second_opinion_until(tight, &Interrupt::new())
}

/// As [`second_opinion`], but stopped when `interrupt` requests it.
///
/// # Errors
/// As [`second_opinion`], and [`KnotError::Interrupted`] with the curve of the first method.
pub fn second_opinion_until(
    tight: &TightKnot,
    interrupt: &Interrupt,
) -> Result<SecondOpinion, KnotError> {
    let kind = Topology::Knot(tight.certificate.invariants.clone());
    let first = First {
        name: &tight.name,
        curves: tight.curve.clone().into(),
        length_over_radius: tight.length_over_radius,
        kind,
    };
    let cut_short = || tight.clone().interrupted();
    Ok(opinion(&first, interrupt, cut_short)?.with(Curves::into_first))
}

/// As [`second_opinion`], of a link.
///
/// # Errors
/// As [`second_opinion`].
///
/// # Validation
/// `val_two_methods_agree_on_tight_links`
pub fn second_opinion_of_link(
    tight: &TightLink,
) -> Result<SecondOpinion<Vec<Polyline>>, KnotError> {
    second_opinion_of_link_until(tight, &Interrupt::new())
}

/// As [`second_opinion_of_link`], but stopped when `interrupt` requests it.
///
/// # Errors
/// As [`second_opinion`], and [`KnotError::InterruptedLink`] with the curves of the first method.
pub fn second_opinion_of_link_until(
    tight: &TightLink,
    interrupt: &Interrupt,
) -> Result<SecondOpinion<Vec<Polyline>>, KnotError> {
    let kind = Topology::Link(tight.certificate.invariants.clone());
    let first = First {
        name: &tight.name,
        curves: tight.curves.clone().into(),
        length_over_radius: tight.length_over_radius,
        kind,
    };
    let cut_short = || tight.clone().interrupted();
    Ok(opinion(&first, interrupt, cut_short)?.with(Curves::into_parts))
}

impl<A> SecondOpinion<A> {
    /// The numbers alone.
    pub fn without_curves(self) -> SecondOpinion<()> {
        self.with(drop)
    }

    fn with<C>(self, change: impl FnOnce(A) -> C) -> SecondOpinion<C> {
        SecondOpinion {
            curve: change(self.curve),
            length_over_radius: self.length_over_radius,
            start_length_over_radius: self.start_length_over_radius,
            converged: self.converged,
            n_evaluations: self.n_evaluations,
            cpu_seconds: self.cpu_seconds,
        }
    }
}

/// What the first method came to.
struct First<'a> {
    name: &'a str,
    curves: Curves,
    length_over_radius: f64,
    kind: Topology,
}

fn opinion(
    first: &First<'_>,
    interrupt: &Interrupt,
    cut_short: impl Fn() -> KnotError,
) -> Result<SecondOpinion<Curves>, KnotError> {
    let stop = Stop::at(interrupt);
    let clock = CpuClock::start();
    let n_fine = first.curves.n_vertices();
    let failed = |n: usize| KnotError::NotTightened {
        knot: first.name.to_owned(),
        n_starts: 1,
        last: format!("the second method failed at {n} vertices"),
    };
    let check = |curves: &Curves, stage| check_type(first.name, curves, &first.kind, stage);
    let mut n = ((COARSE * first.length_over_radius) as usize).clamp(16, n_fine);
    let mut curves = first.curves.resampled(n)?.smoothed(LOOSENING)?;
    check(&curves, "loosening the start of the second method")?;
    let start_length_over_radius = curves.length() / curves.thickness().tau;
    let mut n_evaluations = 0;
    loop {
        let tolerance = if n == n_fine { FINE } else { ROUGH };
        let settled = settle(&curves, tolerance, &stop).ok_or_else(|| failed(n))?;
        if stop.asks() {
            return Err(cut_short());
        }
        n_evaluations += settled.n_evaluations;
        check(&settled.curves, "tightening by the second method")?;
        curves = settled.curves;
        if n == n_fine {
            let curve = curves.scaled(1.0 / curves.thickness_brute_force().tau)?;
            return Ok(SecondOpinion {
                length_over_radius: curve.length() / curve.thickness_brute_force().tau,
                curve,
                start_length_over_radius,
                converged: settled.converged,
                n_evaluations,
                cpu_seconds: clock.seconds(),
            });
        }
        n = if 3 * n > 2 * n_fine { n_fine } else { 2 * n };
        curves = refined(&curves, n)?;
    }
}
