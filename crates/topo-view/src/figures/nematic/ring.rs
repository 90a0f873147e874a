//! A defect line as it is drawn: smooth, although it is known in every cell of the grid only.

use crate::data::DefectLine;
use nalgebra::Vector3;

/// Width of the smoothing along the line, in spacings of its points.
const WIDTH: f64 = 1.6;
/// Share of known profile angles around a place below which none is shown.
const KNOWN: f64 = 0.4;

/// The line through points `spacing` apart: a spline through the means of its points, weighted along it by
///
/// ```math
/// k = 3 g - 3 g * g + g * g * g, \qquad g(s) \propto e^{-s^2 / 2 w^2},
/// ```
///
/// with w 1.6 spacings of the points. The later terms give back what one mean takes away: an undulation of 14 points keeps 99 % of
/// its height, a zigzag of three 1 %. Angles are means of the first kind.
pub fn smooth(line: &DefectLine, spacing: f64) -> DefectLine {
    let n = line.points.len();
    let (length, mean) = lengths(line);
    if n < 6 || mean <= 0.0 {
        return line.clone();
    }
    let even = evenly(line, n, length);
    let once = average(&even);
    let mut knots = once.points.clone();
    for _ in 0..2 {
        let mut rest = even.clone();
        for (r, k) in rest.points.iter_mut().zip(&knots) {
            *r -= k;
        }
        for (k, r) in knots.iter_mut().zip(average(&rest).points) {
            *k += r;
        }
    }
    let (mut points, mut angles) = (Vec::new(), Vec::new());
    let at = |i: isize| -> usize {
        let n = n as isize;
        (if line.closed {
            i.rem_euclid(n)
        } else {
            i.clamp(0, n - 1)
        }) as usize
    };
    let n_sub = (mean / spacing).ceil().clamp(1.0, 40.0) as usize;
    for i in 0..if line.closed { n } else { n - 1 } {
        let [a, b, c, d] = [-1, 0, 1, 2].map(|k| knots[at(i as isize + k)]);
        let (from, to) = (once.angles[i], once.angles[at(i as isize + 1)]);
        for k in 0..n_sub {
            let t = k as f64 / n_sub as f64;
            points.push(cubic([a, b, c, d], t));
            angles.push(
                from.zip(to)
                    .map_or(from.or(to), |(u, v)| Some(u + (v - u) * t)),
            );
        }
    }
    DefectLine {
        time: line.time,
        closed: line.closed,
        points,
        angles,
    }
}

/// Uniform cubic B-spline: continuous in curvature.
fn cubic([a, b, c, d]: [Vector3<f64>; 4], t: f64) -> Vector3<f64> {
    let (t2, t3) = (t * t, t * t * t);
    (a * (1.0 - 3.0 * t + 3.0 * t2 - t3)
        + b * (4.0 - 6.0 * t2 + 3.0 * t3)
        + c * (1.0 + 3.0 * t + 3.0 * t2 - 3.0 * t3)
        + d * t3)
        / 6.0
}

/// Length of the line, and of a piece of it.
fn lengths(line: &DefectLine) -> (f64, f64) {
    let n = line.points.len();
    let pieces = if line.closed { n } else { n.saturating_sub(1) };
    let length = (0..pieces)
        .map(|i| (line.points[(i + 1) % n] - line.points[i]).norm())
        .sum::<f64>();
    (length, length / pieces.max(1) as f64)
}

/// The same line with `n` points at equal distances along it.
fn evenly(line: &DefectLine, n: usize, length: f64) -> DefectLine {
    let step = length / if line.closed { n } else { n - 1 } as f64;
    let (mut points, mut angles) = (Vec::new(), Vec::new());
    let (mut piece, mut start) = (0, 0.0);
    let m = line.points.len();
    for k in 0..n {
        let s = step * k as f64;
        let ends = |i: usize| (line.points[i % m], line.points[(i + 1) % m]);
        let long = |i: usize| (ends(i).1 - ends(i).0).norm();
        while start + long(piece) < s && piece + 2 < m + usize::from(line.closed) {
            start += long(piece);
            piece += 1;
        }
        let t = ((s - start) / long(piece).max(1e-12)).clamp(0.0, 1.0);
        let (a, b) = ends(piece);
        points.push(a + (b - a) * t);
        angles.push(line.angles[(piece + usize::from(t > 0.5)) % m]);
    }
    DefectLine {
        time: line.time,
        closed: line.closed,
        points,
        angles,
    }
}

/// Weighted means around every point; near the ends of an open line the window shrinks.
fn average(line: &DefectLine) -> DefectLine {
    let n = line.points.len() as isize;
    let full = (3.0 * WIDTH).ceil() as isize;
    let mut out = line.clone();
    for i in 0..n {
        let reach = if line.closed {
            full.min((n - 1) / 2)
        } else {
            full.min(i).min(n - 1 - i)
        };
        let (mut sum, mut weight) = (Vector3::zeros(), 0.0);
        let (mut angle, mut known) = (0.0, 0.0);
        for k in -reach..=reach {
            let w = (-0.5 * (k as f64 / WIDTH).powi(2)).exp();
            let j = (i + k).rem_euclid(n) as usize;
            sum += line.points[j] * w;
            weight += w;
            if let Some(a) = line.angles[j] {
                angle += a * w;
                known += w;
            }
        }
        out.points[i as usize] = sum / weight;
        out.angles[i as usize] = (known > KNOWN * weight).then(|| angle / known);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A ring of radius 16 with seven undulations of height 3, seen in cells of side 1.5.
    fn coarse() -> DefectLine {
        let on_grid = |v: f64| (v / 1.5).round() * 1.5;
        let points: Vec<Vector3<f64>> = (0..100)
            .map(|i| {
                let a = f64::from(i) / 100.0 * TAU;
                let p = Vector3::new(16.0 * a.cos(), 16.0 * a.sin(), 3.0 * (7.0 * a).cos());
                p.map(on_grid)
            })
            .collect();
        DefectLine {
            time: None,
            closed: true,
            angles: vec![Some(60.0); 100],
            points,
        }
    }

    /// Largest angle between neighbouring pieces of some length, in degrees.
    fn sharpest(line: &DefectLine) -> f64 {
        let n = line.points.len();
        let mut pieces: Vec<Vector3<f64>> = (0..n)
            .map(|i| line.points[(i + 1) % n] - line.points[i])
            .collect();
        pieces.retain(|p| p.norm() > 1e-9);
        let turns = pieces.windows(2).map(|w| w[0].angle(&w[1]).to_degrees());
        turns.fold(0.0, f64::max)
    }

    #[test]
    fn cells_vanish_and_undulations_stay() {
        let line = coarse();
        let smooth = smooth(&line, 0.2);
        // the curve itself turns by at most 7² · 3 / 16² = 0.57 a unit of length: 7 degrees from one piece of 0.2 to the next
        let (before, after) = (sharpest(&line), sharpest(&smooth));
        assert!(before > 59.0 && after < 9.0, "{before} {after}");
        let height = |f: fn(f64) -> f64| {
            let n = smooth.points.len() as f64;
            let of = |p: &Vector3<f64>| p.z * f(7.0 * p.y.atan2(p.x));
            2.0 / n * smooth.points.iter().map(of).sum::<f64>()
        };
        // points are spread by length, which weighs the slopes more than the crests
        let amplitude = height(f64::cos).hypot(height(f64::sin));
        assert!((2.2..3.1).contains(&amplitude), "{amplitude}");
        let top = smooth.points.iter().map(|p| p.z).fold(0.0, f64::max);
        assert!((top - 3.0).abs() < 0.35, "{top}");
        for p in &line.points {
            let near = smooth
                .points
                .iter()
                .map(|q| (p - q).norm())
                .fold(f64::MAX, f64::min);
            assert!(near < 1.5, "{near}");
        }
        assert!(
            smooth
                .angles
                .iter()
                .all(|a| a.is_some_and(|a| (a - 60.0).abs() < 1e-9))
        );
    }

    #[test]
    fn what_is_unknown_stays_so_and_ends_stay_in_place() {
        let mut line = coarse();
        line.angles[40..60].fill(None);
        let found = smooth(&line, 0.2);
        let share = found.angles.iter().filter(|a| a.is_none()).count() as f64;
        assert!((share / found.angles.len() as f64 - 0.2).abs() < 0.03);
        line.closed = false;
        let open = smooth(&line, 0.2);
        assert!((open.points[0] - line.points[0]).norm() < 1.0);
        assert!(!open.closed);
    }
}
