//! From curves of a search through ever finer levels to the tight shape.

use topo_core::CpuClock;

use super::level::{LOOSE_REACH, Level, NEAR_REACH, Outcome, tighten_level};
use super::stop::Stop;
use super::topology::{Topology, check_type};
use super::{TightenSettings, search};
use crate::KnotError;
use crate::curves::Curves;

/// Vertices per unit of ropelength above which a level starts from curves that are nearly tight.
const WELL_RESOLVED: f64 = 8.0;
/// Levels before the last need not come to rest better than this.
const COARSE_TOLERANCE: f64 = 1e-4;
/// Fewest vertices of all curves.
const LEAST_VERTICES: usize = 16;

/// Tight curves, before their certificate.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    /// At thickness 1.
    pub curves: Curves,
    /// Whether the length came to rest at the finest level.
    pub converged: bool,
    /// Matrix factorisations made.
    pub n_factorisations: usize,
    /// Processor time, in seconds.
    pub cpu_seconds: f64,
}

/// Tightens curves given in one or more embeddings of the same type; cut short, it gives the best so far.
pub(super) fn tighten_all(
    name: &str,
    starts: &[Curves],
    settings: &TightenSettings,
    stop: &Stop,
) -> Result<Shape, KnotError> {
    let clock = CpuClock::start();
    settings.check()?;
    let Some(first) = starts.first() else {
        return Err(KnotError::NotTightened {
            knot: name.to_owned(),
            n_starts: 0,
            last: "no start given".to_owned(),
        });
    };
    let kind = Topology::of(first)?;
    let (found, n_factorisations) = search::search(name, starts, &kind, settings, stop)?;
    let finalists = found.into_iter().take(settings.n_finalists());
    let curves = finalists.map(|outcome| outcome.curves).collect();
    let mut shape = refine_all(name, curves, &kind, settings, stop)?;
    shape.n_factorisations += n_factorisations;
    shape.cpu_seconds = clock.seconds();
    Ok(shape)
}

/// Takes curves of type `kind` through all levels; the shortest at the first one goes on.
pub(super) fn refine_all(
    name: &str,
    mut curves: Vec<Curves>,
    kind: &Topology,
    settings: &TightenSettings,
    stop: &Stop,
) -> Result<Shape, KnotError> {
    let (mut n_factorisations, mut converged) = (0, false);
    for per_unit in settings.levels() {
        if stop.asks() {
            converged = false;
            break;
        }
        let mut finer: Vec<Outcome> = Vec::new();
        for curve in &curves {
            let outcome = refine(curve, per_unit, settings, stop)?
                .filter(|outcome| check_type(name, &outcome.curves, kind, "tightening").is_ok());
            n_factorisations += outcome.as_ref().map_or(0, |o| o.n_factorisations);
            finer.extend(outcome);
        }
        let best = finer
            .into_iter()
            .min_by(|a, b| a.ropelength.total_cmp(&b.ropelength));
        let Some(best) = best else {
            // The level before is still a tight curve of the right type.
            tracing::warn!(name, per_unit, "a level failed, the one before it is kept");
            converged = false;
            break;
        };
        // a level that was cut short need not have come below what it started from
        if stop.asks() && curves[0].ropelength() < best.ropelength {
            converged = false;
            break;
        }
        converged = best.converged;
        curves = vec![best.curves];
    }
    let curves = curves.swap_remove(0);
    Ok(Shape {
        curves: curves.scaled(1.0 / curves.thickness().tau)?,
        converged,
        n_factorisations,
        cpu_seconds: 0.0,
    })
}

/// Tightens curves at a resolution; `None` if a quadratic program fails.
fn refine(
    curves: &Curves,
    per_unit: f64,
    settings: &TightenSettings,
    stop: &Stop,
) -> Result<Option<Outcome>, KnotError> {
    let n = (per_unit * curves.length() / curves.thickness().tau).round() as usize;
    let n = n.max(LEAST_VERTICES);
    let is_last = per_unit == settings.per_unit;
    let is_near = per_unit > WELL_RESOLVED;
    let level = Level {
        weights: [1.0; 3],
        damping: 0.05,
        curvature_damping: 0.1,
        tolerance: if is_last {
            settings.tolerance
        } else {
            settings.tolerance.max(COARSE_TOLERANCE)
        },
        rest: 0.1,
        enough: 0.0,
        reach: if is_near { NEAR_REACH } else { LOOSE_REACH },
        max_steps: settings.max_steps,
    };
    let start = if is_near {
        refined(curves, n)?
    } else {
        curves.resampled(n)?
    };
    Ok(tighten_level(&start, &level, stop))
}

/// Tight curves at more vertices, smoothed: the spline sharpens some so much that the whole curve would have to grow.
pub(super) fn refined(curves: &Curves, n: usize) -> Result<Curves, KnotError> {
    curves.resampled(n)?.smoothed(2)
}
