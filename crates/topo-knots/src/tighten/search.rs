//! The search for the basin: all starts and their variants at low resolution, then kicks to the best.

use rand::SeedableRng;
use rand_pcg::Pcg64;
use topo_core::Polyline;

use super::kick::kick;
use super::level::{Level, Outcome, tighten_level};
use super::settings::TightenSettings;
use super::{Invariants, KnotError, check_type};
use crate::thickness;

/// Amplitude of kicks in units of the thickness; below 1 strands cannot pass each other.
const KICK: f64 = 0.7;
/// Vertices per unit of ropelength that a loose start needs to bend freely.
const LOOSE_PER_UNIT: f64 = 0.8;
/// Curves that share the kicks at first.
const N_FINALISTS: usize = 2;

/// Tightens all starts coarsely and hops between basins from the best; returns the shortest of type `kind`.
pub(crate) fn search(
    name: &str,
    starts: &[Polyline],
    kind: &Invariants,
    settings: &TightenSettings,
) -> Result<Outcome, KnotError> {
    let mut rng = Pcg64::seed_from_u64(settings.seed);
    let mut pool: Vec<Outcome> = Vec::new();
    let mut last = "no start could be tightened".to_owned();
    let mut n_factorisations = 0;
    for start in starts {
        check_type(name, start, kind, "preparing the starts")?;
        for variant in 0..=settings.n_variants {
            let varied = if variant == 0 {
                Some(start.clone())
            } else {
                kick(start, KICK * thickness(start).tau, &mut rng)
            };
            let outcome = varied.and_then(|curve| tighten_loose(&curve, settings));
            match outcome.map(|o| (check_type(name, &o.curve, kind, "searching"), o)) {
                Some((Ok(()), outcome)) => {
                    n_factorisations += outcome.n_factorisations;
                    pool.push(outcome);
                }
                Some((Err(error), _)) => last = error.to_string(),
                None => {}
            }
        }
    }
    pool.sort_by(|a, b| a.ropelength.total_cmp(&b.ropelength));
    pool.truncate(N_FINALISTS);
    for k in 0..settings.n_kicks {
        // The first half of the kicks is shared, the second half goes to the leader.
        let place = if 2 * k < settings.n_kicks {
            k % N_FINALISTS
        } else {
            0
        };
        let Some(curve) = pool.get(place).map(|o| &o.curve) else {
            continue;
        };
        let Some(kicked) = kick(curve, KICK * thickness(curve).tau, &mut rng) else {
            continue;
        };
        let Some(outcome) = tighten_level(&kicked, &level()) else {
            continue;
        };
        n_factorisations += outcome.n_factorisations;
        if outcome.ropelength < pool[place].ropelength
            && check_type(name, &outcome.curve, kind, "searching").is_ok()
        {
            pool[place] = outcome;
            pool.sort_by(|a, b| a.ropelength.total_cmp(&b.ropelength));
        }
    }
    match pool.into_iter().next() {
        Some(best) => Ok(Outcome {
            n_factorisations,
            ..best
        }),
        None => Err(KnotError::NotTightened {
            knot: name.to_owned(),
            n_starts: starts.len(),
            last,
        }),
    }
}

fn level() -> Level {
    Level {
        damping: 0.02,
        curvature_damping: 0.1,
        tolerance: 1e-3,
        rest: 0.3,
        enough: 0.0,
        max_steps: 100,
    }
}

/// Tightens a start that may be several times too long: first with as many vertices as it needs to bend.
fn tighten_loose(start: &Polyline, settings: &TightenSettings) -> Option<Outcome> {
    let n = settings.search_vertices;
    let n_loose =
        (LOOSE_PER_UNIT * start.length() / thickness(start).tau).min(4.0 * n as f64) as usize;
    let mut curve = start.clone();
    let mut n_factorisations = 0;
    if n_loose > n {
        let loose = Level {
            tolerance: 2e-2,
            max_steps: 60,
            enough: n as f64,
            ..level()
        };
        let outcome = tighten_level(&start.resampled(n_loose).ok()?, &loose)?;
        n_factorisations = outcome.n_factorisations;
        curve = outcome.curve;
    }
    let mut outcome = tighten_level(&curve.resampled(n).ok()?, &level())?;
    outcome.n_factorisations += n_factorisations;
    Some(outcome)
}
