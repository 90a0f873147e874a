//! Rows of the grid and what lies beside them, eight cells at a time.

use fearless_simd::{Simd, SimdBase, f64x8};

use crate::grid::{Faces, Grid};

/// Cells that are treated side by side; fixed, so that results do not depend on the machine.
pub(super) const N_LANES: usize = 8;

/// A number that fields are stored in: `f64`, or `f32` to halve the memory traffic.
pub trait Stored: Copy + Send + Sync + Into<f64> + 'static {
    /// Rounds to this type.
    fn narrow(x: f64) -> Self;
}

impl Stored for f64 {
    fn narrow(x: f64) -> Self {
        x
    }
}

impl Stored for f32 {
    fn narrow(x: f64) -> Self {
        x as f32
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
    /// The end itself, times the factor plus the lower or upper shift.
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

    /// The row of tangential velocities of `component` beside (j, k) along `axis`, reflected by a wall.
    #[inline(always)]
    pub fn beside(&self, axis: usize, jk: [usize; 2], up: bool, component: usize) -> Row {
        let edge = if up { self.cells[axis] - 1 } else { 0 };
        if self.faces[axis] == Faces::Wall && jk[axis - 1] == edge {
            let wall = self.wall_velocity[axis][usize::from(up)][component];
            return Row {
                mirror: Some([-1.0, 2.0 * wall]),
                ..self.row(jk)
            };
        }
        self.row(self.step(axis, jk, up))
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

    /// What lies beyond the ends of a row of cell values that a wall reflects.
    pub fn cell_ends(&self) -> Ends {
        match self.faces[0] {
            Faces::Periodic => Ends::Wrap,
            Faces::Wall => Ends::Mirror {
                factor: 1.0,
                shifts: [0.0; 2],
            },
        }
    }
}

/// Eight values from place `at` of a row of n; beyond its ends as `ends` says, and anything from place n + 1 on.
#[inline(always)]
pub(super) fn load<S: Simd, T: Stored>(simd: S, row: &[T], at: isize, ends: Ends) -> f64x8<S> {
    let n = row.len() as isize;
    let mut values = [0.0; N_LANES];
    if at >= 0 && at + N_LANES as isize <= n {
        let from = &row[at as usize..at as usize + N_LANES];
        for l in 0..N_LANES {
            values[l] = from[l].into();
        }
    } else {
        for (l, value) in values.iter_mut().enumerate() {
            *value = beyond(row, at + l as isize, ends);
        }
    }
    f64x8::load_array(simd, values)
}

/// One value of a row or beyond its ends.
#[inline(never)]
fn beyond<T: Stored>(row: &[T], at: isize, ends: Ends) -> f64 {
    let n = row.len() as isize;
    if (0..n).contains(&at) {
        return row[at as usize].into();
    }
    match ends {
        Ends::Wrap => row[at.rem_euclid(n) as usize].into(),
        Ends::Mirror { factor, shifts } => {
            let upper = at >= n;
            let end: f64 = row[if upper { n as usize - 1 } else { 0 }].into();
            factor * end + shifts[usize::from(upper)]
        }
    }
}

/// Eight values of the row `at` of `field`, reflected if the row is.
#[inline(always)]
pub(super) fn load_row<S: Simd, T: Stored>(
    simd: S,
    field: &[T],
    row: Row,
    n: usize,
    at: isize,
    ends: Ends,
) -> f64x8<S> {
    let values = load(simd, &field[row.start..row.start + n], at, ends);
    match row.mirror {
        None => values,
        Some([factor, shift]) => values * factor + shift,
    }
}

/// Writes the values that lie within a row from place `at` on.
#[inline(always)]
pub(super) fn store<S: Simd, T: Stored>(values: f64x8<S>, row: &mut [T], at: usize) {
    let values = values.to_array();
    let n = N_LANES.min(row.len() - at);
    if n == N_LANES {
        for l in 0..N_LANES {
            row[at + l] = T::narrow(values[l]);
        }
    } else {
        for (x, value) in row[at..].iter_mut().zip(values) {
            *x = T::narrow(value);
        }
    }
}
