//! Tight knots: several starts, a search for the basin at low resolution, then ever finer polygons.

mod augmented;
mod certificate;
mod check;
mod constraints;
mod hops;
mod kick;
mod lbfgs;
mod level;
mod qp;
mod search;
mod second;
mod settings;
mod start;
mod stop;
mod struts;

pub use certificate::Certificate;
pub use second::{SecondOpinion, second_opinion, second_opinion_until};
pub use settings::TightenSettings;
pub use struts::struts;

use std::f64::consts::TAU;

use rand::SeedableRng;
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use topo_core::Polyline;

use crate::inversion::inverted;
use crate::moebius::relax_moebius;
use crate::{Invariants, KnotEntry, KnotError, closed_braid, mirror_name, thickness};
use check::check_type;
use level::{LOOSE_REACH, Level, NEAR_REACH, Outcome, tighten_level};
use start::{MOEBIUS_EDGES, MOEBIUS_STEPS, padded, stabilised};
use stop::Stop;
pub(crate) use stop::mirrored;
use topo_core::{CpuClock, Interrupt};

/// Random words that keep the number of strands; further ones get more.
const N_PADDED: usize = 2;
/// Vertices per unit of ropelength of the curve that is inverted.
const LEAST_PER_UNIT: f64 = 4.0;
/// Vertices per unit of ropelength above which a level starts from a curve that is nearly tight.
const WELL_RESOLVED: f64 = 8.0;
/// Vertices of the tight unknot: it is 2e-5 longer than the circle.
const CIRCLE_VERTICES: usize = 400;
/// Levels before the last need not come to rest better than this.
const COARSE_TOLERANCE: f64 = 1e-4;

/// A tight knot with the evidence for it.
///
/// # Validation
/// `all_knots_are_tight`, `long_all_knots_are_tight_at_eight_vertices_a_unit`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TightKnot {
    /// Name of the knot.
    pub name: String,
    /// The curve, scaled to thickness 1.
    pub curve: Polyline,
    /// Its length, in units of the tube radius.
    pub length_over_radius: f64,
    /// What was checked on the curve itself.
    pub certificate: Certificate,
    /// Processor time that it took, in seconds.
    pub cpu_seconds: f64,
    /// Matrix factorisations that it took.
    pub n_factorisations: usize,
}

impl TightKnot {
    /// Centreline of a rod: the tight curve after two passes of the binomial filter (1, 2, 1)/4, since it has jumps of curvature.
    ///
    /// # Errors
    /// [`KnotError::Curve`] if smoothing makes vertices coincide.
    pub fn centreline(&self) -> Result<Polyline, KnotError> {
        Ok(self.curve.smoothed(2)?)
    }

    /// The tight shape of the mirror image, to the bit: turned around in the plane z = 0, with the other name and writhe.
    ///
    /// # Validation
    /// `mirror_images_are_tightened_as_the_knot_itself`
    pub fn mirror(&self) -> Self {
        let certificate = Certificate {
            // not -0 for a planar curve
            writhe: 0.0 - self.certificate.writhe,
            invariants: self.certificate.invariants.mirror(),
            ..self.certificate.clone()
        };
        Self {
            name: mirror_name(&self.name),
            curve: self.curve.mirrored(),
            certificate,
            ..self.clone()
        }
    }
}

/// Tightens a knot of the table from several starts: its curve or closed braid, plain and rounded, the closures of its other
/// words and of random words of the same braid, and inversions of the best of these if the settings include them.
///
/// A mirror image is the mirror image of the tightened knot, to the bit: the search is random and would otherwise find another
/// shape. The tight unknot is the circle, and nothing is searched for.
///
/// # Errors
/// As [`tighten`], and [`KnotError::Mismatch`] if a start contradicts the invariants of the entry.
///
/// # Validation
/// `mirror_images_are_tightened_as_the_knot_itself`, `the_tight_unknot_is_the_circle`
pub fn tighten_entry(
    entry: &KnotEntry,
    settings: &TightenSettings,
) -> Result<TightKnot, KnotError> {
    tighten_entry_until(entry, settings, &Interrupt::new())
}

/// As [`tighten_entry`], but ended early when `interrupt` requests it.
///
/// # Errors
/// As [`tighten_entry`], and [`KnotError::Interrupted`] with the best curve so far.
///
/// # Validation
/// `an_interrupted_search_gives_its_best_curve`
pub fn tighten_entry_until(
    entry: &KnotEntry,
    settings: &TightenSettings,
    interrupt: &Interrupt,
) -> Result<TightKnot, KnotError> {
    if entry.is_mirror_image() {
        let itself = tighten_entry_until(&entry.mirror(), settings, interrupt);
        return mirrored(itself);
    }
    let (clock, stop) = (CpuClock::start(), Stop::at(interrupt));
    settings.check()?;
    let plain = entry.start_curve()?;
    if entry.is_unknot() {
        entry.verify(&plain)?;
        return circle(entry, clock);
    }
    let mut starts = vec![plain];
    for n_edges in MOEBIUS_EDGES {
        // A curve that is too long for so few edges is no loss: the other starts remain.
        let Ok(round) = relax_moebius(&starts[0], n_edges, MOEBIUS_STEPS) else {
            continue;
        };
        // A long start needs more edges, or its strands pass through each other.
        if entry.verify(&round).is_ok() {
            starts.push(round);
            break;
        }
    }
    for word in &entry.other_braids {
        starts.push(closed_braid(word)?);
    }
    let mut rng = Pcg64::seed_from_u64(settings.seed);
    // Words and curves of the table were chosen for the basins that they lead to: one random word less is needed.
    let n_chosen = usize::from(!entry.other_braids.is_empty() || entry.start.is_some());
    for k in 0..settings.n_variants.saturating_sub(n_chosen) {
        if !entry.braid.is_empty() {
            let word = if k < N_PADDED {
                padded(&entry.braid, &mut rng)
            } else {
                stabilised(&entry.braid, &mut rng)
            };
            starts.push(closed_braid(&word)?);
        }
    }
    for start in &starts {
        entry.verify(start)?;
    }
    if settings.n_inversions > 0 {
        starts.extend(inversions(entry, &starts, settings, &stop)?);
    }
    let mut tight = tighten_all(&entry.name, &starts, settings, &stop)?;
    tight.cpu_seconds = clock.seconds();
    stop.unless_cut_short(tight)
}

/// Curves of the walk that go on to the first level: the resolution of the walk does not decide between them.
const N_MET: usize = 6;

/// Tightens a knot of the table from what `n_hops` hops between basins come to, begun from random words of its braid, instead of its
/// own starts: for knots whose starts end in poor minima. The seed of the settings decides which basins are met.
///
/// A hop takes about half a second at 150 vertices.
///
/// # Errors
/// As [`tighten`], and those of a braid that is no word of the knot.
///
/// # Validation
/// `hops_lead_to_published_lengths`
pub fn tighten_by_hops(
    entry: &KnotEntry,
    n_hops: usize,
    settings: &TightenSettings,
) -> Result<TightKnot, KnotError> {
    tighten_by_hops_until(entry, n_hops, settings, &Interrupt::new())
}

/// As [`tighten_by_hops`], but ended early when `interrupt` requests it.
///
/// # Errors
/// As [`tighten_by_hops`], and [`KnotError::Interrupted`] with the best curve so far.
pub fn tighten_by_hops_until(
    entry: &KnotEntry,
    n_hops: usize,
    settings: &TightenSettings,
    interrupt: &Interrupt,
) -> Result<TightKnot, KnotError> {
    if entry.is_mirror_image() {
        let itself = tighten_by_hops_until(&entry.mirror(), n_hops, settings, interrupt);
        return mirrored(itself);
    }
    let (clock, stop) = (CpuClock::start(), Stop::at(interrupt));
    settings.check()?;
    let kind = entry.verify(&closed_braid(&entry.braid)?)?;
    let (met, n_factorisations) = hops::hop(entry, &kind, n_hops, settings, &stop)?;
    let curves = met.into_iter().take(N_MET).map(|o| o.curve).collect();
    let mut tight = refine_all(&entry.name, curves, &kind, settings, &stop)?;
    tight.n_factorisations += n_factorisations;
    tight.cpu_seconds = clock.seconds();
    stop.unless_cut_short(tight)
}

/// The tight unknot: the regular polygon on a circle.
fn circle(entry: &KnotEntry, clock: CpuClock) -> Result<TightKnot, KnotError> {
    let at = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / CIRCLE_VERTICES as f64).sin_cos();
        crate::V::new(cos, sin, 0.0)
    };
    let curve = Polyline::new((0..CIRCLE_VERTICES).map(at).collect(), true)?;
    let curve = curve.scaled(1.0 / thickness(&curve).tau)?;
    let certificate = Certificate::of(&curve, true)?;
    Ok(TightKnot {
        name: entry.name.clone(),
        length_over_radius: curve.length() / certificate.tau(),
        curve,
        certificate,
        cpu_seconds: clock.seconds(),
        n_factorisations: 0,
    })
}

/// Inversions of the best that the starts lead to, rounded.
fn inversions(
    entry: &KnotEntry,
    starts: &[Polyline],
    settings: &TightenSettings,
    stop: &Stop,
) -> Result<Vec<Polyline>, KnotError> {
    let coarse = TightenSettings {
        per_unit: LEAST_PER_UNIT,
        n_kicks: 0,
        ..*settings
    };
    let tight = tighten_all(&entry.name, starts, &coarse, stop)?;
    let round = relax_moebius(&tight.curve, MOEBIUS_EDGES[0], MOEBIUS_STEPS)?;
    let mut rng = Pcg64::seed_from_u64(settings.seed);
    let mut found = Vec::new();
    for _ in 0..settings.n_inversions {
        if stop.asks() {
            break;
        }
        if let Some(curve) = inverted(&round, &mut rng)?
            && entry.verify(&curve).is_ok()
        {
            found.push(curve);
        }
    }
    Ok(found)
}

/// Tightens a closed curve, given in one or more embeddings of the same knot type; the shortest result wins.
///
/// The type is compared after each start, kick and level, so that a curve that passed through itself never wins.
///
/// # Errors
/// [`KnotError::Setting`] for settings out of range, [`KnotError::PassedThroughItself`] when a start differs in type from
/// the first one, [`KnotError::NotTightened`] when no start leads anywhere. A level that fails or changes the type is given up:
/// the curve before it is returned as not converged.
///
/// # References
/// [ashton2011], [rawdon2003]
///
/// [ashton2011]: https://doi.org/10.1080/10586458.2011.544581
/// [rawdon2003]: https://eudml.org/doc/51725
pub fn tighten(
    name: &str,
    starts: &[Polyline],
    settings: &TightenSettings,
) -> Result<TightKnot, KnotError> {
    tighten_all(name, starts, settings, &Stop::default())
}

/// As [`tighten`]; cut short, it gives the best curve so far.
fn tighten_all(
    name: &str,
    starts: &[Polyline],
    settings: &TightenSettings,
    stop: &Stop,
) -> Result<TightKnot, KnotError> {
    let clock = CpuClock::start();
    settings.check()?;
    let Some(first) = starts.first() else {
        return Err(KnotError::NotTightened {
            knot: name.to_owned(),
            n_starts: 0,
            last: "no start given".to_owned(),
        });
    };
    let kind = Invariants::of(first.vertices())?;
    let (found, n_factorisations) = search::search(name, starts, &kind, settings, stop)?;
    let finalists = found.into_iter().take(settings.n_finalists());
    let curves = finalists.map(|outcome| outcome.curve).collect();
    let mut tight = refine_all(name, curves, &kind, settings, stop)?;
    tight.n_factorisations += n_factorisations;
    tight.cpu_seconds = clock.seconds();
    Ok(tight)
}

/// Takes curves of type `kind` through all levels; the shortest at the first one goes on.
fn refine_all(
    name: &str,
    mut curves: Vec<Polyline>,
    kind: &Invariants,
    settings: &TightenSettings,
    stop: &Stop,
) -> Result<TightKnot, KnotError> {
    let (mut n_factorisations, mut converged) = (0, false);
    for per_unit in settings.levels() {
        if stop.asks() {
            converged = false;
            break;
        }
        let mut finer: Vec<Outcome> = Vec::new();
        for curve in &curves {
            let outcome = refine(curve, per_unit, settings, stop)?
                .filter(|outcome| check_type(name, &outcome.curve, kind, "tightening").is_ok());
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
        curves = vec![best.curve];
    }
    let curve = curves.swap_remove(0);
    let curve = curve.scaled(1.0 / thickness(&curve).tau)?;
    let certificate = Certificate::of(&curve, converged)?;
    Ok(TightKnot {
        name: name.to_owned(),
        length_over_radius: curve.length() / certificate.tau(),
        curve,
        certificate,
        cpu_seconds: 0.0,
        n_factorisations,
    })
}

/// Tightens a curve at a resolution; `None` if a quadratic program fails.
fn refine(
    curve: &Polyline,
    per_unit: f64,
    settings: &TightenSettings,
    stop: &Stop,
) -> Result<Option<Outcome>, KnotError> {
    let n = ((per_unit * curve.length() / thickness(curve).tau).round() as usize).max(16);
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
        refined(curve, n)?
    } else {
        curve.resampled(n)?
    };
    Ok(tighten_level(&start, &level, stop))
}

/// A tight curve at more vertices, smoothed: the spline sharpens some so much that the whole curve would have to grow.
fn refined(curve: &Polyline, n: usize) -> Result<Polyline, KnotError> {
    Ok(curve.resampled(n)?.smoothed(2)?)
}

#[cfg(test)]
mod tests;
