//! A polygon as a smooth curve: points, tangents, curvatures and a frame that does not turn.

use crate::color::{Rgb, Scale};
use nalgebra::Vector3;

/// Catmull-Rom points about `spacing` apart through the vertices, with their colours.
pub fn smooth(
    vertices: &[Vector3<f64>],
    values: &[f64],
    closed: bool,
    spacing: f64,
    scale: &Scale,
) -> (Vec<Vector3<f64>>, Vec<Rgb>) {
    let n = vertices.len() as isize;
    let at = |i: isize| -> usize {
        if closed {
            i.rem_euclid(n) as usize
        } else {
            i.clamp(0, n - 1) as usize
        }
    };
    let n_spans = if closed { n } else { n - 1 };
    let length: f64 = (0..n_spans)
        .map(|i| (vertices[at(i + 1)] - vertices[at(i)]).norm())
        .sum();
    // A curve far longer than its picture needs is not refined without end.
    let n_sub = (length / n_spans as f64 / spacing).ceil().clamp(1.0, 64.0) as usize;
    let n_sub = n_sub.min((60_000 / n_spans as usize).max(1));
    let (mut points, mut colors) = (Vec::new(), Vec::new());
    for i in 0..n_spans {
        let [p0, p1, p2, p3] = [-1, 0, 1, 2].map(|k| vertices[at(i + k)]);
        for k in 0..n_sub {
            let t = k as f64 / n_sub as f64;
            let (t2, t3) = (t * t, t * t * t);
            points.push(
                (p1 * 2.0
                    + (p2 - p0) * t
                    + (p0 * 2.0 - p1 * 5.0 + p2 * 4.0 - p3) * t2
                    + (p1 * 3.0 - p0 - p2 * 3.0 + p3) * t3)
                    * 0.5,
            );
            colors.push(scale.rgb(values[at(i)] * (1.0 - t) + values[at(i + 1)] * t));
        }
    }
    if !closed {
        points.push(vertices[at(n - 1)]);
        colors.push(scale.rgb(values[at(n - 1)]));
    }
    (points, colors)
}

/// The vertices before and after one of `n`; the end of an open curve is its own neighbour.
fn neighbours(i: usize, n: usize, closed: bool) -> (usize, usize) {
    if closed {
        ((i + n - 1) % n, (i + 1) % n)
    } else {
        (i.saturating_sub(1), (i + 1).min(n - 1))
    }
}

/// Unit tangents by central differences.
pub fn tangents(points: &[Vector3<f64>], closed: bool) -> Vec<Vector3<f64>> {
    let n = points.len();
    (0..n)
        .map(|i| {
            let (a, b) = neighbours(i, n, closed);
            (points[b] - points[a])
                .try_normalize(1e-12)
                .unwrap_or_else(Vector3::x)
        })
        .collect()
}

/// Curvature vectors, across the tangents.
pub fn curvatures(
    points: &[Vector3<f64>],
    tangents: &[Vector3<f64>],
    closed: bool,
) -> Vec<Vector3<f64>> {
    let n = points.len();
    (0..n)
        .map(|i| {
            let (a, b) = neighbours(i, n, closed);
            let length = (points[i] - points[a]).norm() + (points[b] - points[i]).norm();
            let k = (tangents[b] - tangents[a]) / length.max(1e-12);
            k - tangents[i] * tangents[i].dot(&k)
        })
        .collect()
}

/// Normals carried along the curve without turning about it; a closed curve spreads the angle
/// that is left at its seam.
pub fn frames(tangents: &[Vector3<f64>], closed: bool) -> Vec<Vector3<f64>> {
    let carry = |frame: &Vector3<f64>, t: &Vector3<f64>| {
        (frame - t * t.dot(frame))
            .try_normalize(1e-9)
            .unwrap_or_else(|| any_normal(t))
    };
    let mut frame = any_normal(&tangents[0]);
    let mut frames: Vec<_> = tangents
        .iter()
        .map(|t| {
            frame = carry(&frame, t);
            frame
        })
        .collect();
    if closed {
        let back = carry(&frame, &tangents[0]);
        let seam = frames[0]
            .cross(&back)
            .dot(&tangents[0])
            .atan2(frames[0].dot(&back));
        let n = frames.len() as f64;
        for (i, (f, t)) in frames.iter_mut().zip(tangents).enumerate() {
            let (sin, cos) = (-seam * i as f64 / n).sin_cos();
            *f = *f * cos + t.cross(f) * sin;
        }
    }
    frames
}

fn any_normal(t: &Vector3<f64>) -> Vector3<f64> {
    let axis = if t.x.abs() < 0.8 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    t.cross(&axis).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn frames_close_without_a_jump() {
        let v: Vec<_> = (0..120)
            .map(|i| {
                let a = i as f64 / 120.0 * TAU;
                let r = 2.0 + (3.0 * a).cos();
                Vector3::new(r * (2.0 * a).cos(), r * (2.0 * a).sin(), (3.0 * a).sin()) * 2.0
            })
            .collect();
        let t = tangents(&v, true);
        let f = frames(&t, true);
        for i in 0..v.len() {
            assert!(f[i].dot(&t[i]).abs() < 1e-9);
            assert!(f[i].dot(&f[(i + 1) % v.len()]) > 0.9);
        }
    }
}
