//! Shortening a chain without changing its type: a vertex goes when nothing pierces the triangle with its neighbours.

mod boxes;

use crate::V;
use crate::exact::{is_between, is_in_angle, is_pierced, volume};
use boxes::{Aabb, EdgeBoxes};

/// Rays from the ends of an open chain that no triangle may meet; none for a closed one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ray {
    /// Where it starts.
    pub from: V,
    /// Where it ends, far away.
    pub to: V,
    /// Unit vector from start to end.
    pub direction: V,
}

impl Ray {
    /// The segment between two distinct points.
    pub fn new(from: V, to: V) -> Self {
        Self {
            from,
            to,
            direction: (to - from).normalize(),
        }
    }
}

/// Fewest vertices of a knotted polygon.
const LEAST_CLOSED: usize = 6;
/// Marks a vertex that is gone.
const REMOVED: u32 = u32::MAX;

/// Reduces chains by the moves of Koniaris and Muthukumar; keeps its buffers between calls.
///
/// # References
/// [koniaris1991], [reidemeister1927]
///
/// [koniaris1991]: https://doi.org/10.1063/1.460889
/// [reidemeister1927]: https://doi.org/10.1007/BF02952507
#[derive(Debug, Default)]
pub(crate) struct Reducer {
    /// The chain; after a reduction, what is left of it.
    pub x: Vec<V>,
    boxes: EdgeBoxes,
    next: Vec<u32>,
    /// Edges of other curves, which no triangle may meet; a closed chain then keeps at least a triangle.
    pub others: Vec<[V; 2]>,
    /// Triangles tested, for the tests of cost.
    pub n_triangles: usize,
}

impl Reducer {
    /// Loads a chain, leaving out vertices that repeat their predecessor.
    pub fn load(&mut self, vertices: &[V], closed: bool) {
        self.x.clear();
        for x in vertices {
            if self.x.last() != Some(x) {
                self.x.push(*x);
            }
        }
        while closed && self.x.len() > 1 && self.x.last() == self.x.first() {
            self.x.pop();
        }
    }

    /// Removes vertices until no triangle is free, or fewer than six are left on a closed chain (no knot has so few).
    ///
    /// The two ends of an open chain stay. Every triangle is kept clear of `rays` too, so that the chain keeps its type
    /// under the closure along any of them.
    pub fn reduce(&mut self, closed: bool, rays: &[Ray]) {
        // Single precision rounds by 6e-8; a curve may be much longer along one axis than along another.
        let sizes = |s: V, x: &V| s.sup(&x.abs());
        let ends = self.others.iter().flatten();
        let size = self.x.iter().chain(ends).fold(V::zeros(), sizes);
        let pad = [0, 1, 2].map(|k| (1e-6 * size[k]) as f32);
        let least = match closed && self.others.is_empty() {
            true => LEAST_CLOSED,
            false => 3,
        };
        let mut n_idle = 0;
        while self.x.len() >= least && n_idle < 2 {
            n_idle = if self.pass(closed, rays, pad) {
                0
            } else {
                n_idle + 1
            };
            // The first vertex of a pass stays; a closed chain starts elsewhere next time.
            if closed {
                self.x.rotate_left(1);
            } else if n_idle == 1 {
                break;
            }
        }
    }

    /// One pass along the chain; false if no vertex could go.
    fn pass(&mut self, closed: bool, rays: &[Ray], pad: [f32; 3]) -> bool {
        let n = self.x.len();
        let n_edges = if closed { n } else { n - 1 };
        let fewest = match self.others.is_empty() {
            true => LEAST_CLOSED - 1,
            false => 3,
        };
        self.boxes.reset(n_edges + self.others.len());
        for (k, [p, q]) in self.others.iter().enumerate() {
            self.boxes.set(n_edges + k, &Aabb::around(&[p, q], pad));
        }
        self.next.clear();
        self.next
            .extend((1..=n as u32).map(|i| if i == n as u32 { 0 } else { i }));
        for i in 0..n_edges {
            let b = Aabb::around(&[&self.x[i], &self.x[self.next[i] as usize]], pad);
            self.boxes.set(i, &b);
        }
        let mut removed = 0;
        let mut before = if closed { n - 1 } else { usize::MAX };
        let mut a = 0;
        loop {
            let b = self.next[a] as usize;
            if b == 0 || (!closed && b == n - 1) || (closed && n - removed <= fewest) {
                break;
            }
            let c = self.next[b] as usize;
            let free = self.is_free([a, b, c], before, n_edges, pad, rays);
            before = a;
            a = b;
            if free {
                self.boxes.clear(b);
                let merged = Aabb::around(&[&self.x[before], &self.x[c]], pad);
                self.boxes.set(before, &merged);
                self.next[before] = c as u32;
                self.next[b] = REMOVED;
                removed += 1;
                // Skipping ahead keeps edges of about equal length, whose boxes overlap little.
                a = c;
                if c == 0 {
                    break;
                }
            }
        }
        if removed == 0 {
            return false;
        }
        let mut kept = 0;
        for i in 0..n {
            if self.next[i] != REMOVED {
                self.x[kept] = self.x[i];
                kept += 1;
            }
        }
        self.x.truncate(kept);
        true
    }

    /// Whether no other edge and no ray pierces the triangle of successive vertices.
    fn is_free(
        &mut self,
        [a, b, c]: [usize; 3],
        before: usize,
        n_edges: usize,
        pad: [f32; 3],
        rays: &[Ray],
    ) -> bool {
        self.n_triangles += 1;
        let (x, next) = (&self.x, &self.next);
        let corners = [&x[a], &x[b], &x[c]];
        if is_between(corners[0], corners[1], corners[2]) {
            // Without the vertex, the chain runs through the same points.
            return true;
        }
        // Neighbours share a corner; within the plane of the triangle they may run into it from there.
        let runs_in = |from: usize, to: usize, other: usize| {
            volume(corners[0], corners[1], corners[2], &x[to]) == 0.0
                && is_in_angle(&x[from], &x[b], &x[other], &x[to])
        };
        let after = if n_edges > c {
            Some(next[c] as usize)
        } else {
            None
        };
        if before != usize::MAX && runs_in(a, before, c) || after.is_some_and(|d| runs_in(c, d, a))
        {
            return false;
        }
        let bounds = Aabb::around(&corners, pad);
        let hit = self.boxes.any(&bounds, |edge| {
            if edge >= n_edges {
                let [p, q] = &self.others[edge - n_edges];
                return is_pierced(corners, p, q);
            }
            edge != a
                && edge != b
                && edge != c
                && edge != before
                && is_pierced(corners, &x[edge], &x[next[edge] as usize])
        });
        !hit && (rays.is_empty() || !is_pierced_by_any(corners, rays))
    }
}

/// Whether a ray that does not start at the first or the last of the corners pierces their triangle.
fn is_pierced_by_any(corners: [&V; 3], rays: &[Ray]) -> bool {
    let [a, b, c] = corners;
    let centre = (a + b + c) / 3.0;
    let reach = (a - centre)
        .norm_squared()
        .max((b - centre).norm_squared())
        .max((c - centre).norm_squared());
    rays.iter().any(|ray| {
        let to = centre - ray.from;
        let along = to.dot(&ray.direction);
        let ahead = along.max(0.0);
        // A first comparison; the second margin is for the rounding of a difference of large numbers.
        to.norm_squared() - ahead * (2.0 * along - ahead)
            <= reach * (1.0 + 1e-9) + 1e-13 * to.norm_squared()
            && ray.from != *a
            && ray.from != *c
            && is_pierced(corners, &ray.from, &ray.to)
    })
}

/// A closed curve of the same type with as few vertices as removing them one by one leaves.
pub(crate) fn shortened(vertices: &[V]) -> Vec<V> {
    let mut reducer = Reducer::default();
    reducer.load(vertices, true);
    reducer.reduce(true, &[]);
    while reducer.x.len() < 3 {
        // What is left of an unknot, or of a single point.
        reducer.x.push(vertices[reducer.x.len()]);
    }
    reducer.x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Invariants, KnotTable, closed_braid};

    #[test]
    fn keeps_the_type_of_the_table() {
        let mut reducer = Reducer::default();
        for knot in KnotTable::builtin().iter() {
            let curve = closed_braid(&knot.braid).expect("a knot");
            reducer.load(curve.vertices(), true);
            reducer.reduce(true, &[]);
            assert!(
                reducer.x.len() < 40,
                "{}: {} vertices left",
                knot.name,
                reducer.x.len()
            );
            assert_eq!(
                Invariants::of(&reducer.x).expect("a knot"),
                knot.invariants,
                "{}",
                knot.name
            );
        }
    }

    #[test]
    fn a_straight_chain_and_a_circle_collapse() {
        let mut reducer = Reducer::default();
        let rod: Vec<V> = (0..200).map(|k| V::new(0.1 * k as f64, 0.0, 0.0)).collect();
        reducer.load(&rod, false);
        reducer.reduce(false, &[]);
        assert_eq!(reducer.x, [rod[0], rod[199]]);
        let circle: Vec<V> = (0..200)
            .map(|k| (0.01 * std::f64::consts::PI * k as f64).sin_cos())
            .map(|(s, c)| V::new(c, s, 0.3 * s * c))
            .collect();
        reducer.load(&circle, true);
        reducer.reduce(true, &[]);
        assert!(reducer.x.len() < LEAST_CLOSED);
    }

    #[test]
    fn a_ray_through_a_loop_keeps_it() {
        let bow = [
            V::new(0.0, 0.0, 0.0),
            V::new(1.0, 2.0, 0.0),
            V::new(2.0, 0.0, 0.0),
        ];
        let through = Ray::new(V::new(1.0, 0.7, -1.0), V::new(1.0, 0.7, 50.0));
        let beside = Ray::new(V::new(1.0, 2.7, -1.0), V::new(1.0, 2.7, 50.0));
        let mut reducer = Reducer::default();
        for (ray, n) in [(through, 3), (beside, 2)] {
            reducer.load(&bow, false);
            reducer.reduce(false, &[ray]);
            assert_eq!(reducer.x.len(), n);
        }
    }
}
