//! A second opinion on a tight knot, by another method from a loosened start.

use serde::{Deserialize, Serialize};
use topo_core::{CpuClock, Interrupt, Polyline};

use super::augmented::settle;
use super::check::check_type;
use super::stop::Stop;
use super::{TightKnot, refined};
use crate::{KnotError, thickness, thickness_brute_force};

/// Vertices per unit of ropelength of the loosened start.
const COARSE: f64 = 4.0;
/// Passes of the binomial filter that take the start out of its tight state.
const LOOSENING: usize = 12;
/// Violation of constraints, in tube radii, that is let pass on a coarse level and on the last.
const ROUGH: f64 = 1e-3;
const FINE: f64 = 2e-5;

/// What the second method says of a tight knot.
///
/// # Validation
/// `val_two_methods_agree_on_tight_knots`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SecondOpinion {
    /// The curve, scaled to thickness 1.
    pub curve: Polyline,
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
    let stop = Stop::at(interrupt);
    let clock = CpuClock::start();
    let n_fine = tight.curve.n_vertices();
    let failed = |n: usize| KnotError::NotTightened {
        knot: tight.name.clone(),
        n_starts: 1,
        last: format!("the second method failed at {n} vertices"),
    };
    let mut n = ((COARSE * tight.length_over_radius) as usize).clamp(16, n_fine);
    let mut curve = tight.curve.resampled(n)?.smoothed(LOOSENING)?;
    let kind = &tight.certificate.invariants;
    check_type(
        &tight.name,
        &curve,
        kind,
        "loosening the start of the second method",
    )?;
    let start_length_over_radius = curve.length() / thickness(&curve).tau;
    let mut n_evaluations = 0;
    loop {
        let tolerance = if n == n_fine { FINE } else { ROUGH };
        let settled = settle(&curve, tolerance, &stop).ok_or_else(|| failed(n))?;
        if stop.asks() {
            return Err(KnotError::Interrupted {
                best: Box::new(tight.clone()),
            });
        }
        n_evaluations += settled.n_evaluations;
        check_type(
            &tight.name,
            &settled.curve,
            kind,
            "tightening by the second method",
        )?;
        curve = settled.curve;
        if n == n_fine {
            let curve = curve.scaled(1.0 / thickness_brute_force(&curve).tau)?;
            return Ok(SecondOpinion {
                length_over_radius: curve.length() / thickness_brute_force(&curve).tau,
                curve,
                start_length_over_radius,
                converged: settled.converged,
                n_evaluations,
                cpu_seconds: clock.seconds(),
            });
        }
        n = if 3 * n > 2 * n_fine { n_fine } else { 2 * n };
        curve = refined(&curve, n)?;
    }
}
