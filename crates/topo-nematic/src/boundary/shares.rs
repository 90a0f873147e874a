//! Shares of faces and volumes of a cube that lie outside a sphere.

/// Strips of a face in each of its two directions.
const N_STRIPS: usize = 16;
/// Slices of a cube along each axis.
const N_SLICES: usize = 8;

/// Share outside a sphere of `radius` about the origin of the square face of edge `h` about `centre`, normal to `axis`.
///
/// Strips are cut exactly; both directions of strips are averaged, so that the result has the symmetry of the square.
///
/// # Validation
/// `shares_of_a_large_sphere_are_those_of_a_plane`
pub(crate) fn face_share(centre: [f64; 3], axis: usize, h: f64, radius: f64) -> f64 {
    let square = radius * radius - centre[axis] * centre[axis];
    if square <= 0.0 {
        return 1.0;
    }
    let (u, v) = match axis {
        0 => (centre[1], centre[2]),
        1 => (centre[0], centre[2]),
        _ => (centre[0], centre[1]),
    };
    let reach = u.hypot(v);
    let (circle, half_diagonal) = (square.sqrt(), h * std::f64::consts::FRAC_1_SQRT_2);
    if reach > circle + half_diagonal {
        return 1.0;
    }
    if reach + half_diagonal < circle {
        return 0.0;
    }
    let covered = |across: f64, along: f64| -> f64 {
        (0..N_STRIPS)
            .map(|s| {
                let x = across + h * ((s as f64 + 0.5) / N_STRIPS as f64 - 0.5);
                let chord = (square - x * x).max(0.0).sqrt();
                let (low, high) = ((along - 0.5 * h).max(-chord), (along + 0.5 * h).min(chord));
                (high - low).max(0.0)
            })
            .sum::<f64>()
            / (N_STRIPS as f64 * h)
    };
    (1.0 - 0.5 * (covered(u, v) + covered(v, u))).clamp(0.0, 1.0)
}

/// Share outside a sphere of `radius` about the origin of the cube of edge `h` about `centre`.
pub(crate) fn volume_share(centre: [f64; 3], h: f64, radius: f64) -> f64 {
    let r = norm(centre);
    let half_diagonal = 0.5 * h * 3.0_f64.sqrt();
    if r > radius + half_diagonal {
        return 1.0;
    }
    if r + half_diagonal < radius {
        return 0.0;
    }
    let mut sum = 0.0;
    for axis in 0..3 {
        for s in 0..N_SLICES {
            let mut slice = centre;
            slice[axis] += h * ((s as f64 + 0.5) / N_SLICES as f64 - 0.5);
            sum += face_share(slice, axis, h, radius);
        }
    }
    (sum / (3 * N_SLICES) as f64).clamp(0.0, 1.0)
}

/// Length of a vector.
pub(crate) fn norm(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_a_large_sphere_are_those_of_a_plane() {
        let radius = 1e7;
        for depth in [-0.49, -0.2, 0.0, 0.31, 0.49] {
            let share = volume_share([0.0, radius + depth, 0.0], 1.0, radius);
            assert!((share - (0.5 + depth)).abs() < 0.03, "{depth} {share}");
            let share = face_share([0.0, radius + depth, 0.0], 2, 1.0, radius);
            assert!((share - (0.5 + depth)).abs() < 0.02, "{depth} {share}");
        }
        assert_eq!(face_share([0.0, 0.0, 3.0], 2, 1.0, 2.9), 1.0);
        assert_eq!(volume_share([0.0; 3], 1.0, 2.0), 0.0);
        assert_eq!(volume_share([5.0, 0.0, 0.0], 1.0, 2.0), 1.0);
    }
}
