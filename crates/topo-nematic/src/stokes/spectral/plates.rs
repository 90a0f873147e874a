//! Modes between walls along z: a tridiagonal and a pentadiagonal solve.

use super::lanes::{Lane, Lines, N_LANES};
use super::planes::Planes;
use super::symbol::Symbol;
use topo_fourier::Complex64;

/// What all modes of a block share along their lines.
struct Block {
    /// Symbol along x.
    g_x: Complex64,
    /// Symbols along y, real and imaginary.
    g_y: [Lane; 2],
    /// m^2 and its inverse; 1 in lanes without a mode and in the mean mode, whose result is thrown away.
    m2: Lane,
    inverse: Lane,
    /// First k_y and how many.
    start: usize,
    n: usize,
}

/// Solves for all k_y of one k_x.
#[inline(always)]
pub(super) fn solve_column(planes: &Planes, symbol: &Symbol, cells: [usize; 3], lines: &mut Lines) {
    let [_, n_y, n_z] = cells;
    for start in (0..n_y).step_by(N_LANES) {
        let block = Block::new(symbol, planes.column, start, (n_y - start).min(N_LANES));
        let has_mean = planes.column == 0 && start == 0;
        if has_mean {
            mean_flow(planes, symbol.plane_scale, n_y, lines);
        }
        eliminate(planes, &block, [n_y, n_z], lines);
        substitute(
            planes,
            &block,
            symbol.plane_scale,
            [n_y, n_z],
            lines,
            has_mean,
        );
    }
}

impl Block {
    #[inline(always)]
    fn new(symbol: &Symbol, column: usize, start: usize, n: usize) -> Self {
        let mut block = Self {
            g_x: symbol.gradient[0][column],
            g_y: [[0.0; N_LANES]; 2],
            m2: [1.0; N_LANES],
            inverse: [1.0; N_LANES],
            start,
            n,
        };
        for l in 0..n {
            let g = symbol.gradient[1][start + l];
            (block.g_y[0][l], block.g_y[1][l]) = (g.re, g.im);
            let m2 = symbol.laplacian[0][column] + symbol.laplacian[1][start + l];
            if m2 > 0.0 {
                block.m2[l] = m2;
                block.inverse[l] = 1.0 / m2;
            }
        }
        block
    }

    /// The forces in plane `k`: real and imaginary parts of the three components.
    #[inline(always)]
    fn load(&self, planes: &Planes, k: usize, n_y: usize) -> [[Lane; 2]; 3] {
        let mut f = [[[0.0; N_LANES]; 2]; 3];
        if (planes.forced)(k) {
            let tile = planes.tile(k);
            for (axis, f) in f.iter_mut().enumerate() {
                let modes = &tile[axis * n_y + self.start..][..self.n];
                if let Ok(modes) = <&[Complex64; N_LANES]>::try_from(modes) {
                    for l in 0..N_LANES {
                        (f[0][l], f[1][l]) = (modes[l].re, modes[l].im);
                    }
                } else {
                    for (l, mode) in modes.iter().enumerate() {
                        (f[0][l], f[1][l]) = (mode.re, mode.im);
                    }
                }
            }
        }
        f
    }
}

/// Up the lines: both factorisations and both forward substitutions.
#[inline(always)]
fn eliminate(planes: &Planes, b: &Block, [n_y, n_z]: [usize; 2], lines: &mut Lines) {
    let (g_x, [g_r, g_i]) = (b.g_x, &b.g_y);
    let zero = [0.0; N_LANES];
    // Longitudinal force times m, one plane below.
    let mut below = [zero; 2];
    // Of the two rows before: inverse pivots, and the subdiagonal of the row before.
    let (mut tri, mut pent, mut pent_2, mut sub) = (zero, zero, zero, zero);
    let mut transverse = [zero; 2];
    let (mut normal, mut normal_2) = ([zero; 2], [zero; 2]);
    for k in 0..n_z {
        let f = b.load(planes, k, n_y);
        let tri_shift = if k == 0 || k + 1 == n_z { 3.0 } else { 2.0 };
        let pent_shift = if k == 1 || k + 1 == n_z { 7.0 } else { 6.0 };
        let factor = &mut lines.factor[k];
        let (line_t, line_n) = (&mut lines.transverse[k], &mut lines.normal[k]);
        for l in 0..N_LANES {
            let m2 = b.m2[l];
            let [[x_r, x_i], [y_r, y_i], [z_r, z_i]] = [
                [f[0][0][l], f[0][1][l]],
                [f[1][0][l], f[1][1][l]],
                [f[2][0][l], f[2][1][l]],
            ];
            let (gr, gi) = (g_r[l], g_i[l]);
            // Transverse: (g_x f_y - g_y f_x)/m^2.
            let t_r = (g_x.re * y_r - g_x.im * y_i - gr * x_r + gi * x_i) * b.inverse[l];
            let t_i = (g_x.re * y_i + g_x.im * y_r - gr * x_i - gi * x_r) * b.inverse[l];
            let pivot = 1.0 / (m2 + tri_shift - tri[l]);
            // The row below is solved up to its pivot, which is still to be multiplied.
            transverse[0][l] = t_r + tri[l] * transverse[0][l];
            transverse[1][l] = t_i + tri[l] * transverse[1][l];
            tri[l] = pivot;
            line_t[0][l] = transverse[0][l];
            line_t[1][l] = transverse[1][l];
            factor[0][l] = pivot;
            // Longitudinal, times m: conj(g_x) f_x + conj(g_y) f_y.
            let l_r = g_x.re * x_r + g_x.im * x_i + gr * y_r + gi * y_i;
            let l_i = g_x.re * x_i - g_x.im * x_r + gr * y_i - gi * y_r;
            let r_r = m2 * z_r - (l_r - below[0][l]);
            let r_i = m2 * z_i - (l_i - below[1][l]);
            (below[0][l], below[1][l]) = (l_r, l_i);
            if k == 0 {
                continue;
            }
            // The row of the lower wall is empty: its pivot stays 0, which drops it.
            let lower = (-4.0 - 2.0 * m2 - sub[l]) * pent[l];
            let diagonal = m2 * m2 + 4.0 * m2 + pent_shift;
            let inverse = 1.0 / (diagonal - lower * (-4.0 - 2.0 * m2 - sub[l]) - pent_2[l]);
            let n_r = r_r - lower * normal[0][l] - pent_2[l] * normal_2[0][l];
            let n_i = r_i - lower * normal[1][l] - pent_2[l] * normal_2[1][l];
            (normal_2[0][l], normal_2[1][l]) = (normal[0][l], normal[1][l]);
            (normal[0][l], normal[1][l]) = (n_r, n_i);
            (pent_2[l], pent[l], sub[l]) = (pent[l], inverse, lower);
            (line_n[0][l], line_n[1][l]) = (n_r, n_i);
            factor[1][l] = inverse;
            factor[2][l] = lower;
        }
    }
}

/// Down the lines: both back substitutions, and the velocities.
#[inline(always)]
fn substitute(
    planes: &Planes,
    b: &Block,
    scale: f64,
    [n_y, n_z]: [usize; 2],
    lines: &Lines,
    has_mean: bool,
) {
    let (g_x, [g_r, g_i]) = (b.g_x, &b.g_y);
    let zero = [0.0; N_LANES];
    let mut transverse = [zero; 2];
    // Normal velocity one and two planes above, and the subdiagonal one plane above.
    let (mut normal, mut normal_2, mut sub) = ([zero; 2], [zero; 2], zero);
    for k in (0..n_z).rev() {
        let factor = &lines.factor[k];
        let (line_t, line_n) = (&lines.transverse[k], &lines.normal[k]);
        let mut u = [[zero; 2]; 3];
        for l in 0..N_LANES {
            let mut t = [0.0; 2];
            let mut w = [0.0; 2];
            let mut difference = [0.0; 2];
            for c in 0..2 {
                t[c] = factor[0][l] * (line_t[c][l] + transverse[c][l]);
                transverse[c][l] = t[c];
                if k > 0 {
                    w[c] = factor[1][l] * (line_n[c][l] - normal_2[c][l]) - sub[l] * normal[c][l];
                }
                difference[c] = (normal[c][l] - w[c]) * b.inverse[l];
                normal_2[c][l] = normal[c][l];
                normal[c][l] = w[c];
            }
            sub[l] = factor[2][l];
            let (gr, gi) = (g_r[l], g_i[l]);
            let ([t_r, t_i], [d_r, d_i]) = (t, difference);
            u[0][0][l] = scale * (g_x.re * d_r - g_x.im * d_i - gr * t_r - gi * t_i);
            u[0][1][l] = scale * (g_x.re * d_i + g_x.im * d_r - gr * t_i + gi * t_r);
            u[1][0][l] = scale * (gr * d_r - gi * d_i + g_x.re * t_r + g_x.im * t_i);
            u[1][1][l] = scale * (gr * d_i + gi * d_r + g_x.re * t_i - g_x.im * t_r);
            u[2][0][l] = scale * w[0];
            u[2][1][l] = scale * w[1];
        }
        if !(planes.wanted)(k) {
            continue;
        }
        let mut tile = planes.tile(k);
        for (axis, u) in u.iter().enumerate() {
            let modes = &mut tile[axis * n_y + b.start..][..b.n];
            let first = if has_mean { Some(modes[0]) } else { None };
            for (l, mode) in modes.iter_mut().enumerate() {
                *mode = Complex64::new(u[0][l], u[1][l]);
            }
            if let Some(mean) = first {
                modes[0] = mean;
            }
        }
    }
}

/// The mode without waves, solved in place: each in-plane component is a tridiagonal solve, and nothing crosses the planes.
fn mean_flow(planes: &Planes, scale: f64, n_y: usize, lines: &mut Lines) {
    let n_z = lines.factor.len();
    let mut pivot = 0.0;
    let mut below = [0.0; 2];
    for k in 0..n_z {
        let shift = if k == 0 || k + 1 == n_z { 3.0 } else { 2.0 };
        let force = if (planes.forced)(k) {
            let tile = planes.tile(k);
            [tile[0].re, tile[n_y].re]
        } else {
            [0.0; 2]
        };
        for axis in 0..2 {
            below[axis] = force[axis] + pivot * below[axis];
            lines.transverse[k][axis][0] = below[axis];
        }
        pivot = 1.0 / (shift - pivot);
        lines.factor[k][0][0] = pivot;
    }
    let mut above = [0.0; 2];
    for k in (0..n_z).rev() {
        for axis in 0..2 {
            above[axis] = lines.factor[k][0][0] * (lines.transverse[k][axis][0] + above[axis]);
        }
        if (planes.wanted)(k) || (planes.forced)(k) {
            let mut tile = planes.tile(k);
            for axis in 0..2 {
                tile[axis * n_y] = Complex64::new(scale * above[axis], 0.0);
            }
            tile[2 * n_y] = Complex64::default();
        }
    }
}
