//! How a curve is turned towards the reader: flattest side in front, like its neighbour.

use nalgebra::{Matrix3, Rotation3, Vector3};

/// Centre of the vertices.
pub fn centroid(points: &[Vector3<f64>]) -> Vector3<f64> {
    points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64
}

/// Rotation that lays the widest extent along x and the thinnest along the view (z).
pub fn flattest(points: &[Vector3<f64>]) -> Matrix3<f64> {
    let eigen = covariance(points, points).symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let mut rows = order.map(|k| {
        let axis: Vector3<f64> = eigen.eigenvectors.column(k).into();
        // Eigenvectors have no sign: fix it, so that a picture can be drawn again.
        let sign = axis
            .iter()
            .find(|c| c.abs() > 1e-6)
            .map_or(1.0, |c| c.signum());
        axis * sign
    });
    if rows[0].cross(&rows[1]).dot(&rows[2]) < 0.0 {
        rows[2] = -rows[2];
    }
    Matrix3::from_rows(&rows.map(|r| r.transpose()))
}

/// Rotation that shows all of several shapes wide, each counted by its form and not by its size.
pub fn flattest_of(shapes: &[&[Vector3<f64>]]) -> Matrix3<f64> {
    let scaled = |points: &&[Vector3<f64>]| -> Vec<Vector3<f64>> {
        let center = centroid(points);
        let sizes = points.iter().map(|p| (p - center).norm());
        let size = sizes.sum::<f64>() / points.len().max(1) as f64;
        let about = points.iter().map(|p| (p - center) / size.max(1e-12));
        about.collect()
    };
    let all: Vec<Vector3<f64>> = shapes.iter().flat_map(scaled).collect();
    flattest(&all)
}

/// Rotation of `points` that best lays them on `model` (same number of points), both about
/// their centres (Kabsch); `None` when the numbers differ.
pub fn aligned(points: &[Vector3<f64>], model: &[Vector3<f64>]) -> Option<Matrix3<f64>> {
    if points.len() != model.len() || points.is_empty() {
        return None;
    }
    let svd = covariance(points, model).svd(true, true);
    let (u, v) = (svd.u?, svd.v_t?.transpose());
    let mirror = Matrix3::from_diagonal(&Vector3::new(
        1.0,
        1.0,
        (v * u.transpose()).determinant().signum(),
    ));
    Some(v * mirror * u.transpose())
}

/// Points turned by `rotation` about their centre, which moves to the origin.
pub fn view(points: &[Vector3<f64>], rotation: &Matrix3<f64>) -> Vec<Vector3<f64>> {
    let c = centroid(points);
    points.iter().map(|p| rotation * (p - c)).collect()
}

/// A view leant the shortest way so that its thinnest extent lies along the view.
pub fn flattened(points: Vec<Vector3<f64>>) -> Vec<Vector3<f64>> {
    let thin = flattest(&points).row(2).transpose();
    let thin = if thin.z < 0.0 { -thin } else { thin };
    match Rotation3::rotation_between(&thin, &Vector3::z()) {
        Some(lean) => view(&points, lean.matrix()),
        None => points,
    }
}

/// Smallest and largest x and y of points in view coordinates: `[x0, y0, x1, y1]`.
pub fn extent(points: &[Vector3<f64>]) -> [f64; 4] {
    points.iter().fold(
        [f64::MAX, f64::MAX, f64::MIN, f64::MIN],
        |[x0, y0, x1, y1], p| [x0.min(p.x), y0.min(p.y), x1.max(p.x), y1.max(p.y)],
    )
}

fn covariance(a: &[Vector3<f64>], b: &[Vector3<f64>]) -> Matrix3<f64> {
    let (ca, cb) = (centroid(a), centroid(b));
    a.iter()
        .zip(b)
        .map(|(p, q)| (p - ca) * (q - cb).transpose())
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn helix() -> Vec<Vector3<f64>> {
        (0..50)
            .map(|i| {
                let t = i as f64 * 0.2;
                Vector3::new(3.0 * t, 2.0 * t.sin(), 0.5 * t.cos())
            })
            .collect()
    }

    #[test]
    fn alignment_undoes_a_rotation() {
        let a = helix();
        let r = Rotation3::from_euler_angles(0.4, -1.1, 2.0);
        let b: Vec<_> = a
            .iter()
            .map(|p| r * p + Vector3::new(1.0, 2.0, 3.0))
            .collect();
        let back = aligned(&b, &a).unwrap();
        assert!((back - r.inverse().matrix()).norm() < 1e-9);
        assert!(aligned(&b[1..], &a).is_none());
    }

    #[test]
    fn flattest_view_is_a_rotation_and_shows_the_long_side() {
        let r = Rotation3::from_euler_angles(1.0, 0.3, -0.7);
        let turned: Vec<_> = helix().iter().map(|p| r * p).collect();
        let f = flattest(&turned);
        assert!((f.determinant() - 1.0).abs() < 1e-9);
        let [x0, y0, x1, y1] = extent(&view(&turned, &f));
        assert!(x1 - x0 > 4.0 * (y1 - y0));
    }

    #[test]
    fn a_ring_and_a_long_line_across_it_are_both_seen_wide() {
        let ring: Vec<_> = (0..60)
            .map(|i| {
                let (s, c) = (f64::from(i) * 0.1).sin_cos();
                Vector3::new(c, s, 0.0)
            })
            .collect();
        // seen onto the ring it is a dot
        let line: Vec<_> = (0..60)
            .map(|i| Vector3::new(0.0, 0.0, f64::from(i)))
            .collect();
        let width = |points: &[Vector3<f64>], turn: &Matrix3<f64>| {
            let [x0, y0, x1, y1] = extent(&view(points, turn));
            (x1 - x0).max(y1 - y0)
        };
        assert!(width(&line, &flattest(&ring)) < 1e-9);
        let both = flattest_of(&[&ring, &line]);
        assert!(width(&line, &both) > 58.0 && width(&ring, &both) > 1.9);
    }

    #[test]
    fn leaning_back_shows_the_flat_side() {
        let tilted: Vec<_> = helix()
            .iter()
            .map(|p| Rotation3::from_euler_angles(0.9, 0.2, 0.0) * p)
            .collect();
        let depth = |v: &[Vector3<f64>]| v.iter().map(|p| p.z * p.z).sum::<f64>();
        let flat = flattened(tilted.clone());
        let best = depth(&view(&tilted, &flattest(&tilted)));
        assert!((depth(&flat) / best - 1.0).abs() < 1e-9);
    }
}
