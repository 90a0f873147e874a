//! What is read off a velocity field.

use fearless_simd::Level;

use super::rate::Flow;
use crate::stokes::MacField;
use crate::vector::dispatch;

/// Curl of the velocity at the cell centres, component-major.
pub(super) fn vorticity(flow: &Flow, level: Level) -> Vec<f64> {
    let [n_x, n_y, n_z] = flow.stencil.cells;
    let n = n_x * n_y * n_z;
    let mut curl = vec![0.0; 3 * n];
    let mut row = vec![[[0.0; 3]; 3]; n_x];
    for (j, k) in (0..n_z).flat_map(|k| (0..n_y).map(move |j| (j, k))) {
        dispatch!(level, simd => flow.gradient_row(simd, [j, k], &mut row));
        for (i, w) in row.iter().enumerate() {
            let cell = (k * n_y + j) * n_x + i;
            curl[cell] = w[1][2] - w[2][1];
            curl[n + cell] = w[2][0] - w[0][2];
            curl[2 * n + cell] = w[0][1] - w[1][0];
        }
    }
    curl
}

/// Velocity at the cell centres, component-major.
pub(super) fn centred(velocity: &MacField) -> Vec<f64> {
    let [n_x, n_y, n_z] = velocity.cells();
    let n = n_x * n_y * n_z;
    let mut out = vec![0.0; 3 * n];
    for cell in 0..n {
        let u = velocity.at_centre([cell % n_x, cell / n_x % n_y, cell / n_x / n_y]);
        for axis in 0..3 {
            out[axis * n + cell] = u[axis];
        }
    }
    out
}
