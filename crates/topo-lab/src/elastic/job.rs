//! A case with what it starts from, and what was followed of it.

use topo_analysis::{DischargeTimes, SweepRow, Timeline};
use topo_knots::{KnotTable, TightKnot};
use topo_rod::Discharge;

use super::case::ElasticCase;
use super::scene::ElasticScene;

/// A case with what it starts from.
#[derive(Clone, Copy)]
pub(crate) struct CaseJob<'a> {
    pub scene: &'a ElasticScene,
    pub case: &'a ElasticCase,
    pub tight: &'a TightKnot,
    pub table: &'a KnotTable,
}

/// One cut of a charged rod, followed to its end.
pub(super) struct FollowedCut {
    pub discharge: Discharge,
    /// Of the energy before the cut.
    pub times: DischargeTimes,
    /// Of the energy that the cut left.
    pub times_after_cut: DischargeTimes,
    pub timeline: Timeline,
    pub row: SweepRow,
}
