//! Closest points of two segments, with relative tolerances, for edges of any length.

use nalgebra::Vector3;

type V = Vector3<f64>;

/// Squared distance of the segments a-b and c-d and the parameters of the closest points, each in [0, 1].
///
/// # References
/// [ericson2005]
///
/// [ericson2005]: https://doi.org/10.1201/b14581
pub fn closest_points(a: &V, b: &V, c: &V, d: &V) -> (f64, f64, f64) {
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.norm_squared(), u.dot(&v), v.norm_squared());
    let (uw, vw) = (u.dot(&w), v.dot(&w));
    let det = uu * vv - uv * uv;
    // Nearly parallel edges: any start on one will do, the clamps below finish.
    let mut s = if det > 1e-12 * uu * vv {
        ((uv * vw - vv * uw) / det).clamp(0.0, 1.0)
    } else {
        0.5
    };
    let mut t = if vv > 0.0 { (uv * s + vw) / vv } else { 0.0 };
    if !(0.0..=1.0).contains(&t) {
        t = t.clamp(0.0, 1.0);
        s = if uu > 0.0 {
            ((uv * t - uw) / uu).clamp(0.0, 1.0)
        } else {
            0.0
        };
    }
    ((w + u * s - v * t).norm_squared(), s, t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = V> {
        (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(|(x, y, z)| V::new(x, y, z))
    }

    proptest! {
        #[test]
        fn no_sampled_pair_is_closer(a in point(), b in point(), c in point(), d in point()) {
            let (d2, s, t) = closest_points(&a, &b, &c, &d);
            let at = |s: f64, t: f64| ((a + (b - a) * s) - (c + (d - c) * t)).norm_squared();
            prop_assert!((at(s, t) - d2).abs() < 1e-12);
            for i in 0..=20 {
                for j in 0..=20 {
                    prop_assert!(at(i as f64 / 20.0, j as f64 / 20.0) > d2 - 1e-12);
                }
            }
        }
    }

    #[test]
    fn parallel_edges_are_their_gap_apart() {
        let (d2, ..) = closest_points(
            &V::zeros(),
            &V::x(),
            &V::new(0.25, 2.0, 0.0),
            &V::new(4.0, 2.0, 0.0),
        );
        assert!((d2 - 4.0).abs() < 1e-14);
    }

    #[test]
    fn edges_of_any_length_cross_at_their_points() {
        for l in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
            let (a, b) = (V::new(-0.2, 0.0, 0.1) * l, V::new(0.8, 0.0, 0.1) * l);
            let (c, d) = (V::new(0.0, -0.7, 0.0) * l, V::new(0.0, 0.3, 0.0) * l);
            let (d2, s, t) = closest_points(&a, &b, &c, &d);
            assert!((d2 / (l * l) - 0.01).abs() < 1e-14, "{l}: {d2}");
            assert!(
                (s - 0.2).abs() < 1e-14 && (t - 0.7).abs() < 1e-14,
                "{l}: {s} {t}"
            );
        }
    }
}
