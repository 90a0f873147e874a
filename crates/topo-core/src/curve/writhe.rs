//! Writhe and average crossing number of polygons, exact up to rounding.

use std::f64::consts::PI;
use std::ops::Range;

use nalgebra::Vector3;

use super::polyline::Polyline;

type V = Vector3<f64>;

impl Polyline {
    /// Writhe of this curve; see [`writhe`].
    pub fn writhe(&self) -> f64 {
        writhe(self.vertices(), self.is_closed())
    }

    /// Average crossing number of this curve; see [`average_crossing_number`].
    pub fn average_crossing_number(&self) -> f64 {
        average_crossing_number(self.vertices(), self.is_closed())
    }
}

/// Writhe of the polygon through `vertices`: the Gauss integral of the curve with itself, for an open chain over the chain
/// alone.
///
/// ```math
/// Wr = \frac{1}{4\pi} \iint \frac{(\mathrm{d}r_1 \times \mathrm{d}r_2) \cdot (r_1 - r_2)}{|r_1 - r_2|^3}
///    = \frac{1}{2\pi} \sum_{i<j} \Omega_{ij}
/// ```
///
/// Ω_ij is a signed solid angle: the differences between the points of two straight edges fill a flat parallelogram, and the
/// origin sees it under Ω_ij. Cut along a diagonal, both triangles share one triple product, so that one arctangent per pair
/// gives the exact value, without the cancellation that the four arcsines of the usual form suffer near coplanar pairs.
/// Positive for right-handed crossings; a curve that passes through itself gets the share 0 at that pair (the mean of the two
/// sides).
///
/// # Validation
/// `writhe_equals_the_gauss_integral`, `planar_curves_have_no_writhe`, `ideal_like_trefoil_is_right_handed`
///
/// # References
/// `banchoff1976`, [klenin2000]
///
/// [klenin2000]: https://doi.org/10.1002/1097-0282(20001015)54:5%3C307::AID-BIP20%3E3.0.CO;2-Y
pub fn writhe(vertices: &[V], closed: bool) -> f64 {
    sum_over_pairs(vertices, closed, |half_angle| half_angle) / PI
}

/// Crossing number of the polygon through `vertices`, averaged over all directions of view.
///
/// ```math
/// ACN = \frac{1}{2\pi} \sum_{i<j} |\Omega_{ij}|
/// ```
///
/// # Validation
/// `crossing_number_of_two_views`
///
/// # References
/// [klenin2000]
///
/// [klenin2000]: https://doi.org/10.1002/1097-0282(20001015)54:5%3C307::AID-BIP20%3E3.0.CO;2-Y
pub fn average_crossing_number(vertices: &[V], closed: bool) -> f64 {
    sum_over_pairs(vertices, closed, f64::abs) / PI
}

/// Gauss integral of two curves, each given by its vertices and whether it is closed: of two closed ones their linking number, exact
/// up to rounding.
///
/// ```math
/// Lk = \frac{1}{4\pi} \oint\!\oint \frac{(\mathrm{d}r_1 \times \mathrm{d}r_2) \cdot (r_1 - r_2)}{|r_1 - r_2|^3}
///    = \frac{1}{4\pi} \sum_{i, j} \Omega_{ij}
/// ```
///
/// Ω_ij and its sign are those of [`writhe`]: two right-handed crossings are one link. A pair of edges that meet gets the share 0.
///
/// # Validation
/// `val_linking_numbers_of_torus_links`, `linking_of_open_curves_is_the_gauss_integral`
///
/// # References
/// [klenin2000]
///
/// [klenin2000]: https://doi.org/10.1002/1097-0282(20001015)54:5%3C307::AID-BIP20%3E3.0.CO;2-Y
pub fn linking(a: (&[V], bool), b: (&[V], bool)) -> f64 {
    let both: Vec<V> = a.0.iter().chain(b.0).copied().collect();
    if let Some(scaled) = within_range(&both, &both) {
        let (x, y) = scaled.split_at(a.0.len());
        return linking((x, a.1), (y, b.1));
    }
    let n_edges = |(x, closed): (&[V], bool)| x.len().saturating_sub(usize::from(!closed));
    let (n, m) = (n_edges(a), n_edges(b));
    if n == 0 || m == 0 {
        return 0.0;
    }
    let x = a.0;
    let edges = (0..n).map(|i| [x[i], x[(i + 1) % x.len()]]);
    let sum: f64 = edges
        .map(|edge| sum_over_edges(edge, b.0, 0..m, &|half| half))
        .sum();
    sum / (2.0 * PI)
}

/// Sum over all pairs of edges that share no vertex of `weight` of half their signed solid angle.
fn sum_over_pairs(vertices: &[V], closed: bool, weight: impl Fn(f64) -> f64) -> f64 {
    let n = vertices.len();
    let n_edges = if closed { n } else { n.saturating_sub(1) };
    if n_edges < 3 {
        return 0.0;
    }
    if let Some(scaled) = within_range(vertices, vertices) {
        return sum_over_pairs(&scaled, closed, weight);
    }
    let mut total = 0.0;
    for i in 0..n_edges - 2 {
        // The first and the last edge of a closed curve share a vertex, as do those of a curve just cut.
        let joined = closed || vertices[0] == vertices[n - 1];
        let end = if joined && i == 0 {
            n_edges - 1
        } else {
            n_edges
        };
        let edge = [vertices[i], vertices[(i + 1) % n]];
        total += sum_over_edges(edge, vertices, i + 2..end, &weight);
    }
    total
}

/// Sum over `edges` of the curve through `vertices` of `weight` of half the signed solid angle of each with an edge of its own or
/// of another curve, which shares no vertex with them.
#[inline]
fn sum_over_edges(
    [p, q]: [V; 2],
    vertices: &[V],
    edges: Range<usize>,
    weight: &impl Fn(f64) -> f64,
) -> f64 {
    let n = vertices.len();
    let e = q - p;
    let mut a = vertices[edges.start] - p;
    let mut d = vertices[edges.start] - q;
    let (mut a_norm, mut d_norm) = (a.norm(), d.norm());
    let mut row = 0.0;
    for j in edges {
        let next = vertices[if j + 1 == n { 0 } else { j + 1 }];
        let (b, c) = (next - p, next - q);
        let (b_norm, c_norm) = (b.norm(), c.norm());
        let triple = a.dot(&e.cross(&(b - a)));
        if triple != 0.0 {
            let ac = a.dot(&c);
            let first =
                a_norm * b_norm * c_norm + a.dot(&b) * c_norm + b.dot(&c) * a_norm + ac * b_norm;
            let second =
                a_norm * c_norm * d_norm + ac * d_norm + c.dot(&d) * a_norm + a.dot(&d) * c_norm;
            row += weight(-angle(
                triple * (first + second),
                first * second - triple * triple,
            ));
        }
        (a, a_norm, d, d_norm) = (b, b_norm, c, c_norm);
    }
    row
}

/// Vertices scaled about the first of `origin` where products of six of its lengths would leave the range of f64.
fn within_range(vertices: &[V], origin: &[V]) -> Option<Vec<V>> {
    let centre = *origin.first()?;
    let from_centre = origin.iter().map(|v| (v - centre).amax());
    let extent = from_centre.fold(0.0, f64::max);
    let leaves = !(1e-40..1e40).contains(&extent) && extent > 0.0 && extent.is_finite();
    leaves.then(|| vertices.iter().map(|v| (v - centre) / extent).collect())
}

/// `y.atan2(x)`, by its series where most pairs lie.
#[inline]
fn angle(y: f64, x: f64) -> f64 {
    let ratio = y / x;
    let square = ratio * ratio;
    // The next term is below 1e-17 of the first.
    if x > 0.0 && square < 0.0036 {
        const C: [f64; 6] = [
            -1.0 / 3.0,
            1.0 / 5.0,
            -1.0 / 7.0,
            1.0 / 9.0,
            -1.0 / 11.0,
            1.0 / 13.0,
        ];
        let tail = C[0]
            + square * (C[1] + square * (C[2] + square * (C[3] + square * (C[4] + square * C[5]))));
        ratio * (1.0 + square * tail)
    } else {
        y.atan2(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::polyline::Polyline;
    use approx::assert_relative_eq;

    fn torus_knot(p: f64, q: f64, n: usize) -> Vec<V> {
        let point = |i: usize| {
            let t = 2.0 * PI * i as f64 / n as f64;
            let r = 2.0 + (q * t).cos();
            V::new(r * (p * t).cos(), r * (p * t).sin(), -(q * t).sin())
        };
        (0..n).map(point).collect()
    }

    /// Gauss integral of a pair of edges by the midpoint rule: independent of the formula under test.
    fn quadrature(vertices: &[V], closed: bool, m: usize) -> f64 {
        let n = vertices.len();
        let n_edges = if closed { n } else { n - 1 };
        let mut sum = 0.0;
        for i in 0..n_edges {
            for j in 0..n_edges {
                let apart = i.abs_diff(j);
                if apart < 2 || (closed && apart == n_edges - 1) {
                    continue;
                }
                let (p, r) = (vertices[i], vertices[j]);
                let (e, f) = (vertices[(i + 1) % n] - p, vertices[(j + 1) % n] - r);
                for k in 0..m * m {
                    let (s, t) = ((k % m) as f64 + 0.5, (k / m) as f64 + 0.5);
                    let d = p + e * (s / m as f64) - r - f * (t / m as f64);
                    sum += e.cross(&f).dot(&d) / d.norm().powi(3) / (m * m) as f64;
                }
            }
        }
        sum / (4.0 * PI)
    }

    #[test]
    fn writhe_equals_the_gauss_integral() {
        for (vertices, closed) in [
            (torus_knot(2.0, 3.0, 24), true),
            (torus_knot(2.0, 5.0, 30)[..21].to_vec(), false),
        ] {
            let (coarse, fine) = (
                quadrature(&vertices, closed, 12),
                quadrature(&vertices, closed, 24),
            );
            let extrapolated = fine + (fine - coarse) / 3.0;
            assert_relative_eq!(writhe(&vertices, closed), extrapolated, max_relative = 2e-6);
        }
    }

    #[test]
    fn ideal_like_trefoil_is_right_handed() {
        let vertices = torus_knot(2.0, 3.0, 200);
        let wr = writhe(&vertices, true);
        assert!((3.0..4.0).contains(&wr), "{wr}");
        let mirror: Vec<V> = vertices.iter().map(|v| V::new(v.x, v.y, -v.z)).collect();
        assert_relative_eq!(writhe(&mirror, true), -wr, max_relative = 1e-13);
        let reversed: Vec<V> = vertices.iter().rev().copied().collect();
        assert_relative_eq!(writhe(&reversed, true), wr, max_relative = 1e-13);
        assert!(average_crossing_number(&vertices, true) > wr);
    }

    #[test]
    fn writhe_does_not_know_place_turn_or_size() {
        let vertices = torus_knot(3.0, 4.0, 150);
        let wr = writhe(&vertices, true);
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, -1.2, 2.5);
        for scale in [1e-120, 1e-3, 1.0, 1e5, 1e120] {
            let moved: Vec<V> = vertices
                .iter()
                .map(|v| turn * v * scale + V::new(3.0, -2.0, 1.0) * scale)
                .collect();
            assert_relative_eq!(writhe(&moved, true), wr, max_relative = 1e-12);
        }
        let mut shifted = vertices.clone();
        shifted.rotate_left(37);
        assert_relative_eq!(writhe(&shifted, true), wr, max_relative = 1e-13);
    }

    #[test]
    fn planar_curves_have_no_writhe() {
        let circle: Vec<V> = (0..50)
            .map(|i| {
                V::new(
                    (i as f64 * PI / 25.0).cos(),
                    (i as f64 * PI / 25.0).sin(),
                    0.0,
                )
            })
            .collect();
        assert_eq!(writhe(&circle, true), 0.0);
        let curve = Polyline::new(circle.clone(), true).unwrap();
        assert_eq!(
            (curve.writhe(), curve.average_crossing_number()),
            (0.0, 0.0)
        );
        // Tilted, coplanarity holds only up to rounding, and antiparallel edges see each other.
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, -1.2, 2.5);
        let tilted: Vec<V> = circle
            .iter()
            .map(|v| turn * v + V::new(5.0, 1.0, 0.1))
            .collect();
        assert!(writhe(&tilted, true).abs() < 1e-13);
        let line: Vec<V> = (0..50).map(|i| turn * V::x() * i as f64).collect();
        assert!(
            writhe(&line, false).abs() < 1e-13 && average_crossing_number(&line, false) < 1e-13
        );
    }

    #[test]
    fn crossing_number_of_two_views() {
        // Edges that cross at right angles and are much longer than their distance are seen crossing from almost everywhere.
        let (far, gap) = (1.0, 1e-4);
        let over = [V::new(-far, 0.0, gap), V::new(far, 0.0, gap)];
        let under = [V::new(0.0, -far, 0.0), V::new(0.0, far, 0.0)];
        let chain = vec![
            over[0],
            over[1],
            V::new(9.0, 9.0, 0.0),
            V::new(9.0, -9.0, 0.0),
            under[0],
            under[1],
        ];
        let pair: f64 = {
            let all = sum_over_pairs(&chain, false, |w| if w.abs() > 1.0 { w } else { 0.0 });
            all / PI
        };
        // Half the solid angle of the pair tends to pi: one crossing, whose sign is over x under = x cross y > 0.
        assert!((pair - 1.0).abs() < 1e-3, "{pair}");
    }

    /// The two circles of the torus link T(2, 2k) wind k times around each other, right-handedly for this torus.
    #[test]
    fn val_linking_numbers_of_torus_links() {
        let strand = |windings: f64, start: f64, n: usize| -> Vec<V> {
            let point = |i: usize| {
                let t = 2.0 * PI * i as f64 / n as f64;
                let u = windings * t + start;
                let r = 2.0 + u.cos();
                V::new(r * t.cos(), r * t.sin(), -u.sin())
            };
            (0..n).map(point).collect()
        };
        for windings in [-3.0, -1.0, 0.0, 1.0, 2.0] {
            let (a, b) = (strand(windings, 0.0, 90), strand(windings, PI, 70));
            let found = linking((&a, true), (&b, true));
            assert!((found - windings).abs() < 1e-12, "{found} of {windings}");
            let other = linking((&b, true), (&a, true));
            assert!((found - other).abs() < 1e-13);
            for scale in [1e-120, 1e90] {
                let [a, b] = [&a, &b].map(|x| x.iter().map(|v| v * scale).collect::<Vec<V>>());
                let again = linking((&a, true), (&b, true));
                assert!((found - again).abs() < 1e-12);
            }
            // a reversed partner links the other way round
            let reversed: Vec<V> = b.iter().rev().copied().collect();
            let back = linking((&a, true), (&reversed, true));
            assert!((found + back).abs() < 1e-12);
        }
        assert_eq!(linking((&[], true), (&[V::x(), V::y()], false)), 0.0);
    }

    #[test]
    fn linking_of_open_curves_is_the_gauss_integral() {
        let whole = torus_knot(2.0, 3.0, 40);
        let (a, b) = (whole[..15].to_vec(), whole[18..33].to_vec());
        let integral = |m: usize| {
            let mut sum = 0.0;
            for (p, r) in (0..14).flat_map(|i| (0..14).map(move |j| (i, j))) {
                let (e, f) = (a[p + 1] - a[p], b[r + 1] - b[r]);
                for k in 0..m * m {
                    let (s, t) = ((k % m) as f64 + 0.5, (k / m) as f64 + 0.5);
                    let d = a[p] + e * (s / m as f64) - b[r] - f * (t / m as f64);
                    sum += e.cross(&f).dot(&d) / d.norm().powi(3) / (m * m) as f64;
                }
            }
            sum / (4.0 * PI)
        };
        let (coarse, fine) = (integral(12), integral(24));
        let extrapolated = fine + (fine - coarse) / 3.0;
        let found = linking((&a, false), (&b, false));
        assert_relative_eq!(found, extrapolated, max_relative = 2e-6);
    }

    #[test]
    fn series_meets_the_arctangent() {
        for k in -2000..2000 {
            let y = k as f64 * 1e-4;
            assert_relative_eq!(angle(y, 1.0), y.atan2(1.0), max_relative = 4e-16);
        }
        assert_eq!(angle(-0.5, -1.0), (-0.5_f64).atan2(-1.0));
    }

    #[test]
    fn touching_and_short_curves_stay_finite() {
        // A closed figure that passes exactly through one of its own vertices.
        let vertices = vec![
            V::x(),
            V::y(),
            -V::x(),
            V::zeros(),
            V::x() * 0.5 - V::y(),
            V::zeros() + V::z() * 0.0,
            V::z(),
        ];
        assert!(writhe(&vertices, true).is_finite());
        assert_eq!(writhe(&[V::x(), V::y()], false), 0.0);
        assert_eq!(writhe(&[], true), 0.0);
        assert!(
            Polyline::new(vec![V::x(), V::y(), V::z()], true)
                .unwrap()
                .writhe()
                == 0.0
        );
    }
}
