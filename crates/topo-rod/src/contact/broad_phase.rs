//! The only file that names parry: a bounding volume hierarchy over stretches of a curve.
//!
//! An edge of a slender rod is shorter than the rod is thick, so one leaf per edge would mostly find neighbours along the arc.
//! One leaf holds a stretch about as long as the reach.

use nalgebra::Vector3;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};

/// Up to as many boxes each is held against each: a tree takes longer to build.
const FEW: usize = 128;

/// Lowest and highest corner.
type Corners = [Vector3<f64>; 2];

/// Finds pairs of stretches of a curve that may be within a distance of each other.
#[derive(Default)]
pub struct BroadPhase {
    workspace: BvhWorkspace,
    boxes: Vec<Corners>,
    pairs: Vec<(u32, u32)>,
}

impl std::fmt::Debug for BroadPhase {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("BroadPhase")
            .field("n_leaves", &self.boxes.len())
            .finish_non_exhaustive()
    }
}

impl BroadPhase {
    /// Calls `found(a, b)` with a ≤ b, in ascending order, for every pair of stretches (a stretch with itself included) whose
    /// boxes come within `reach`; stretch a holds the points `a·stride .. (a+1)·stride` and, for its box, the next one.
    pub fn for_each_pair(
        &mut self,
        points: &[Vector3<f64>],
        closed: bool,
        stride: usize,
        reach: f64,
        mut found: impl FnMut(usize, usize),
    ) {
        let n = points.len();
        let margin = 0.5 * reach;
        self.boxes.clear();
        for first in (0..n).step_by(stride) {
            let last = (first + stride).min(if closed { n } else { n - 1 });
            let (mut low, mut high) = (points[first], points[first]);
            for k in first + 1..=last {
                let p = &points[k % n];
                low = low.inf(p);
                high = high.sup(p);
            }
            low.add_scalar_mut(-margin);
            high.add_scalar_mut(margin);
            self.boxes.push([low, high]);
        }
        if self.boxes.len() <= FEW {
            for (a, one) in self.boxes.iter().enumerate() {
                found(a, a);
                for (b, other) in self.boxes.iter().enumerate().skip(a + 1) {
                    if overlap(one, other) {
                        found(a, b);
                    }
                }
            }
        } else {
            self.pairs_of_tree();
            for &(a, b) in &self.pairs {
                found(a as usize, b as usize);
            }
        }
    }

    /// The pairs whose boxes overlap, and each box with itself, ascending.
    fn pairs_of_tree(&mut self) {
        let vector = |v: &Vector3<f64>| Vector::new(v.x, v.y, v.z);
        let boxes = self
            .boxes
            .iter()
            .map(|[low, high]| Aabb::new(vector(low), vector(high)));
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes.collect::<Vec<_>>());
        self.pairs.clear();
        self.pairs
            .extend((0..self.boxes.len() as u32).map(|a| (a, a)));
        let pairs = &mut self.pairs;
        tree.traverse_bvtt_single_tree::<false>(&mut self.workspace, &mut |a, b| {
            pairs.push((a.min(b), a.max(b)))
        });
        // the tree's order is an accident of its shape; sums over pairs must not depend on it
        self.pairs.sort_unstable();
    }
}

fn overlap([low, high]: &Corners, [other_low, other_high]: &Corners) -> bool {
    (0..3).all(|k| low[k] <= other_high[k] && other_low[k] <= high[k])
}

/// All pairs i < j of edges of a curve, not sharing a vertex, whose distance may be at most `reach` (a superset, ascending).
pub fn close_pairs(vertices: &[Vector3<f64>], closed: bool, reach: f64, out: &mut Vec<(u32, u32)>) {
    out.clear();
    let n = vertices.len();
    let n_edges = if closed { n } else { n - 1 };
    let length: f64 = (0..n_edges)
        .map(|j| (vertices[(j + 1) % n] - vertices[j]).norm())
        .sum();
    let stride =
        ((reach * n_edges as f64 / length).ceil() as usize).clamp(1, n_edges.div_ceil(4).max(1));
    let middle = |j: usize| (vertices[j] + vertices[(j + 1) % n]) * 0.5;
    let half = |j: usize| (vertices[(j + 1) % n] - vertices[j]).norm() * 0.5;
    BroadPhase::default().for_each_pair(vertices, closed, stride, reach, |a, b| {
        for i in a * stride..((a + 1) * stride).min(n_edges) {
            for j in (b * stride).max(i + 2)..((b + 1) * stride).min(n_edges) {
                if closed && i == 0 && j == n_edges - 1 {
                    continue;
                }
                let limit = reach + half(i) + half(j);
                if (middle(i) - middle(j)).norm_squared() <= limit * limit {
                    out.push((i as u32, j as u32));
                }
            }
        }
    });
    out.sort_unstable();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::segment_distance;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn few_boxes_and_a_tree_find_the_same_pairs(seed in proptest::collection::vec((-3.0f64..3.0, -3.0f64..3.0, -3.0f64..3.0), 5..FEW), reach in 0.1f64..3.0) {
            let v: Vec<_> = seed.iter().map(|p| Vector3::new(p.0, p.1, p.2)).collect();
            let (mut phase, mut found) = (BroadPhase::default(), Vec::new());
            phase.for_each_pair(&v, true, 1, reach, |a, b| found.push((a as u32, b as u32)));
            phase.pairs_of_tree();
            prop_assert_eq!(found, phase.pairs);
        }

        #[test]
        fn close_pairs_miss_nothing(seed in proptest::collection::vec((-3.0f64..3.0, -3.0f64..3.0, -3.0f64..3.0), 5..60), closed: bool, reach in 0.1f64..3.0) {
            let v: Vec<_> = seed.iter().map(|p| Vector3::new(p.0, p.1, p.2)).collect();
            let n = v.len();
            let n_edges = if closed { n } else { n - 1 };
            let mut found = Vec::new();
            close_pairs(&v, closed, reach, &mut found);
            for i in 0..n_edges {
                for j in i + 2..n_edges {
                    if closed && i == 0 && j == n_edges - 1 { continue; }
                    let d = segment_distance(&v[i], &v[(i + 1) % n], &v[j], &v[(j + 1) % n]);
                    if d < reach {
                        prop_assert!(found.binary_search(&(i as u32, j as u32)).is_ok(), "pair {i} {j} at {d} missed");
                    }
                }
            }
        }
    }
}
