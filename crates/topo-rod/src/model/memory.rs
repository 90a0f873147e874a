//! What a rod's model must remember between two steps, so that a run continues from a checkpoint to the same bits.
//!
//! Everything that follows from the state is computed again; what an earlier state left behind is remembered: the list of pairs (by
//! where it was built), the patterns of the matrices, the Newton matrix in use, pairs expected to touch, guards and the account.

use serde::{Deserialize, Serialize};
use topo_core::{Ledger, MOST_COUNTED, Model};
use topo_sparse::SparseError;

use super::RodModel;
use super::approaching::ApproachingPairs;
use super::parts::{Accepted, Frozen};
use crate::RodState;
use crate::contact::PairsMemory;
use crate::guard::RiseBudget;
use crate::newton::{NewtonMemory, NewtonTwistMemory};
use crate::viscosity::MobilityMemory;

/// What a model remembers.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct ModelMemory {
    /// Whether energies and forces at the state are computed.
    is_evaluated: bool,
    pairs: PairsMemory,
    expected: ApproachingPairs,
    mobility: MobilityMemory,
    n_twist_factorisations: Option<u64>,
    newton: NewtonMemory,
    newton_twist: Option<NewtonTwistMemory>,
    frozen: Option<Frozen>,
    accepted: Accepted,
    rises: RiseBudget,
    ledger: Ledger,
    probe: Vec<f64>,
    /// Stamp given last.
    stamp: u64,
    /// Evaluations: all, of terms, of friction.
    n_evaluations: [u64; 3],
    least_distance: f64,
    longest_step: f64,
    /// Room for couplings by friction, which the account of bytes reports.
    room: [usize; 2],
}

impl ModelMemory {
    /// What does not fit `fresh`, the model of the same rod that has not begun, at `state`.
    pub(crate) fn flaw(&self, fresh: &RodModel, state: &RodState) -> Option<&'static str> {
        let (n, n_edges, n_dof) = (fresh.n_vertices, fresh.n_edges, fresh.n_dof());
        let or_none = |found: usize, expected: usize| found == 0 || found == expected;
        let a = &self.accepted;
        let coupled = |&(i, j, c): &(u32, u32, f64)| (i.max(j) as usize) < n && c.is_finite();
        let needs_cosine = self.n_twist_factorisations.is_some();
        let remembered = (a.cosine.len() == n || a.cosine.is_empty() && !needs_cosine)
            && or_none(a.force.vertex.len(), n)
            && or_none(a.force.torque.len(), n_edges)
            && or_none(a.joints.len(), fresh.drives().len())
            && a.joints.iter().all(|x| x.is_finite())
            && or_none(a.rate.len(), n_dof)
            && (a.rate_stamp.is_none() || !a.rate.is_empty())
            && a.couplings.iter().all(coupled)
            && a.total.is_finite()
            && or_none(self.probe.len(), n_dof)
            && self.room.iter().all(|room| *room <= 2 * n * n);
        let patterns = self.newton.pairs.are_of(n) && self.mobility.pairs.are_of(n);
        let matrices = self.newton.factor.iter().all(|factor| factor.is_of(n))
            && self.newton_twist.iter().all(|twist| twist.is_of(n))
            && self.newton_twist.is_some() == fresh.newton_twist.is_some()
            && self.frozen.is_some() == self.newton.factor.is_some();
        if !self.pairs.is_of(n) || !self.expected.is_like(&fresh.expected, n) {
            Some("the list of pairs is one of another rod")
        } else if !remembered || state.stamp() > self.stamp {
            Some("the last state is one of another rod")
        } else if !patterns || !matrices {
            Some("the matrices are those of another rod")
        } else if self.ledger.terms() != fresh.ledger.terms()
            || self.ledger.channels() != fresh.ledger.channels()
        {
            Some("the energy account is one of another model")
        } else if !self.rises.is_sound()
            || self.least_distance.is_nan()
            || self.longest_step.is_nan()
            || self.n_evaluations.iter().any(|n| *n >= MOST_COUNTED)
        {
            Some("a counter or a guard is out of range")
        } else {
            None
        }
    }
}

impl RodModel {
    /// What it remembers at `state`, the one accepted last.
    pub(crate) fn memory(&self, state: &RodState) -> ModelMemory {
        ModelMemory {
            is_evaluated: self.at.stamp == Some(state.stamp()),
            pairs: self.pairs.memory(),
            expected: self.expected.clone(),
            mobility: self.centreline.memory(),
            n_twist_factorisations: self.rotation.as_ref().and_then(|r| r.memory()),
            newton: self.newton.memory(self.frozen.is_some()),
            newton_twist: self.newton_twist.as_ref().map(|twist| twist.memory()),
            frozen: self.frozen,
            accepted: self.accepted.clone(),
            rises: self.rises,
            ledger: self.ledger.clone(),
            probe: self.probe.clone(),
            stamp: self.stamps.get(),
            n_evaluations: [
                self.n_evaluations,
                self.n_term_evaluations,
                self.n_friction_evaluations,
            ],
            least_distance: self.least_distance,
            longest_step: self.longest_step,
            room: [
                self.at.couplings.capacity(),
                self.accepted.couplings.capacity(),
            ],
        }
    }

    /// Continues from what a model of the same rod remembered at `state`; false if that is inconsistent.
    pub(crate) fn recall(
        &mut self,
        state: &RodState,
        memory: ModelMemory,
    ) -> Result<bool, SparseError> {
        self.pairs.recall(state, memory.pairs);
        self.expected = memory.expected;
        self.at.couplings = Vec::with_capacity(memory.room[0]);
        self.at.stamp = None;
        if memory.is_evaluated && self.evaluate(state).is_err() {
            return Ok(false);
        }
        if let Some(load) = &mut self.load {
            load.accept_at(state);
        }
        let mut couplings = Vec::with_capacity(memory.room[1]);
        couplings.extend_from_slice(&memory.accepted.couplings);
        self.accepted = Accepted {
            couplings,
            ..memory.accepted
        };
        self.centreline
            .recall(state, &self.pairs, self.friction, memory.mobility)?;
        if let Some(rotation) = &mut self.rotation {
            let n_factorisations = memory.n_twist_factorisations;
            rotation.recall(state, &self.accepted.cosine, 0.0, n_factorisations)?;
        }
        if !self.newton.recall(state, memory.newton)? {
            return Ok(false);
        }
        if let (Some(newton), Some(twist)) = (&mut self.newton_twist, memory.newton_twist) {
            newton.recall(state, twist)?;
        }
        self.frozen = memory.frozen;
        self.rises = memory.rises;
        self.ledger = memory.ledger;
        self.probe = memory.probe;
        self.stamps.set(memory.stamp);
        [
            self.n_evaluations,
            self.n_term_evaluations,
            self.n_friction_evaluations,
        ] = memory.n_evaluations;
        self.least_distance = memory.least_distance;
        self.longest_step = memory.longest_step;
        Ok(true)
    }
}

/// The parts of the memory, so that a test can forget or spoil each.
#[cfg(test)]
pub(crate) const PARTS: [&str; 16] = [
    "pairs",
    "expected",
    "mobility",
    "n_twist_factorisations",
    "newton",
    "newton_twist",
    "frozen",
    "accepted",
    "rises",
    "ledger",
    "stamp",
    "n_evaluations",
    "least_distance",
    "longest_step",
    "probe",
    "room",
];

#[cfg(test)]
impl ModelMemory {
    /// Whether a step was refused a little while ago.
    pub(crate) fn is_wary(&self) -> bool {
        self.expected.is_wary()
    }

    /// Whether the matrix in use is good for the `next` step too.
    pub(crate) fn is_reusing(&self, next: &Self) -> bool {
        let n_uses = |memory: &Self| memory.frozen.map_or(0, |frozen| frozen.n_uses);
        n_uses(next) > n_uses(self) && n_uses(self) > 0
    }

    /// Takes a part from another memory.
    pub(crate) fn take_part(&mut self, part: usize, from: &mut Self) {
        use std::mem::swap;
        match PARTS[part] {
            "pairs" => swap(&mut self.pairs, &mut from.pairs),
            "expected" => swap(&mut self.expected, &mut from.expected),
            "mobility" => swap(&mut self.mobility, &mut from.mobility),
            "n_twist_factorisations" => {
                self.n_twist_factorisations = from.n_twist_factorisations;
            }
            "newton" => swap(&mut self.newton, &mut from.newton),
            "newton_twist" => swap(&mut self.newton_twist, &mut from.newton_twist),
            "frozen" => self.frozen = from.frozen,
            "accepted" => swap(&mut self.accepted, &mut from.accepted),
            // the energy has not risen yet at any step that tests stop at
            "rises" => self.rises = from.rises.after_a_rise(),
            "ledger" => swap(&mut self.ledger, &mut from.ledger),
            "stamp" => self.stamp = from.stamp,
            "n_evaluations" => self.n_evaluations = from.n_evaluations,
            "least_distance" => self.least_distance = f64::INFINITY,
            "longest_step" => self.longest_step = from.longest_step,
            "probe" => self.probe.clear(),
            _ => self.room = [0; 2],
        }
    }

    /// Gives a part a value that no run can produce; false for a part that may have any value.
    pub(crate) fn spoil(&mut self, part: usize) -> bool {
        match PARTS[part] {
            "pairs" => self.pairs.spoil(),
            "expected" => self.expected = ApproachingPairs::new(1.0),
            "newton" => self.newton.factor = None,
            "newton_twist" => self.newton_twist = None,
            "accepted" => self.accepted.rate.truncate(7),
            "rises" => self.rises = RiseBudget::new(f64::NAN),
            "ledger" => self.ledger = Ledger::new(&["other"], &["names"]),
            "stamp" => self.stamp = 0,
            "n_evaluations" => self.n_evaluations[2] = u64::MAX,
            "longest_step" => self.longest_step = f64::NAN,
            "least_distance" => self.least_distance = f64::NAN,
            "room" => self.room[1] = usize::MAX,
            _ => return false,
        }
        true
    }
}
