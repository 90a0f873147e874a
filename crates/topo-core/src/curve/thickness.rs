//! Thickness of a polygon: the radius of the thickest tube around it.

use nalgebra::Vector3;

use super::polyline::Polyline;
use super::segment::closest_points;

type V = Vector3<f64>;

/// Thickness of a polygon and the two quantities that bound it.
///
/// ```math
/// \tau = \min\left(\mathrm{minRad}, \tfrac12 \mathrm{dcsd}\right), \qquad
/// \mathrm{minRad} = \min_i \frac{\min(|e_{i-1}|, |e_i|)}{2 \tan(\theta_i / 2)}
/// ```
///
/// Lengths are in the curve's own unit. The self-distance is infinite for curves without a doubly critical pair.
///
/// # Validation
/// `pruned_thickness_is_brute_force`, `circle_is_bounded_by_its_radius`.
///
/// # References
/// [rawdon2003]
///
/// [rawdon2003]: https://eudml.org/doc/51725
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Thickness {
    /// Smallest radius of curvature of the polygon, minRad.
    pub min_rad: f64,
    /// Smallest doubly critical self-distance, dcsd.
    pub dcsd: f64,
    /// Radius of the thickest tube, min(min_rad, dcsd / 2).
    pub tau: f64,
}

impl Thickness {
    fn new(min_rad: f64, dcsd: f64) -> Self {
        Self {
            min_rad,
            dcsd,
            tau: min_rad.min(0.5 * dcsd),
        }
    }
}

impl Polyline {
    /// Length over thickness, which does not depend on the scale: 2π for a circle, 0 for a straight line (of infinite
    /// thickness), and infinite for a polygon that touches itself.
    ///
    /// # Validation
    /// `circle_is_bounded_by_its_radius`, `a_curve_that_crosses_itself_has_no_thickness`.
    pub fn ropelength(&self) -> f64 {
        self.length() / thickness(self).tau
    }
}

/// Thickness of a polygon; pairs of edges that cannot be closer than the best pair so far are skipped.
pub fn thickness(curve: &Polyline) -> Thickness {
    Thickness::new(min_rad(curve), self_distance(curve, true))
}

/// Thickness of a polygon from every pair of edges, O(n^2) exact distances: the certificate of [`thickness`].
pub fn thickness_brute_force(curve: &Polyline) -> Thickness {
    Thickness::new(min_rad(curve), self_distance(curve, false))
}

/// Thickness of several curves together, such as the components of a link: `dcsd` is the smallest self-distance of any of them or
/// distance between two, so that tubes of radius `tau` around all of them neither overlap themselves nor each other.
///
/// ```math
/// \tau = \min\left( \min_a \tau_a, \tfrac12 \min_{a \neq b} \mathrm{dist}(a, b) \right)
/// ```
///
/// Of a single curve it is [`thickness`], to the bit; of none it is infinite.
///
/// # Validation
/// `thickness_of_two_rings_is_half_their_distance`, `pruned_thickness_of_several_is_brute_force`
pub fn thickness_of_all(curves: &[Polyline]) -> Thickness {
    together(curves, true)
}

/// The same from every pair of edges, O(n^2) exact distances: the certificate of [`thickness_of_all`].
pub fn thickness_of_all_brute_force(curves: &[Polyline]) -> Thickness {
    together(curves, false)
}

fn together(curves: &[Polyline], prune: bool) -> Thickness {
    let (mut radius, mut distance) = (f64::INFINITY, f64::INFINITY);
    for (k, curve) in curves.iter().enumerate() {
        radius = radius.min(min_rad(curve));
        distance = distance.min(self_distance(curve, prune));
        for other in &curves[k + 1..] {
            distance = nearest(curve, other, distance, prune);
        }
    }
    Thickness::new(radius, distance)
}

/// Smallest distance between two curves; infinite if one has no edge. Their nearest points are those of a doubly critical pair.
pub fn distance_between(a: &Polyline, b: &Polyline) -> f64 {
    nearest(a, b, f64::INFINITY, true)
}

/// The smaller of `least` and the distance between two curves.
fn nearest(a: &Polyline, b: &Polyline, mut least: f64, prune: bool) -> f64 {
    let ends = |curve: &Polyline, k: usize| {
        let x = curve.vertices();
        (x[k], *head(x, k))
    };
    let half: Vec<f64> = b.edge_lengths().iter().map(|l| 0.5 * l).collect();
    let middle = |p: &V, q: &V| 0.5 * (p + q);
    let middles: Vec<V> = (0..b.n_edges())
        .map(|j| ends(b, j))
        .map(|(p, q)| middle(&p, &q))
        .collect();
    for i in 0..a.n_edges() {
        let (p, q) = ends(a, i);
        let (here, half_here) = (middle(&p, &q), 0.5 * (q - p).norm());
        for j in 0..b.n_edges() {
            let reach = least + half_here + half[j];
            if prune && (here - middles[j]).norm_squared() > reach * reach {
                continue;
            }
            let (r, s) = ends(b, j);
            let square = closest_points(&p, &q, &r, &s).0;
            if square < least * least {
                least = square.sqrt();
            }
        }
    }
    least
}

/// Half the smallest distance between points at least π `radius` apart along the curve, another usual definition of the
/// self-distance: it reaches `radius` exactly when a tube of that radius does not overlap itself.
pub fn windowed_half_distance(curve: &Polyline, radius: f64) -> f64 {
    let x = curve.vertices();
    let n = curve.n_edges();
    let mut start = Vec::with_capacity(n + 1);
    start.push(0.0);
    for i in 0..n {
        start.push(start[i] + curve.edge(i).norm());
    }
    let length = start[n];
    let mut least = f64::INFINITY;
    for i in 0..n {
        for j in i + 2..n {
            let between = start[j] - start[i + 1];
            let around = if curve.is_closed() {
                length - (start[j + 1] - start[i])
            } else {
                f64::INFINITY
            };
            if between.min(around) >= std::f64::consts::PI * radius {
                least = least.min(closest_points(&x[i], head(x, i), &x[j], head(x, j)).0);
            }
        }
    }
    0.5 * least.sqrt()
}

fn head(x: &[V], edge: usize) -> &V {
    &x[(edge + 1) % x.len()]
}

/// Radius of curvature at a vertex with the given edges before and after.
pub fn vertex_radius(before: &V, after: &V) -> f64 {
    let (a, b) = (before.norm(), after.norm());
    // tan(theta / 2) = |u x v| / (|u| |v| + u . v), without cancellation at small angles.
    let tangent_of_half = before.cross(after).norm() / (a * b + before.dot(after)).max(0.0);
    0.5 * a.min(b) / tangent_of_half
}

fn min_rad(curve: &Polyline) -> f64 {
    let n = curve.n_edges();
    let mut least = f64::INFINITY;
    for i in usize::from(!curve.is_closed())..n {
        least = least.min(vertex_radius(&curve.edge((i + n - 1) % n), &curve.edge(i)));
    }
    least
}

fn self_distance(curve: &Polyline, prune: bool) -> f64 {
    let x = curve.vertices();
    let n = curve.n_edges();
    let closed = curve.is_closed();
    let middle: Vec<V> = (0..n).map(|i| 0.5 * (x[i] + head(x, i))).collect();
    let half: Vec<f64> = (0..n).map(|i| 0.5 * curve.edge(i).norm()).collect();
    let mut least = f64::INFINITY;
    for i in 0..n {
        let last = if closed && i == 0 { n - 1 } else { n };
        for j in i + 2..last {
            if prune {
                let reach = least + half[i] + half[j];
                if (middle[i] - middle[j]).norm_squared() > reach * reach {
                    continue;
                }
            }
            let (d2, s, t) = closest_points(&x[i], head(x, i), &x[j], head(x, j));
            if d2 >= least * least {
                continue;
            }
            let from = x[i] + (head(x, i) - x[i]) * s;
            let to = x[j] + (head(x, j) - x[j]) * t;
            let gap = to - from;
            if is_minimum(curve, i, s, &gap) && is_minimum(curve, j, t, &-gap) {
                least = d2.sqrt();
            }
        }
    }
    least
}

/// Whether the distance to a point `gap` away has a local minimum at parameter `s` of an edge.
fn is_minimum(curve: &Polyline, edge: usize, s: f64, gap: &V) -> bool {
    let n = curve.n_edges();
    let closed = curve.is_closed();
    let grows = |edge: usize, sense: f64| {
        let e = curve.edge(edge);
        sense * e.dot(gap) <= 1e-9 * e.norm() * gap.norm()
    };
    if s <= 0.0 {
        (edge == 0 && !closed) || grows((edge + n - 1) % n, -1.0)
    } else if s >= 1.0 {
        (edge + 1 == n && !closed) || grows((edge + 1) % n, 1.0)
    } else {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn circle(n: usize, radius: f64) -> Polyline {
        let vertices = (0..n).map(|k| {
            let (s, c) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
            V::new(radius * c, radius * s, 0.0)
        });
        Polyline::new(vertices.collect(), true).expect("a circle")
    }

    #[test]
    fn circle_is_bounded_by_its_radius() {
        let n = 60;
        let found = thickness_brute_force(&circle(n, 2.0));
        let inscribed = 2.0 * (std::f64::consts::PI / n as f64).cos();
        assert!((found.min_rad - inscribed).abs() < 1e-12);
        assert!((found.dcsd - 2.0 * inscribed).abs() < 1e-6, "{found:?}");
        let ropelength = circle(800, 7.0).ropelength();
        assert!((ropelength / std::f64::consts::TAU - 1.0).abs() < 1e-5);
    }

    /// Rings of radius 2 chained at a right angle so that each runs through the middle of the other: thickness 1, ropelength 8π of
    /// both; apart they are bounded by their own radius or by half their distance.
    #[test]
    fn val_thickness_of_chained_and_of_apart_rings() {
        let flat = circle(800, 2.0);
        let upright = |shift: f64| {
            let turned = flat
                .vertices()
                .iter()
                .map(|v| V::new(v.x + shift, 0.0, v.y));
            Polyline::new(turned.collect(), true).expect("a circle")
        };
        for (shift, expected) in [(2.0, 1.0), (5.0, 0.5), (40.0, 2.0), (1.0, 0.5)] {
            let found = thickness_of_all(&[flat.clone(), upright(shift)]);
            assert!((found.tau - expected).abs() < 1e-4, "{shift}: {found:?}");
        }
        assert_eq!(
            thickness_of_all(std::slice::from_ref(&flat)),
            thickness(&flat)
        );
        assert!(thickness_of_all(&[]).tau.is_infinite());
    }

    #[test]
    fn a_curve_that_crosses_itself_has_no_thickness() {
        let at = |u: f64| V::new(u.sin(), (2.0 * u).sin(), 0.0);
        let eight = (0..40).map(|k| at(std::f64::consts::TAU * k as f64 / 40.0 + 0.01));
        let eight = Polyline::new(eight.collect(), true).expect("a figure of eight");
        assert!(thickness(&eight).tau < 1e-12 && eight.ropelength() > 1e12);
    }

    #[test]
    fn straight_rod_has_no_bound() {
        let rod = Polyline::new((0..9).map(|k| V::new(k as f64, 0.0, 0.0)).collect(), false);
        let found = thickness(&rod.expect("a rod"));
        assert!(found.tau.is_infinite(), "{found:?}");
    }

    #[test]
    fn hairpin_tips_are_a_gap_apart() {
        let x = [(0.0, 0.0), (4.0, 0.0), (5.0, 0.7), (4.0, 1.4), (0.1, 1.4)];
        let hairpin = x.iter().map(|&(x, y)| V::new(x, y, 0.0)).collect();
        let found = thickness(&Polyline::new(hairpin, false).expect("a curve"));
        assert!((found.dcsd - 1.4).abs() < 1e-12, "{found:?}");
    }

    /// Points of a regular polygon at least π r apart along it are closest k edges apart, k = ⌈π r/l⌉, 2 sin(k π/n) R by a chord.
    #[test]
    fn windowed_distance_of_a_circle_is_a_chord() {
        let (n, size) = (90, 3.0);
        let turn = std::f64::consts::PI / n as f64;
        for radius in [0.2, 0.7, 1.5] {
            let apart = std::f64::consts::PI * radius / (2.0 * size * turn.sin());
            let chord = size * (apart.ceil() * turn).sin();
            let found = windowed_half_distance(&circle(n, size), radius);
            assert!((found - chord).abs() < 1e-12, "{found} {chord}");
        }
        let x = [(0.0, 0.0), (4.0, 0.0), (5.0, 0.7), (4.0, 1.4), (0.0, 1.4)];
        let hairpin = x.iter().map(|&(x, y)| V::new(x, y, 0.0)).collect();
        let hairpin = Polyline::new(hairpin, false).expect("a curve");
        assert!((windowed_half_distance(&hairpin, 0.5) - 0.7).abs() < 1e-12);
    }

    #[test]
    fn thickness_of_two_rings_is_half_their_distance() {
        let n = 400;
        let ring = circle(n, 2.0);
        // Each through the middle of the other, at right angles: all its points are 2 from that one.
        let through = |x: &V| V::new(x.x + 2.0, 0.0, x.y);
        let through = Polyline::new(ring.vertices().iter().map(through).collect(), true);
        let rings = [ring.clone(), through.expect("a ring")];
        let found = thickness_of_all(&rings);
        // Edges run a little within the circles, by 2 (1 - cos(pi / n)) = 6e-5.
        assert!((1.9998..2.0).contains(&found.dcsd) && found.tau == 0.5 * found.dcsd);
        assert!((found.min_rad - thickness(&ring).min_rad).abs() < 1e-9);
        assert!((distance_between(&rings[0], &rings[1]) - found.dcsd).abs() < 1e-15);
        assert_eq!(thickness_of_all(&rings[..1]), thickness(&ring));
        assert!(thickness_of_all(&[]).tau.is_infinite());
        // Rings that cross have no thickness; far apart each has its own.
        let at = |shift: V| {
            let moved = ring.vertices().iter().map(|x| x + shift).collect();
            [ring.clone(), Polyline::new(moved, true).expect("a ring")]
        };
        assert!(thickness_of_all(&at(V::new(2.0, 0.1, 0.0))).tau < 1e-12);
        assert_eq!(thickness_of_all(&at(V::z() * 9.0)), thickness(&ring));
    }

    proptest! {
        #[test]
        fn pruned_thickness_of_several_is_brute_force(
            raw in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 10..40), closed: bool, at in 3..7_usize,
        ) {
            let curve = |part: &[[f64; 3]]| {
                Polyline::new(part.iter().copied().map(V::from).collect(), closed).expect("distinct vertices")
            };
            let curves = [curve(&raw[..at]), curve(&raw[at..])];
            let found = thickness_of_all(&curves);
            prop_assert_eq!(found, thickness_of_all_brute_force(&curves));
            let least = curves.iter().map(|c| thickness(c).tau).fold(f64::INFINITY, f64::min);
            let between = distance_between(&curves[0], &curves[1]);
            prop_assert!((found.tau - least.min(0.5 * between)).abs() < 1e-15);
        }

        #[test]
        fn pruned_thickness_is_brute_force(
            raw in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 5..40), closed: bool,
        ) {
            let curve = Polyline::new(raw.into_iter().map(V::from).collect(), closed);
            let curve = curve.expect("distinct vertices");
            prop_assert_eq!(thickness(&curve), thickness_brute_force(&curve));
        }
    }
}
