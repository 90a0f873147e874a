//! Advection, co-rotation and alignment by a given velocity.

use fearless_simd::{Level, Simd, SimdBase, f64x8};
use rayon::prelude::*;

use super::stencil::{Ends, N_LANES, Segment, Stencil, Stored, TILE, WIDE, load, store};
use super::terms::turn_and_align;
use crate::stokes::MacField;
use crate::vector::dispatch;

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
        let n = self.stencil.cells[0];
        for j in 0..self.stencil.cells[1] {
            let [r0, r1, r2, r3, r4] = &mut rate;
            let range = j * n..(j + 1) * n;
            let rows = [
                &mut r0[range.clone()],
                &mut r1[range.clone()],
                &mut r2[range.clone()],
                &mut r3[range.clone()],
                &mut r4[range],
            ];
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
        let rows = GradientRows::new(s, self.velocity, jk);
        let half = 0.5 / s.spacing;
        let own = s.row(jk);
        let (south, north) = (s.row(s.step(1, jk, false)), s.row(s.step(1, jk, true)));
        let (down, up) = (s.row(s.step(2, jk, false)), s.row(s.step(2, jk, true)));
        for start in (0..n).step_by(TILE) {
            let gradient = GradientTile::new(s, &rows, start);
            let end = n.min(start + TILE);
            let weight = self
                .weights
                .map(|w| Segment::of(s.values(w, own), start, Ends::Wrap));
            // Half the velocities through the six faces, cell after cell; none where a neighbour is not fluid.
            let mut through = [[[0.0; TILE]; 2]; 3];
            for at in (start..end).step_by(N_LANES) {
                let i = at - start;
                let u = [
                    [gradient.u_x.load(simd, i, 0), gradient.u_x.load(simd, i, 1)],
                    [load(simd, rows.y[0], at), load(simd, rows.y[1], at)],
                    [load(simd, rows.z[0], at), load(simd, rows.z[1], at)],
                ];
                for axis in 0..3 {
                    for side in 0..2 {
                        let mut flux = u[axis][side] * half;
                        if let (Some(mine), Some(weights)) = (&weight, self.weights) {
                            let beside = match (axis, side) {
                                (0, 0) => mine.load(simd, i, -1),
                                (0, _) => mine.load(simd, i, 1),
                                (1, 0) => load(simd, s.values(weights, south), at),
                                (1, _) => load(simd, s.values(weights, north), at),
                                (_, 0) => load(simd, s.values(weights, down), at),
                                (_, _) => load(simd, s.values(weights, up), at),
                            };
                            flux = open(simd, mine.load(simd, i, 0) * beside, flux);
                        }
                        flux.store_slice(&mut through[axis][side][i..i + N_LANES]);
                    }
                }
            }
            // The row itself, to turn and align it, and to advect it along x.
            let centre = [
                Segment::of(s.values(q[0], own), start, Ends::Wrap),
                Segment::of(s.values(q[1], own), start, Ends::Wrap),
                Segment::of(s.values(q[2], own), start, Ends::Wrap),
                Segment::of(s.values(q[3], own), start, Ends::Wrap),
                Segment::of(s.values(q[4], own), start, Ends::Wrap),
            ];
            let mut turned = [[0.0; TILE]; 5];
            for at in (start..end).step_by(N_LANES) {
                let i = at - start;
                let mut here = [f64x8::splat(simd, 0.0); 5];
                for c in 0..5 {
                    here[c] = centre[c].load(simd, i, 0);
                }
                let w = gradient.at(simd, &rows, at, i);
                let change = turn_and_align(here, w, self.alignment);
                for c in 0..5 {
                    change[c].store_slice(&mut turned[c][i..i + N_LANES]);
                }
            }
            for c in 0..5 {
                let beside = [
                    s.values(q[c], south),
                    s.values(q[c], north),
                    s.values(q[c], down),
                    s.values(q[c], up),
                ];
                for at in (start..end).step_by(N_LANES) {
                    let i = at - start;
                    let flux = |axis: usize, side: usize| &through[axis][side][i..i + N_LANES];
                    let mid = centre[c].load(simd, i, 0);
                    let advected = f64x8::from_slice(simd, flux(0, 0))
                        * (mid - centre[c].load(simd, i, -1))
                        + f64x8::from_slice(simd, flux(0, 1)) * (centre[c].load(simd, i, 1) - mid)
                        + f64x8::from_slice(simd, flux(1, 0)) * (mid - load(simd, beside[0], at))
                        + f64x8::from_slice(simd, flux(1, 1)) * (load(simd, beside[1], at) - mid)
                        + f64x8::from_slice(simd, flux(2, 0)) * (mid - load(simd, beside[2], at))
                        + f64x8::from_slice(simd, flux(2, 1)) * (load(simd, beside[3], at) - mid);
                    let turned = f64x8::from_slice(simd, &turned[c][i..i + N_LANES]);
                    let mut change = turned - advected;
                    if let Some(mine) = &weight {
                        change = open(simd, mine.load(simd, i, 0), change);
                    }
                    store(load(simd, &*rate[c], at) + change, rate[c], at);
                }
            }
        }
    }

    /// W_ij = d_i u_j at the centres of row (j, k).
    #[inline(always)]
    pub fn gradient_row<S: Simd>(&self, simd: S, jk: [usize; 2], out: &mut [[[f64; 3]; 3]]) {
        let rows = GradientRows::new(self.stencil, self.velocity, jk);
        for (tile, out) in out.chunks_mut(TILE).enumerate() {
            let start = tile * TILE;
            let gradient = GradientTile::new(self.stencil, &rows, start);
            for (block, out) in out.chunks_mut(N_LANES).enumerate() {
                let i = block * N_LANES;
                let w = gradient.at(simd, &rows, start + i, i);
                for (l, out) in out.iter_mut().enumerate() {
                    *out = w.map(|w| w.map(|w| w[l]));
                }
            }
        }
    }
}

/// Rows of the velocity that its gradient in row (j, k) needs.
struct GradientRows<'a> {
    u_x: &'a [f64],
    /// u_y on the lower and upper y face, and u_z on the lower and upper z face.
    y: [&'a [f64]; 2],
    z: [&'a [f64]; 2],
    /// u_x of the rows around along y, and along z.
    x_y: [Mirrored<'a>; 4],
    x_z: [Mirrored<'a>; 4],
    /// u_z of the rows around along y, each on both z faces; u_y of those along z, each on both y faces.
    z_y: [[Mirrored<'a>; 2]; 4],
    y_z: [[Mirrored<'a>; 2]; 4],
}

/// Offsets of the rows that a difference takes, and their factors over twice the spacing.
const AROUND: [(isize, f64); 4] = [
    (-WIDE[1].0, -WIDE[1].1),
    (-WIDE[0].0, -WIDE[0].1),
    WIDE[0],
    WIDE[1],
];

/// A row, and how a wall reflects it.
type Mirrored<'a> = (&'a [f64], Option<[f64; 2]>);

impl<'a> GradientRows<'a> {
    fn new(s: &Stencil, velocity: &'a MacField, jk: [usize; 2]) -> Self {
        let u = velocity.components();
        let faces = |axis| [jk, s.step(axis, jk, true)];
        let beside = |axis, jk, offset, component: usize| {
            let row = s.beside(axis, jk, offset, component);
            (s.values(u[component], row), row.mirror)
        };
        let around = AROUND.map(|(offset, _)| offset);
        Self {
            u_x: s.values(u[0], s.row(jk)),
            y: faces(1).map(|jk| s.values(u[1], s.row(jk))),
            z: faces(2).map(|jk| s.values(u[2], s.row(jk))),
            x_y: around.map(|d| beside(1, jk, d, 0)),
            x_z: around.map(|d| beside(2, jk, d, 0)),
            z_y: around.map(|d| faces(2).map(|jk| beside(1, jk, d, 2))),
            y_z: around.map(|d| faces(1).map(|jk| beside(2, jk, d, 1))),
        }
    }
}

/// Combinations of these rows in one tile: off the diagonal, W is the mean over two faces of a difference of order four, as
/// one of order two across two cells would read a wave of forty cells 0.6 % too low.
struct GradientTile {
    u_x: Segment,
    /// u_y and u_z summed over the two faces of a cell.
    sum_y: Segment,
    sum_z: Segment,
    /// Differences of u_x along y and along z, times twice the spacing.
    x_y: Segment,
    x_z: Segment,
    /// Those of u_z along y and of u_y along z, summed over the two faces of a cell.
    z_y: Segment,
    y_z: Segment,
    whole: f64,
    quarter: f64,
}

impl GradientTile {
    #[inline(always)]
    fn new(s: &Stencil, rows: &GradientRows, start: usize) -> Self {
        let mut tile = Self {
            u_x: Segment::of(rows.u_x, start, Ends::Wrap),
            sum_y: Segment::zero(),
            sum_z: Segment::zero(),
            x_y: Segment::zero(),
            x_z: Segment::zero(),
            z_y: Segment::zero(),
            y_z: Segment::zero(),
            whole: 1.0 / s.spacing,
            quarter: 0.25 / s.spacing,
        };
        let (ends_y, ends_z) = (s.velocity_ends(1), s.velocity_ends(2));
        for face in 0..2 {
            tile.sum_y.add(rows.y[face], None, start, ends_y, 1.0);
            tile.sum_z.add(rows.z[face], None, start, ends_z, 1.0);
        }
        for (place, (_, factor)) in AROUND.into_iter().enumerate() {
            let (row, mirror) = rows.x_y[place];
            tile.x_y.add(row, mirror, start, Ends::Wrap, factor);
            let (row, mirror) = rows.x_z[place];
            tile.x_z.add(row, mirror, start, Ends::Wrap, factor);
            for face in 0..2 {
                let (row, mirror) = rows.z_y[place][face];
                tile.z_y.add(row, mirror, start, Ends::Wrap, factor);
                let (row, mirror) = rows.y_z[place][face];
                tile.y_z.add(row, mirror, start, Ends::Wrap, factor);
            }
        }
        tile
    }

    /// W_ij = d_i u_j in the eight cells from `at` on, which is place i of the tile.
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, rows: &GradientRows, at: usize, i: usize) -> [[f64x8<S>; 3]; 3] {
        let (whole, quarter) = (self.whole, self.quarter);
        let u_x = &self.u_x;
        [
            [
                (u_x.load(simd, i, 1) - u_x.load(simd, i, 0)) * whole,
                along(simd, &self.sum_y, i) * quarter,
                along(simd, &self.sum_z, i) * quarter,
            ],
            [
                (self.x_y.load(simd, i, 0) + self.x_y.load(simd, i, 1)) * quarter,
                (load(simd, rows.y[1], at) - load(simd, rows.y[0], at)) * whole,
                self.z_y.load(simd, i, 0) * quarter,
            ],
            [
                (self.x_z.load(simd, i, 0) + self.x_z.load(simd, i, 1)) * quarter,
                self.y_z.load(simd, i, 0) * quarter,
                (load(simd, rows.z[1], at) - load(simd, rows.z[0], at)) * whole,
            ],
        ]
    }
}

/// The difference along a row across the eight cells from `i` on, times twice the spacing.
#[inline(always)]
fn along<S: Simd>(simd: S, sum: &Segment, i: usize) -> f64x8<S> {
    let mut difference = f64x8::splat(simd, 0.0);
    for (offset, factor) in WIDE {
        difference += (sum.load(simd, i, offset) - sum.load(simd, i, -offset)) * factor;
    }
    difference
}

/// `value` where `weight` is above zero, else zero.
#[inline(always)]
pub(super) fn open<S: Simd>(simd: S, weight: f64x8<S>, value: f64x8<S>) -> f64x8<S> {
    let zero = f64x8::splat(simd, 0.0);
    simd.select_f64x8(simd.simd_gt_f64x8(weight, zero), value, zero)
}
