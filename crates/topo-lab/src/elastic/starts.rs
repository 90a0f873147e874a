//! Starts of what is tied besides tight knots by name: tightened once, or as they are.

use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;
use topo_knots::{
    KnotError, KnotTable, TightenSettings, ideal_link_until, ideal_until, is_kept, is_link_kept,
};

use super::case::ElasticCase;
use super::probe::ROD_PROBE;
use super::tied::{Entry, Made, Tied};
use crate::LabError;
use crate::cost::{Estimate, Speed, estimate as estimated, threads};
use crate::knots::{cost, knots_folder, tight_shapes};
use crate::progress::{Event, SweepSettings};

/// Starts by name; why not where there is none.
type Starts = BTreeMap<String, Result<Made, String>>;

/// What is tied in the cases, by name, each once.
fn tied<'a>(cases: impl Iterator<Item = &'a ElasticCase>) -> BTreeMap<String, &'a Tied> {
    let of = |case: &'a ElasticCase| Some((case.start_name(), case.tied.as_deref()?));
    cases.filter_map(of).collect()
}

/// What [`make`] is expected to take for what is not kept below `out`.
pub(super) fn estimate(
    cases: &[ElasticCase],
    settings: &TightenSettings,
    out: &Path,
    jobs: usize,
) -> Estimate {
    let cache = knots_folder(out).join("cache");
    let is_there = |tied: &Tied| {
        tied.laid.is_some()
            || match &tied.entry {
                Entry::Knot(knot) => is_kept(knot, settings, &cache),
                Entry::Link(link) => is_link_kept(link, settings, &cache),
            }
    };
    let missing = tied(cases.iter()).into_values().filter(|t| !is_there(t));
    let costs: Vec<_> = missing
        .map(|tied| cost(tied.entry.crossing_number(), settings))
        .collect();
    estimated(&costs, Speed::of(&ROD_PROBE, &[]), threads(jobs), true)
}

/// Tight shapes of the knots of the cases, in parallel; fewer when interrupted.
pub(super) fn of_knots(
    todo: &[&ElasticCase],
    table: &KnotTable,
    tighten: &TightenSettings,
    settings: &SweepSettings,
    progress: &(dyn Fn(Event<'_>) + Sync),
) -> Result<Starts, LabError> {
    let mut names: Vec<String> = todo.iter().map(|c| c.knot.clone()).collect();
    names.sort();
    names.dedup();
    let shape = |name: String| {
        let one = std::slice::from_ref(&name);
        let (out, interrupt) = (&settings.out, &settings.interrupt);
        match tight_shapes(one, table, tighten, out, interrupt, progress) {
            Ok(mut shapes) => Ok(shapes
                .remove(&name)
                .map(|shape| (name, Ok(Made::Knot(Box::new(shape)))))),
            Err(LabError::Knot(error)) => Ok(Some((name, Err(error.to_string())))),
            Err(error) => Err(error),
        }
    };
    let made: Vec<_> = names
        .into_par_iter()
        .with_max_len(1)
        .map(shape)
        .collect::<Result<_, LabError>>()?;
    Ok(made.into_iter().flatten().collect())
}

/// Makes the starts of the cases, in parallel; stops early when interrupted.
pub(super) fn make(
    todo: &[&ElasticCase],
    tighten: &TightenSettings,
    settings: &SweepSettings,
    progress: &(dyn Fn(Event<'_>) + Sync),
) -> Result<Starts, LabError> {
    let cache = knots_folder(&settings.out).join("cache");
    let interrupt = &settings.interrupt;
    let one = |(name, tied): (String, &Tied)| {
        if interrupt.is_requested() {
            return None;
        }
        if tied.laid.is_some() {
            return Some((name, Ok(Made::Own)));
        }
        let (kept, entry) = (Some(cache.as_path()), &tied.entry);
        let made = match entry {
            Entry::Knot(knot) => ideal_until(knot, tighten, kept, interrupt)
                .map(|tight| (tight.length_over_radius, Made::Knot(Box::new(tight)))),
            Entry::Link(link) => ideal_link_until(link, tighten, kept, interrupt)
                .map(|tight| (tight.length_over_radius, Made::Link(Box::new(tight)))),
        };
        match made {
            Ok((length_over_radius, made)) => {
                progress(Event::Knot {
                    name: &tied.name,
                    length_over_radius,
                });
                Some((name, Ok(made)))
            }
            Err(KnotError::Interrupted { .. } | KnotError::InterruptedLink { .. }) => None,
            Err(error) => Some((name, Err(error.to_string()))),
        }
    };
    let tied: Vec<_> = tied(todo.iter().copied()).into_iter().collect();
    let made = tied.into_par_iter().with_max_len(1).filter_map(one);
    Ok(made.collect())
}
