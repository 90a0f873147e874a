//! Where charged rods are cut: places along all components, one after the other.

use topo_rod::{Chain, ChargedRod, CutCandidate, CutSite};

use super::case_run::CaseInputs;
use super::choices::{Cuts, NEAR_TIE};

/// Where the scene cuts the rod, s/L along all components.
pub(super) fn sites(inputs: &CaseInputs<'_>, charged: &ChargedRod) -> Vec<f64> {
    let CaseInputs { scene, case, .. } = *inputs;
    if scene.pull.is_some() {
        // its ends are there
        return vec![0.0];
    }
    match &scene.cuts {
        _ if scene.fixed_cuts.is_some() => {
            let fixed = scene.fixed_cuts.as_ref();
            fixed
                .and_then(|cuts| cuts.get(&case.state()))
                .cloned()
                .unwrap_or_default()
        }
        Cuts::Argmax => vec![along(charged, &charged.cut_candidates(0.0)[0])],
        Cuts::NearTies => charged
            .cut_candidates(NEAR_TIE)
            .iter()
            .map(|c| along(charged, c))
            .collect(),
        Cuts::All(k) => (0..*k).map(|i| i as f64 / *k as f64).collect(),
        Cuts::At(places) => places.clone(),
    }
}

/// Share of a length within which a place counts as the next component's first.
const END: f64 = 1e-9;

/// Place of a site of a component, s/L along all of them, one after the other.
pub(super) fn place(charged: &ChargedRod, component: usize, at: f64) -> f64 {
    let chains = charged.state().components();
    if chains.len() == 1 {
        return at;
    }
    let length = |of: &[Chain]| of.iter().map(Chain::length).sum::<f64>();
    (length(&chains[..component]) + at * chains[component].length()) / length(chains)
}

/// The same of a candidate.
fn along(charged: &ChargedRod, found: &CutCandidate) -> f64 {
    place(charged, found.component, found.at)
}

/// The site at a place s/L along all components.
pub(super) fn site(charged: &ChargedRod, place: f64) -> CutSite {
    let chains = charged.state().components();
    if chains.len() == 1 {
        return CutSite::At(place);
    }
    let mut s = place * chains.iter().map(Chain::length).sum::<f64>();
    let last = chains.len() - 1;
    for (component, chain) in chains.iter().enumerate() {
        let at = s / chain.length();
        if at < 1.0 - END || component == last {
            return CutSite::On {
                component,
                at: at.clamp(0.0, 1.0 - f64::EPSILON),
            };
        }
        s = (s - chain.length()).max(0.0);
    }
    CutSite::At(place)
}
