//! Rows of the grid and what lies beside them, eight cells at a time.

use fearless_simd::{Simd, SimdBase, f32x8, f64x8};

use crate::grid::{Faces, Grid};

/// Cells that are treated side by side; fixed, so that results do not depend on the machine.
pub(super) const N_LANES: usize = 8;

/// A number that fields are stored in: `f64`, or `f32` to halve the memory traffic.
pub trait Stored: Copy + Send + Sync + Into<f64> + 'static {
    /// Rounds to this type.
    fn narrow(x: f64) -> Self;

    /// Eight successive numbers.
    fn load<S: Simd>(simd: S, from: &[Self]) -> f64x8<S>;

    /// Rounds to eight successive numbers.
    fn store<S: Simd>(values: f64x8<S>, to: &mut [Self]);

    /// Numbers of either type, for what is compiled once for both.
    fn either(values: &[Self]) -> Either<'_>;
}

/// Stored numbers whose type is known when they are read.
#[derive(Debug, Clone, Copy)]
pub enum Either<'a> {
    /// 8 bytes each.
    Double(&'a [f64]),
    /// 4 bytes each.
    Single(&'a [f32]),
}

impl Either<'_> {
    pub(super) fn len(self) -> usize {
        match self {
            Self::Double(values) => values.len(),
            Self::Single(values) => values.len(),
        }
    }
}

impl Stored for f64 {
    #[inline(always)]
    fn narrow(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn load<S: Simd>(simd: S, from: &[Self]) -> f64x8<S> {
        f64x8::from_slice(simd, from)
    }

    #[inline(always)]
    fn store<S: Simd>(values: f64x8<S>, to: &mut [Self]) {
        values.store_slice(to);
    }

    fn either(values: &[Self]) -> Either<'_> {
        Either::Double(values)
    }
}

impl Stored for f32 {
    #[inline(always)]
    fn narrow(x: f64) -> Self {
        x as f32
    }

    #[inline(always)]
    fn load<S: Simd>(simd: S, from: &[Self]) -> f64x8<S> {
        let (low, high) = simd.widen_f32x8(f32x8::from_slice(simd, from));
        simd.combine_f64x4(low, high)
    }

    #[inline(always)]
    fn store<S: Simd>(values: f64x8<S>, to: &mut [Self]) {
        for (x, value) in to.iter_mut().zip(values.to_array()) {
            *x = value as f32;
        }
    }

    fn either(values: &[Self]) -> Either<'_> {
        Either::Single(values)
    }
}

/// A row along x: where it starts, and what turns its values into those of a ghost beyond a wall.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub start: usize,
    /// `[factor, shift]` of a row that is reflected by a wall.
    pub mirror: Option<[f64; 2]>,
}

/// What lies beyond the two ends of a row.
#[derive(Debug, Clone, Copy)]
pub(super) enum Ends {
    /// The other end.
    Wrap,
    /// The reflected cell, times the factor plus the lower or upper shift.
    Mirror { factor: f64, shifts: [f64; 2] },
}

/// The grid as the flow terms see it, with the velocities of its walls.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stencil {
    pub cells: [usize; 3],
    pub faces: [Faces; 3],
    pub spacing: f64,
    wall_velocity: [[[f64; 3]; 2]; 3],
}

impl Stencil {
    pub fn new(grid: &Grid, wall_velocity: [[[f64; 3]; 2]; 3]) -> Self {
        Self {
            cells: grid.cells(),
            faces: grid.faces(),
            spacing: grid.spacing(),
            wall_velocity,
        }
    }

    /// The values of `field` in `row`.
    #[inline(always)]
    pub fn values<'a, T>(&self, field: &'a [T], row: Row) -> &'a [T] {
        &field[row.start..row.start + self.cells[0]]
    }

    /// Cells of a plane.
    pub fn plane(&self) -> usize {
        self.cells[0] * self.cells[1]
    }

    /// Row (j, k).
    pub fn row(&self, [j, k]: [usize; 2]) -> Row {
        Row {
            start: (k * self.cells[1] + j) * self.cells[0],
            mirror: None,
        }
    }

    /// The next (or previous) place along `axis` (1 or 2), around the box; with walls, the faces there carry no velocity.
    pub fn step(&self, axis: usize, mut jk: [usize; 2], up: bool) -> [usize; 2] {
        let n = self.cells[axis];
        let at = &mut jk[axis - 1];
        *at = if up { (*at + 1) % n } else { (*at + n - 1) % n };
        jk
    }

    /// The cell along `axis` that represents place `at`: around the box, or as a wall reflects it.
    pub fn image(&self, axis: usize, at: isize) -> usize {
        let n = self.cells[axis] as isize;
        let place = match self.faces[axis] {
            Faces::Periodic => at.rem_euclid(n),
            Faces::Wall if at < 0 => -1 - at,
            Faces::Wall if at >= n => 2 * n - 1 - at,
            Faces::Wall => at,
        };
        place.clamp(0, n - 1) as usize
    }

    /// The row of tangential velocities of `component` `offset` rows from (j, k) along `axis`, reflected by a wall.
    #[inline(always)]
    pub fn beside(&self, axis: usize, mut jk: [usize; 2], offset: isize, component: usize) -> Row {
        let at = jk[axis - 1] as isize + offset;
        jk[axis - 1] = self.image(axis, at);
        let beyond = at < 0 || at >= self.cells[axis] as isize;
        let wall = self.wall_velocity[axis][usize::from(at >= 0)][component];
        Row {
            mirror: (beyond && self.faces[axis] == Faces::Wall).then_some([-1.0, 2.0 * wall]),
            ..self.row(jk)
        }
    }

    /// What lies beyond the ends of a row of velocities of `component` (y or z).
    pub fn velocity_ends(&self, component: usize) -> Ends {
        match self.faces[0] {
            Faces::Periodic => Ends::Wrap,
            Faces::Wall => Ends::Mirror {
                factor: -1.0,
                shifts: self.wall_velocity[0].map(|wall| 2.0 * wall[component]),
            },
        }
    }
}

/// Differences across a cell that span more than it, of order four: offsets and factors, over twice the spacing.
pub(super) const WIDE: [(isize, f64); 2] = [(1, 4.0 / 3.0), (2, -1.0 / 6.0)];

/// Values more on either end of a part of a row: as far as [`WIDE`] reaches.
pub(super) const MARGIN: usize = 2;

/// Part of a row with a margin on either end.
pub(super) struct Segment([f64; TILE + N_LANES]);

/// Cells along x that are treated in one go: what they need fits in the first cache, on the stack.
pub(super) const TILE: usize = 64;

impl Segment {
    #[inline(always)]
    pub const fn zero() -> Self {
        Self([0.0; TILE + N_LANES])
    }

    /// The values of one row from `start` on.
    #[inline(always)]
    pub fn of<T: Stored>(row: &[T], start: usize, ends: Ends) -> Self {
        let mut segment = Self::zero();
        segment.add(row, None, start, ends, 1.0);
        segment
    }

    /// Adds `factor` times a row, reflected by `mirror`.
    #[inline(always)]
    pub fn add<T: Stored>(
        &mut self,
        row: &[T],
        mirror: Option<[f64; 2]>,
        start: usize,
        ends: Ends,
        factor: f64,
    ) {
        let [slope, shift] = mirror.map_or([factor, 0.0], |m| m.map(|m| factor * m));
        let end = row.len().min(start + TILE);
        let n = end - start;
        let within = &mut self.0[MARGIN..MARGIN + n];
        for (x, value) in within.iter_mut().zip(&row[start..end]) {
            let value: f64 = (*value).into();
            *x += slope * value + shift;
        }
        for m in 1..=MARGIN {
            self.0[MARGIN - m] += slope * beyond(row, start as isize - m as isize, ends) + shift;
            self.0[MARGIN + n + m - 1] += slope * beyond(row, (end + m) as isize - 1, ends) + shift;
        }
    }

    /// The values of the eight cells from `i` + `offset` on, the first of the segment being 0.
    #[inline(always)]
    pub fn load<S: Simd>(&self, simd: S, i: usize, offset: isize) -> f64x8<S> {
        self.load_place(simd, i.wrapping_add_signed(MARGIN as isize + offset))
    }

    /// The eight values from place `at` on, margin included.
    #[inline(always)]
    pub fn load_place<S: Simd>(&self, simd: S, at: usize) -> f64x8<S> {
        f64x8::from_slice(simd, &self.0[at..at + N_LANES])
    }

    /// Writes eight values from place `at` on, margin included.
    #[inline(always)]
    pub fn store_place<S: Simd>(&mut self, values: f64x8<S>, at: usize) {
        values.store_slice(&mut self.0[at..at + N_LANES]);
    }
}

/// One value of a row or beyond its ends.
#[inline(always)]
fn beyond<T: Stored>(row: &[T], at: isize, ends: Ends) -> f64 {
    let n = row.len();
    if let Some(value) = usize::try_from(at).ok().and_then(|at| row.get(at)) {
        return (*value).into();
    }
    let upper = at > 0;
    match ends {
        Ends::Wrap => row[at.rem_euclid(n as isize) as usize].into(),
        Ends::Mirror { factor, shifts } => {
            let image = if upper {
                2 * n as isize - 1 - at
            } else {
                -1 - at
            };
            let end: f64 = row[image.clamp(0, n as isize - 1) as usize].into();
            factor * end + shifts[usize::from(upper)]
        }
    }
}

/// The eight values of a row from place `at` on; zero beyond its end.
#[inline(always)]
pub(super) fn load<S: Simd, T: Stored>(simd: S, row: &[T], at: usize) -> f64x8<S> {
    match row.get(at..at + N_LANES) {
        Some(within) => T::load(simd, within),
        None => f64x8::load_array(simd, tail(row, at)),
    }
}

#[cold]
#[inline(never)]
fn tail<T: Stored>(row: &[T], at: usize) -> [f64; N_LANES] {
    let mut values = [0.0; N_LANES];
    for (value, x) in values.iter_mut().zip(&row[at..]) {
        *value = (*x).into();
    }
    values
}

/// Writes the values that lie within a row from place `at` on.
#[inline(always)]
pub(super) fn store<S: Simd, T: Stored>(values: f64x8<S>, row: &mut [T], at: usize) {
    match row.get_mut(at..at + N_LANES) {
        Some(within) => T::store(values, within),
        None => {
            for (x, value) in row[at..].iter_mut().zip(values.to_array()) {
                *x = T::narrow(value);
            }
        }
    }
}
