//! What the numbers of a case depend on.

use serde_json::json;
use topo_rod::Guards;

use super::case::ElasticCase;
use super::scene::ElasticScene;
use super::tied::Entry;
use crate::folder::identity;

/// Changes whenever the same scene gives other numbers than before; finished cases of another version are computed again.
pub const RESULTS_VERSION: u32 = 5;

/// Identity of a case: everything that its numbers depend on.
pub(crate) fn fingerprint(scene: &ElasticScene, case: &ElasticCase, entry: &Entry) -> String {
    let mut all = json!({
        "version": RESULTS_VERSION, "case": case, "knot": entry, "tighten": scene.tighten, "imperfection": case.imperfection,
        "seed": case.seed, "charge": scene.charge, "cuts": scene.cuts, "discharge": scene.discharge,
        "timeline": scene.timeline, "accuracy": scene.accuracy, "guards": Guards::default(),
    });
    if starts_from_two_images(scene, case, entry) {
        all["images"] = 2.into();
    }
    // earlier programs left the types of links out
    if case.n_components() > 1 {
        all["typed_links"] = true.into();
    }
    // earlier programs booked work across the line of a load, and turned seams by the clock
    if case.load.is_some() {
        all["loads"] = 2.into();
    }
    if scene.charge.twisting.is_some() {
        all["twisting"] = 2.into();
    }
    if let Some(pull) = &scene.pull {
        all["pull"] = json!(pull);
    }
    if let Some(cuts) = &scene.fixed_cuts {
        all["fixed_cuts"] = json!(cuts.get(&case.state()));
    }
    if !scene.own_terms.is_empty() {
        all["own_terms"] = json!(scene.own_terms);
    }
    if !scene.observables.is_empty() {
        all["observables"] = json!(scene.observables);
    }
    identity(&all)
}

/// What the numbers of a case depend on besides the case, its imperfection and seed.
pub(super) fn settings_of(scene: &ElasticScene, case: &ElasticCase) -> serde_json::Value {
    let fixed = scene
        .fixed_cuts
        .as_ref()
        .map(|cuts| cuts.get(&case.state()));
    let mut all = json!([
        scene.tighten,
        scene.charge,
        scene.cuts,
        scene.discharge,
        scene.timeline,
        scene.accuracy,
        fixed
    ]);
    if let Some(all) = all.as_array_mut() {
        if !scene.own_terms.is_empty() {
            all.push(json!(scene.own_terms));
        }
        if scene.pull.is_some() {
            all.push(json!(scene.pull));
        }
    }
    all
}

/// Whether a rod that is twisted, or not its own mirror image at rest, may start from the tight curve or from its mirror image, being
/// the same knot. One that may break by itself starts from the curve alone, as energies of two rods that broke at two times say
/// nothing about which to keep.
pub(super) fn starts_from_two_images(
    scene: &ElasticScene,
    case: &ElasticCase,
    entry: &Entry,
) -> bool {
    let is_twisted = case.rod.twist.is_some_and(|twist| twist != 0.0);
    let has_hand = is_twisted || case.rest.as_ref().is_some_and(|rest| rest.is_chiral());
    has_hand
        && scene.charge.breaking.is_none()
        && entry.is_amphichiral_knot()
        && case.is_tightened()
}
