//! The force of the director on the fluid: exactly what makes the flow terms conserve energy.

use std::sync::{Mutex, PoisonError};

use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x8};
use rayon::prelude::*;

use super::rate::open;
use super::stencil::{Ends, N_LANES, Row, Stencil, Stored, load, load_row, store};
use super::terms::{contract, six, stress};
use crate::grid::Faces;
use crate::stokes::MacField;

/// Planes of one job: each job computes the stress of one plane more on either side.
const SLAB: usize = 12;

/// Q, H and what they act through.
pub(super) struct Director<'a, T> {
    pub stencil: &'a Stencil,
    pub q: &'a [T],
    pub h: &'a [T],
    pub weights: Option<&'a [f64]>,
    pub alignment: f64,
}

/// Stress of three successive planes, (i, j) entry after entry: the working memory of one thread.
pub(super) struct Window {
    planes: [Vec<f64>; 3],
}

impl Window {
    pub fn new(stencil: &Stencil) -> Self {
        Self {
            planes: std::array::from_fn(|_| vec![0.0; 9 * stencil.plane()]),
        }
    }

    pub fn n_bytes(&self) -> usize {
        self.planes.iter().map(|p| p.len() * size_of::<f64>()).sum()
    }
}

impl<T: Stored> Director<'_, T> {
    /// Writes the force on all faces.
    ///
    /// ```math
    /// f_i = -H : \partial_i Q - \partial_j T_{ji}
    /// ```
    pub fn force(&self, level: Level, windows: &mut [Window], force: &mut MacField) {
        let size = SLAB * self.stencil.plane();
        let [f_x, f_y, f_z] = force.components_mut();
        let [f_x, f_y, f_z] = [f_x, f_y, f_z].map(|f| f.chunks_mut(size));
        let queue = Mutex::new(f_x.zip(f_y.zip(f_z)).enumerate());
        windows.par_iter_mut().for_each(|window| {
            loop {
                let job = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
                let Some((slab, (f_x, (f_y, f_z)))) = job else {
                    break;
                };
                self.slab(level, window, slab * SLAB, [f_x, f_y, f_z]);
            }
        });
    }

    /// Forces in the planes from `first` on that `force` has room for.
    fn slab(&self, level: Level, window: &mut Window, first: usize, mut force: [&mut [f64]; 3]) {
        let s = self.stencil;
        let (n_z, plane) = (s.cells[2], s.plane());
        let walled = s.faces[2] == Faces::Wall;
        let after = |k: usize| {
            if k + 1 < n_z {
                k + 1
            } else if walled {
                k
            } else {
                0
            }
        };
        let before = if first > 0 {
            first - 1
        } else if walled {
            0
        } else {
            n_z - 1
        };
        for (place, k) in [(1, before), (2, first)] {
            let out = &mut window.planes[place];
            dispatch!(level, simd => self.stress_plane(simd, k, out));
        }
        for (n, k) in (first..first + force[0].len() / plane).enumerate() {
            window.planes.rotate_left(1);
            let next = &mut window.planes[2];
            dispatch!(level, simd => self.stress_plane(simd, after(k), next));
            let range = n * plane..(n + 1) * plane;
            let out = force.each_mut().map(|f| &mut f[range.clone()]);
            let planes = &window.planes;
            dispatch!(level, simd => self.force_plane(simd, k, planes, out));
        }
    }

    #[inline(always)]
    fn tensor<S: Simd>(&self, simd: S, field: &[T], row: Row, at: isize) -> [f64x8<S>; 5] {
        let n_cells = field.len() / 5;
        let n = self.stencil.cells[0];
        std::array::from_fn(|c| {
            let field = &field[c * n_cells..(c + 1) * n_cells];
            load_row(simd, field, row, n, at, Ends::Wrap)
        })
    }

    /// H times the share of the cell that is fluid, zero elsewhere whatever is stored there.
    #[inline(always)]
    fn weighted<S: Simd>(&self, simd: S, row: Row, at: isize) -> [f64x8<S>; 5] {
        let h = self.tensor(simd, self.h, row, at);
        match self.weights {
            None => h,
            Some(weights) => {
                let weight = load_row(simd, weights, row, self.stencil.cells[0], at, Ends::Wrap);
                h.map(|h| open(simd, weight, h * weight))
            }
        }
    }

    #[inline(always)]
    fn stress_plane<S: Simd>(&self, simd: S, k: usize, out: &mut [f64]) {
        let s = self.stencil;
        let (n, plane) = (s.cells[0], s.plane());
        for j in 0..s.cells[1] {
            let row = s.row([j, k]);
            for at in (0..n).step_by(N_LANES) {
                let q = self.tensor(simd, self.q, row, at as isize);
                let h = self.weighted(simd, row, at as isize);
                let mut t = stress(q, h, self.alignment);
                if let Some(weights) = self.weights {
                    // Q may be anything where there is no fluid.
                    let weight = load_row(simd, weights, row, n, at as isize, Ends::Wrap);
                    t = t.map(|t| t.map(|t| open(simd, weight, t)));
                }
                for (entry, t) in t.into_iter().flatten().enumerate() {
                    let start = entry * plane + j * n;
                    store(t, &mut out[start..start + n], at);
                }
            }
        }
    }

    #[inline(always)]
    fn force_plane<S: Simd>(
        &self,
        simd: S,
        k: usize,
        stresses: &[Vec<f64>; 3],
        force: [&mut [f64]; 3],
    ) {
        let s = self.stencil;
        let n = s.cells[0];
        for j in 0..s.cells[1] {
            let range = j * n..(j + 1) * n;
            for at in (0..n).step_by(N_LANES) {
                let total = self.force_block(simd, [j, k], stresses, at as isize);
                for axis in 0..3 {
                    let on_wall = axis > 0 && s.faces[axis] == Faces::Wall && [j, k][axis - 1] == 0;
                    let row = &mut force[axis][range.clone()];
                    if on_wall {
                        row.fill(0.0);
                    } else {
                        store(total[axis], row, at);
                    }
                }
            }
            if s.faces[0] == Faces::Wall {
                force[0][j * n] = 0.0;
            }
        }
    }

    /// Forces on the lower faces of eight cells.
    #[inline(always)]
    fn force_block<S: Simd>(
        &self,
        simd: S,
        jk @ [j, _]: [usize; 2],
        stresses: &[Vec<f64>; 3],
        i: isize,
    ) -> [f64x8<S>; 3] {
        let s = self.stencil;
        let (n, n_y, plane) = (s.cells[0], s.cells[1], s.plane());
        let ends = s.cell_ends();
        let walled = s.faces[1] == Faces::Wall;
        let above = if j + 1 < n_y {
            j + 1
        } else if walled {
            j
        } else {
            0
        };
        let below = if j > 0 {
            j - 1
        } else if walled {
            0
        } else {
            n_y - 1
        };
        // Entry (a, b) of the stress in plane k + dz - 1, row `row`, shifted along x.
        let t = |a: usize, b: usize, dz: usize, row: usize, shift: isize| {
            let start = (3 * a + b) * plane + row * n;
            load(simd, &stresses[dz][start..start + n], i + shift, ends)
        };
        let (whole, quarter) = (1.0 / s.spacing, 0.25 / s.spacing);
        let x = (t(0, 0, 1, j, -1) - t(0, 0, 1, j, 0)) * whole
            + ((t(1, 0, 1, below, -1) + t(1, 0, 1, below, 0))
                - (t(1, 0, 1, above, -1) + t(1, 0, 1, above, 0))
                + (t(2, 0, 0, j, -1) + t(2, 0, 0, j, 0))
                - (t(2, 0, 2, j, -1) + t(2, 0, 2, j, 0)))
                * quarter;
        let y = (t(1, 1, 1, below, 0) - t(1, 1, 1, j, 0)) * whole
            + ((t(0, 1, 1, below, -1) + t(0, 1, 1, j, -1))
                - (t(0, 1, 1, below, 1) + t(0, 1, 1, j, 1))
                + (t(2, 1, 0, below, 0) + t(2, 1, 0, j, 0))
                - (t(2, 1, 2, below, 0) + t(2, 1, 2, j, 0)))
                * quarter;
        let z = (t(2, 2, 0, j, 0) - t(2, 2, 1, j, 0)) * whole
            + ((t(0, 2, 0, j, -1) + t(0, 2, 1, j, -1)) - (t(0, 2, 0, j, 1) + t(0, 2, 1, j, 1))
                + (t(1, 2, 0, below, 0) + t(1, 2, 1, below, 0))
                - (t(1, 2, 0, above, 0) + t(1, 2, 1, above, 0)))
                * quarter;
        // Advection: each face moves Q of both its cells by half the difference.
        let own = s.row(jk);
        let (q, h) = (
            six(self.tensor(simd, self.q, own, i)),
            six(self.weighted(simd, own, i)),
        );
        let half = 0.5 / s.spacing;
        let weight = |row, at| match self.weights {
            Some(weights) => load_row(simd, weights, row, n, at, Ends::Wrap),
            None => f64x8::splat(simd, 1.0),
        };
        let advection = |row: Row, at: isize| {
            let q_before = six(self.tensor(simd, self.q, row, at));
            let h_before = six(self.weighted(simd, row, at));
            let difference = std::array::from_fn(|c| q[c] - q_before[c]);
            let sum = std::array::from_fn(|c| h[c] + h_before[c]);
            let value = contract(sum, difference) * half;
            match self.weights {
                None => value,
                Some(_) => open(simd, weight(own, i) * weight(row, at), value),
            }
        };
        [
            x - advection(own, i - 1),
            y - advection(s.row(s.step(1, jk, false)), i),
            z - advection(s.row(s.step(2, jk, false)), i),
        ]
    }
}
