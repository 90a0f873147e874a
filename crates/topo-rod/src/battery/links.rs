//! What must not change while components stay closed: Tw + Wr of each, and the linking number of each two.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::RodState;

/// The linking number of two closed components over a phase.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Linking {
    /// Numbers of the components, from 0, the smaller first.
    pub components: [usize; 2],
    /// At the start of the phase.
    pub start: f64,
    /// Largest change seen.
    pub drift: f64,
}

/// Drifts seen so far in the samples of a state of several components; nothing is held for a single one.
#[derive(Default)]
pub(super) struct Links {
    /// Component, Tw + Wr at the first sample, largest change.
    own: Vec<(usize, f64, f64)>,
    pairs: Vec<Linking>,
}

impl Links {
    /// Takes a sample into account; the first one is the start.
    pub(super) fn look(&mut self, state: &RodState, has_twist: bool) {
        let chains = state.components();
        if chains.len() < 2 {
            return;
        }
        let is_first = self.own.is_empty() && self.pairs.is_empty();
        let closed = || (0..chains.len()).filter(|&c| chains[c].is_closed());
        if is_first {
            self.own = closed().map(|c| (c, f64::NAN, 0.0)).collect();
            self.own.retain(|_| has_twist);
            let both = closed().flat_map(|a| closed().filter(move |&b| b > a).map(move |b| [a, b]));
            let fresh = |components| Linking {
                components,
                start: f64::NAN,
                drift: 0.0,
            };
            self.pairs = both.map(fresh).collect();
        }
        for (c, start, drift) in &mut self.own {
            let sum = state
                .writhe_of(*c)
                .and_then(|w| Ok(w + (state.total_twist_of(*c)? - state.turned_by(*c) / TAU)));
            follow(start, drift, sum.unwrap_or(f64::NAN), is_first);
        }
        for pair in &mut self.pairs {
            let [a, b] = pair.components;
            let now = state.linking(a, b).unwrap_or(f64::NAN);
            follow(&mut pair.start, &mut pair.drift, now, is_first);
        }
    }

    /// Largest |Δ(Tw + Wr)| of a closed component, if there is one with twist.
    pub(super) fn own_drift(&self) -> Option<f64> {
        self.own.iter().map(|own| own.2).reduce(f64::max)
    }

    /// Linking numbers of each two closed components.
    pub(super) fn linking(&self) -> Vec<Linking> {
        self.pairs.clone()
    }
}

fn follow(start: &mut f64, drift: &mut f64, now: f64, is_first: bool) {
    if is_first {
        *start = now;
    }
    *drift = drift.max((now - *start).abs());
}
