//! Where a charged rod is cut.

use serde::{Deserialize, Serialize};

use crate::{Chain, ChargedRod, Criterion, RodError, RodState, Tips};

/// How the site of a cut is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CutSite {
    /// The vertex of largest elastic energy density, smoothed over π h.
    #[default]
    MaximumEnergyDensity,
    /// The vertex at which the measure of a criterion, smoothed over π h, is largest.
    Maximum(Criterion),
    /// The vertex nearest to a given s/L in [0, 1); of a link, on its first component.
    At(f64),
    /// The vertex nearest to a given s/L in [0, 1) of a component of a link.
    On {
        /// Number of the component, from 0.
        component: usize,
        /// s/L along it.
        at: f64,
    },
}

/// A local maximum of the smoothed energy density, or of the measure of another criterion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CutCandidate {
    /// Vertex to cut.
    pub vertex: usize,
    /// Its position s/L, along its component.
    pub at: f64,
    /// Number of its component, from 0.
    #[serde(default, skip_serializing_if = "is_first")]
    pub component: usize,
    /// Smoothed density per area, in E_b, or measure of the criterion in its [unit](Criterion::unit).
    pub density: f64,
}

fn is_first(component: &usize) -> bool {
    *component == 0
}

/// Local maxima of a smoothed density on a closed rod within `share` of the largest, largest first.
///
/// The maximum is often nearly degenerate, and the discharge depends on which one is cut; these are the sites that a small
/// imperfection of a real fibre would choose among. Maxima closer than π h to a larger one count as part of it.
pub fn cut_candidates(smoothed: &[f64], rest_length: f64, share: f64) -> Vec<CutCandidate> {
    peaks_of(smoothed, rest_length, share, true)
}

/// The same of a rod that may be open: at no end of it.
fn peaks_of(smoothed: &[f64], rest_length: f64, share: f64, closed: bool) -> Vec<CutCandidate> {
    let n = smoothed.len();
    let peak =
        |i: usize| smoothed[i] >= smoothed[(i + n - 1) % n] && smoothed[i] > smoothed[(i + 1) % n];
    let sites = if closed { 0..n } else { 2..n.saturating_sub(2) };
    let mut peaks: Vec<usize> = sites.clone().filter(|&i| peak(i)).collect();
    if peaks.is_empty() {
        // a constant density, as of a circle: any site is as good; or one that falls all along
        let largest = sites.max_by(|&a, &b| smoothed[a].total_cmp(&smoothed[b]).then(b.cmp(&a)));
        peaks.push(largest.unwrap_or(0));
    }
    let n_edges = if closed { n } else { n - 1 };
    peaks.sort_by(|&a, &b| smoothed[b].total_cmp(&smoothed[a]).then(a.cmp(&b)));
    let largest = smoothed[peaks[0]];
    let flank = std::f64::consts::PI / rest_length;
    let mut kept: Vec<CutCandidate> = Vec::new();
    for i in peaks {
        let apart = |j: usize| match closed {
            true => i.abs_diff(j).min(n - i.abs_diff(j)) as f64,
            false => i.abs_diff(j) as f64,
        };
        if smoothed[i] >= (1.0 - share) * largest && kept.iter().all(|c| apart(c.vertex) >= flank) {
            kept.push(CutCandidate {
                vertex: i,
                at: i as f64 / n_edges as f64,
                component: 0,
                density: smoothed[i],
            });
        }
    }
    kept
}

/// As [`cut_candidates`], of all closed components of `state` together, with its smoothed density; of open ones where none is closed.
pub(super) fn candidates_of(state: &RodState, smoothed: &[f64], share: f64) -> Vec<CutCandidate> {
    let mut all: Vec<CutCandidate> = Vec::new();
    let some_closed = state.components().iter().any(Chain::is_closed);
    for (component, chain) in state.components().iter().enumerate() {
        let closed = chain.is_closed();
        if closed == some_closed {
            let own = &smoothed[chain.vertices()];
            let own = peaks_of(own, chain.rest_length(), share, closed);
            all.extend(own.into_iter().map(|found| CutCandidate {
                vertex: chain.first() + found.vertex,
                component,
                ..found
            }));
        }
    }
    let largest = all.iter().map(|c| c.density).fold(0.0, f64::max);
    all.retain(|c| c.density >= (1.0 - share) * largest);
    all.sort_by(|a, b| b.density.total_cmp(&a.density));
    all
}

/// A rod that has just been cut.
#[derive(Debug, Clone)]
pub struct CutRod {
    /// What was cut.
    pub charged: ChargedRod,
    /// The open rod, its first and last vertex still in one place.
    pub state: RodState,
    /// Vertex of the closed rod that was doubled.
    pub vertex: usize,
    /// Its position s/L, along its component.
    pub at: f64,
    /// The component that was opened, from 0.
    pub component: usize,
    /// The ends that the cut made; none where an open rod was let go.
    pub tips: Option<Tips>,
}

impl CutRod {
    /// The charged rod with a component cut at s/L = `at`; an open one into two, of two edges at least.
    ///
    /// # Errors
    /// The component must exist, and `at` be in [0, 1), and not at an end of an open one.
    pub(crate) fn new(charged: &ChargedRod, component: usize, at: f64) -> Result<Self, RodError> {
        if !(0.0..1.0).contains(&at) {
            return Err(RodError::CutSite { at });
        }
        let closed = charged.state();
        let chain = closed.chain(component)?;
        let n = chain.n_edges();
        let nearest = (at * n as f64).round() as usize;
        let (vertex, tips) = match chain.is_closed() {
            true => (nearest % n, Tips::Of(component)),
            false => (nearest, Tips::Between(component)),
        };
        Ok(Self {
            charged: charged.clone(),
            state: closed.cut_at(chain.first() + vertex)?,
            vertex: chain.first() + vertex,
            at: vertex as f64 / n as f64,
            component,
            tips: Some(tips),
        })
    }
}

impl ChargedRod {
    /// Sites within `share` of the largest smoothed density, largest first; of a link, on all of its components.
    pub fn cut_candidates(&self, share: f64) -> Vec<CutCandidate> {
        let state = self.state();
        candidates_of(state, &state.smoothed(self.density()), share)
    }

    /// Sites within `share` of the largest smoothed measure of a criterion, largest first; those of [`Criterion::Energy`] are the
    /// [`cut_candidates`](Self::cut_candidates).
    pub fn cut_candidates_by(&self, criterion: Criterion, share: f64) -> Vec<CutCandidate> {
        if criterion == Criterion::Energy {
            return self.cut_candidates(share);
        }
        let state = self.state();
        let measure = self.battery().measure(criterion, state);
        candidates_of(state, &state.smoothed(&measure), share)
    }

    /// Cuts the rod, or one component of a link.
    ///
    /// # Errors
    /// A site that is not on the rod.
    pub fn cut(&self, site: CutSite) -> Result<CutRod, RodError> {
        match site {
            CutSite::MaximumEnergyDensity => self.cut(CutSite::Maximum(Criterion::Energy)),
            CutSite::Maximum(criterion) => {
                let found = self.cut_candidates_by(criterion, 0.0)[0];
                CutRod::new(self, found.component, found.at)
            }
            CutSite::At(at) => CutRod::new(self, 0, at),
            CutSite::On { component, at } => CutRod::new(self, component, at),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn candidates_are_peaks_within_the_share_and_not_on_a_flank() {
        let n = 200;
        let mut density = vec![1.0; n];
        for (centre, height) in [(20isize, 3.0), (25, 2.99), (110, 2.95), (160, 2.5)] {
            for k in -2isize..=2 {
                let i = (centre + k).rem_euclid(n as isize) as usize;
                density[i] = f64::max(density[i], height - 0.1 * k.abs() as f64);
            }
        }
        let found = cut_candidates(&density, 0.25, 0.03);
        assert_eq!(
            found.iter().map(|c| c.vertex).collect::<Vec<_>>(),
            [20, 110]
        );
        assert_eq!(cut_candidates(&vec![1.0; 30], 0.25, 0.03).len(), 1);
    }

    /// Of a link, the components compete: sites come from all that are closed, with their own vertex and s/L.
    #[test]
    fn candidates_are_those_of_all_closed_components() {
        let ring = |n: usize| {
            let at = |k: usize| {
                let u = std::f64::consts::TAU * k as f64 / n as f64;
                nalgebra::Vector3::new(u.cos(), u.sin(), 0.0)
            };
            let curve = topo_core::Polyline::new((0..n).map(at).collect(), true).unwrap();
            RodState::new(&curve, 0.25 * n as f64, 0.0).unwrap()
        };
        let rods = [ring(80), ring(60).cut_at(0).unwrap(), ring(100)];
        let state = RodState::link(&rods).unwrap();
        let mut density = vec![1.0; state.n_vertices()];
        (density[20], density[100], density[80 + 61 + 25]) = (2.95, 9.0, 3.0);
        let found = candidates_of(&state, &density, 0.03);
        let sites: Vec<_> = found
            .iter()
            .map(|c| (c.component, c.vertex, c.at))
            .collect();
        assert_eq!(sites, [(2, 166, 0.25), (0, 20, 0.25)]);
        assert_eq!(candidates_of(&state, &density, 0.01).len(), 1);
        // smoothing stops at the ends of a component
        density.fill(1.0);
        density[0] = 21.0;
        let smoothed = state.smoothed(&density);
        assert!(smoothed[79] > 1.5 && smoothed[80..].iter().all(|w| (w - 1.0).abs() < 1e-12));
    }

    /// Distances are the shorter way round: flanks reach π/0.25 = 12.6 vertices, across the seam as anywhere.
    #[test]
    fn flanks_reach_across_the_seam() {
        let n = 200;
        for (apart, n_kept) in [(10, 1), (14, 2)] {
            for first in [193, 50] {
                let mut density = vec![1.0; n];
                density[first] = 3.0;
                density[(first + apart) % n] = 2.99;
                let found = cut_candidates(&density, 0.25, 0.03);
                assert_eq!(found.len(), n_kept, "{first} {apart}");
                assert_eq!(found[0].vertex, first);
            }
        }
    }
}
