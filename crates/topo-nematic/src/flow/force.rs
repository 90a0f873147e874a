//! The force of the director on the fluid: the adjoint of the flow terms, so that they conserve energy.

use std::sync::{Mutex, PoisonError};

use fearless_simd::{Level, Simd, SimdBase, f64x8};
use rayon::prelude::*;

use super::rate::open;
use super::stencil::{Either, Ends, MARGIN, N_LANES, Row, Segment, Stencil, TILE, WIDE, store};
use super::terms::{contract, six, stress};
use crate::grid::Faces;
use crate::stokes::MacField;
use crate::vector::dispatch;

/// Planes of one job: each job computes the stress of as many more on either side as differences reach.
const SLAB: usize = 12;

/// Q, H and what they act through.
pub(super) struct Director<'a> {
    pub stencil: &'a Stencil,
    pub q: Either<'a>,
    pub h: Either<'a>,
    pub weights: Option<&'a [f64]>,
    pub alignment: f64,
}

/// Planes that a difference takes.
const PLANES: usize = 2 * MARGIN + 1;

/// Stress of successive planes, (i, j) entry after entry: the working memory of one thread.
///
/// Each row has a margin on either end, and room for whole blocks.
pub(super) struct Window {
    planes: [Vec<f64>; PLANES],
}

impl Window {
    pub fn new(stencil: &Stencil) -> Self {
        Self {
            planes: std::array::from_fn(|_| vec![0.0; 9 * stencil.cells[1] * width(stencil)]),
        }
    }

    pub fn n_bytes(&self) -> usize {
        self.planes.iter().map(|p| p.len() * size_of::<f64>()).sum()
    }
}

/// Numbers from one row of stress to the next.
fn width(stencil: &Stencil) -> usize {
    stencil.cells[0].next_multiple_of(N_LANES) + N_LANES
}

impl Director<'_> {
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
        let plane = s.plane();
        let stress_at = |k: usize, offset: isize, out: &mut [f64]| {
            let k = s.image(2, k as isize + offset);
            dispatch!(level, simd => self.stress_plane(simd, k, out));
        };
        for place in 1..PLANES {
            let offset = place as isize - 1 - MARGIN as isize;
            stress_at(first, offset, &mut window.planes[place]);
        }
        for (n, k) in (first..first + force[0].len() / plane).enumerate() {
            window.planes.rotate_left(1);
            stress_at(k, MARGIN as isize, &mut window.planes[PLANES - 1]);
            let range = n * plane..(n + 1) * plane;
            let out = force.each_mut().map(|f| &mut f[range.clone()]);
            let planes = &window.planes;
            dispatch!(level, simd => self.force_plane(simd, k, planes, out));
        }
    }

    /// The five components of a row from `start` on, with a margin on either end.
    #[inline(always)]
    fn tensor(&self, field: Either, row: Row, start: usize) -> [Segment; 5] {
        let n_cells = field.len() / 5;
        let s = self.stencil;
        let mut tensor = [const { Segment::zero() }; 5];
        for c in 0..5 {
            let range = c * n_cells..(c + 1) * n_cells;
            let segment = &mut tensor[c];
            match field {
                Either::Double(field) => {
                    segment.add(s.values(&field[range], row), None, start, Ends::Wrap, 1.0);
                }
                Either::Single(field) => {
                    segment.add(s.values(&field[range], row), None, start, Ends::Wrap, 1.0);
                }
            }
        }
        tensor
    }

    /// H times the share of the cell that is fluid, zero elsewhere whatever is stored there; and that share.
    #[inline(always)]
    fn weighted<S: Simd>(&self, simd: S, row: Row, start: usize) -> ([Segment; 5], Segment) {
        let mut h = self.tensor(self.h, row, start);
        let mut weight = Segment::zero();
        if let Some(weights) = self.weights {
            weight = Segment::of(self.stencil.values(weights, row), start, Ends::Wrap);
            for at in (0..TILE + N_LANES).step_by(N_LANES) {
                let weight = weight.load_place(simd, at);
                for c in 0..5 {
                    let value = h[c].load_place(simd, at);
                    h[c].store_place(open(simd, weight, value * weight), at);
                }
            }
        }
        (h, weight)
    }

    #[inline(always)]
    fn stress_plane<S: Simd>(&self, simd: S, k: usize, out: &mut [f64]) {
        let s = self.stencil;
        let (n, width) = (s.cells[0], width(s));
        for j in 0..s.cells[1] {
            let row = s.row([j, k]);
            for start in (0..n).step_by(TILE) {
                let q = self.tensor(self.q, row, start);
                let (h, weight) = self.weighted(simd, row, start);
                for at in (start..n.min(start + TILE)).step_by(N_LANES) {
                    let i = at - start;
                    let zero = f64x8::splat(simd, 0.0);
                    let (mut q_here, mut h_here) = ([zero; 5], [zero; 5]);
                    for c in 0..5 {
                        q_here[c] = q[c].load(simd, i, 0);
                        h_here[c] = h[c].load(simd, i, 0);
                    }
                    let t = stress(q_here, h_here, self.alignment);
                    let fluid = weight.load(simd, i, 0);
                    for entry in 0..9 {
                        let mut value = t[entry / 3][entry % 3];
                        if self.weights.is_some() {
                            // Q may be anything where there is no fluid.
                            value = open(simd, fluid, value);
                        }
                        let place = (entry * s.cells[1] + j) * width + MARGIN + at;
                        value.store_slice(&mut out[place..place + N_LANES]);
                    }
                }
            }
            for entry in 0..9 {
                let row = &mut out[(entry * s.cells[1] + j) * width..][..width];
                for m in 0..MARGIN {
                    row[m] = row[MARGIN + s.image(0, m as isize - MARGIN as isize)];
                    row[MARGIN + n + m] = row[MARGIN + s.image(0, (n + m) as isize)];
                }
            }
        }
    }

    #[inline(always)]
    fn force_plane<S: Simd>(
        &self,
        simd: S,
        k: usize,
        stresses: &[Vec<f64>; PLANES],
        force: [&mut [f64]; 3],
    ) {
        let s = self.stencil;
        let n = s.cells[0];
        for j in 0..s.cells[1] {
            let range = j * n..(j + 1) * n;
            let t = Stresses::new(s, stresses, j);
            for start in (0..n).step_by(TILE) {
                let advection = self.advection(simd, [j, k], start);
                for at in (start..n.min(start + TILE)).step_by(N_LANES) {
                    let divergence = t.divergence(simd, at, s.spacing);
                    for axis in 0..3 {
                        let moved = advection[axis].load(simd, at - start, 0);
                        let row = &mut force[axis][range.clone()];
                        store(divergence[axis] - moved, row, at);
                    }
                }
            }
            for axis in (0..3).filter(|&axis| s.faces[axis] == Faces::Wall) {
                match axis {
                    0 => force[0][j * n] = 0.0,
                    _ if [j, k][axis - 1] == 0 => force[axis][range.clone()].fill(0.0),
                    _ => {}
                }
            }
        }
    }

    /// H:(Q - Q before), with H of both cells and half weights, across the lower faces of a tile along the three axes.
    #[inline(always)]
    fn advection<S: Simd>(&self, simd: S, jk: [usize; 2], start: usize) -> [Segment; 3] {
        let s = self.stencil;
        let half = 0.5 / s.spacing;
        let own = s.row(jk);
        let q = self.tensor(self.q, own, start);
        let (h, weight) = self.weighted(simd, own, start);
        let mut out = [const { Segment::zero() }; 3];
        for axis in 0..3 {
            // Along x, the cells before are in the same segments, one place earlier.
            let beside = (axis > 0).then(|| {
                let row = s.row(s.step(axis, jk, false));
                (
                    self.tensor(self.q, row, start),
                    self.weighted(simd, row, start),
                )
            });
            let (q_before, (h_before, weight_before), shift) = match &beside {
                Some((q, (h, weight))) => (q, (h, weight), 0),
                None => (&q, (&h, &weight), -1),
            };
            for i in (0..TILE).step_by(N_LANES) {
                let zero = f64x8::splat(simd, 0.0);
                let (mut difference, mut sum) = ([zero; 5], [zero; 5]);
                for c in 0..5 {
                    difference[c] = q[c].load(simd, i, 0) - q_before[c].load(simd, i, shift);
                    sum[c] = h[c].load(simd, i, 0) + h_before[c].load(simd, i, shift);
                }
                let mut value = contract(six(sum), six(difference)) * half;
                if self.weights.is_some() {
                    let both = weight.load(simd, i, 0) * weight_before.load(simd, i, shift);
                    value = open(simd, both, value);
                }
                out[axis].store_place(value, i + MARGIN);
            }
        }
        out
    }
}

/// Rows of stress around row j, in the planes around its own.
struct Stresses<'a> {
    planes: &'a [Vec<f64>; PLANES],
    /// Where row j and those around it start.
    rows: [usize; PLANES],
    /// Numbers from one entry of the tensor to the next.
    entry: usize,
}

impl<'a> Stresses<'a> {
    #[inline(always)]
    fn new(s: &Stencil, planes: &'a [Vec<f64>; PLANES], j: usize) -> Self {
        let width = width(s);
        let row = |place: usize| s.image(1, (j + place) as isize - MARGIN as isize) * width;
        Self {
            planes,
            rows: std::array::from_fn(row),
            entry: s.cells[1] * width,
        }
    }

    /// T_ab in the eight cells from `at` on, offset along x, y and z.
    #[inline(always)]
    fn at<S: Simd>(
        &self,
        simd: S,
        [a, b]: [usize; 2],
        [along, row, plane]: [isize; 3],
        at: usize,
    ) -> f64x8<S> {
        let middle = MARGIN as isize;
        let row = self.rows[(middle + row) as usize];
        let start = (3 * a + b) * self.entry + row + at.wrapping_add_signed(middle + along);
        f64x8::from_slice(
            simd,
            &self.planes[(middle + plane) as usize][start..start + N_LANES],
        )
    }

    /// -d_j T_ji on the lower faces of the eight cells from `at` on.
    #[inline(always)]
    fn divergence<S: Simd>(&self, simd: S, at: usize, spacing: f64) -> [f64x8<S>; 3] {
        let (whole, quarter) = (1.0 / spacing, 0.25 / spacing);
        let mut force = [f64x8::splat(simd, 0.0); 3];
        for i in 0..3 {
            let mut before = [0; 3];
            before[i] = -1;
            let here = self.at(simd, [i, i], [0; 3], at);
            force[i] = (self.at(simd, [i, i], before, at) - here) * whole;
            for j in 0..3 {
                if j == i {
                    continue;
                }
                for (offset, factor) in WIDE {
                    let (mut lower, mut upper) = ([0; 3], [0; 3]);
                    (lower[j], upper[j]) = (-offset, offset);
                    let mut sum =
                        self.at(simd, [j, i], lower, at) - self.at(simd, [j, i], upper, at);
                    (lower[i], upper[i]) = (-1, -1);
                    sum += self.at(simd, [j, i], lower, at) - self.at(simd, [j, i], upper, at);
                    force[i] += sum * (factor * quarter);
                }
            }
        }
        force
    }
}
