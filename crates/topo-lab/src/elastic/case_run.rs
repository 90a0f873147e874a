//! A case with what it starts from, and what was followed of it.

use topo_analysis::{DischargeTimes, SweepRow, Timeline};
use topo_knots::{KnotError, KnotTable};
use topo_rod::{ChargedRod, CutSite, Discharge, DischargeSettings, RodError, RunHooks};

use super::case::ElasticCase;
use super::choices::Cuts;
use super::scene::ElasticScene;
use super::tied::Start;
use crate::LabError;

/// A case with what it starts from.
#[derive(Clone, Copy)]
pub(crate) struct CaseInputs<'a> {
    pub scene: &'a ElasticScene,
    pub case: &'a ElasticCase,
    pub start: Start<'a>,
    pub table: &'a KnotTable,
}

impl CaseInputs<'_> {
    /// The error of this case.
    pub(crate) fn refused(&self, source: RodError) -> LabError {
        LabError::Rod {
            case: self.scene.case_name(self.case),
            source,
        }
    }

    /// The error of a start that its edges do not follow.
    pub(crate) fn too_coarse(&self, error: &KnotError) -> LabError {
        let reason = format!(
            "{} edges do not follow its start curve ({error}): use more edges",
            self.case.rod.n_edges
        );
        LabError::Case {
            case: self.scene.case_name(self.case),
            source: reason.into(),
        }
    }

    /// Cuts the charged rod and follows it.
    pub(crate) fn discharge(
        &self,
        charged: &ChargedRod,
        site: CutSite,
        settings: &DischargeSettings,
        hooks: &mut RunHooks<'_>,
    ) -> Result<Discharge, LabError> {
        let settings = DischargeSettings {
            load: self.case.load,
            ..*settings
        };
        let opened = match self.scene.cuts {
            Cuts::LetGo => charged.let_go(),
            _ => charged.cut(site),
        };
        opened
            .and_then(|cut| cut.discharge(&settings, hooks))
            .map_err(|source| self.refused(source))
    }
}

/// One cut of a charged rod, followed to its end.
pub(super) struct CutResults {
    pub discharge: Discharge,
    /// Place of the cut, s/L along all components, one after the other.
    pub cut: f64,
    /// Criteria that chose it, as in tables.
    pub cut_by: String,
    /// Of the energy before the cut.
    pub times: DischargeTimes,
    /// Of the energy that the cut left.
    pub times_after_cut: DischargeTimes,
    pub timeline: Timeline,
    /// Processor seconds of all this, those before a checkpoint included.
    pub cpu_seconds: f64,
    pub row: SweepRow,
}
