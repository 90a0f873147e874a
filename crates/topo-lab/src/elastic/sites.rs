//! Where charged rods are cut: places along all components, one after the other.

use topo_rod::{Chain, ChargedRod, Criterion, CutCandidate, CutSite};

use super::case_run::CaseInputs;
use super::choices::{Cuts, NEAR_TIE};

/// A cut to be made.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chosen {
    /// Its place, s/L along all components.
    pub place: f64,
    /// The criteria that chose it; none of a place that was given.
    pub by: Vec<Criterion>,
}

impl Chosen {
    fn given(place: &f64) -> Self {
        Self {
            place: *place,
            by: Vec::new(),
        }
    }

    fn by(criterion: Criterion, charged: &ChargedRod, found: &CutCandidate) -> Self {
        Self {
            place: along(charged, found),
            by: vec![criterion],
        }
    }

    /// The criteria, as in tables.
    pub(super) fn criteria(&self) -> String {
        let names = self.by.iter().map(|c| c.name());
        names.collect::<Vec<_>>().join(";")
    }
}

/// Where the scene cuts the rod; nowhere if it should have broken by itself and did not.
pub(super) fn sites(inputs: &CaseInputs<'_>, charged: &ChargedRod) -> Vec<Chosen> {
    let CaseInputs { scene, case, .. } = *inputs;
    if let Some(fixed) = &scene.fixed_cuts {
        let places = fixed.get(&case.state());
        return places.into_iter().flatten().map(Chosen::given).collect();
    }
    if let Some(breaking) = scene.charge.breaking {
        let broken = charged.broken().into_iter();
        return broken
            .map(|broken| Chosen::by(breaking.criterion, charged, &broken.site))
            .collect();
    }
    let within = |criterion: Criterion, share: f64| {
        let found = charged.cut_candidates_by(criterion, share);
        let all = found.iter().map(|c| Chosen::by(criterion, charged, c));
        all.collect::<Vec<_>>()
    };
    match &scene.cuts {
        Cuts::Largest(criterion) => within(*criterion, 0.0).into_iter().take(1).collect(),
        Cuts::NearTies(criterion) => within(*criterion, NEAR_TIE),
        Cuts::Criteria => {
            let others = Criterion::ALL.into_iter();
            let others = others.filter(|c| *c != Criterion::Energy);
            let largest = others.filter_map(|c| within(c, 0.0).into_iter().next());
            let ties = within(Criterion::Energy, NEAR_TIE).into_iter();
            agreeing(ties.chain(largest))
        }
        Cuts::All(k) => {
            // an open fibre is not cut at its ends
            let first = if charged.state().is_closed() {
                0.0
            } else {
                0.5
            };
            let places = (0..*k).map(|i| (i as f64 + first) / *k as f64);
            places.map(|place| Chosen::given(&place)).collect()
        }
        // its ends are there
        Cuts::LetGo => vec![Chosen::given(&0.0)],
        Cuts::At(places) => places.iter().map(Chosen::given).collect(),
    }
}

/// Each site once, with all criteria that chose it, in the order in which they come.
fn agreeing(all: impl Iterator<Item = Chosen>) -> Vec<Chosen> {
    let mut sites: Vec<Chosen> = Vec::new();
    for one in all {
        match sites.iter_mut().find(|site| site.place == one.place) {
            Some(site) => site.by.extend(one.by),
            None => sites.push(one),
        }
    }
    sites
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn criteria_that_agree_cut_once() {
        let at = |place, criterion| Chosen {
            place,
            by: vec![criterion],
        };
        let [energy, curvature, tension, mises] = Criterion::ALL;
        let all = [
            at(0.25, energy),
            at(0.5, curvature),
            at(0.25, tension),
            at(0.25, mises),
        ];
        let sites = agreeing(all.into_iter());
        let said: Vec<_> = sites.iter().map(|s| (s.place, s.criteria())).collect();
        let expected = [(0.25, "energy;tension;von-mises"), (0.5, "curvature")];
        assert_eq!(said, expected.map(|(p, by)| (p, by.to_owned())));
    }
}
