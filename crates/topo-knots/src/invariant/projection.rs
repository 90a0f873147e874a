//! Knot diagrams by projecting a closed polygon along a direction.

use std::borrow::Cow;

use super::diagram::{Diagram, Visit};
use crate::{KnotError, V};

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

/// Coordinates whose third powers, and fourth ones of their differences, are far from overflow and underflow.
const TAME: std::ops::Range<f64> = 1e-30..1e30;

/// Refuses curves with too few or non-finite vertices; curves of outlandish size are scaled by a power of two.
pub(crate) fn usable_vertices(vertices: &[V], closed: bool) -> Result<Cow<'_, [V]>, KnotError> {
    let least = if closed { 3 } else { 2 };
    if vertices.len() < least {
        return Err(KnotError::TooFewVertices {
            n_vertices: vertices.len(),
        });
    }
    let mut size = 0.0_f64;
    for (vertex, x) in vertices.iter().enumerate() {
        if !x.iter().all(|c| c.is_finite()) {
            return Err(KnotError::NotFinite { vertex });
        }
        size = size.max(x.amax());
    }
    if size == 0.0 || TAME.contains(&size) {
        return Ok(Cow::Borrowed(vertices));
    }
    // In two steps: 2^1074 itself is beyond the largest number.
    let half = (-0.5 * size.log2()).round().exp2();
    Ok(Cow::Owned(
        vertices.iter().map(|x| x * half * half).collect(),
    ))
}

/// The diagram with the fewest crossings among `n_directions` projections; none if all are degenerate.
pub(crate) fn least_crossing(vertices: &[V], n_directions: usize, seed: u64) -> Option<Diagram> {
    let mut projector = Projector::default();
    let mut best = usize::MAX;
    let mut diagram = None;
    for direction in fibonacci_directions(n_directions, seed) {
        if projector.find_crossings(vertices, direction, best) {
            best = projector.crossings.len();
            diagram = Some(direction);
            if best < 3 {
                break;
            }
        }
    }
    let direction = diagram?;
    projector
        .find_crossings(vertices, direction, usize::MAX)
        .then(|| projector.diagram())
}

/// One crossing of two edges: position of the upper and the lower visit along the curve, and the sign.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    over: f64,
    under: f64,
    sign: i8,
}

/// Projects curves; keeps its buffers between calls.
#[derive(Debug, Default)]
struct Projector {
    points: Vec<[f64; 3]>,
    crossings: Vec<Crossing>,
}

impl Projector {
    /// Finds all crossings seen along `direction`; false when there are `limit` or more, or one is degenerate.
    fn find_crossings(&mut self, vertices: &[V], direction: V, limit: usize) -> bool {
        let w = direction.normalize();
        let u = if w.x.abs() < 0.6 { V::x() } else { V::y() }
            .cross(&w)
            .normalize();
        let v = w.cross(&u);
        self.points.clear();
        self.points
            .extend(vertices.iter().map(|x| [x.dot(&u), x.dot(&v), x.dot(&w)]));
        self.points.push(self.points[0]);
        let size = vertices.iter().map(|x| x.amax()).fold(0.0, f64::max);
        let touch = TOUCH * size;
        self.crossings.clear();
        let n = vertices.len();
        for i in 0..n {
            let (a, b) = (self.points[i], self.points[i + 1]);
            let (low_x, high_x) = (a[0].min(b[0]), a[0].max(b[0]));
            let (low_y, high_y) = (a[1].min(b[1]), a[1].max(b[1]));
            let last = if i == 0 { n - 1 } else { n };
            for j in i + 2..last {
                let (c, d) = (self.points[j], self.points[j + 1]);
                if (c[0].min(d[0]) > high_x)
                    | (c[0].max(d[0]) < low_x)
                    | (c[1].min(d[1]) > high_y)
                    | (c[1].max(d[1]) < low_y)
                {
                    continue;
                }
                match cross(a, b, c, d, touch) {
                    Meeting::Apart => {}
                    Meeting::Degenerate => return false,
                    Meeting::Crossing { s, t, turn, height } => {
                        if self.crossings.len() + 1 >= limit {
                            return false;
                        }
                        let (s, t) = (i as f64 + s, j as f64 + t);
                        // `turn` is the sense from the first edge to the second; the sign wants upper to lower.
                        self.crossings.push(if height > 0.0 {
                            Crossing {
                                over: s,
                                under: t,
                                sign: if turn > 0.0 { 1 } else { -1 },
                            }
                        } else {
                            Crossing {
                                over: t,
                                under: s,
                                sign: if turn > 0.0 { -1 } else { 1 },
                            }
                        });
                    }
                }
            }
        }
        true
    }

    fn diagram(&self) -> Diagram {
        let mut order: Vec<(f64, Visit)> = Vec::with_capacity(2 * self.crossings.len());
        for (k, c) in self.crossings.iter().enumerate() {
            order.push((
                c.over,
                Visit {
                    crossing: k as u32,
                    over: true,
                },
            ));
            order.push((
                c.under,
                Visit {
                    crossing: k as u32,
                    over: false,
                },
            ));
        }
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        Diagram {
            visits: order.into_iter().map(|(_, visit)| visit).collect(),
            signs: self.crossings.iter().map(|c| c.sign).collect(),
        }
    }
}

enum Meeting {
    Apart,
    Degenerate,
    Crossing {
        s: f64,
        t: f64,
        turn: f64,
        height: f64,
    },
}

/// Height, in units of the largest coordinate, below which two strands touch: rounding could put either above the other.
const TOUCH: f64 = 1e-13;

/// How two projected edges meet; heights are the third coordinates.
fn cross(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3], touch: f64) -> Meeting {
    let e = [b[0] - a[0], b[1] - a[1]];
    let f = [d[0] - c[0], d[1] - c[1]];
    let g = [c[0] - a[0], c[1] - a[1]];
    let turn = e[0] * f[1] - e[1] * f[0];
    let s = g[0] * f[1] - g[1] * f[0];
    let t = g[0] * e[1] - g[1] * e[0];
    let size = turn.abs();
    // Ends this close to the other edge make the order along the curve depend on rounding.
    let margin = 1e-9 * size;
    let (s_signed, t_signed) = if turn < 0.0 { (-s, -t) } else { (s, t) };
    if s_signed < -margin
        || t_signed < -margin
        || s_signed > size + margin
        || t_signed > size + margin
    {
        return Meeting::Apart;
    }
    if size == 0.0
        || s_signed < margin
        || t_signed < margin
        || s_signed > size - margin
        || t_signed > size - margin
    {
        return Meeting::Degenerate;
    }
    let (s, t) = (s_signed / size, t_signed / size);
    let height = (a[2] + s * (b[2] - a[2])) - (c[2] + t * (d[2] - c[2]));
    if height.abs() <= touch {
        return Meeting::Degenerate;
    }
    Meeting::Crossing { s, t, turn, height }
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

    #[test]
    fn bad_coordinates_are_refused() {
        assert!(matches!(
            usable_vertices(&[V::zeros(); 2], true),
            Err(KnotError::TooFewVertices { n_vertices: 2 })
        ));
        let nan = [V::zeros(), V::x(), V::new(0.0, f64::NAN, 0.0)];
        assert!(matches!(
            usable_vertices(&nan, true),
            Err(KnotError::NotFinite { vertex: 2 })
        ));
    }
}
