//! Symmetric traceless tensors as five numbers: invariants, director, order.

use nalgebra::Vector3;

pub use nalgebra::Matrix3;

/// Components (xx, xy, xz, yy, yz) of a symmetric traceless tensor; zz = -xx - yy.
pub type Tensor5 = [f64; 5];

/// The uniaxial tensor of order `order` about the unit vector `director`.
///
/// ```math
/// Q = \tfrac{S}{2}\,(3\, n \otimes n - I)
/// ```
pub fn uniaxial(order: f64, director: [f64; 3]) -> Tensor5 {
    let [x, y, z] = director;
    let s = 1.5 * order;
    let third = order / 2.0;
    [
        s * x * x - third,
        s * x * y,
        s * x * z,
        s * y * y - third,
        s * y * z,
    ]
}

/// The double contraction a:b of two symmetric traceless tensors.
pub fn contract(a: &Tensor5, b: &Tensor5) -> f64 {
    2.0 * (a[0] * b[0] + a[3] * b[3] + a[1] * b[1] + a[2] * b[2] + a[4] * b[4])
        + a[0] * b[3]
        + a[3] * b[0]
}

/// The traceless part of Q², in the same five components.
pub fn square_traceless(q: &Tensor5) -> Tensor5 {
    let [xx, xy, xz, yy, yz] = *q;
    let third = contract(q, q) / 3.0;
    [
        xx * xx + xy * xy + xz * xz - third,
        xy * (xx + yy) + xz * yz,
        xy * yz - xz * yy,
        xy * xy + yy * yy + yz * yz - third,
        xy * xz - yz * xx,
    ]
}

/// The full 3 x 3 matrix.
pub fn matrix(q: &Tensor5) -> Matrix3<f64> {
    let [xx, xy, xz, yy, yz] = *q;
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, -xx - yy)
}

/// Scalar order S (the largest eigenvalue of Q) and director n (its unit eigenvector, with n_z >= 0).
///
/// Where the two largest eigenvalues coincide, as in the middle of a defect, the director is some unit vector of their plane; a
/// tensor that is not finite has order NaN and director z.
///
/// # Validation
/// `order_and_director_of_a_uniaxial_tensor`
pub fn order_and_director(q: &Tensor5) -> (f64, [f64; 3]) {
    if q.iter().any(|x| !x.is_finite()) {
        return (f64::NAN, [0.0, 0.0, 1.0]);
    }
    let order = largest_eigenvalue(q);
    let m = matrix(q) - Matrix3::identity() * order;
    // The eigenvector is orthogonal to the rows: the longest product of two of them is the best conditioned.
    let rows = [0, 1, 2].map(|i| Vector3::new(m[(i, 0)], m[(i, 1)], m[(i, 2)]));
    let products = [
        rows[0].cross(&rows[1]),
        rows[1].cross(&rows[2]),
        rows[2].cross(&rows[0]),
    ];
    let best = products
        .iter()
        .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
        .copied()
        .unwrap_or_else(Vector3::z);
    let scale = matrix(q).norm_squared();
    let n = if best.norm() > 1e-13 * scale && scale > 0.0 {
        best.normalize()
    } else {
        // Two equal largest eigenvalues: any vector orthogonal to the rows, or z for an isotropic tensor.
        let row = rows
            .iter()
            .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
            .copied()
            .unwrap_or_else(Vector3::zeros);
        if row.norm_squared() > 0.0 {
            let axis = if row.z.abs() <= row.x.abs().max(row.y.abs()) {
                Vector3::z()
            } else {
                Vector3::x()
            };
            (axis - row * (axis.dot(&row) / row.norm_squared())).normalize()
        } else {
            Vector3::z()
        }
    };
    let n = if n.z < 0.0 { -n } else { n };
    (order, [n.x, n.y, n.z])
}

/// The largest eigenvalue of Q: the largest root of
///
/// ```math
/// \lambda^3 - 3 p^2 \lambda - \det Q = 0, \quad p^2 = Q{:}Q/6, \quad p \le \lambda \le 2 p
/// ```
///
/// Newton's method descends to it from 2p, its value for a uniaxial Q, and so needs few steps nearly everywhere. Where the two
/// largest eigenvalues nearly coincide it is slow, and the trigonometric formula is used instead.
///
/// # Validation
/// `eigenvalues_are_those_of_the_matrix`
pub fn largest_eigenvalue(q: &Tensor5) -> f64 {
    let square = contract(q, q) / 6.0;
    if square <= 0.0 {
        return 0.0;
    }
    let p = square.sqrt();
    let determinant = determinant(q);
    let mut root = 2.0 * p;
    for _ in 0..NEWTON_STEPS {
        let slope = 3.0 * (root * root - square);
        if slope < square {
            break;
        }
        let step = (root * (root * root - 3.0 * square) - determinant) / slope;
        root -= step;
        // the next step would be below rounding
        if step.abs() < 1e-9 * root {
            return root;
        }
    }
    let cosine = (determinant / (2.0 * p * square)).clamp(-1.0, 1.0);
    2.0 * p * (cosine.acos() / 3.0).cos()
}

/// Most steps of Newton's method for an eigenvalue.
pub(crate) const NEWTON_STEPS: usize = 8;

/// Whether the largest eigenvalue is safely above `threshold`, which costs less than the eigenvalue; where it is not, it may be either.
pub(crate) fn is_ordered_above(q: &Tensor5, threshold: f64) -> bool {
    let square = contract(q, q) / 6.0;
    // right of the cubic's minimum it is negative up to the largest root
    let cubic = threshold * (threshold * threshold - 3.0 * square) - determinant(q);
    threshold * threshold >= square && cubic < -1e-9 * square * threshold
}

fn determinant(q: &Tensor5) -> f64 {
    let [xx, xy, xz, yy, yz] = *q;
    let zz = -xx - yy;
    xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn order_and_director_of_a_uniaxial_tensor() {
        for (s, n) in [
            (0.53, [0.6, 0.0, 0.8]),
            (0.2, [0.0, 1.0, 0.0]),
            (0.9, [-0.48, 0.6, 0.64]),
        ] {
            let q = uniaxial(s, n);
            let (order, director) = order_and_director(&q);
            assert_relative_eq!(order, s, max_relative = 1e-12);
            let along: f64 = director.iter().zip(&n).map(|(a, b)| a * b).sum();
            assert_relative_eq!(along.abs(), 1.0, max_relative = 1e-12);
            assert!(director[2] >= 0.0);
            assert_relative_eq!(contract(&q, &q), 1.5 * s * s, max_relative = 1e-12);
        }
        assert_eq!(order_and_director(&[0.0; 5]), (0.0, [0.0, 0.0, 1.0]));
        assert!(order_and_director(&[f64::NAN; 5]).0.is_nan());
        // An oblate tensor has no unique director, but a unit one across its axis, with half of |S| as its order.
        let axes = [
            [0.0, 0.6, 0.8],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        for axis in axes {
            let (order, n) = order_and_director(&uniaxial(-0.3, axis));
            // A double root is known to the square root of rounding.
            assert_relative_eq!(order, 0.15, max_relative = 1e-7);
            let dot = |a: [f64; 3]| n.iter().zip(a).map(|(x, y)| x * y).sum::<f64>();
            assert_relative_eq!(dot(n), 1.0, max_relative = 1e-12);
            assert!(dot(axis).abs() < 1e-6, "{axis:?}: {n:?}");
        }
    }

    #[test]
    fn eigenvalues_are_those_of_the_matrix() {
        let mut noise = crate::noise::noise(1);
        let mut next = || 0.5 * noise.next().unwrap();
        for k in 0..2000 {
            let mut q: Tensor5 = std::array::from_fn(|_| next());
            if k % 3 == 0 {
                // nearly uniaxial, prolate and oblate
                let small = q.map(|x| 1e-3 * x);
                let sign = if k % 2 == 0 { 0.5 } else { -0.5 };
                let [x, y, z] = [next(), next(), next()];
                let norm = (x * x + y * y + z * z).sqrt();
                q = uniaxial(sign, [x / norm, y / norm, z / norm]);
                q.iter_mut().zip(small).for_each(|(a, b)| *a += b);
            }
            let truth = matrix(&q).symmetric_eigen().eigenvalues.max();
            let found = largest_eigenvalue(&q);
            assert!((found - truth).abs() < 1e-12, "{q:?}: {found} {truth}");
            for threshold in [0.8 * truth, truth - 1e-6, truth + 1e-6] {
                if is_ordered_above(&q, threshold) {
                    assert!(truth > threshold);
                }
            }
        }
        let q = uniaxial(0.5, [0.0, 0.6, 0.8]);
        assert!(is_ordered_above(&q, 0.35) && !is_ordered_above(&q, 0.51));
        assert!(!is_ordered_above(&[0.0; 5], 0.35));
    }

    #[test]
    fn components_agree_with_matrices() {
        let (a, b) = ([0.3, -0.1, 0.2, 0.05, -0.4], [-0.2, 0.15, 0.1, 0.3, 0.25]);
        let product = (matrix(&a) * matrix(&b)).trace();
        assert_relative_eq!(contract(&a, &b), product, max_relative = 1e-12);
        let square = matrix(&a) * matrix(&a);
        let traceless = square - Matrix3::identity() * (square.trace() / 3.0);
        let difference = matrix(&square_traceless(&a)) - traceless;
        assert!(difference.norm() < 1e-15, "{difference}");
    }
}
