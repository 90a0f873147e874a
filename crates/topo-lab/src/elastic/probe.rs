//! The short run that tells how fast this machine is with rods.

use topo_core::RunHooks;
use topo_rod::{Accuracy, ChargeSettings, Guards, RodBattery, RodParameters};

use crate::cost::Probe;
use crate::stability::rod::trefoil;

/// Of rods; knots are tightened, and figures drawn, at the same pace.
pub(crate) static ROD_PROBE: Probe = Probe {
    name: "rod",
    reference_seconds: 0.089,
    run: charge,
};

/// The charge of a twisted trefoil of 200 edges; `None` if it cannot be run.
fn charge() -> Option<()> {
    let rod = RodParameters {
        twist: Some(1.0),
        ..RodParameters::default()
    };
    let accuracy = Accuracy {
        tolerance: TOLERANCE,
        ..Accuracy::default()
    };
    let battery = RodBattery::new(&rod, &accuracy, Guards::default(), &trefoil()).ok()?;
    let settings = ChargeSettings::default();
    battery.charge(&settings, &mut RunHooks::default()).ok()?;
    Some(())
}

/// In h.
const TOLERANCE: f64 = 2e-4;
