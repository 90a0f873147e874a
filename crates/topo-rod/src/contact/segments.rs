//! Distance of two segments.

use nalgebra::Vector3;

/// Least distance of the segments p0–p1 and q0–q1, without an absolute tolerance, so for any scale.
///
/// The minimum of a convex quadratic on the unit square lies inside or on one of the four sides; the interior candidate is used
/// when it falls inside, the sides are always tried. So nearly parallel segments need no special case.
pub fn segment_distance(
    p0: &Vector3<f64>,
    p1: &Vector3<f64>,
    q0: &Vector3<f64>,
    q1: &Vector3<f64>,
) -> f64 {
    let (d1, d2, r) = (p1 - p0, q1 - q0, p0 - q0);
    let (a, e, b) = (d1.norm_squared(), d2.norm_squared(), d1.dot(&d2));
    let (c, f) = (d1.dot(&r), d2.dot(&r));
    let along = |num: f64, den: f64| {
        if den > 0.0 {
            (num / den).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let square = |s: f64, t: f64| (r + d1 * s - d2 * t).norm_squared();
    let mut best = square(0.0, along(f, e))
        .min(square(1.0, along(f + b, e)))
        .min(square(along(-c, a), 0.0))
        .min(square(along(b - c, a), 1.0));
    let det = a * e - b * b;
    if det > 1e-14 * a * e {
        let (s, t) = ((b * f - c * e) / det, (a * f - b * c) / det);
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            best = best.min(square(s, t));
        }
    }
    best.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn v() -> impl Strategy<Value = Vector3<f64>> {
        (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0).prop_map(|(x, y, z)| Vector3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn agrees_with_a_fine_sampling(p0 in v(), p1 in v(), q0 in v(), q1 in v()) {
            let d = segment_distance(&p0, &p1, &q0, &q1);
            let n = 60;
            let mut sampled = f64::INFINITY;
            for i in 0..=n {
                for j in 0..=n {
                    let (s, t) = (i as f64 / n as f64, j as f64 / n as f64);
                    sampled = sampled.min((p0 + (p1 - p0) * s - q0 - (q1 - q0) * t).norm());
                }
            }
            prop_assert!(d <= sampled + 1e-12);
            prop_assert!(d >= sampled - 4.0 * 3.5 / n as f64);
        }
    }

    #[test]
    fn crossing_parallel_and_tiny_segments() {
        let o = Vector3::zeros();
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        assert!((segment_distance(&-x, &x, &(z - y), &(z + y)) - 1.0).abs() < 1e-15);
        assert!((segment_distance(&o, &x, &(y + x * 0.2), &(y + x * 0.4)) - 1.0).abs() < 1e-15);
        assert!((segment_distance(&o, &x, &(x * 3.0), &(x * 2.0)) - 1.0).abs() < 1e-15);
        assert!(
            (segment_distance(&o, &(x * 1e-9), &(z * 1e-8), &(z * 1e-8 + y * 1e-9)) / 1e-8 - 1.0)
                .abs()
                < 1e-12
        );
    }
}
