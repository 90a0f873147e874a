//! A battery run from its charge to the end of its discharge.

use super::NematicBattery;
use super::charge::ChargedNematic;
use super::charge_settings::ChargeSettings;
use super::discharge::{Discharge, DischargeSettings};
use super::hooks::RunHooks;
use super::record::ChargeStop;
use super::switch::SwitchSettings;
use crate::NematicError;

/// Charge, switch, discharge: what is done to a battery.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Protocol {
    /// How it is charged.
    pub charge: ChargeSettings,
    /// What the anchoring is switched to.
    pub switch: SwitchSettings,
    /// How it is discharged.
    pub discharge: DischargeSettings,
}

impl NematicBattery {
    /// Charges, switches and discharges. An interrupted charge is not followed by a discharge.
    ///
    /// The checkpoint file of the hooks, if there is one, is that of the charge. That of the discharge is beside it, with
    /// `discharge` as its last extension.
    ///
    /// # Errors
    /// Those of [`charge`](Self::charge), [`ChargedNematic::switch`] and
    /// [`SwitchedNematic::discharge`](crate::SwitchedNematic::discharge).
    pub fn run(
        &self,
        protocol: &Protocol,
        hooks: &mut RunHooks<'_>,
    ) -> Result<(ChargedNematic, Option<Discharge>), NematicError> {
        let charged = self.charge(&protocol.charge, hooks)?;
        if charged.report().stop == ChargeStop::Interrupted {
            return Ok((charged, None));
        }
        hooks.begin_phase("discharge");
        let switched = charged.switch(&protocol.switch)?;
        let discharge = switched.discharge(&protocol.discharge, hooks)?;
        Ok((charged, Some(discharge)))
    }
}
