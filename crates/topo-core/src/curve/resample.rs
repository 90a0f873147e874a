//! Smoothing of a polyline, and resampling to equal edges.

use nalgebra::Vector3;

use super::polyline::Polyline;
use super::spline::CubicSpline;
use crate::error::CurveError;
use crate::integrate::max_norm;

type V = Vector3<f64>;

/// Edges count as equal within this relative spread; otherwise the resampling is refused.
const SPREAD_LIMIT: f64 = 1e-9;
/// Where iterating stops gaining anything.
const SPREAD_TARGET: f64 = 1e-13;
const MAX_SWEEPS: usize = 60;
const MAX_NEWTON: usize = 30;

impl Polyline {
    /// The polyline after `n_passes` of the binomial filter (1/4, 1/2, 1/4); ends of an open one stay.
    ///
    /// A pass multiplies a mode of k vertices per wavelength by cos²(π/k): zigzags vanish at once, long waves stay.
    ///
    /// # Errors
    /// [`CurveError::CoincidentVertices`] when smoothing collapses an edge, for example of a pure zigzag.
    ///
    /// # Validation
    /// `smoothing_damps_a_mode_by_its_factor`
    pub fn smoothed(&self, n_passes: usize) -> Result<Self, CurveError> {
        let n = self.n_vertices();
        let mut old = self.vertices().to_vec();
        let mut new = old.clone();
        for _ in 0..n_passes {
            let inner = if self.is_closed() { 0..n } else { 1..n - 1 };
            for i in inner {
                let (before, after) = (old[(i + n - 1) % n], old[(i + 1) % n]);
                new[i] = old[i] * 0.5 + before * 0.25 + after * 0.25;
            }
            std::mem::swap(&mut old, &mut new);
        }
        Self::new(old, self.is_closed())
    }

    /// The curve with `n_edges` edges of equal length, its vertices on a cubic spline through the present ones.
    ///
    /// The spline is periodic for a closed curve and natural for an open one; the first vertex (and the last of an open curve)
    /// stays. Parameters are first swept towards equal chords, then polished by Newton's method on all chords at once.
    ///
    /// # Errors
    /// [`CurveError::TooFewVertices`] for fewer than 3 (closed) or 1 (open) edges; [`CurveError::UnequalEdges`] when edges
    /// cannot be made equal to 1e-9, for example when `n_edges` is too small to follow the curve.
    ///
    /// # Validation
    /// `edges_become_equal_and_keep_the_curve`
    pub fn resampled(&self, n_edges: usize) -> Result<Self, CurveError> {
        let (least, closed) = (if self.is_closed() { 3 } else { 1 }, self.is_closed());
        if n_edges < least {
            let extra = usize::from(!closed);
            return Err(CurveError::TooFewVertices {
                n_vertices: n_edges + extra,
                needed: least + extra,
            });
        }
        let spline = CubicSpline::through(self);
        let mut sampling = Sampling::uniform(&spline, n_edges);
        sampling.sweep(&spline);
        sampling.polish(&spline);
        if sampling.spread.is_nan() || sampling.spread > SPREAD_LIMIT {
            return Err(CurveError::UnequalEdges {
                n_edges,
                spread: sampling.spread,
            });
        }
        let mut vertices = sampling.points;
        if closed {
            vertices.pop();
        }
        Self::new(vertices, closed)
    }
}

/// Points of a spline at growing parameters, the first and the last at its ends.
struct Sampling {
    parameters: Vec<f64>,
    points: Vec<V>,
    /// Lengths of the chords between successive points.
    chords: Vec<f64>,
    /// Largest relative deviation of a chord from the mean.
    spread: f64,
}

impl Sampling {
    fn uniform(spline: &CubicSpline, n_edges: usize) -> Self {
        let parameters = (0..=n_edges)
            .map(|i| spline.end() * i as f64 / n_edges as f64)
            .collect();
        Self::at(spline, parameters)
    }

    fn at(spline: &CubicSpline, parameters: Vec<f64>) -> Self {
        let points: Vec<V> = parameters.iter().map(|u| spline.at(*u).0).collect();
        let chords: Vec<f64> = points.windows(2).map(|p| (p[1] - p[0]).norm()).collect();
        let mean = chords.iter().sum::<f64>() / chords.len() as f64;
        let deviations: Vec<f64> = chords.iter().map(|c| c / mean - 1.0).collect();
        let spread = max_norm(&deviations);
        Self {
            parameters,
            points,
            chords,
            spread,
        }
    }

    /// Moves parameters to equal shares of the cumulated chords, as long as that helps.
    fn sweep(&mut self, spline: &CubicSpline) {
        let n = self.chords.len();
        for _ in 0..MAX_SWEEPS {
            if self.spread <= SPREAD_TARGET {
                return;
            }
            let total: f64 = self.chords.iter().sum();
            let mut parameters = Vec::with_capacity(n + 1);
            parameters.push(0.0);
            let (mut edge, mut passed) = (0, 0.0);
            for i in 1..n {
                let target = total * i as f64 / n as f64;
                while edge + 1 < n && passed + self.chords[edge] < target {
                    passed += self.chords[edge];
                    edge += 1;
                }
                let share = ((target - passed) / self.chords[edge]).clamp(0.0, 1.0);
                parameters.push(
                    self.parameters[edge]
                        + share * (self.parameters[edge + 1] - self.parameters[edge]),
                );
            }
            parameters.push(spline.end());
            let next = Self::at(spline, parameters);
            if next.spread.is_nan() || next.spread >= 0.9 * self.spread {
                return;
            }
            *self = next;
        }
    }

    /// Newton's method for inner parameters and the common chord; bidiagonal, so one forward recursion solves it.
    fn polish(&mut self, spline: &CubicSpline) {
        let n = self.chords.len();
        for _ in 0..MAX_NEWTON {
            if self.spread <= SPREAD_TARGET {
                return;
            }
            let common = self.chords.iter().sum::<f64>() / n as f64;
            // Shift of each parameter as (constant, factor of the change of the common chord).
            let mut shifts = Vec::with_capacity(n + 1);
            let mut shift = (0.0, 0.0);
            shifts.push(shift);
            for i in 0..n {
                let along = (self.points[i + 1] - self.points[i]) / self.chords[i];
                let leave = along.dot(&spline.at(self.parameters[i]).1);
                let arrive = along.dot(&spline.at(self.parameters[i + 1]).1);
                shift = (
                    (common - self.chords[i] + leave * shift.0) / arrive,
                    (1.0 + leave * shift.1) / arrive,
                );
                shifts.push(shift);
            }
            let change = -shift.0 / shift.1;
            let mut parameters: Vec<f64> = self
                .parameters
                .iter()
                .zip(&shifts)
                .map(|(u, (constant, factor))| u + constant + factor * change)
                .collect();
            parameters[n] = spline.end();
            if !parameters.windows(2).all(|u| u[0] < u[1]) {
                return;
            }
            let next = Self::at(spline, parameters);
            if next.spread.is_nan() || next.spread >= self.spread {
                return;
            }
            *self = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::{PI, TAU};

    fn trefoil(n: usize) -> Polyline {
        let point = |i: usize| {
            // Uneven on purpose.
            let t = TAU * i as f64 / n as f64 + 0.1 * (TAU * i as f64 / n as f64).sin();
            V::new(
                (2.0 + (3.0 * t).cos()) * (2.0 * t).cos(),
                (2.0 + (3.0 * t).cos()) * (2.0 * t).sin(),
                -(3.0 * t).sin(),
            )
        };
        Polyline::new((0..n).map(point).collect(), true).unwrap()
    }

    fn spread(curve: &Polyline) -> f64 {
        let lengths = curve.edge_lengths();
        let mean = curve.length() / lengths.len() as f64;
        lengths
            .iter()
            .map(|l| (l / mean - 1.0).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn edges_become_equal_and_keep_the_curve() {
        let fine = trefoil(1000);
        for n in [24, 100, 200, 1537] {
            let even = fine.resampled(n).unwrap();
            assert_eq!((even.n_edges(), even.is_closed()), (n, true));
            assert!(spread(&even) < 1e-10, "{n}: {:e}", spread(&even));
            assert_eq!(even.vertices()[0], fine.vertices()[0]);
        }
        assert_relative_eq!(
            fine.resampled(1537).unwrap().length(),
            fine.length(),
            max_relative = 1e-5
        );
        assert_relative_eq!(
            fine.resampled(400).unwrap().writhe(),
            fine.writhe(),
            max_relative = 1e-3
        );
        let coarse_origin = trefoil(30).resampled(200).unwrap();
        assert!(spread(&coarse_origin) < 1e-10);
    }

    #[test]
    fn open_curves_keep_their_ends() {
        let helix = |n: usize| {
            let point = |i: usize| {
                let t = (i as f64 / n as f64).powf(1.3) * 9.0;
                V::new(t.cos(), t.sin(), 0.3 * t)
            };
            Polyline::new((0..=n).map(point).collect(), false).unwrap()
        };
        let curve = helix(300);
        let even = curve.resampled(120).unwrap();
        assert_eq!((even.n_edges(), even.n_vertices()), (120, 121));
        assert!(spread(&even) < 1e-10);
        assert!((even.vertices()[120] - curve.vertices()[300]).norm() < 1e-14);
        assert_eq!(curve.resampled(1).unwrap().n_vertices(), 2);
        let few = |n_vertices, needed| CurveError::TooFewVertices { n_vertices, needed };
        assert_eq!(curve.resampled(0), Err(few(1, 2)));
        assert_eq!(trefoil(50).resampled(2), Err(few(2, 3)));
    }

    /// Few long chords start far from equal, and Newton's method ends at rounding.
    #[test]
    fn edges_are_equal_to_rounding_however_few() {
        for n in [9, 12, 15, 20, 40, 200] {
            let even = trefoil(200).resampled(n).unwrap();
            assert!(spread(&even) < 2e-13, "{n}: {:e}", spread(&even));
        }
    }

    #[test]
    fn smoothing_damps_a_mode_by_its_factor() {
        let n = 64;
        let ring = |ripple: f64| {
            let point = |i: usize| {
                let t = TAU * i as f64 / n as f64;
                V::new(t.cos(), t.sin(), ripple * (8.0 * t).cos())
            };
            Polyline::new((0..n).map(point).collect(), true).unwrap()
        };
        let smooth = ring(0.1).smoothed(3).unwrap();
        let factor = (PI * 8.0 / n as f64).cos().powi(6);
        assert_relative_eq!(smooth.vertices()[0].z, 0.1 * factor, max_relative = 1e-12);
        assert_relative_eq!(
            smooth.vertices()[0].x,
            (PI / n as f64).cos().powi(6),
            max_relative = 1e-12
        );
        let zigzag =
            Polyline::new((0..4).map(|i| V::x() * (i % 2) as f64).collect(), true).unwrap();
        assert!(matches!(
            zigzag.smoothed(1),
            Err(CurveError::CoincidentVertices { .. })
        ));
        let open = Polyline::new(vec![V::zeros(), V::y(), V::x()], false)
            .unwrap()
            .smoothed(5)
            .unwrap();
        assert_eq!(
            (open.vertices()[0], open.vertices()[2]),
            (V::zeros(), V::x())
        );
    }

    #[test]
    fn scales_beyond_all_reason_are_refused_not_broken() {
        let huge = trefoil(50).scaled(1e153).unwrap();
        if let Ok(even) = huge.resampled(40) {
            assert!(spread(&even) < 1e-9);
        }
    }

    #[test]
    fn extreme_scales_resample_alike() {
        let curve = trefoil(200);
        for scale in [1e-100, 1e-8, 1e8, 1e100] {
            let even = curve.scaled(scale).unwrap().resampled(90).unwrap();
            assert!(spread(&even) < 1e-10, "{scale:e}");
        }
    }
}
