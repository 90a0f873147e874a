//! Which side of a line or a plane a point is on, exactly: Shewchuk's adaptive predicates, free of rounding.
//!
//! Coordinates must be within the range that [`usable_vertices`](crate::invariant::usable_vertices) admits, so that nothing on the way
//! overflows or underflows.
//!
//! # References
//! [shewchuk1997]
//!
//! [shewchuk1997]: https://doi.org/10.1007/PL00009321

use robust::{Coord, Coord3D};

use crate::V;

/// Relative error of a volume of 3 x 3 products when it is computed directly, in units of the sum of the sizes of its terms.
pub(crate) const VOLUME_ERROR: f64 = 8.0 * f64::EPSILON;

/// A number with the sign of (b - a) x (d - c) . (c - a), six times the volume of the tetrahedron: 0 if the points lie in a plane.
pub(crate) fn volume(a: &V, b: &V, c: &V, d: &V) -> f64 {
    let at = |x: &V| Coord3D {
        x: x.x,
        y: x.y,
        z: x.z,
    };
    robust::orient3d(at(a), at(b), at(c), at(d))
}

/// A number with the sign of the area of the triangle, seen along the axis `drop` so that the next two axes turn counterclockwise.
pub(crate) fn area(drop: usize, a: &V, b: &V, c: &V) -> f64 {
    let at = |x: &V| Coord {
        x: x[(drop + 1) % 3],
        y: x[(drop + 2) % 3],
    };
    robust::orient2d(at(a), at(b), at(c))
}

/// Whether three points lie on a line, the second between the others or on one of them.
pub(crate) fn is_between(a: &V, b: &V, c: &V) -> bool {
    (0..3).all(|k| area(k, a, b, c) == 0.0)
        && (0..3).all(|k| (a[k] <= b[k] && b[k] <= c[k]) || (c[k] <= b[k] && b[k] <= a[k]))
}

/// Whether `p`, in the plane of the triangle, lies in its angle at `a`, the two sides and what is beyond them included.
///
/// Of a triangle without an area, whether `p` lies on its line.
pub(crate) fn is_in_angle(a: &V, b: &V, c: &V, p: &V) -> bool {
    for drop in 0..3 {
        let turn = area(drop, a, b, c);
        if turn != 0.0 {
            return turn.signum() * area(drop, a, b, p) >= 0.0
                && turn.signum() * area(drop, a, p, c) >= 0.0;
        }
    }
    let on_line = |to: &V| (0..3).all(|k| area(k, a, to, p) == 0.0);
    on_line(b) && on_line(c)
}

/// Whether two segments have a point in common.
pub(crate) fn segments_meet(a: &V, b: &V, c: &V, d: &V) -> bool {
    if volume(a, b, c, d) != 0.0 {
        return false;
    }
    let boxes_meet =
        (0..3).all(|k| a[k].min(b[k]) <= c[k].max(d[k]) && c[k].min(d[k]) <= a[k].max(b[k]));
    // In a plane they are apart if both ends of one are strictly on one side of the other, along any axis.
    let one_side = |s: f64, t: f64| s > 0.0 && t > 0.0 || s < 0.0 && t < 0.0;
    let apart = |k: usize| {
        one_side(area(k, a, b, c), area(k, a, b, d)) || one_side(area(k, c, d, a), area(k, c, d, b))
    };
    boxes_meet && !(0..3).any(apart)
}

/// Whether the segment p-q meets the triangle; touching counts, and so does any segment in its plane.
pub(crate) fn is_pierced([a, b, c]: [&V; 3], p: &V, q: &V) -> bool {
    let (from, to) = (volume(a, b, c, p), volume(a, b, c, q));
    if from > 0.0 && to > 0.0 || from < 0.0 && to < 0.0 {
        return false;
    }
    let sides = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    !(sides.iter().any(|s| *s > 0.0) && sides.iter().any(|s| *s < 0.0))
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    use super::*;

    /// Six times the volume of a tetrahedron of integers.
    fn integer_volume([a, b, c, d]: [[i64; 3]; 4]) -> i128 {
        let minus =
            |p: [i64; 3], q: [i64; 3]| [0, 1, 2].map(|k| i128::from(p[k]) - i128::from(q[k]));
        let (e, f, g) = (minus(b, a), minus(d, c), minus(c, a));
        (0..3)
            .map(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                (e[i] * f[j] - e[j] * f[i]) * g[k]
            })
            .sum()
    }

    /// Points that all but lie in a plane: rounding alone gets hundreds of the signs wrong.
    #[test]
    fn volumes_have_the_sign_of_integer_arithmetic() {
        let mut rng = Pcg64::seed_from_u64(1);
        let mut random = |n: i64| rng.random_range(0..n);
        let (mut n_zero, mut n_rounded) = (0, 0);
        for _ in 0..20_000 {
            let mut point = || [0; 3].map(|_: i64| random(1 << 30));
            let (a, b, c) = (point(), point(), point());
            let (s, t) = (random(9) - 4, random(9) - 4);
            let near =
                [0, 1, 2].map(|k| a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]) + random(3) - 1);
            let [p, q, r, w] = [a, b, c, near].map(|x| V::from(x.map(|c| c as f64)));
            let truth = integer_volume([a, b, c, near]).signum() as f64;
            let found = volume(&p, &q, &r, &w);
            let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
            assert_eq!(sign(found), truth);
            let naive = (q - p).cross(&(w - r)).dot(&(r - p));
            n_zero += usize::from(truth == 0.0);
            n_rounded += usize::from(sign(naive) != truth);
        }
        assert!(n_zero > 500 && n_rounded > 300, "{n_zero}, {n_rounded}");
    }

    #[test]
    fn segments_that_touch_meet() {
        let v = |x: f64, y: f64| V::new(x, y, 0.25 * x - 0.5 * y);
        let (o, e) = (v(0.0, 0.0), v(4.0, 0.0));
        for (c, d, meet) in [
            (v(2.0, -1.0), v(2.0, 1.0), true),
            (v(2.0, 0.0), v(2.0, 1.0), true),
            (v(3.0, 0.0), v(8.0, 0.0), true),
            (v(4.0, 0.0), v(8.0, 0.0), true),
            (v(5.0, 0.0), v(8.0, 0.0), false),
            (v(2.0, 0.5), v(2.0, 1.0), false),
            (v(2.0, -1.0), v(2.0, 1.0) + V::z(), false),
        ] {
            assert_eq!(segments_meet(&o, &e, &c, &d), meet, "{c} {d}");
            assert_eq!(segments_meet(&d, &c, &o, &e), meet, "{c} {d}");
        }
    }

    #[test]
    fn angles_take_in_their_sides() {
        let v = |x: f64, y: f64| V::new(x, y, 2.0 * x + y);
        let (a, b, c) = (v(0.0, 0.0), v(2.0, 0.0), v(0.0, 2.0));
        for (p, inside) in [
            (v(9.0, 9.0), true),
            (v(1.0, 0.0), true),
            (v(0.0, 5.0), true),
            (v(-1.0, 0.0), false),
            (v(-1.0, 3.0), false),
        ] {
            assert_eq!(is_in_angle(&a, &b, &c, &p), inside, "{p}");
            assert_eq!(is_in_angle(&a, &c, &b, &p), inside, "{p}");
        }
    }
}
