//! Tight knots and links: several starts, a search for the basin at low resolution, then ever finer polygons.

mod augmented;
mod certificate;
mod constraints;
mod hops;
mod kick;
mod lbfgs;
mod level;
mod origin;
mod pairs;
mod qp;
mod search;
mod second;
mod settings;
mod shape;
mod start;
mod stop;
mod struts;
mod topology;

pub use certificate::Certificate;
pub use second::{
    SecondOpinion, second_opinion, second_opinion_of_link, second_opinion_of_link_until,
    second_opinion_until,
};
pub use settings::TightenSettings;
pub use struts::{struts, struts_of_all};

use std::f64::consts::TAU;

use rand::SeedableRng;
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use topo_core::Polyline;

use crate::curves::Curves;
use crate::inversion::inverted;
use crate::moebius::relax_moebius_of;
use crate::{
    KnotEntry, KnotError, LinkEntry, LinkInvariants, braid_closure, mirror_name, thickness,
};
pub(crate) use origin::{Origin, Tight};
use shape::{Shape, refine_all, tighten_all};
use start::{MOEBIUS_EDGES, MOEBIUS_STEPS, padded, stabilised};
use stop::Stop;
pub(crate) use stop::mirrored;
use topo_core::{CpuClock, Interrupt};

/// Random words that keep the number of strands; further ones get more.
const N_PADDED: usize = 2;
/// Vertices per unit of ropelength of the curve that is inverted.
const LEAST_PER_UNIT: f64 = 4.0;
/// Vertices of the tight unknot: it is 2e-5 longer than the circle.
const CIRCLE_VERTICES: usize = 400;
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

/// A tight link with the evidence for it.
///
/// # Validation
/// `val_tight_links_have_their_exact_lengths`, `val_torus_links_are_as_short_as_published`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TightLink {
    /// Name of the link.
    pub name: String,
    /// The components, scaled to thickness 1 together.
    pub curves: Vec<Polyline>,
    /// The sum of their lengths, in units of the tube radius.
    pub length_over_radius: f64,
    /// What was checked on the curves themselves.
    pub certificate: Certificate<LinkInvariants>,
    /// Processor time that it took, in seconds.
    pub cpu_seconds: f64,
    /// Matrix factorisations that it took.
    pub n_factorisations: usize,
}

impl TightLink {
    /// Centrelines of rods, as [`TightKnot::centreline`].
    ///
    /// # Errors
    /// As [`TightKnot::centreline`].
    pub fn centrelines(&self) -> Result<Vec<Polyline>, KnotError> {
        let curves = self.curves.iter();
        Ok(curves.map(|c| c.smoothed(2)).collect::<Result<_, _>>()?)
    }

    /// The tight shape of the mirror image, to the bit, as [`TightKnot::mirror`].
    pub fn mirror(&self) -> Self {
        let certificate = Certificate {
            writhe: 0.0 - self.certificate.writhe,
            invariants: self.certificate.invariants.mirror(),
            ..self.certificate.clone()
        };
        Self {
            name: mirror_name(&self.name),
            curves: self.curves.iter().map(Polyline::mirrored).collect(),
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
    tighten_origin(entry, settings, interrupt)
}

/// Tightens a link as [`tighten_entry`] does a knot: the sum of the lengths of its components at the thickness of all together.
///
/// # Errors
/// As [`tighten_entry`].
///
/// # Validation
/// `val_tight_links_have_their_exact_lengths`, `val_torus_links_are_as_short_as_published`
///
/// # References
/// `cantarella2002`
pub fn tighten_link(entry: &LinkEntry, settings: &TightenSettings) -> Result<TightLink, KnotError> {
    tighten_link_until(entry, settings, &Interrupt::new())
}

/// As [`tighten_link`], but ended early when `interrupt` requests it.
///
/// # Errors
/// As [`tighten_link`], and [`KnotError::InterruptedLink`] with the best curves so far.
pub fn tighten_link_until(
    entry: &LinkEntry,
    settings: &TightenSettings,
    interrupt: &Interrupt,
) -> Result<TightLink, KnotError> {
    tighten_origin(entry, settings, interrupt)
}

/// Tightens a knot or a link.
pub(crate) fn tighten_origin<O: Origin>(
    entry: &O,
    settings: &TightenSettings,
    interrupt: &Interrupt,
) -> Result<O::Tight, KnotError> {
    if entry.is_mirror_image() {
        let itself = tighten_origin(&entry.mirror(), settings, interrupt);
        return mirrored(itself);
    }
    let (clock, stop) = (CpuClock::start(), Stop::at(interrupt));
    settings.check()?;
    let plain = entry.start()?;
    if let Some(shape) = entry.known()? {
        entry.verify(&plain)?;
        return Tight::of(entry.name(), shape);
    }
    let mut starts = starts(entry, plain, settings)?;
    if settings.n_inversions > 0 {
        starts.extend(inversions(entry, &starts, settings, &stop)?);
    }
    let mut shape = tighten_all(entry.name(), &starts, settings, &stop)?;
    shape.cpu_seconds = clock.seconds();
    stop.unless_cut_short(Tight::of(entry.name(), shape)?)
}

/// Curves to start from, all of them of the type of the entry: its own, rounded, and the closures of other words.
fn starts<O: Origin>(
    entry: &O,
    plain: Curves,
    settings: &TightenSettings,
) -> Result<Vec<Curves>, KnotError> {
    let mut starts = vec![plain];
    for n_edges in MOEBIUS_EDGES {
        // A curve that is too long for so few edges is no loss: the other starts remain.
        let Ok(round) = relax_moebius_of(&starts[0], n_edges, MOEBIUS_STEPS) else {
            continue;
        };
        // A long start needs more edges, or its strands pass through each other.
        if entry.verify(&round).is_ok() {
            starts.push(round);
            break;
        }
    }
    for word in entry.other_braids() {
        starts.push(braid_closure(word)?.into());
    }
    let mut rng = Pcg64::seed_from_u64(settings.seed);
    // Words and curves of the table were chosen for the basins that they lead to: one random word less is needed.
    let n_chosen = usize::from(!entry.other_braids().is_empty() || entry.has_start());
    for k in 0..settings.n_variants.saturating_sub(n_chosen) {
        if !entry.braid().is_empty() {
            let word = if k < N_PADDED {
                padded(entry.braid(), &mut rng)
            } else {
                stabilised(entry.braid(), &mut rng)
            };
            starts.push(braid_closure(&word)?.into());
        }
    }
    for start in &starts {
        entry.verify(start)?;
    }
    Ok(starts)
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
    hop_from(entry, n_hops, settings, interrupt)
}

/// As [`tighten_by_hops_until`], of a link.
///
/// # Errors
/// As [`tighten_by_hops`], and [`KnotError::InterruptedLink`] with the best curves so far.
pub fn tighten_link_by_hops_until(
    entry: &LinkEntry,
    n_hops: usize,
    settings: &TightenSettings,
    interrupt: &Interrupt,
) -> Result<TightLink, KnotError> {
    hop_from(entry, n_hops, settings, interrupt)
}

fn hop_from<O: Origin>(
    entry: &O,
    n_hops: usize,
    settings: &TightenSettings,
    interrupt: &Interrupt,
) -> Result<O::Tight, KnotError> {
    if entry.is_mirror_image() {
        let itself = hop_from(&entry.mirror(), n_hops, settings, interrupt);
        return mirrored(itself);
    }
    let (clock, stop) = (CpuClock::start(), Stop::at(interrupt));
    settings.check()?;
    let kind = entry.verify(&braid_closure(entry.braid())?.into())?;
    let (met, n_factorisations) = hops::hop(entry, &kind, n_hops, settings, &stop)?;
    let curves = met.into_iter().take(N_MET).map(|o| o.curves).collect();
    let mut shape = refine_all(entry.name(), curves, &kind, settings, &stop)?;
    shape.n_factorisations += n_factorisations;
    shape.cpu_seconds = clock.seconds();
    stop.unless_cut_short(Tight::of(entry.name(), shape)?)
}

/// The tight unknot: the regular polygon on a circle.
fn circle(clock: CpuClock) -> Result<Shape, KnotError> {
    let at = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / CIRCLE_VERTICES as f64).sin_cos();
        crate::V::new(cos, sin, 0.0)
    };
    let curve = Polyline::new((0..CIRCLE_VERTICES).map(at).collect(), true)?;
    Ok(Shape {
        curves: curve.scaled(1.0 / thickness(&curve).tau)?.into(),
        converged: true,
        n_factorisations: 0,
        cpu_seconds: clock.seconds(),
    })
}

/// Inversions of the best that the starts lead to, rounded.
fn inversions<O: Origin>(
    entry: &O,
    starts: &[Curves],
    settings: &TightenSettings,
    stop: &Stop,
) -> Result<Vec<Curves>, KnotError> {
    let coarse = TightenSettings {
        per_unit: LEAST_PER_UNIT,
        n_kicks: 0,
        ..*settings
    };
    let tight = tighten_all(entry.name(), starts, &coarse, stop)?;
    let round = relax_moebius_of(&tight.curves, MOEBIUS_EDGES[0], MOEBIUS_STEPS)?;
    let mut rng = Pcg64::seed_from_u64(settings.seed);
    let mut found = Vec::new();
    for _ in 0..settings.n_inversions {
        if stop.asks() {
            break;
        }
        if let Some(curves) = inverted(&round, &mut rng)?
            && entry.verify(&curves).is_ok()
        {
            found.push(curves);
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
    let starts: Vec<Curves> = starts.iter().cloned().map(Curves::from).collect();
    let shape = tighten_all(name, &starts, settings, &Stop::default())?;
    Tight::of(name, shape)
}

#[cfg(test)]
mod tests;
