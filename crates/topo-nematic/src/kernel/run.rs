//! Passes over the whole domain, plane by plane, by one thread or by all, with the same bits.

use fearless_simd::{Level, Simd};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::domain::{Domain, SpecialCell, Wall, face_index};
use crate::kernel::combine::{Combine, Factors};
use crate::kernel::second::SecondElastic;
use crate::kernel::{Coefficients, Stretch, five, pass};
use crate::material::Material;
use crate::real::{Lanes, One, Real, Wide};
use crate::tensor::{Tensor5, contract};
use crate::vector::dispatch;

/// How many threads share one field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Threads {
    /// One: best when many cases run side by side.
    #[default]
    One,
    /// All of the current pool, a plane of cells at a time; results are the same to the bit.
    All,
}

/// Sums of H:H (forces scaled for relaxation), H:X, X:X and of mass times H:H.
pub(crate) type Sums = [f64; 4];

/// What is done to a plane of cells: its number, its part of the output by components, scratch memory.
type PlaneWork<'a, T> = dyn Fn(usize, [&mut [T]; 5], &mut Vec<T>) -> Sums + Sync + 'a;

/// The molecular field of one domain in one precision.
#[derive(Debug, Clone)]
pub(crate) struct Kernel<T> {
    pub domain: Domain,
    material: Material,
    field: Tensor5,
    coefficients: Coefficients<T>,
    pub threads: Threads,
    level: Level,
    /// Numbers from one component to the next.
    pub stride: usize,
    /// Present only when there is a second elastic constant.
    pub second: Option<SecondElastic>,
}

/// What a pass writes, and from what.
pub(crate) struct Combination<'a, T, const INPUTS: usize> {
    pub on_q: f64,
    pub on_old: f64,
    pub on_field: f64,
    pub inputs: [(f64, &'a [T]); INPUTS],
    /// Scale forces of special cells so that they are no stiffer than others.
    pub relaxing: bool,
}

impl<T: Real> Kernel<T> {
    pub(crate) fn new(
        domain: Domain,
        material: &Material,
        field: Tensor5,
        threads: Threads,
    ) -> Self {
        let coefficients = Coefficients::new(material, domain.grid.spacing(), &field);
        let stride = component_stride(domain.grid.n_cells(), size_of::<T>());
        let second = material
            .second_elastic_constant
            .filter(|constant| *constant != 0.0)
            .map(|constant| SecondElastic::new(&domain, constant, stride));
        Self {
            domain,
            material: *material,
            field,
            coefficients,
            threads,
            level: Level::new(),
            stride,
            second,
        }
    }

    /// The kernel of small changes of a field in equilibrium, elastic terms only: linear, and zero on all surfaces.
    pub(crate) fn elastic_part(&self) -> Self {
        let mut part = self.clone();
        for wall in part.domain.walls.iter_mut().flatten().flatten() {
            wall.values = vec![[0.0; 5]];
        }
        for special in &mut part.domain.special {
            (special.source, special.offset) = ([0.0; 5], 0.0);
        }
        part.material = Material {
            a: 0.0,
            b: 0.0,
            c: 0.0,
            ..self.material
        };
        part.field = [0.0; 5];
        part.coefficients =
            Coefficients::new(&part.material, part.domain.grid.spacing(), &part.field);
        part
    }

    /// The same kernel on arrays without gaps between components, as the flow reads them.
    pub(crate) fn without_gaps(mut self) -> Self {
        self.stride = self.domain.grid.n_cells();
        self
    }

    /// Bytes of lists and values, those of the second elastic constant left out.
    pub(crate) fn n_bytes(&self) -> u64 {
        self.domain.n_bytes()
    }

    /// Length of the arrays that passes read and write.
    pub(crate) fn array_length(&self) -> usize {
        5 * self.stride
    }

    /// Copies a field of five components without gaps to an array with this kernel's stride.
    pub(crate) fn spread(&self, flat: &[f64], to: &mut [T]) {
        let n = self.domain.grid.n_cells();
        for c in 0..5 {
            let to = &mut to[c * self.stride..c * self.stride + n];
            for (x, y) in to.iter_mut().zip(&flat[c * n..(c + 1) * n]) {
                *x = T::of(*y);
            }
        }
    }

    /// The converse of [`spread`](Self::spread).
    pub(crate) fn gather(&self, from: &[T], flat: &mut [f64]) {
        let n = self.domain.grid.n_cells();
        for c in 0..5 {
            let from = &from[c * self.stride..c * self.stride + n];
            for (y, x) in flat[c * n..(c + 1) * n].iter_mut().zip(from) {
                *y = (*x).into();
            }
        }
    }

    /// The five components of an array, without gaps.
    fn components_mut<'a>(&self, array: &'a mut [T]) -> [&'a mut [T]; 5] {
        let (n, stride) = (self.domain.grid.n_cells(), self.stride);
        let (a, rest) = array.split_at_mut(stride);
        let (b, rest) = rest.split_at_mut(stride);
        let (c, rest) = rest.split_at_mut(stride);
        let (d, e) = rest.split_at_mut(stride);
        [a, b, c, d, e].map(|component| &mut component[..n])
    }

    pub(crate) fn material(&self) -> &Material {
        &self.material
    }

    pub(crate) fn field(&self) -> &Tensor5 {
        &self.field
    }

    /// Writes the molecular field of `q` to `h`, 0 where there is no field.
    pub(crate) fn molecular_field(&self, q: &[T], h: &mut [T]) {
        h.fill(T::of(0.0));
        let what = Combination {
            on_q: 0.0,
            on_old: 0.0,
            on_field: 1.0,
            inputs: [],
            relaxing: false,
        };
        self.combine::<false, 0, false>(q, &what, h);
        self.add_second(q, 1.0, h);
    }

    /// Bytes of the lists of the second elastic constant.
    pub(crate) fn n_second_bytes(&self) -> u64 {
        self.second.as_ref().map_or(0, SecondElastic::n_bytes)
    }

    /// Passes that the second elastic constant took so far.
    pub(crate) fn n_second_passes(&self) -> u64 {
        self.second.as_ref().map_or(0, SecondElastic::n_passes)
    }

    /// Energy of the second elastic constant.
    pub(crate) fn second_energy(&self, q: &[T]) -> f64 {
        self.second.as_ref().map_or(0.0, |second| second.energy(q))
    }

    /// Adds `factor` times the molecular field of the second elastic constant to `out`.
    pub(crate) fn add_second(&self, q: &[T], factor: f64, out: &mut [T]) {
        if let Some(second) = &self.second {
            second.add_field(q, factor, out);
        }
    }

    /// Sums of the field in `h` and of `x` over the fluid, as the fused pass would have made them.
    pub(crate) fn sums_of(&self, h: &[T], x: &[T]) -> Sums {
        let mut sums = [0.0; 4];
        let at = |a: &[T], cell: usize| -> Tensor5 {
            std::array::from_fn(|c| a[c * self.stride + cell].into())
        };
        let mut add = |cell: usize, mass: f64| {
            let (h, x) = (at(h, cell), at(x, cell));
            let square = contract(&h, &h);
            sums[0] += square;
            sums[1] += contract(&h, &x);
            sums[2] += contract(&x, &x);
            sums[3] += mass * square;
        };
        for run in &self.domain.runs {
            (run.start..run.start + run.length).for_each(|cell| add(cell as usize, 1.0));
        }
        for special in &self.domain.special {
            add(special.cell as usize, special.mass);
        }
        sums
    }

    /// Writes the combination of `q`, its molecular field, `out` itself (if `OLD`) and the inputs to `out`; cells that are not
    /// active stay as they are. With `SUMS` the inputs only enter the sums.
    pub(crate) fn combine<const OLD: bool, const INPUTS: usize, const SUMS: bool>(
        &self,
        q: &[T],
        what: &Combination<'_, T, INPUTS>,
        out: &mut [T],
    ) -> Sums {
        let n = self.stride;
        debug_assert!(q.len() == 5 * n && out.len() == 5 * n);
        self.by_planes(out, &|k, mut out, scratch| {
            let runs = dispatch!(self.level, simd => self.runs::<_, OLD, INPUTS, SUMS>(simd, k, q, what, &mut out, scratch));
            self.special_cells::<OLD, INPUTS, SUMS>(runs, k, q, what, out)
        })
    }

    /// Calls `work` with each plane of cells, its part of `out` and scratch memory; the sums are the same for any number of threads.
    pub(crate) fn by_planes(&self, out: &mut [T], work: &PlaneWork<'_, T>) -> Sums {
        let [nx, ny, nz] = self.domain.grid.cells();
        let plane = nx * ny;
        let [a, b, c, d, e] = self.components_mut(out);
        let mut sums = vec![[0.0; 4]; nz];
        let work = |(k, (sum, out)): (usize, (&mut Sums, [&mut [T]; 5])), scratch: &mut Vec<T>| {
            *sum = work(k, out, scratch);
        };
        match self.threads {
            Threads::One => {
                let mut scratch = Vec::new();
                let chunks = a
                    .chunks_mut(plane)
                    .zip(b.chunks_mut(plane))
                    .zip(c.chunks_mut(plane).zip(d.chunks_mut(plane)))
                    .zip(e.chunks_mut(plane))
                    .map(|(((a, b), (c, d)), e)| [a, b, c, d, e]);
                for item in sums.iter_mut().zip(chunks).enumerate() {
                    work(item, &mut scratch);
                }
            }
            Threads::All => {
                let chunks = a
                    .par_chunks_mut(plane)
                    .zip(b.par_chunks_mut(plane))
                    .zip(c.par_chunks_mut(plane).zip(d.par_chunks_mut(plane)))
                    .zip(e.par_chunks_mut(plane))
                    .map(|(((a, b), (c, d)), e)| [a, b, c, d, e]);
                sums.par_iter_mut()
                    .zip(chunks)
                    .enumerate()
                    .for_each_init(Vec::new, |scratch, item| work(item, scratch));
            }
        }
        // In the order of planes, whoever worked on them.
        sums.iter().fold([0.0; 4], |mut total, s| {
            total.iter_mut().zip(s).for_each(|(t, x)| *t += x);
            total
        })
    }

    #[inline(always)]
    fn runs<S: Simd, const OLD: bool, const INPUTS: usize, const SUMS: bool>(
        &self,
        simd: S,
        k: usize,
        q: &[T],
        what: &Combination<'_, T, INPUTS>,
        out: &mut [&mut [T]; 5],
        scratch: &mut Vec<T>,
    ) -> Sums {
        let [nx, ny, _] = self.domain.grid.cells();
        let first = k * nx * ny;
        let mut sums = [0.0; 4];
        for run in self.domain.runs_of(k) {
            let (start, length) = (run.start as usize, run.length as usize);
            let j = (start - first) / nx;
            let at = Place {
                start,
                length,
                local: start - first,
            };
            let ends = self.ends(q, &at, [j, k]);
            let stretch = if self.is_inner([j, k]) {
                Stretch {
                    field: self.components(q),
                    start,
                    length,
                    sides: self.neighbour_rows(start, [j, k]),
                    ends,
                }
            } else {
                self.copied(q, &at, [j, k], ends, scratch)
            };
            let part =
                self.run_passes::<_, OLD, INPUTS, SUMS>(simd, &at, &stretch, what, &mut *out);
            sums.iter_mut().zip(part).for_each(|(s, x)| *s += x);
            sums[3] += part[0];
        }
        sums
    }

    /// A run next to walls, copied with its neighbours and what lies beyond the walls: few runs are, and kernels need not be
    /// compiled for them.
    #[inline(never)]
    fn copied<'a>(
        &self,
        q: &[T],
        at: &Place,
        jk: [usize; 2],
        ends: [[T; 5]; 2],
        scratch: &'a mut Vec<T>,
    ) -> Stretch<'a, T> {
        let nx = self.domain.grid.cells()[0];
        scratch.resize(45 * nx, T::of(0.0));
        let (ghosts, copies) = scratch.split_at_mut(20 * nx);
        self.write_ghosts(q, at.start, at.length, jk, ghosts);
        let sides = self.side_rows(q, at.start, at.length, jk, ghosts);
        let mut rest = copies;
        let field = std::array::from_fn(|c| {
            let (component, after) = std::mem::take(&mut rest).split_at_mut(5 * nx);
            rest = after;
            let own = &q[c * self.stride + at.start..][..at.length];
            let rows = [own, sides[0][c], sides[1][c], sides[2][c], sides[3][c]];
            for (to, row) in component.chunks_exact_mut(nx).zip(rows) {
                to[..at.length].copy_from_slice(row);
            }
            &*component
        });
        Stretch {
            field,
            start: 0,
            length: at.length,
            sides: [nx, 2 * nx, 3 * nx, 4 * nx],
            ends,
        }
    }

    /// The same combination in the cells whose links or volumes are not whole, in double precision; adds to `sums`.
    #[inline(never)]
    fn special_cells<const OLD: bool, const INPUTS: usize, const SUMS: bool>(
        &self,
        mut sums: Sums,
        k: usize,
        q: &[T],
        what: &Combination<'_, T, INPUTS>,
        out: [&mut [T]; 5],
    ) -> Sums {
        let [nx, ny, _] = self.domain.grid.cells();
        let (n, first) = (self.stride, k * nx * ny);
        for special in self.domain.special_of(k) {
            let cell = special.cell as usize;
            let value = |x: &[T]| -> Tensor5 { five(|c| x[c * n + cell].into()) };
            let here = value(q);
            let mut h = self.special_field(q, special, &here);
            if SUMS {
                sums[3] += special.mass * contract(&h, &h);
            }
            if what.relaxing {
                let scale = special.mass / special.relaxation_mass();
                h = h.map(|x| x * scale);
            }
            let inputs = what.inputs.map(|(factor, x)| (factor, value(x)));
            if SUMS {
                let x = inputs[0].1;
                sums[0] += contract(&h, &h);
                sums[1] += contract(&h, &x);
                sums[2] += contract(&x, &x);
            }
            for c in 0..5 {
                let to = &mut out[c][cell - first];
                let mut sum = what.on_field * h[c] + what.on_q * here[c];
                if OLD {
                    sum += what.on_old * (*to).into();
                }
                if !SUMS {
                    sum += inputs.iter().map(|(f, x)| f * x[c]).sum::<f64>();
                }
                *to = T::of(sum);
            }
        }
        sums
    }

    /// Molecular field of a special cell, in double precision.
    pub(crate) fn special_field(&self, q: &[T], special: &SpecialCell, here: &Tensor5) -> Tensor5 {
        let n = self.stride;
        let h = self.domain.grid.spacing();
        let link = self.material.elastic_constant / (h * h);
        let bulk = self.material.bulk_field(here);
        five(
            #[inline(always)]
            |c| {
                let row = &q[c * n..(c + 1) * n];
                let mut flux = special.source[c] - special.sink * here[c];
                for (w, other) in special.weights.iter().zip(special.neighbours) {
                    let there: f64 = row[other as usize].into();
                    flux += w * (there - here[c]);
                }
                (link * flux + special.volume * (bulk[c] + self.field[c])) / special.mass
            },
        )
    }

    pub(crate) fn level(&self) -> Level {
        self.level
    }

    fn wall(&self, axis: usize, up: bool) -> Option<&Wall> {
        self.domain.walls[axis][usize::from(up)].as_ref()
    }

    /// Which of the sides -y, +y, -z, +z of a row lie beyond a wall.
    pub(crate) fn beyond(&self, [j, k]: [usize; 2]) -> [Option<&Wall>; 4] {
        let [_, ny, nz] = self.domain.grid.cells();
        let at = |is: bool, axis, up| if is { self.wall(axis, up) } else { None };
        [
            at(j == 0, 1, false),
            at(j + 1 == ny, 1, true),
            at(k == 0, 2, false),
            at(k + 1 == nz, 2, true),
        ]
    }

    /// Conductances of the walls beyond the first and the last cell of a run.
    pub(crate) fn end_walls(&self, start: usize, length: usize) -> [Option<f64>; 2] {
        let nx = self.domain.grid.cells()[0];
        let i = start % nx;
        [(i == 0, false), (i + length == nx, true)]
            .map(|(at_edge, up)| self.wall(0, up).filter(|_| at_edge).map(|w| w.conductance))
    }

    /// Writes the values beyond walls along the row: Q + conductance (Q_wall - Q).
    pub(crate) fn write_ghosts(
        &self,
        q: &[T],
        start: usize,
        length: usize,
        jk: [usize; 2],
        ghosts: &mut [T],
    ) {
        let n = self.stride;
        let nx = self.domain.grid.cells()[0];
        for (side, wall) in self.beyond(jk).into_iter().enumerate() {
            let Some(wall) = wall else { continue };
            let face = face_index(&self.domain.grid, [start % nx, jk[0], jk[1]], 1 + side / 2);
            let conductance = T::of(wall.conductance);
            for c in 0..5 {
                let row = &q[c * n + start..c * n + start + length];
                let ghost = &mut ghosts[(side * 5 + c) * nx..(side * 5 + c) * nx + length];
                for (i, (g, x)) in ghost.iter_mut().zip(row).enumerate() {
                    *g = *x + conductance * (T::of(wall.value(face + i)[c]) - *x);
                }
            }
        }
    }

    /// Whether no side of a row lies beyond a wall.
    pub(crate) fn is_inner(&self, jk: [usize; 2]) -> bool {
        self.beyond(jk).iter().all(Option::is_none)
    }

    /// The first neighbours of a run at -y, +y, -z, +z, as if there were no walls.
    pub(crate) fn neighbour_rows(&self, start: usize, [j, k]: [usize; 2]) -> [usize; 4] {
        let [nx, ny, nz] = self.domain.grid.cells();
        let plane = nx * ny;
        let step = |x: usize, n: usize, stride: usize| {
            [
                if x > 0 {
                    start - stride
                } else {
                    start + (n - 1) * stride
                },
                if x + 1 < n {
                    start + stride
                } else {
                    start - (n - 1) * stride
                },
            ]
        };
        let ([below, above], [back, front]) = (step(j, ny, nx), step(k, nz, plane));
        [below, above, back, front]
    }

    /// The neighbours of a run at -y, +y, -z, +z, from the field or from `ghosts` beyond walls.
    pub(crate) fn side_rows<'a>(
        &self,
        q: &'a [T],
        start: usize,
        length: usize,
        jk: [usize; 2],
        ghosts: &'a [T],
    ) -> [[&'a [T]; 5]; 4] {
        let nx = self.domain.grid.cells()[0];
        let rows = self.neighbour_rows(start, jk);
        let beyond = self.beyond(jk);
        std::array::from_fn(|s| {
            std::array::from_fn(|c| {
                let (from, array) = match beyond[s] {
                    None => (c * self.stride + rows[s], q),
                    Some(_) => ((s * 5 + c) * nx, ghosts),
                };
                &array[from..from + length]
            })
        })
    }

    /// The neighbour of the first cell of a run at -x and of its last at +x.
    #[inline(always)]
    pub(crate) fn ends(&self, q: &[T], at: &Place, [j, k]: [usize; 2]) -> [[T; 5]; 2] {
        let [nx, ny, _] = self.domain.grid.cells();
        let i = at.start % nx;
        let last = at.start + at.length - 1;
        let mut ends = [[T::of(0.0); 5]; 2];
        for (up, end) in ends.iter_mut().enumerate() {
            let (cell, at_edge) = [(at.start, i == 0), (last, i + at.length == nx)][up];
            let other = match (up, at_edge) {
                (1, false) => cell + 1,
                (_, false) => cell - 1,
                (1, true) => cell + 1 - nx,
                (_, true) => cell + nx - 1,
            };
            let wall = if at_edge { self.wall(0, up == 1) } else { None };
            for c in 0..5 {
                end[c] = match wall {
                    None => q[c * self.stride + other],
                    Some(wall) => {
                        let x = q[c * self.stride + cell];
                        x + T::of(wall.conductance) * (T::of(wall.value(k * ny + j)[c]) - x)
                    }
                };
            }
        }
        ends
    }

    /// Components of an array, without gaps.
    #[inline(always)]
    pub(crate) fn components<'a>(&self, array: &'a [T]) -> [&'a [T]; 5] {
        let (n, s) = (self.domain.grid.n_cells(), self.stride);
        [
            &array[..n],
            &array[s..s + n],
            &array[2 * s..2 * s + n],
            &array[3 * s..3 * s + n],
            &array[4 * s..4 * s + n],
        ]
    }

    /// One run, by vectors if it is long enough for one.
    #[inline(always)]
    fn run_passes<S: Simd, const OLD: bool, const INPUTS: usize, const SUMS: bool>(
        &self,
        simd: S,
        at: &Place,
        stretch: &Stretch<'_, T>,
        what: &Combination<'_, T, INPUTS>,
        out: &mut [&mut [T]; 5],
    ) -> Sums {
        let mut inputs = [[&[][..]; 5]; INPUTS];
        for k in 0..INPUTS {
            inputs[k] = self.components(what.inputs[k].1);
        }
        let [a, b, c, d, e] = out;
        let out = [&mut **a, &mut **b, &mut **c, &mut **d, &mut **e];
        if at.length >= <Wide<S, T> as Lanes>::N {
            run_pass::<Wide<S, T>, OLD, INPUTS, SUMS>(
                simd,
                stretch,
                &self.coefficients,
                what,
                inputs,
                out,
                at,
            )
        } else {
            short_pass::<T, OLD, INPUTS, SUMS>(stretch, &self.coefficients, what, inputs, out, at)
        }
    }
}

/// Where a run lies: its first cell, its length, its place in the plane.
pub(crate) struct Place {
    pub start: usize,
    pub length: usize,
    pub local: usize,
}

/// Distance of components such that their lines do not fall on the same few sets of a cache whose ways span 4 KiB.
fn component_stride(n_cells: usize, n_bytes: usize) -> usize {
    const WAY: usize = 4096;
    const APART: usize = 384;
    let falls_apart = |stride: &usize| {
        let places = [0, 1, 2, 3, 4].map(|c| c * stride * n_bytes % WAY);
        (1..5).all(|a| {
            (0..a).all(|b| {
                let d = places[a].abs_diff(places[b]);
                d.min(WAY - d) >= APART
            })
        })
    };
    (n_cells..n_cells + WAY)
        .find(falls_apart)
        .unwrap_or(n_cells)
}

/// A run that is shorter than a vector, cell by cell; compiled once, not for each instruction set.
#[inline(never)]
fn short_pass<T: Real, const OLD: bool, const INPUTS: usize, const SUMS: bool>(
    stretch: &Stretch<'_, T>,
    k: &Coefficients<T>,
    what: &Combination<'_, T, INPUTS>,
    inputs: [[&[T]; 5]; INPUTS],
    out: [&mut [T]; 5],
    at: &Place,
) -> Sums {
    run_pass::<One<T>, OLD, INPUTS, SUMS>((), stretch, k, what, inputs, out, at)
}

#[inline(always)]
fn run_pass<L: Lanes, const OLD: bool, const INPUTS: usize, const SUMS: bool>(
    token: L::Token,
    stretch: &Stretch<'_, L::Scalar>,
    k: &Coefficients<L::Scalar>,
    what: &Combination<'_, L::Scalar, INPUTS>,
    inputs: [[&[L::Scalar]; 5]; INPUTS],
    out: [&mut [L::Scalar]; 5],
    at: &Place,
) -> Sums {
    let zero = L::splat(token, L::Scalar::of(0.0));
    let mut on_inputs = [zero; 2];
    for (to, (factor, _)) in on_inputs.iter_mut().zip(&what.inputs) {
        *to = L::splat(token, L::Scalar::of(*factor));
    }
    let mut combine = Combine::<L, OLD, INPUTS, SUMS> {
        factors: Factors {
            on_q: L::splat(token, L::Scalar::of(what.on_q)),
            on_old: L::splat(token, L::Scalar::of(what.on_old)),
            on_field: L::splat(token, L::Scalar::of(what.on_field)),
            on_inputs,
        },
        out,
        out_start: at.local,
        start: at.start,
        inputs,
        kept: [zero; 5],
        sums: [zero; 3],
    };
    pass(token, stretch, k, &mut combine);
    let mut sums = [0.0; 4];
    if SUMS {
        let mut lanes = [L::Scalar::of(0.0); 16];
        for (sum, total) in sums.iter_mut().zip(combine.sums) {
            total.store(&mut lanes);
            *sum = lanes[..L::N].iter().map(|x| (*x).into()).sum();
        }
    }
    sums
}
