//! A battery run from its charge to the end of its discharge.

use super::RodBattery;
use super::charge::{ChargeSettings, ChargedRod};
use super::cut::CutSite;
use super::discharge::{Discharge, DischargeSettings};
use super::hooks::RunHooks;
use crate::RodError;

/// Charge, cut, discharge: what is done to a battery.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Protocol {
    /// How it is charged.
    pub charge: ChargeSettings,
    /// Where it is cut; one that [breaks](ChargeSettings::breaking) by itself is cut there.
    pub cut: CutSite,
    /// How it is discharged.
    pub discharge: DischargeSettings,
}

impl RodBattery {
    /// Charges, cuts and discharges. A charge that does not finish is not followed by a discharge, nor is that of a fibre which
    /// should have broken by itself and did not.
    ///
    /// The checkpoint file of the hooks, if there is one, is that of the charge. That of the discharge is beside it, with
    /// `discharge` as its last extension.
    ///
    /// # Errors
    /// Those of [`charge`](Self::charge), [`ChargedRod::cut`] and [`CutRod::discharge`](crate::CutRod::discharge).
    pub fn run(
        &self,
        protocol: &Protocol,
        hooks: &mut RunHooks<'_>,
    ) -> Result<(ChargedRod, Option<Discharge>), RodError> {
        let charged = self.charge(&protocol.charge, hooks)?;
        if !charged.record().report.stop.is_success() {
            return Ok((charged, None));
        }
        let site = match (protocol.charge.breaking, charged.broken()) {
            (None, _) => protocol.cut,
            (Some(_), Some(broken)) => CutSite::On {
                component: broken.site.component,
                at: broken.site.at,
            },
            (Some(_), None) => return Ok((charged, None)),
        };
        hooks.begin_phase("discharge");
        let cut = charged.cut(site)?;
        let discharge = cut.discharge(&protocol.discharge, hooks)?;
        Ok((charged, Some(discharge)))
    }
}
