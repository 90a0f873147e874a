//! The search for the basin: all starts and their variants at low resolution, then kicks to the best.

use rand::SeedableRng;
use rand_pcg::Pcg64;

use super::kick::{kick, squeeze};
use super::level::{LOOSE_REACH, Level, Outcome, tighten_level};
use super::settings::TightenSettings;
use super::stop::Stop;
use super::topology::{Topology, check_type};
use crate::KnotError;
use crate::curves::Curves;

/// Amplitude of kicks in units of the thickness; below 1 strands cannot pass each other.
pub(super) const KICK: f64 = 0.7;
/// Vertices per unit of ropelength that a loose start needs to bend freely.
const LOOSE_PER_UNIT: f64 = 0.8;
/// Relative difference of ropelength that the resolution of the search does not decide.
pub(super) const NEAR_TIE: f64 = 1e-2;
/// Curves that share the kicks at first.
const N_FINALISTS: usize = 2;

/// Tightens all starts coarsely and hops between basins from the best; returns the shortest of type `kind` first, then others
/// nearly as short, and the number of factorisations.
pub(crate) fn search(
    name: &str,
    starts: &[Curves],
    kind: &Topology,
    settings: &TightenSettings,
    stop: &Stop,
) -> Result<(Vec<Outcome>, usize), KnotError> {
    let mut rng = Pcg64::seed_from_u64(settings.seed);
    let mut pool: Vec<Outcome> = Vec::new();
    let mut last = "no start could be tightened".to_owned();
    let mut n_factorisations = 0;
    for start in starts {
        if !pool.is_empty() && stop.asks() {
            break;
        }
        check_type(name, start, kind, "preparing the starts")?;
        let Some(outcome) = tighten_loose(start, settings, stop) else {
            continue;
        };
        n_factorisations += outcome.n_factorisations;
        match check_type(name, &outcome.curves, kind, "searching") {
            Ok(()) => pool.push(outcome),
            Err(error) => last = error.to_string(),
        }
    }
    let rested = pool.clone();
    // Many starts rest at saddle points high above the basin below them, so each is kicked before they are compared.
    for place in 0..pool.len() {
        for _ in 0..settings.n_kicks_a_start {
            n_factorisations += try_move(&mut pool[place], Move::Kick, name, kind, &mut rng, stop);
        }
    }
    pool.sort_by(|a, b| a.ropelength.total_cmp(&b.ropelength));
    pool.truncate(N_FINALISTS);
    for k in 0..settings.n_kicks {
        let (kind_of_move, place) = match (k % 2, k / 2 % N_FINALISTS) {
            (0, place) => (Move::Squeeze, place),
            (_, place) => (Move::Kick, place),
        };
        if let Some(finalist) = pool.get_mut(place) {
            n_factorisations += try_move(finalist, kind_of_move, name, kind, &mut rng, stop);
        }
    }
    pool.sort_by(|a, b| a.ropelength.total_cmp(&b.ropelength));
    if pool.is_empty() {
        return Err(KnotError::NotTightened {
            knot: name.to_owned(),
            n_starts: starts.len(),
            last,
        });
    }
    // At this resolution a kick may lead to a basin that is better here only: what the starts came to stays in the race.
    let limit = pool[0].ropelength * (1.0 + NEAR_TIE);
    pool.extend(rested.into_iter().filter(|o| o.ropelength < limit));
    Ok((pool, n_factorisations))
}

/// How to leave a basin.
#[derive(Clone, Copy)]
enum Move {
    /// Off a saddle point.
    Kick,
    /// Further, into another basin.
    Squeeze,
}

/// Moves a curve, tightens it again and keeps the better one; returns the number of factorisations.
fn try_move(
    best: &mut Outcome,
    how: Move,
    name: &str,
    kind: &Topology,
    rng: &mut Pcg64,
    stop: &Stop,
) -> usize {
    if stop.asks() {
        return 0;
    }
    let curve = &best.curves;
    let moved = match how {
        Move::Kick => kick(curve, KICK * curve.thickness().tau, rng),
        Move::Squeeze => squeeze(curve, rng),
    };
    let Some(outcome) = moved.and_then(|curve| tighten_level(&curve, &level(), stop)) else {
        return 0;
    };
    let n_factorisations = outcome.n_factorisations;
    if outcome.ropelength < best.ropelength
        && check_type(name, &outcome.curves, kind, "searching").is_ok()
    {
        *best = outcome;
    }
    n_factorisations
}

fn level() -> Level {
    Level {
        damping: 0.02,
        curvature_damping: 0.1,
        weights: [1.0; 3],
        tolerance: 3e-4,
        rest: 0.3,
        enough: 0.0,
        reach: LOOSE_REACH,
        max_steps: 100,
    }
}

/// Tightens a start that may be several times too long: first with as many vertices as it needs to bend.
pub(super) fn tighten_loose(
    start: &Curves,
    settings: &TightenSettings,
    stop: &Stop,
) -> Option<Outcome> {
    let n = settings.search_vertices;
    let n_loose =
        (LOOSE_PER_UNIT * start.length() / start.thickness().tau).min(4.0 * n as f64) as usize;
    let mut curve = start.clone();
    let mut n_factorisations = 0;
    if n_loose > n {
        let loose = Level {
            tolerance: 2e-2,
            max_steps: 60,
            enough: n as f64,
            ..level()
        };
        let outcome = tighten_level(&start.resampled(n_loose).ok()?, &loose, stop)?;
        n_factorisations = outcome.n_factorisations;
        curve = outcome.curves;
    }
    let mut outcome = tighten_level(&curve.resampled(n).ok()?, &level(), stop)?;
    outcome.n_factorisations += n_factorisations;
    Some(outcome)
}
