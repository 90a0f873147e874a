//! Flow between periodic sides: Fourier modes along x and y, a direct solve along z.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use fearless_simd::{Level, Simd};
use rayon::prelude::*;

use crate::grid::{Faces, Grid};
use crate::stokes::{FaceSites, MacField, StokesError, StokesSolver};
use crate::vector::dispatch;
use topo_fourier::{Complex64, LineFft, PlaneFft, PlaneScratch};

use self::lanes::Lines;
use self::planes::{Planes, lock};
use self::symbol::Symbol;

mod lanes;
mod periodic;
mod planes;
mod plates;
mod symbol;

/// Direct Stokes solver for periodic x and y; z is periodic or has walls.
///
/// A mode (k_x, k_y) decouples into a transverse velocity, which obeys a tridiagonal equation in z, and a longitudinal and a
/// normal one, which a pentadiagonal equation for the normal velocity determines once pressure is eliminated:
///
/// ```math
/// \eta \left( m^4 - 2 m^2 D_n^2 + G D_t^2 D \right) w = m^2 f_z - m G f_L, \qquad m^2 = |g_x|^2 + |g_y|^2
/// ```
///
/// with the difference symbols g, the second differences D_n² and D_t² of normal and tangential components, and the gradient G
/// and divergence D along z. w is the normal velocity, f_z and f_L are the normal and longitudinal force. With periodic z, a
/// third transform makes every mode algebraic. Either way the solution is that of the discrete equations to rounding. Nothing
/// is allocated in a solve, and each mode is solved by one thread in one order, so that the result does not depend on the
/// number of threads.
///
/// # Validation
/// `law_spectral_and_sparse_flow_agree`, `val_poiseuille_and_couette_flow`, `law_stokes_solution_converges_at_second_order`
///
/// # References
/// [harlow1965]
///
/// [harlow1965]: https://doi.org/10.1063/1.1761178
pub struct Spectral {
    cells: [usize; 3],
    viscosity: f64,
    symbol: Symbol,
    plane_fft: PlaneFft,
    line_fft: Option<LineFft>,
    /// Modes of one k_x in one plane, (component, k_y). In each pass every tile is taken by one thread, so that no lock ever
    /// waits: the locks let two passes cut the same modes in two directions.
    tiles: Vec<Mutex<Vec<Complex64>>>,
    threads: Vec<Scratch>,
    level: Level,
    n_solves: [u64; 2],
}

struct Scratch {
    plane: PlaneScratch,
    lines: Lines,
    fft: Vec<Complex64>,
}

/// Where forces come from in a solve.
enum Source<'a> {
    Field(&'a MacField),
    Sites(&'a FaceSites, &'a [f64]),
}

impl Spectral {
    /// A solver on `grid` for a fluid of viscosity `viscosity` (reduced units: Γ η).
    ///
    /// # Errors
    /// [`StokesError::Walls`] when x or y are not periodic, [`StokesError::Value`] for a viscosity that is not positive.
    pub fn new(grid: &Grid, viscosity: f64) -> Result<Self, StokesError> {
        let viscosity = topo_core::positive("viscosity", viscosity)?;
        if let Some(axis) = (0..2).find(|&axis| grid.faces()[axis] == Faces::Wall) {
            return Err(StokesError::Walls { axis });
        }
        let cells @ [n_x, n_y, n_z] = grid.cells();
        let plane_fft = PlaneFft::new(n_x, n_y);
        let line_fft = (grid.faces()[2] == Faces::Periodic).then(|| LineFft::new(n_z));
        let n_tiles = n_z * plane_fft.n_columns();
        let threads = (0..rayon::current_num_threads())
            .map(|_| Scratch {
                plane: plane_fft.scratch(),
                lines: Lines::new(n_z, line_fft.is_some()),
                fft: line_fft.as_ref().map_or_else(Vec::new, LineFft::scratch),
            })
            .collect();
        Ok(Self {
            cells,
            viscosity,
            symbol: Symbol::new(grid, viscosity),
            tiles: (0..n_tiles)
                .map(|_| Mutex::new(vec![Complex64::default(); 3 * n_y]))
                .collect(),
            plane_fft,
            line_fft,
            threads,
            level: Level::new(),
            n_solves: [0; 2],
        })
    }

    /// Bytes a solver on `cells` will hold, without its small tables.
    pub fn n_bytes_estimate(cells: [usize; 3]) -> u64 {
        let [n_x, n_y, n_z] = cells.map(|n| n as u64);
        3 * (n_x / 2 + 1) * n_y * n_z * size_of::<Complex64>() as u64
    }

    /// Transforms the forces in the planes that have some.
    fn forward(&mut self, source: &Source) {
        let [n_x, n_y, n_z] = self.cells;
        let n_columns = self.plane_fft.n_columns();
        let (fft, tiles) = (&self.plane_fft, &self.tiles);
        let next = AtomicUsize::new(0);
        self.threads.par_iter_mut().for_each(|s| {
            while let Some(k) = take(&next, n_z) {
                if source.is_empty(k) {
                    continue;
                }
                let mut place = match source {
                    Source::Field(_) => 0,
                    Source::Sites(sites, _) => sites.plane(k).start,
                };
                for axis in 0..3 {
                    let fill = |j: usize, row: &mut [f64]| match source {
                        Source::Field(force) => {
                            let start = (k * n_y + j) * n_x;
                            row.copy_from_slice(&force.component(axis)[start..start + n_x]);
                            true
                        }
                        Source::Sites(sites, forces) => {
                            fill_row(row, sites, forces, &mut place, k, (axis, j))
                        }
                    };
                    fft.forward(&mut s.plane, fill, |column, transform| {
                        let mut tile = lock(&tiles[k * n_columns + column]);
                        transform(&mut tile[axis * n_y..(axis + 1) * n_y]);
                    });
                }
            }
        });
    }

    /// Solves for all modes.
    fn solve_modes(&mut self, source: &Source, wanted: impl Fn(usize) -> bool + Sync) {
        let n_columns = self.plane_fft.n_columns();
        let level = self.level;
        let (symbol, line_fft, cells) = (&self.symbol, &self.line_fft, self.cells);
        let tiles = &self.tiles;
        let next = AtomicUsize::new(0);
        let column_job = |s: &mut Scratch, column: usize| {
            let planes = Planes {
                tiles,
                n_columns,
                column,
                forced: &|k| !source.is_empty(k),
                wanted: &wanted,
            };
            match line_fft {
                Some(fft) => {
                    periodic::solve_column(&planes, symbol, cells, fft, &mut s.lines, &mut s.fft);
                }
                None => dispatch!(level, simd => simd.vectorize(
                    #[inline(always)]
                    || plates::solve_column(&planes, symbol, cells, &mut s.lines)
                )),
            }
        };
        self.threads.par_iter_mut().for_each(|s| {
            while let Some(column) = take(&next, n_columns) {
                column_job(s, column);
            }
        });
    }

    /// Transforms the velocities back in whole planes.
    fn inverse(&mut self, velocity: &mut MacField) {
        let [n_x, n_y, _] = self.cells;
        let n_columns = self.plane_fft.n_columns();
        let (fft, tiles) = (&self.plane_fft, &self.tiles);
        let [u_x, u_y, u_z] = velocity.components_mut();
        let [u_x, u_y, u_z] = [u_x, u_y, u_z].map(|u| u.chunks_exact_mut(n_x * n_y));
        let queue = Mutex::new(u_x.zip(u_y.zip(u_z)).enumerate());
        self.threads.par_iter_mut().for_each(|s| {
            loop {
                // Bound, so that the lock is gone before the work starts.
                let job = lock(&queue).next();
                let Some((k, (u_x, (u_y, u_z)))) = job else {
                    break;
                };
                for (axis, plane) in [u_x, u_y, u_z].into_iter().enumerate() {
                    fft.inverse(
                        &mut s.plane,
                        |column, transform| {
                            let mut tile = lock(&tiles[k * n_columns + column]);
                            transform(&mut tile[axis * n_y..(axis + 1) * n_y]);
                        },
                        |_| true,
                        |j, transform, _| transform(&mut plane[j * n_x..(j + 1) * n_x]),
                    );
                }
            }
        });
    }

    /// Transforms the velocities back in the rows that have sites.
    fn inverse_at(&mut self, sites: &FaceSites, velocities: &mut [f64]) {
        let [_, n_y, n_z] = self.cells;
        let n_columns = self.plane_fft.n_columns();
        let (fft, tiles) = (&self.plane_fft, &self.tiles);
        let queue = Mutex::new((0, velocities));
        self.threads.par_iter_mut().for_each(|s| {
            while let Some((k, values)) = next_plane(&queue, sites, n_z) {
                let mut place = sites.plane(k).start;
                let end = sites.plane(k).end;
                let start = place;
                for axis in 0..3 {
                    let has = |place: usize, j: usize| {
                        place < end && {
                            let (a, row, _) = sites.locate(place);
                            (a, row) == (axis, j)
                        }
                    };
                    let rows = rows_of(sites, place, end, axis);
                    if rows.is_empty() {
                        continue;
                    }
                    fft.inverse(
                        &mut s.plane,
                        |column, transform| {
                            let mut tile = lock(&tiles[k * n_columns + column]);
                            transform(&mut tile[axis * n_y..(axis + 1) * n_y]);
                        },
                        |j| rows.contains(&j),
                        |j, transform, row| {
                            if !has(place, j) {
                                return;
                            }
                            transform(row);
                            while has(place, j) {
                                values[place - start] = row[sites.locate(place).2];
                                place += 1;
                            }
                        },
                    );
                }
            }
        });
    }
}

impl Source<'_> {
    /// Whether plane `k` has no force.
    fn is_empty(&self, k: usize) -> bool {
        match self {
            Self::Field(_) => false,
            Self::Sites(sites, _) => sites.plane(k).is_empty(),
        }
    }
}

/// Next of `n` jobs for whichever thread asks.
fn take(next: &AtomicUsize, n: usize) -> Option<usize> {
    let job = next.fetch_add(1, Ordering::Relaxed);
    (job < n).then_some(job)
}

/// Next plane that has sites, with the places where its values go.
fn next_plane<'a>(
    queue: &Mutex<(usize, &'a mut [f64])>,
    sites: &FaceSites,
    n_z: usize,
) -> Option<(usize, &'a mut [f64])> {
    let mut queue = lock(queue);
    while queue.0 < n_z && sites.plane(queue.0).is_empty() {
        queue.0 += 1;
    }
    let k = queue.0;
    if k == n_z {
        return None;
    }
    let (values, rest) = std::mem::take(&mut queue.1).split_at_mut(sites.plane(k).len());
    *queue = (k + 1, rest);
    Some((k, values))
}

/// Rows from the first to the last that has a site of component `axis`, from `place` on.
fn rows_of(sites: &FaceSites, place: usize, end: usize, axis: usize) -> std::ops::Range<usize> {
    let of_axis = |place: &usize| sites.locate(*place).0 == axis;
    let mut places = (place..end).skip_while(|p| !of_axis(p)).take_while(of_axis);
    match places.next() {
        Some(first) => {
            let last = places.last().unwrap_or(first);
            sites.locate(first).1..sites.locate(last).1 + 1
        }
        None => 0..0,
    }
}

/// Writes the forces of row (`axis`, j) from `place` on; whether it has any.
fn fill_row(
    row: &mut [f64],
    sites: &FaceSites,
    forces: &[f64],
    place: &mut usize,
    k: usize,
    (axis, j): (usize, usize),
) -> bool {
    let end = sites.plane(k).end;
    let start = *place;
    while *place < end {
        let (a, r, i) = sites.locate(*place);
        if (a, r) != (axis, j) {
            break;
        }
        if *place == start {
            row.fill(0.0);
        }
        row[i] = forces[*place];
        *place += 1;
    }
    *place > start
}

impl StokesSolver for Spectral {
    fn solve(&mut self, force: &MacField, velocity: &mut MacField) -> Result<(), StokesError> {
        assert!(
            force.cells() == self.cells && velocity.cells() == self.cells,
            "fields of another grid"
        );
        let source = Source::Field(force);
        self.forward(&source);
        self.solve_modes(&source, |_| true);
        self.inverse(velocity);
        self.n_solves[0] += 1;
        Ok(())
    }

    fn solve_at(
        &mut self,
        sites: &FaceSites,
        forces: &[f64],
        velocities: &mut [f64],
    ) -> Result<(), StokesError> {
        assert!(
            forces.len() == sites.len() && velocities.len() == sites.len(),
            "as many forces and velocities as sites"
        );
        let source = Source::Sites(sites, forces);
        self.forward(&source);
        self.solve_modes(&source, |k| !sites.plane(k).is_empty());
        self.inverse_at(sites, velocities);
        self.n_solves[1] += 1;
        Ok(())
    }

    fn viscosity(&self) -> f64 {
        self.viscosity
    }

    fn set_counts(&mut self, n_solves: [u64; 2], _n_iterations: u64) {
        self.n_solves = n_solves;
    }

    fn n_solves(&self) -> [u64; 2] {
        self.n_solves
    }

    fn n_bytes(&self) -> usize {
        let scratch: usize = self.threads.iter().map(Scratch::n_bytes).sum();
        let n_y = self.cells[1];
        self.tiles.len() * (3 * n_y * size_of::<Complex64>() + size_of::<Mutex<Vec<Complex64>>>())
            + scratch
    }

    fn name(&self) -> &'static str {
        "spectral"
    }
}

impl Scratch {
    fn n_bytes(&self) -> usize {
        self.plane.n_bytes() + self.lines.n_bytes() + self.fft.len() * size_of::<Complex64>()
    }
}

#[cfg(test)]
mod tests;
