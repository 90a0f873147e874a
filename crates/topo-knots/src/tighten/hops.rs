//! Hops between basins: a random walk over tight curves that may go uphill, restarted from other words of the knot.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::kick::{kick, squeeze};
use super::level::Outcome;
use super::origin::Origin;
use super::search::{KICK, NEAR_TIE, tighten_loose};
use super::settings::TightenSettings;
use super::start::{MOEBIUS_EDGES, MOEBIUS_STEPS, padded, stabilised};
use super::stop::Stop;
use super::topology::{Topology, check_type};
use crate::curves::Curves;
use crate::inversion::inverted;
use crate::moebius::relax_moebius_of;
use crate::{KnotError, braid_closure};

/// Relative rise of the ropelength that is accepted once in e hops.
const TEMPERATURE: f64 = 2e-3;
/// Hops without a new best after which a walk ends and another begins.
const PATIENCE: usize = 20;
/// Relative fall of the ropelength that counts as a new best.
const PROGRESS: f64 = 2e-4;
/// Curves whose writhes differ by less and whose lengths by less than `SAME_LENGTH` lie in one basin.
const SAME_WRITHE: f64 = 0.02;
const SAME_LENGTH: f64 = 5e-4;
/// Starts in a row that lead nowhere before the walk is given up.
const MOST_FAILURES: usize = 100;

/// Walks from tight curve to tight curve, `n_hops` hops in all; returns one curve of each basin that comes within one
/// percent of the best, the shortest first, and the number of factorisations.
///
/// A hop is a kick, one or two squeezes, or an inversion of the rounded curve, each tightened again. It is accepted as in simulated annealing at a constant
/// temperature, so that a walk gets over what the descending search of [`super::search`] does not. Starts are the closures of random words of the
/// knot's braid, most of them rounded, some inverted; curves of the table are left out.
///
/// # Errors
/// [`KnotError::NotTightened`] if no start leads anywhere.
///
/// # Validation
/// `hops_lead_to_published_lengths`
pub(super) fn hop(
    entry: &impl Origin,
    kind: &Topology,
    n_hops: usize,
    settings: &TightenSettings,
    stop: &Stop,
) -> Result<(Vec<Outcome>, usize), KnotError> {
    let mut rng = Pcg64::seed_from_u64(settings.seed);
    let mut met: Vec<Outcome> = Vec::new();
    let (mut n_done, mut n_failures, mut n_factorisations) = (0, 0, 0);
    let sound = |o: &Outcome| check_type(entry.name(), &o.curves, kind, "searching").is_ok();
    let is_over = |met: &[Outcome]| !met.is_empty() && stop.asks();
    while n_done < n_hops && n_failures < MOST_FAILURES && !is_over(&met) {
        let tightened = start(entry, &mut rng).and_then(|s| tighten_loose(&s, settings, stop));
        let Some(mut state) = tightened.filter(sound) else {
            n_failures += 1;
            continue;
        };
        n_failures = 0;
        n_factorisations += state.n_factorisations;
        let mut best = state.ropelength;
        keep(&mut met, &state);
        let mut idle = 0;
        while idle < PATIENCE && n_done < n_hops && !is_over(&met) {
            idle += 1;
            n_done += 1;
            let Some(next) =
                moved(&state.curves, &mut rng).and_then(|c| tighten_loose(&c, settings, stop))
            else {
                continue;
            };
            n_factorisations += next.n_factorisations;
            let u: f64 = rng.random_range(0.0..1.0);
            let limit = state.ropelength * (1.0 - TEMPERATURE * u.ln());
            if next.ropelength < limit && sound(&next) {
                if next.ropelength < best * (1.0 - PROGRESS) {
                    idle = 0;
                }
                best = best.min(next.ropelength);
                keep(&mut met, &next);
                state = next;
            }
        }
    }
    met.sort_by(|a, b| a.ropelength.total_cmp(&b.ropelength));
    if met.is_empty() {
        return Err(KnotError::NotTightened {
            knot: entry.name().to_owned(),
            n_starts: n_failures,
            last: "no random word led to a tight curve".to_owned(),
        });
    }
    Ok((met, n_factorisations))
}

/// Adds a curve unless its basin is known; drops what is far from the best.
fn keep(met: &mut Vec<Outcome>, found: &Outcome) {
    let writhe = found.curves.writhe();
    let same = |o: &Outcome| {
        (o.curves.writhe() - writhe).abs() < SAME_WRITHE
            && (o.ropelength / found.ropelength - 1.0).abs() < SAME_LENGTH
    };
    match met.iter_mut().find(|o| same(o)) {
        Some(known) if known.ropelength <= found.ropelength => {}
        Some(known) => *known = found.clone(),
        None => met.push(found.clone()),
    }
    let shortest = |least: f64, o: &Outcome| least.min(o.ropelength);
    let limit = met.iter().fold(f64::INFINITY, shortest) * (1.0 + NEAR_TIE);
    met.retain(|o| o.ropelength < limit);
}

/// The closure of a random word of the knot's braid, plain, rounded or rounded and inverted; `None` if it comes out badly.
fn start(entry: &impl Origin, rng: &mut Pcg64) -> Option<Curves> {
    let braid = entry.braid();
    let word = match rng.random_range(0..4) {
        0 => padded(braid, rng),
        1 => {
            let word = stabilised(braid, rng);
            stabilised(&word, rng)
        }
        _ => stabilised(braid, rng),
    };
    let mut curve = Curves::from(braid_closure(&word).ok()?);
    if rng.random_bool(0.7) {
        curve = relax_moebius_of(&curve, MOEBIUS_EDGES[0], MOEBIUS_STEPS).ok()?;
        entry.verify(&curve).ok()?;
        if rng.random_bool(0.6) {
            curve = inverted(&curve, rng).ok()??;
        }
    }
    entry.verify(&curve).ok()?;
    Some(curve)
}

/// A curve of the same type some way off.
fn moved(curve: &Curves, rng: &mut Pcg64) -> Option<Curves> {
    match rng.random_range(0..6) {
        0 | 1 => kick(curve, KICK * curve.thickness().tau, rng),
        2 => squeeze(&squeeze(curve, rng)?, rng),
        3 => {
            let round = relax_moebius_of(curve, MOEBIUS_EDGES[0], MOEBIUS_STEPS / 2).ok()?;
            inverted(&round, rng).ok()?
        }
        _ => squeeze(curve, rng),
    }
}
