//! Pairs of edges of several curves that come near each other.

use std::ops::Range;

use topo_rod::contact::close_pairs;

use crate::V;
use crate::rings::Rings;

/// Edges of a stretch that has one box.
const STRETCH: usize = 8;

/// All pairs i < j of edges of closed curves, not sharing a vertex, whose distance may be at most `reach` (a superset, ascending).
///
/// # Validation
/// `pairs_of_several_curves_miss_nothing`
pub(super) fn all_close_pairs(x: &[V], rings: &Rings, reach: f64, out: &mut Vec<(u32, u32)>) {
    if rings.n_rings() == 1 {
        return close_pairs(x, true, reach, out);
    }
    out.clear();
    let mut own = Vec::new();
    for range in rings.ranges() {
        let first = range.start as u32;
        close_pairs(&x[range], true, reach, &mut own);
        out.extend(own.iter().map(|(i, j)| (i + first, j + first)));
    }
    let next = rings.next();
    let stretches: Vec<Vec<Stretch>> = rings
        .ranges()
        .map(|range| stretches(x, &next, range))
        .collect();
    for (b, upper) in stretches.iter().enumerate() {
        for lower in &stretches[..b] {
            for (p, q) in lower.iter().flat_map(|p| upper.iter().map(move |q| (p, q))) {
                if p.is_within(q, reach) {
                    let pairs = |i: usize| q.edges.clone().map(move |j| (i as u32, j as u32));
                    out.extend(p.edges.clone().flat_map(pairs));
                }
            }
        }
    }
    out.sort_unstable();
}

/// Successive edges and their box.
struct Stretch {
    edges: Range<usize>,
    low: V,
    high: V,
}

fn stretches(x: &[V], next: &[usize], range: Range<usize>) -> Vec<Stretch> {
    let stretch = |first: usize| {
        let edges = first..(first + STRETCH).min(range.end);
        let (mut low, mut high) = (x[first], x[first]);
        for i in edges.clone() {
            let end = &x[next[i]];
            (low, high) = (low.inf(end), high.sup(end));
        }
        Stretch { edges, low, high }
    };
    range.clone().step_by(STRETCH).map(stretch).collect()
}

impl Stretch {
    fn is_within(&self, other: &Self, reach: f64) -> bool {
        let gap = (self.low - other.high).sup(&(other.low - self.high));
        gap.map(|g| g.max(0.0)).norm_squared() <= reach * reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::braid_closure;
    use crate::curves::Curves;
    use topo_core::closest_points;

    #[test]
    fn pairs_of_several_curves_miss_nothing() {
        let curves = Curves::from(braid_closure(&[1, 1, -2, 2, 2, 1]).expect("a link"));
        let curves = curves.resampled(170).expect("resampled");
        let (x, rings) = (curves.vertices(), curves.rings());
        let next = rings.next();
        let mut found = Vec::new();
        for reach in [1.0, 2.5, 4.0] {
            all_close_pairs(&x, &rings, reach, &mut found);
            assert!(found.windows(2).all(|w| w[0] < w[1]));
            let mut n_near = 0;
            for i in 0..x.len() {
                for j in i + 1..x.len() {
                    let near = closest_points(&x[i], &x[next[i]], &x[j], &x[next[j]]).0;
                    if near < reach * reach && next[i] != j && next[j] != i {
                        n_near += 1;
                        assert!(found.binary_search(&(i as u32, j as u32)).is_ok());
                    }
                }
            }
            assert!(n_near <= found.len() && found.len() < 8 * n_near + 300);
        }
    }
}
