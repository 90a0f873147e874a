//! Diagrams: closed polygons as they are seen from a point outside, every crossing decided without rounding.

use super::diagram::{Diagram, Visit};
use crate::rings::Rings;
use crate::{KnotError, V, exact};

/// Directions spread evenly over the sphere along Fibonacci's spiral, turned by `seed` about a skew axis.
pub(crate) fn fibonacci_directions(n: usize, seed: u64) -> impl Iterator<Item = V> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let start = 0.5 + 2.399_963 * (seed % 10_007) as f64;
    let axis = nalgebra::Unit::new_normalize(V::new(0.3, -0.5, 0.81));
    let turn = nalgebra::Rotation3::from_axis_angle(&axis, 0.7 + 0.618_034 * (seed % 997) as f64);
    (0..n).map(move |k| {
        let z = 1.0 - (2 * k + 1) as f64 / n as f64;
        let (sin, cos) = (start + golden * k as f64).sin_cos();
        let rho = (1.0 - z * z).max(0.0).sqrt();
        turn * V::new(rho * cos, rho * sin, z)
    })
}

/// Further views for the rare curve of which all others are degenerate.
const N_MORE_VIEWS: usize = 64;

/// The diagram with the fewest crossings, once simplified, among `n_views` from all around.
///
/// # Errors
/// [`KnotError::Degenerate`] if the curve touches itself, or no view is in general position.
///
/// # Validation
/// `every_view_gives_the_same_and_sums_multiply`, `curves_that_touch_themselves_are_refused`.
pub(crate) fn least_crossing(
    vertices: &[V],
    n_views: usize,
    seed: u64,
) -> Result<Diagram, KnotError> {
    least_crossing_of(vertices, &Rings::one(vertices.len()), n_views, seed)
}

/// The same of several closed polygons, with their vertices one after the other.
pub(crate) fn least_crossing_of(
    vertices: &[V],
    rings: &Rings,
    n_views: usize,
    seed: u64,
) -> Result<Diagram, KnotError> {
    let mut viewer = Viewer::of(rings);
    match viewer.best_of(vertices, n_views, seed)? {
        Some(diagram) => Ok(diagram),
        None => viewer
            .best_of(vertices, N_MORE_VIEWS, seed + 1)?
            .ok_or(KnotError::Degenerate),
    }
}

/// What a view shows.
enum View {
    Diagram(Diagram),
    /// More crossings than allowed, or a vertex on an edge, or crossings of an edge too close to be kept apart.
    Unusable,
    /// The curve runs through itself.
    Touching,
}

/// One passage through a crossing: which edge, where along it, and how exactly that is known.
#[derive(Debug, Clone, Copy)]
struct Passage {
    edge: u32,
    low: f64,
    high: f64,
    visit: Visit,
}

/// Looks at curves; keeps its buffers between calls.
#[derive(Debug, Default)]
struct Viewer {
    rings: Rings,
    /// The vertex after each.
    next: Vec<usize>,
    eye: V,
    /// Vertices seen from the eye.
    from_eye: Vec<V>,
    /// Normal of the plane of the eye and each edge, and the sums of the sizes of its terms.
    normals: Vec<(V, V)>,
    /// The picture, for a first comparison alone.
    picture: Vec<[f64; 2]>,
    passages: Vec<Passage>,
    signs: Vec<i8>,
}

/// Distance of the eye in units of the half extents: the curve lies in a box within 1.8.
const EYE: f64 = 8.0;
/// Extent along one axis, in units of the largest, below which it is always stretched: little could be resolved otherwise.
const SLENDER: f64 = 1e-3;
/// Margin of the picture in its units: far above its rounding.
const MARGIN: f64 = 1e-11;
/// Crossings of a view in units of those of the best so far, simplified, beyond which it is not simplified.
const WORTH_A_TRY: usize = 4;

impl Viewer {
    fn of(rings: &Rings) -> Self {
        Self {
            rings: rings.clone(),
            next: rings.next(),
            ..Self::default()
        }
    }

    fn best_of(
        &mut self,
        vertices: &[V],
        n_views: usize,
        seed: u64,
    ) -> Result<Option<Diagram>, KnotError> {
        let mut best: Option<Diagram> = None;
        for (k, direction) in fibonacci_directions(n_views, seed).enumerate() {
            let n_best = best.as_ref().map_or(usize::MAX, Diagram::n_crossings);
            match self.look(
                vertices,
                direction,
                k % 2 == 1,
                n_best.saturating_mul(WORTH_A_TRY),
            ) {
                View::Touching => return Err(KnotError::Degenerate),
                View::Unusable => {}
                View::Diagram(mut diagram) => {
                    diagram.simplify();
                    if diagram.n_crossings() < 3 {
                        return Ok(Some(diagram));
                    }
                    if diagram.n_crossings() < n_best {
                        best = Some(diagram);
                    }
                }
            }
        }
        Ok(best)
    }

    /// What is seen from an eye in the given direction, of the curve as it is or, to `follow` its extents, stretched to a cube.
    fn look(&mut self, vertices: &[V], direction: V, follow: bool, limit: usize) -> View {
        self.place_eye(vertices, direction, follow);
        self.passages.clear();
        self.signs.clear();
        let n = vertices.len();
        for i in 0..n {
            let (a, b) = (self.picture[i], self.picture[self.next[i]]);
            let (low_x, high_x) = (a[0].min(b[0]) - MARGIN, a[0].max(b[0]) + MARGIN);
            let (low_y, high_y) = (a[1].min(b[1]) - MARGIN, a[1].max(b[1]) + MARGIN);
            let own = self.rings.range(self.rings.ring(i));
            let last = if i == own.start { own.end - 1 } else { own.end };
            for j in (i + 2..last).chain(own.end..n) {
                let (c, d) = (self.picture[j], self.picture[self.next[j]]);
                if (c[0].min(d[0]) > high_x)
                    | (c[0].max(d[0]) < low_x)
                    | (c[1].min(d[1]) > high_y)
                    | (c[1].max(d[1]) < low_y)
                {
                    continue;
                }
                match self.meet(vertices, i, j) {
                    Meeting::Apart => {}
                    Meeting::Unclear => return View::Unusable,
                    Meeting::Touch => return View::Touching,
                    Meeting::Crossing if self.signs.len() > limit => return View::Unusable,
                    Meeting::Crossing => {}
                }
            }
        }
        self.diagram().map_or(View::Unusable, View::Diagram)
    }

    /// Puts the eye outside the box of the curve and draws the picture.
    fn place_eye(&mut self, vertices: &[V], direction: V, follow: bool) {
        let (mut low, mut high) = (vertices[0], vertices[0]);
        for x in vertices {
            low = low.inf(x);
            high = high.sup(x);
        }
        let centre = 0.5 * (low + high);
        let largest = (high - low).amax();
        // A flat curve must not be looked at from within its plane.
        let follows = |e: f64| e > 0.0 && (follow || e < SLENDER * largest);
        let half = (high - low).map(|e| 0.5 * if follows(e) { e } else { largest });
        let w = direction.normalize();
        let u = if w.x.abs() < 0.6 { V::x() } else { V::y() }
            .cross(&w)
            .normalize();
        let v = w.cross(&u);
        self.eye = centre + EYE * w.component_mul(&half);
        self.from_eye.clear();
        self.picture.clear();
        for x in vertices {
            self.from_eye.push(x - self.eye);
            let y = (x - centre).component_div(&half);
            let scale = EYE / (EYE - y.dot(&w));
            self.picture.push([y.dot(&u) * scale, y.dot(&v) * scale]);
        }
        self.normals.clear();
        let from_eye = &self.from_eye;
        self.normals
            .extend(self.next.iter().enumerate().map(|(i, next)| {
                let sizes = |p: &V, q: &V| {
                    let term = |i: usize, j: usize| (p[i] * q[j]).abs() + (p[j] * q[i]).abs();
                    V::new(term(1, 2), term(2, 0), term(0, 1))
                };
                let (p, q) = (&from_eye[i], &from_eye[*next]);
                (p.cross(q), sizes(p, q))
            }));
    }

    /// Six times the volume of eye, edge and vertex, and a bound of its error; if that leaves the sign open, a number of the right
    /// sign.
    fn side(&self, vertices: &[V], edge: usize, vertex: usize) -> (f64, f64) {
        let (normal, sizes) = &self.normals[edge];
        let to = &self.from_eye[vertex];
        let volume = normal.dot(to);
        let error = exact::VOLUME_ERROR * sizes.dot(&to.abs());
        if volume.abs() > error {
            return (volume, error);
        }
        let [a, b, c] = [edge, self.next[edge], vertex].map(|k| &vertices[k]);
        let sign = exact::volume(a, b, c, &self.eye);
        let sign = if sign == 0.0 { 0.0 } else { sign.signum() };
        (sign * f64::MIN_POSITIVE.max(volume.abs()), error)
    }

    /// Whether two edges cross, and how; a crossing is noted.
    fn meet(&mut self, vertices: &[V], i: usize, j: usize) -> Meeting {
        let (i_end, j_end) = (self.next[i], self.next[j]);
        let (c, c_error) = self.side(vertices, i, j);
        let (d, d_error) = self.side(vertices, i, j_end);
        if (c > 0.0 && d > 0.0) || (c < 0.0 && d < 0.0) {
            return Meeting::Apart;
        }
        let (a, a_error) = self.side(vertices, j, i);
        let (b, b_error) = self.side(vertices, j, i_end);
        if (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0) {
            return Meeting::Apart;
        }
        if a == 0.0 || b == 0.0 || c == 0.0 || d == 0.0 {
            return Meeting::Unclear;
        }
        let ends = [i, i_end, j, j_end].map(|k| &vertices[k]);
        let volume = exact::volume(ends[0], ends[1], ends[2], ends[3]);
        if volume == 0.0 {
            return Meeting::Touch;
        }
        // With d on the positive side, the second edge passes from right to left as seen along the ray: left to right for us.
        let first_is_over = (volume > 0.0) == (d > 0.0);
        let crossing = self.signs.len() as u32;
        self.signs
            .push(if (d > 0.0) == first_is_over { -1 } else { 1 });
        for (edge, (from, from_error), (to, to_error), over) in [
            (i, (a, a_error), (b, b_error), first_is_over),
            (j, (c, c_error), (d, d_error), !first_is_over),
        ] {
            let whole = from.abs() + to.abs();
            let at = from.abs() / whole;
            // Twice the errors, for the rounding of the quotient.
            let error = 2.0 * (from_error + to_error) / whole + 4.0 * f64::EPSILON;
            self.passages.push(Passage {
                edge: edge as u32,
                low: at - error,
                high: at + error,
                visit: Visit { crossing, over },
            });
        }
        Meeting::Crossing
    }

    /// The diagram of the passages; none if the order of two on one edge is not known for certain.
    fn diagram(&mut self) -> Option<Diagram> {
        self.passages
            .sort_by(|p, q| p.edge.cmp(&q.edge).then(p.low.total_cmp(&q.low)));
        let in_order = |p: &[Passage]| p[0].edge != p[1].edge || p[0].high < p[1].low;
        if !self.passages.windows(2).all(in_order) {
            return None;
        }
        let until = |end: usize| self.passages.partition_point(|p| (p.edge as usize) < end);
        let of_ring = |r: std::ops::Range<usize>| until(r.end) - until(r.start);
        Some(Diagram {
            visits: self.passages.iter().map(|p| p.visit).collect(),
            signs: self.signs.clone(),
            rings: Rings::of(self.rings.ranges().map(of_ring)),
        })
    }
}

enum Meeting {
    Apart,
    /// One's end lies on the other, as seen from here.
    Unclear,
    /// They have a point in common.
    Touch,
    Crossing,
}

/// The diagram of one view, as it is seen.
#[cfg(test)]
pub(crate) fn one_view(vertices: &[V], seed: u64) -> Diagram {
    let mut viewer = Viewer::of(&Rings::one(vertices.len()));
    let mut views = fibonacci_directions(16, seed).filter_map(|direction| {
        match viewer.look(vertices, direction, false, usize::MAX) {
            View::Diagram(diagram) => Some(diagram),
            _ => None,
        }
    });
    views.next().expect("general position")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_cover_the_sphere() {
        let directions: Vec<V> = fibonacci_directions(200, 3).collect();
        let mean = directions.iter().sum::<V>() / 200.0;
        assert!(mean.norm() < 0.02, "mean {mean}");
        assert!(directions.iter().all(|d| (d.norm() - 1.0).abs() < 1e-12));
    }

    #[test]
    fn a_planar_circle_has_a_diagram_without_crossings() {
        let circle: Vec<V> = (0..40)
            .map(|k| (std::f64::consts::TAU * k as f64 / 40.0).sin_cos())
            .map(|(s, c)| V::new(c, s, 0.0))
            .collect();
        assert_eq!(
            least_crossing(&circle, 8, 0)
                .expect("general")
                .n_crossings(),
            0
        );
    }
}
