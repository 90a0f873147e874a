//! What the numbers of a case depend on.

use serde_json::json;
use topo_nematic::{NematicAccuracy, Threads};

use super::case::NematicCase;
use super::scene::NematicScene;
use crate::folder::identity;

/// Changes whenever the same scene gives other numbers than before; finished cases of another version are computed again.
pub const RESULTS_VERSION: u32 = 6;

/// Identity of a case: everything that its numbers depend on.
pub(super) fn fingerprint(scene: &NematicScene, case: &NematicCase) -> String {
    identity(&json!({
        "version": RESULTS_VERSION, "case": case, "charge": scene.charge, "switch": scene.switch,
        "discharge": scene.discharge, "accuracy": hashed_accuracy(&scene.accuracy),
    }))
}

/// The part of the accuracy that numbers depend on: the number of threads changes no bit.
pub(super) fn hashed_accuracy(accuracy: &NematicAccuracy) -> NematicAccuracy {
    NematicAccuracy {
        threads: Threads::One,
        memory_limit: None,
        ..*accuracy
    }
}
