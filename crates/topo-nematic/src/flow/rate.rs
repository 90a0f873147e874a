//! Advection, co-rotation and alignment by a given velocity.

use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x8};
use rayon::prelude::*;

use super::stencil::{Ends, N_LANES, Row, Stencil, Stored, load, load_row, store};
use super::terms::turn_and_align;
use crate::stokes::MacField;

/// A frozen velocity and what it acts on.
pub(super) struct Flow<'a> {
    pub stencil: &'a Stencil,
    pub velocity: &'a MacField,
    /// Share of each cell that is fluid; all of it without a particle.
    pub weights: Option<&'a [f64]>,
    pub alignment: f64,
}

impl Flow<'_> {
    /// Adds -u.grad Q and what turns and aligns Q to `rate`; both fields are component-major.
    pub fn add_rate<T: Stored>(&self, level: Level, q: &[T], rate: &mut [T]) {
        let n = q.len() / 5;
        let plane = self.stencil.plane();
        let q: [&[T]; 5] = std::array::from_fn(|c| &q[c * n..(c + 1) * n]);
        let mut rates = rate.chunks_exact_mut(n);
        let mut next = || rates.next().unwrap_or_default().par_chunks_mut(plane);
        let (r0, r1, r2, r3, r4) = (next(), next(), next(), next(), next());
        r0.zip(r1).zip(r2.zip(r3)).zip(r4).enumerate().for_each(
            |(k, (((r0, r1), (r2, r3)), r4))| {
                let rate = [r0, r1, r2, r3, r4];
                dispatch!(level, simd => self.add_plane(simd, q, k, rate));
            },
        );
    }

    #[inline(always)]
    fn add_plane<S: Simd, T: Stored>(
        &self,
        simd: S,
        q: [&[T]; 5],
        k: usize,
        mut rate: [&mut [T]; 5],
    ) {
        let n_x = self.stencil.cells[0];
        for j in 0..self.stencil.cells[1] {
            let range = j * n_x..(j + 1) * n_x;
            let rows = rate.each_mut().map(|r| &mut r[range.clone()]);
            self.add_row(simd, q, [j, k], rows);
        }
    }

    #[inline(always)]
    fn add_row<S: Simd, T: Stored>(
        &self,
        simd: S,
        q: [&[T]; 5],
        jk: [usize; 2],
        rate: [&mut [T]; 5],
    ) {
        let s = self.stencil;
        let n = s.cells[0];
        let half = 0.5 / s.spacing;
        let gradient = GradientRows::new(s, jk);
        // Rows of Q: the cell's, and before and after it along y and z.
        let own = s.row(jk);
        let beside = [1, 2].map(|axis| [false, true].map(|up| s.row(s.step(axis, jk, up))));
        let [u_x, u_y, u_z] = self.velocity.components();
        for at in (0..n).step_by(N_LANES) {
            let i = at as isize;
            // Velocities through the six faces, halved; closed where a neighbour is not fluid.
            let face =
                |field: &[f64], row, at| load_row(simd, field, row, n, at, Ends::Wrap) * half;
            let mut through = [
                [face(u_x, own, i), face(u_x, own, i + 1)],
                [face(u_y, own, i), face(u_y, beside[0][1], i)],
                [face(u_z, own, i), face(u_z, beside[1][1], i)],
            ];
            let mut fluid = None;
            if let Some(weights) = self.weights {
                let weight = |row, at| load_row(simd, weights, row, n, at, Ends::Wrap);
                let mine = weight(own, i);
                let others = [
                    [weight(own, i - 1), weight(own, i + 1)],
                    beside[0].map(|row| weight(row, i)),
                    beside[1].map(|row| weight(row, i)),
                ];
                for axis in 0..3 {
                    for side in 0..2 {
                        through[axis][side] =
                            open(simd, mine * others[axis][side], through[axis][side]);
                    }
                }
                fluid = Some(mine);
            }
            let value = |c: usize, row, at| load_row(simd, q[c], row, n, at, Ends::Wrap);
            let centre: [f64x8<S>; 5] = std::array::from_fn(|c| value(c, own, i));
            let turned = turn_and_align(centre, self.gradient(simd, &gradient, i), self.alignment);
            for c in 0..5 {
                let mid = centre[c];
                let advected = through[0][0] * (mid - value(c, own, i - 1))
                    + through[0][1] * (value(c, own, i + 1) - mid)
                    + through[1][0] * (mid - value(c, beside[0][0], i))
                    + through[1][1] * (value(c, beside[0][1], i) - mid)
                    + through[2][0] * (mid - value(c, beside[1][0], i))
                    + through[2][1] * (value(c, beside[1][1], i) - mid);
                let mut change = turned[c] - advected;
                if let Some(mine) = fluid {
                    change = open(simd, mine, change);
                }
                let before = load(simd, &*rate[c], i, Ends::Wrap);
                store(before + change, rate[c], at);
            }
        }
    }

    /// W_ij = d_i u_j at the centres of row (j, k).
    #[inline(always)]
    pub fn gradient_row<S: Simd>(&self, simd: S, jk: [usize; 2], out: &mut [[[f64; 3]; 3]]) {
        let rows = GradientRows::new(self.stencil, jk);
        for (block, out) in out.chunks_mut(N_LANES).enumerate() {
            let w = self.gradient(simd, &rows, (block * N_LANES) as isize);
            for (l, out) in out.iter_mut().enumerate() {
                *out = w.map(|w| w.map(|w| w[l]));
            }
        }
    }

    /// W_ij = d_i u_j at the centres: off the diagonal, the mean of the four nearest differences.
    #[inline(always)]
    fn gradient<S: Simd>(&self, simd: S, rows: &GradientRows, i: isize) -> [[f64x8<S>; 3]; 3] {
        let s = self.stencil;
        let n = s.cells[0];
        let [u_x, u_y, u_z] = self.velocity.components();
        let (whole, quarter) = (1.0 / s.spacing, 0.25 / s.spacing);
        let at = |field: &[f64], row, i, ends| load_row(simd, field, row, n, i, ends);
        // Sum over the two faces of a cell along x.
        let pair = |row| at(u_x, row, i, Ends::Wrap) + at(u_x, row, i + 1, Ends::Wrap);
        // Difference along x, summed over the two faces of a cell along y or z.
        let along = |field: &[f64], [lower, upper]: [_; 2], ends| {
            (at(field, lower, i + 1, ends) + at(field, upper, i + 1, ends))
                - (at(field, lower, i - 1, ends) + at(field, upper, i - 1, ends))
        };
        // Difference between the rows above and below, each summed over two faces.
        let across = |field: &[f64], [below, above]: [[_; 2]; 2]| {
            (at(field, above[0], i, Ends::Wrap) + at(field, above[1], i, Ends::Wrap))
                - (at(field, below[0], i, Ends::Wrap) + at(field, below[1], i, Ends::Wrap))
        };
        let own = rows.y[0];
        [
            [
                (at(u_x, own, i + 1, Ends::Wrap) - at(u_x, own, i, Ends::Wrap)) * whole,
                along(u_y, rows.y, s.velocity_ends(1)) * quarter,
                along(u_z, rows.z, s.velocity_ends(2)) * quarter,
            ],
            [
                (pair(rows.x_y[1]) - pair(rows.x_y[0])) * quarter,
                (at(u_y, rows.y[1], i, Ends::Wrap) - at(u_y, own, i, Ends::Wrap)) * whole,
                across(u_z, rows.z_y) * quarter,
            ],
            [
                (pair(rows.x_z[1]) - pair(rows.x_z[0])) * quarter,
                across(u_y, rows.y_z) * quarter,
                (at(u_z, rows.z[1], i, Ends::Wrap) - at(u_z, own, i, Ends::Wrap)) * whole,
            ],
        ]
    }
}

/// Rows that the velocity gradient of row (j, k) needs.
struct GradientRows {
    /// Of the lower and upper y face, and of the lower and upper z face.
    y: [Row; 2],
    z: [Row; 2],
    /// u_x below and above along y, and along z.
    x_y: [Row; 2],
    x_z: [Row; 2],
    /// u_z below and above along y, each on both z faces; u_y below and above along z, each on both y faces.
    z_y: [[Row; 2]; 2],
    y_z: [[Row; 2]; 2],
}

impl GradientRows {
    fn new(s: &Stencil, jk: [usize; 2]) -> Self {
        let faces = |axis| [jk, s.step(axis, jk, true)];
        let sides = [false, true];
        Self {
            y: faces(1).map(|jk| s.row(jk)),
            z: faces(2).map(|jk| s.row(jk)),
            x_y: sides.map(|up| s.beside(1, jk, up, 0)),
            x_z: sides.map(|up| s.beside(2, jk, up, 0)),
            z_y: sides.map(|up| faces(2).map(|jk| s.beside(1, jk, up, 2))),
            y_z: sides.map(|up| faces(1).map(|jk| s.beside(2, jk, up, 1))),
        }
    }
}

/// `value` where `weight` is above zero, else zero.
#[inline(always)]
pub(super) fn open<S: Simd>(simd: S, weight: f64x8<S>, value: f64x8<S>) -> f64x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    simd.select_f64x8(simd.simd_gt_f64x8(weight, zero), value, zero)
}
