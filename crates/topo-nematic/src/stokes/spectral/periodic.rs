//! Modes of a fully periodic box: each is algebraic.

use super::lanes::{Lines, N_LANES};
use super::planes::Planes;
use super::symbol::Symbol;
use topo_fourier::{Complex64, LineFft};

/// Solves for all k_y of one k_x.
pub(super) fn solve_column(
    planes: &Planes,
    symbol: &Symbol,
    [_, n_y, n_z]: [usize; 3],
    fft: &LineFft,
    lines: &mut Lines,
    scratch: &mut [Complex64],
) {
    for start in (0..n_y).step_by(N_LANES) {
        let n = (n_y - start).min(N_LANES);
        let modes = &mut lines.periodic[..3 * n * n_z];
        let place = |axis: usize, l: usize, k: usize| (axis * n + l) * n_z + k;
        for k in 0..n_z {
            let tile = (planes.forced)(k).then(|| planes.tile(k));
            for (axis, l) in (0..3).flat_map(|axis| (0..n).map(move |l| (axis, l))) {
                let value = tile.as_ref().map(|tile| tile[axis * n_y + start + l]);
                modes[place(axis, l, k)] = value.unwrap_or_default();
            }
        }
        fft.forward(modes, scratch);
        for (l, k) in (0..n).flat_map(|l| (0..n_z).map(move |k| (l, k))) {
            let at = [planes.column, start + l, k];
            let g: [Complex64; 3] = std::array::from_fn(|axis| symbol.gradient[axis][at[axis]]);
            let m2: f64 = (0..3).map(|axis| symbol.laplacian[axis][at[axis]]).sum();
            // The mean flow is given, not driven.
            let (inverse, scale) = if m2 > 0.0 {
                (1.0 / m2, symbol.scale / m2)
            } else {
                (0.0, 0.0)
            };
            let f: [Complex64; 3] = std::array::from_fn(|axis| modes[place(axis, l, k)]);
            let along: Complex64 = (0..3).map(|axis| g[axis].conj() * f[axis]).sum();
            for axis in 0..3 {
                modes[place(axis, l, k)] = (f[axis] - g[axis] * along * inverse) * scale;
            }
        }
        fft.inverse(modes, scratch);
        for k in (0..n_z).filter(|&k| (planes.wanted)(k)) {
            let mut tile = planes.tile(k);
            for (axis, l) in (0..3).flat_map(|axis| (0..n).map(move |l| (axis, l))) {
                tile[axis * n_y + start + l] = modes[place(axis, l, k)];
            }
        }
    }
}
