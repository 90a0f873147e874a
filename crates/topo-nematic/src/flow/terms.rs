//! Co-rotation and alignment in one cell, and their adjoint.

use fearless_simd::{Simd, f64x8};

/// Full symmetric tensor from five components (xx, xy, xz, yy, yz): the sixth is zz.
#[inline(always)]
pub(super) fn six<S: Simd>([xx, xy, xz, yy, yz]: [f64x8<S>; 5]) -> [f64x8<S>; 6] {
    [xx, xy, xz, yy, yz, -(xx + yy)]
}

/// Full contraction of two symmetric tensors.
#[inline(always)]
pub(super) fn contract<S: Simd>(a: [f64x8<S>; 6], b: [f64x8<S>; 6]) -> f64x8<S> {
    (a[0] * b[0] + a[3] * b[3] + a[5] * b[5]) + (a[1] * b[1] + a[2] * b[2] + a[4] * b[4]) * 2.0
}

/// Place of component (i, j) in six.
const PLACE: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];

/// Rate of Q that the velocity gradient W_ij = d_i u_j causes.
///
/// ```math
/// -\Omega Q + Q \Omega + \chi [\tfrac23 D + DQ + QD] - 2 \chi (Q + I/3) (Q : D)
/// ```
///
/// With M = Ω + χ D, the first four terms are Q M and its transpose, and 2/3 χ D.
#[inline(always)]
pub(super) fn turn_and_align<S: Simd>(
    q: [f64x8<S>; 5],
    w: [[f64x8<S>; 3]; 3],
    chi: f64,
) -> [f64x8<S>; 5] {
    let q = six(q);
    let (plus, minus) = (0.5 * (chi + 1.0), 0.5 * (chi - 1.0));
    let mut d = q;
    let mut m = w;
    // Loops, not closures: only what is surely inlined runs on the vector unit.
    for i in 0..3 {
        for j in 0..3 {
            d[PLACE[i][j]] = (w[i][j] + w[j][i]) * 0.5;
            m[i][j] = w[i][j] * plus + w[j][i] * minus;
        }
    }
    let mut product = w;
    for i in 0..3 {
        for j in 0..3 {
            product[i][j] =
                q[PLACE[i][0]] * m[0][j] + q[PLACE[i][1]] * m[1][j] + q[PLACE[i][2]] * m[2][j];
        }
    }
    let stretch = contract(q, d) * (2.0 * chi);
    let trace = stretch * (1.0 / 3.0);
    let mut rate = [stretch; 5];
    for (c, (i, j)) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2)]
        .into_iter()
        .enumerate()
    {
        let place = PLACE[i][j];
        rate[c] = product[i][j] + product[j][i] + d[place] * (2.0 / 3.0 * chi) - q[place] * stretch;
        if i == j {
            rate[c] -= trace;
        }
    }
    rate
}

/// What multiplies W_ij in the contraction of H with [`turn_and_align`].
///
/// ```math
/// T = QH - HQ + \chi [\tfrac23 H + HQ + QH - 2 (Q:H) Q]
/// ```
#[inline(always)]
pub(super) fn stress<S: Simd>(q: [f64x8<S>; 5], h: [f64x8<S>; 5], chi: f64) -> [[f64x8<S>; 3]; 3] {
    let (q, h) = (six(q), six(h));
    let stretch = contract(q, h) * (2.0 * chi);
    let mut product = [[stretch; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            product[i][j] = q[PLACE[i][0]] * h[PLACE[0][j]]
                + q[PLACE[i][1]] * h[PLACE[1][j]]
                + q[PLACE[i][2]] * h[PLACE[2][j]];
        }
    }
    let mut stress = product;
    for i in 0..3 {
        for j in 0..3 {
            let place = PLACE[i][j];
            stress[i][j] = product[i][j] * (chi + 1.0)
                + product[j][i] * (chi - 1.0)
                + h[place] * (2.0 / 3.0 * chi)
                - q[place] * stretch;
        }
    }
    stress
}
