//! Cubic spline through the vertices of a polyline: periodic when closed, natural when open.

use nalgebra::Vector3;

use super::polyline::Polyline;

type V = Vector3<f64>;

/// Piecewise cubic curve with continuous curvature, parametrised by the arclength of the polyline that it interpolates.
pub(super) struct CubicSpline {
    /// Parameter at each knot; one more than intervals.
    knots: Vec<f64>,
    points: Vec<V>,
    /// Second derivative at each knot.
    bends: Vec<V>,
}

impl CubicSpline {
    pub(super) fn through(curve: &Polyline) -> Self {
        let lengths = curve.edge_lengths();
        let mut knots = Vec::with_capacity(lengths.len() + 1);
        let mut s = 0.0;
        knots.push(s);
        for length in &lengths {
            s += length;
            knots.push(s);
        }
        let mut points = curve.vertices().to_vec();
        if curve.is_closed() {
            points.push(points[0]);
        }
        let bends = if curve.is_closed() {
            periodic_bends(&lengths, &points)
        } else {
            natural_bends(&lengths, &points)
        };
        Self {
            knots,
            points,
            bends,
        }
    }

    /// Largest parameter; the smallest is 0.
    pub(super) fn end(&self) -> f64 {
        self.knots[self.knots.len() - 1]
    }

    /// Point and derivative at parameter `u`, clamped to the curve.
    pub(super) fn at(&self, u: f64) -> (V, V) {
        let last = self.knots.len() - 2;
        let i = self
            .knots
            .partition_point(|k| *k <= u)
            .saturating_sub(1)
            .min(last);
        let h = self.knots[i + 1] - self.knots[i];
        let t = ((u - self.knots[i]) / h).clamp(0.0, 1.0);
        let r = 1.0 - t;
        let (p, q, m, n) = (
            self.points[i],
            self.points[i + 1],
            self.bends[i],
            self.bends[i + 1],
        );
        let point = p * r + q * t + (m * (r * r * r - r) + n * (t * t * t - t)) * (h * h / 6.0);
        let slope = (q - p) / h + (n * (3.0 * t * t - 1.0) - m * (3.0 * r * r - 1.0)) * (h / 6.0);
        (point, slope)
    }
}

/// Right side 6 (slope after - slope before) of the continuity of the first derivative at an inner knot.
fn kink(before: f64, after: f64, p: V, q: V, r: V) -> V {
    ((r - q) / after - (q - p) / before) * 6.0
}

fn natural_bends(lengths: &[f64], points: &[V]) -> Vec<V> {
    let n = points.len();
    let mut bends = vec![V::zeros(); n];
    if n < 3 {
        return bends;
    }
    let (lower, diagonal): (Vec<f64>, Vec<f64>) = (1..n - 1)
        .map(|i| (lengths[i - 1], 2.0 * (lengths[i - 1] + lengths[i])))
        .unzip();
    let rhs: Vec<V> = (1..n - 1)
        .map(|i| {
            kink(
                lengths[i - 1],
                lengths[i],
                points[i - 1],
                points[i],
                points[i + 1],
            )
        })
        .collect();
    bends[1..n - 1].copy_from_slice(&solve_tridiagonal(&lower, diagonal, rhs));
    bends
}

/// Cyclic system by the Sherman-Morrison formula: a tridiagonal one and a rank-one corner.
fn periodic_bends(lengths: &[f64], points: &[V]) -> Vec<V> {
    let n = lengths.len();
    let before = |i: usize| lengths[(i + n - 1) % n];
    let corner = lengths[n - 1];
    let mut diagonal: Vec<f64> = (0..n).map(|i| 2.0 * (before(i) + lengths[i])).collect();
    let gamma = -diagonal[0];
    diagonal[0] -= gamma;
    diagonal[n - 1] -= corner * corner / gamma;
    let lower: Vec<f64> = (0..n)
        .map(|i| if i == 0 { 0.0 } else { lengths[i - 1] })
        .collect();
    let rhs = (0..n)
        .map(|i| {
            kink(
                before(i),
                lengths[i],
                points[(i + n - 1) % n],
                points[i],
                points[i + 1],
            )
        })
        .collect();
    let mut bends = solve_tridiagonal(&lower, diagonal.clone(), rhs);
    let mut spike = vec![V::zeros(); n];
    spike[0].x = gamma;
    spike[n - 1].x = corner;
    let spike = solve_tridiagonal(&lower, diagonal, spike);
    let ratio = corner / gamma;
    let weight = (bends[0] + bends[n - 1] * ratio) / (1.0 + spike[0].x + spike[n - 1].x * ratio);
    for (bend, s) in bends.iter_mut().zip(&spike) {
        *bend -= weight * s.x;
    }
    bends.push(bends[0]);
    bends
}

/// Symmetric tridiagonal solve; `lower[i]` couples `i - 1` and `i`. Diagonally dominant, so no pivoting.
fn solve_tridiagonal(lower: &[f64], mut diagonal: Vec<f64>, mut rhs: Vec<V>) -> Vec<V> {
    let n = diagonal.len();
    for i in 1..n {
        let w = lower[i] / diagonal[i - 1];
        diagonal[i] -= w * lower[i];
        let carried = rhs[i - 1] * w;
        rhs[i] -= carried;
    }
    rhs[n - 1] /= diagonal[n - 1];
    for i in (0..n - 1).rev() {
        let carried = rhs[i + 1] * lower[i + 1];
        rhs[i] = (rhs[i] - carried) / diagonal[i];
    }
    rhs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_with_continuous_slope_and_fourth_order() {
        let circle = |n: usize| {
            let point = |i: usize| {
                let t = (i as f64 + 0.2 * (i as f64).sin()) * std::f64::consts::TAU / n as f64;
                V::new(t.cos(), t.sin(), 0.0)
            };
            Polyline::new((0..n).map(point).collect(), true).unwrap()
        };
        let error = |n: usize| {
            let spline = CubicSpline::through(&circle(n));
            for (k, p) in spline.knots.iter().zip(&spline.points) {
                assert!((spline.at(*k).0 - p).norm() < 1e-14);
                let (before, after) = (spline.at(k - 1e-9).1, spline.at(k + 1e-9).1);
                assert!((before - after).norm() < 1e-6);
            }
            let (start, end) = (spline.at(0.0), spline.at(spline.end()));
            assert!((start.0 - end.0).norm() < 1e-14 && (start.1 - end.1).norm() < 1e-12);
            (0..4000)
                .map(|i| (spline.at(i as f64 * spline.end() / 4000.0).0.norm() - 1.0).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(20) / error(80)).log2() / 2.0;
        assert!(order > 3.7, "{order}");
    }

    #[test]
    fn an_open_line_stays_straight() {
        let line = Polyline::new(
            (0..5).map(|i| V::new((i * i) as f64, 0.0, 0.0)).collect(),
            false,
        )
        .unwrap();
        let spline = CubicSpline::through(&line);
        assert_eq!(spline.end(), 16.0);
        for i in 0..=32 {
            let (point, slope) = spline.at(0.5 * i as f64);
            assert!(
                (point - V::x() * 0.5 * i as f64).norm() < 1e-13 && (slope - V::x()).norm() < 1e-13
            );
        }
    }

    /// Middles of the pieces through four points with right angles, 1, 2 and 3 apart: second derivatives by Cramer's rule.
    #[test]
    fn natural_splines_solve_their_equations() {
        let x = [
            V::zeros(),
            V::x(),
            V::new(1.0, 2.0, 0.0),
            V::new(1.0, 2.0, 3.0),
        ];
        let kinks = [(V::y() - V::x()) * 6.0, (V::z() - V::y()) * 6.0];
        for n in [3, 4] {
            let m = if n == 3 {
                [V::zeros(), kinks[0] / 6.0, V::zeros(), V::zeros()]
            } else {
                // 6 m1 + 2 m2 = k1, 2 m1 + 10 m2 = k2
                let one = (kinks[0] * 10.0 - kinks[1] * 2.0) / 56.0;
                let two = (kinks[1] * 6.0 - kinks[0] * 2.0) / 56.0;
                [V::zeros(), one, two, V::zeros()]
            };
            let spline = CubicSpline::through(&Polyline::new(x[..n].to_vec(), false).unwrap());
            for (i, middle) in [0.5, 2.0, 4.5].into_iter().enumerate().take(n - 1) {
                let h = (i + 1) as f64;
                let expected = (x[i] + x[i + 1]) * 0.5 - (m[i] + m[i + 1]) * (h * h / 16.0);
                assert!(
                    (spline.at(middle).0 - expected).norm() < 1e-14,
                    "{n}, piece {i}"
                );
            }
        }
    }
}
