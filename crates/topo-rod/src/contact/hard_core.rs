//! Pairs within the contact window that are closer than a tube can be bent.

use nalgebra::Vector3;

use crate::{Chain, RodState};

/// A pair of neighbours along the rod, closer than their limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CorePair {
    /// Smaller index.
    pub i: u32,
    /// Larger index.
    pub j: u32,
    /// Product of the arclengths of the two vertices, in h².
    pub weight: f64,
    /// Distance r, in h.
    pub distance: f64,
    /// Distance below which they repel, in h.
    pub limit: f64,
    /// (x_i − x_j)/r.
    pub normal: Vector3<f64>,
}

/// Share of the chord of the tightest bend below which neighbours along the rod repel.
const SHARE: f64 = 0.5;
/// Spacing along the rod, in h, at which pairs are looked for on finer rods.
const SPACING: f64 = 0.25;

/// Repulsion that keeps a rod from collapsing inside the contact window, where contact does not act.
///
/// A tube of radius h cannot be bent to a radius below h, so that two points an arc s < πh apart are at least 2h sin(s/2h)
/// apart in space. The stretch energy alone does not enforce this: an edge of length zero costs a finite energy, and at θ'h =
/// ±4 and γ = 1 curls shrink through themselves. Neighbours along the rod closer than half that chord therefore repel by the
/// law of the contact. Rods of γ ≥ 2 stay above 0.7 of the chord, and no pair is ever found on them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Core;

impl Core {
    /// Pairs below their limit at `state`, ascending; those across the ends of an open rod are left out.
    pub(crate) fn find(state: &RodState, out: &mut Vec<CorePair>) {
        out.clear();
        for chain in state.components() {
            Self::find_along(state.vertices(), chain, out);
        }
        out.sort_unstable_by_key(|p| (p.i, p.j));
    }

    fn find_along(x: &[Vector3<f64>], chain: &Chain, out: &mut Vec<CorePair>) {
        let (first, n, l0) = (chain.first(), chain.n_vertices(), chain.rest_length());
        // on a rod much shorter than the spacing no pair is far enough apart
        let stride = ((SPACING / l0) as usize).clamp(1, n.max(1));
        let share = l0 * stride as f64;
        let longest = (std::f64::consts::PI / share) as usize;
        for k in 1..=longest {
            let apart = k * stride;
            if 2 * apart >= n {
                break;
            }
            let limit = SHARE * 2.0 * (0.5 * share * k as f64).sin();
            let square = limit * limit;
            let last = if chain.is_closed() { n } else { n - apart };
            for i in (0..last).step_by(stride) {
                let j = if i + apart < n {
                    i + apart
                } else {
                    i + apart - n
                };
                let d = x[first + i] - x[first + j];
                let found = d.norm_squared();
                if found < square {
                    let distance = found.sqrt().max(1e-9);
                    let sign = if i < j { 1.0 } else { -1.0 };
                    out.push(CorePair {
                        i: (first + i.min(j)) as u32,
                        j: (first + i.max(j)) as u32,
                        weight: share * share,
                        distance,
                        limit,
                        normal: d * (sign / distance),
                    });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_core::Polyline;

    fn found(points: impl Iterator<Item = [f64; 3]>, closed: bool, length: f64) -> Vec<CorePair> {
        let curve = Polyline::new(points.map(Vector3::from).collect(), closed).unwrap();
        let mut out = Vec::new();
        Core::find(&RodState::new(&curve, length, 0.0).unwrap(), &mut out);
        out
    }

    #[test]
    fn straight_rods_and_the_tightest_ring_have_none() {
        let line = (0..=100).map(|k| [0.1 * f64::from(k), 0.0, 0.0]);
        assert!(found(line, false, 10.0).is_empty());
        let ring = |radius: f64| {
            (0..64).map(move |k| {
                let u = std::f64::consts::TAU * f64::from(k) / 64.0;
                [radius * u.cos(), radius * u.sin(), 0.0]
            })
        };
        let length = std::f64::consts::TAU;
        assert!(found(ring(1.0), true, length).is_empty());
        // a ring shrunk below half of that is everywhere too close, across its seam as well
        let shrunk = found(ring(0.45), true, length);
        assert!(shrunk.iter().any(|p| (p.i, p.j) == (0, 60)));
        assert!(
            shrunk
                .windows(2)
                .all(|p| (p[0].i, p[0].j) < (p[1].i, p[1].j))
        );
        // weights sum to the integral over all pairs less than half a turn apart, however fine the ring
        let fine = (0..1024).map(|k| std::f64::consts::TAU * f64::from(k) / 1024.0);
        let fine = fine.map(|u| [0.45 * u.cos(), 0.45 * u.sin(), 0.0]);
        let integral = length * std::f64::consts::PI;
        for pairs in [&shrunk, &found(fine, true, length)] {
            let sum: f64 = pairs.iter().map(|p| p.weight).sum();
            assert!((sum / integral - 1.0).abs() < 0.1, "{sum} {integral}");
        }
        // of a link, each component has its own
        let curve =
            |radius| Polyline::new(ring(radius).map(Vector3::from).collect(), true).unwrap();
        let rods = [1.0, 0.45, 1.0].map(|r| RodState::new(&curve(r), length, 0.0).unwrap());
        let mut behind = Vec::new();
        Core::find(&RodState::link(&rods).unwrap(), &mut behind);
        let moved = |p: &CorePair| (p.i - 64, p.j - 64, p.weight, p.normal);
        let expected: Vec<_> = shrunk
            .iter()
            .map(|p| (p.i, p.j, p.weight, p.normal))
            .collect();
        assert_eq!(behind.iter().map(moved).collect::<Vec<_>>(), expected);
        let first = shrunk[0];
        let pulled = first.normal.dot(&Vector3::new(1.0, 0.0, 0.0));
        assert!(pulled > 0.0 && first.distance < first.limit);
    }
}
