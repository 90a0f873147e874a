//! The short run that tells how fast this machine is with colloids.

use topo_core::Interrupt;
use topo_nematic::{
    ChargeSettings, NematicAccuracy, NematicBattery, NematicParameters, RunHooks, SurfacePattern,
    Threads,
};

use crate::cost::Probe;

/// Of colloids.
pub(crate) static COLLOID_PROBE: Probe = Probe {
    name: "nematic",
    reference_seconds: 0.096,
    run: charge,
};

/// The first steps of the charge of a colloid of 70 000 cells; `None` if it cannot be run.
fn charge() -> Option<()> {
    let colloid = NematicParameters {
        radius: 12.0,
        spacing: 1.5,
        pattern: SurfacePattern::Winding(2),
        ..NematicParameters::default()
    };
    let settings = ChargeSettings {
        max_steps: STEPS,
        ..ChargeSettings::default()
    };
    let accuracy = NematicAccuracy {
        threads: Threads::One,
        ..NematicAccuracy::default()
    };
    let battery = NematicBattery::new(&colloid, &accuracy).ok()?;
    let stop = Interrupt::new();
    battery.charge(&settings, &mut RunHooks::new(&stop)).ok()?;
    Some(())
}

const STEPS: u64 = 75;
