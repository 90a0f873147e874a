//! Flow between any sides: the assembled equations, preconditioned by multigrid over a factorised coarse grid.

use topo_core::{in_range, positive};

use crate::grid::{Faces, Grid};
use crate::stokes::{FaceSites, MacField, StokesError, StokesSolver};

use self::minres::Minres;
use self::multigrid::Multigrid;
use self::operator::{Operator, divergence, gradient};

mod minres;
mod multigrid;
mod operator;
mod transfer;

/// How the sparse solver works.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SparseOptions {
    /// Residual relative to the force, in the norm of the preconditioner.
    pub tolerance: f64,
    /// Number of cells up to which a grid is factorised directly; larger grids are coarsened first.
    pub direct_up_to: usize,
    /// Largest memory it may take, in bytes.
    pub memory_limit: u64,
}

impl Default for SparseOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            direct_up_to: 4096,
            memory_limit: 16 << 30,
        }
    }
}

/// Most iterations of one solve.
const MAX_ITERATIONS: usize = 300;

/// Bytes of a Cholesky factor of the 7-point Laplacian over n^(4/3) with 0 to 3 periodic axes, measured up to 32^3 cells.
const FACTOR_BYTES: [f64; 4] = [75.0, 110.0, 160.0, 220.0];

/// Stokes solver for periodic or walled sides in any combination: the reference, and the solver for walls along x or y.
///
/// ```math
/// \begin{pmatrix} A & G \\ G^T & 0 \end{pmatrix} \begin{pmatrix} u \\ p \end{pmatrix} =
/// \begin{pmatrix} f \\ 0 \end{pmatrix}, \qquad A = -\eta \nabla_h^2
/// ```
///
/// solved by MINRES for velocity and pressure at once. Its preconditioner inverts A, and the pressure that makes the velocity
/// free of divergence by the viscosity alone, which is close to G^T A^-1 G for smooth and rough fields alike: so the number of
/// iterations (at most 50 with a factor, 80 with multigrid) hardly depends on the grid. A is inverted by a Cholesky factor on
/// small grids, and by one symmetric multigrid cycle with a Cholesky factor on its coarsest grid beyond. The three components
/// run side by side, each in one order, so that the result does not depend on the number of threads.
///
/// # Validation
/// `law_spectral_and_sparse_flow_agree`, `val_flow_in_a_square_duct`
///
/// # References
/// [elman2014], [harlow1965]
///
/// [elman2014]: https://doi.org/10.1093/acprof:oso/9780199678792.001.0001
/// [harlow1965]: https://doi.org/10.1063/1.1761178
pub struct Sparse {
    grid: Grid,
    viscosity: f64,
    operators: [Operator; 3],
    components: [Multigrid; 3],
    minres: Minres,
    tolerance: f64,
    n_solves: [u64; 2],
    n_iterations: u64,
}

impl Sparse {
    /// A solver on `grid` for a fluid of viscosity `viscosity`.
    ///
    /// # Errors
    /// [`StokesError::Value`] for numbers out of range, [`StokesError::Memory`] beyond the limit, [`StokesError::Sparse`] when
    /// the coarsest grid cannot be factorised.
    pub fn new(grid: &Grid, viscosity: f64, options: &SparseOptions) -> Result<Self, StokesError> {
        let viscosity = positive("viscosity", viscosity)?;
        in_range("tolerance", options.tolerance, 1e-14, 0.1)?;
        let estimate = Self::n_bytes_estimate(grid, options);
        if estimate > options.memory_limit {
            return Err(StokesError::Memory {
                estimate,
                limit: options.memory_limit,
            });
        }
        let operators = [0, 1, 2].map(|component| Operator::new(grid, component));
        let multigrid =
            |component: usize| Multigrid::new(operators[component], options.direct_up_to);
        Ok(Self {
            grid: *grid,
            viscosity,
            components: [multigrid(0)?, multigrid(1)?, multigrid(2)?],
            operators,
            minres: Minres::new(4 * grid.n_cells()),
            tolerance: options.tolerance,
            n_solves: [0; 2],
            n_iterations: 0,
        })
    }

    /// Bytes a solver on `grid` will hold, within a third.
    pub fn n_bytes_estimate(grid: &Grid, options: &SparseOptions) -> u64 {
        let vectors = 4 * Minres::N_VECTORS * grid.n_cells() * size_of::<f64>();
        let levels = multigrid::cells_of_levels(grid.cells(), options.direct_up_to);
        let n_cells = |cells: &[usize; 3]| cells.iter().product::<usize>();
        let cycles: usize = levels
            .iter()
            .map(|l| 3 * 3 * n_cells(l) * size_of::<f64>())
            .sum();
        let coarsest = levels.last().map_or(0, n_cells) as f64;
        let n_periodic = grid
            .faces()
            .iter()
            .filter(|f| **f == Faces::Periodic)
            .count();
        let factors = 3.0 * FACTOR_BYTES[n_periodic] * coarsest.powf(4.0 / 3.0);
        (vectors + cycles) as u64 + factors as u64
    }

    /// Solves for the force in the iteration's right-hand side, which is scaled by h^2/η.
    fn run(&mut self) -> Result<(), StokesError> {
        let n = self.grid.n_cells();
        let periodic = self.grid.faces() == [Faces::Periodic; 3];
        let rhs = self.minres.rhs();
        for (component, operator) in self.operators.iter().enumerate() {
            let force = &mut rhs[component * n..(component + 1) * n];
            operator.clear_walls(force);
            if periodic {
                remove_mean(force);
            }
        }
        rhs[3 * n..].fill(0.0);
        let (operators, components) = (&self.operators, &mut self.components);
        let result = self.minres.solve(
            self.tolerance,
            MAX_ITERATIONS,
            |x, y| balance(operators, x, y),
            |x, y| precondition(components, periodic, x, y),
        );
        self.n_iterations += result.n_iterations as u64;
        if result.residual > self.tolerance || result.residual.is_nan() {
            return Err(if result.residual.is_finite() {
                StokesError::NotConverged {
                    what: "the sparse flow solver",
                    residual: result.residual,
                    tolerance: self.tolerance,
                    n_iterations: result.n_iterations,
                }
            } else {
                StokesError::NotFinite
            });
        }
        Ok(())
    }

    /// What turns a force into the right-hand side.
    fn scale(&self) -> f64 {
        self.grid.spacing().powi(2) / self.viscosity
    }
}

/// Writes the force and the outflow that belong to the velocity and the pressure `x` to `y`.
fn balance(operators: &[Operator; 3], x: &[f64], y: &mut [f64]) {
    let n = x.len() / 4;
    let (velocity, pressure) = x.split_at(3 * n);
    let (force, outflow) = y.split_at_mut(3 * n);
    let mut parts = force.chunks_exact_mut(n);
    let mut part = || parts.next().unwrap_or_default();
    let (f_x, f_y, f_z) = (part(), part(), part());
    let balance = |component: usize, force: &mut [f64]| {
        let u = &velocity[component * n..(component + 1) * n];
        operators[component].apply(u, force);
        gradient(&operators[component], pressure, force);
    };
    rayon::join(
        || rayon::join(|| balance(0, f_x), || balance(1, f_y)),
        || {
            rayon::join(
                || balance(2, f_z),
                || divergence(operators, velocity, outflow),
            )
        },
    );
}

/// Writes to `y` about the velocity and the pressure of the force and the outflow `x`: a cycle for each component, the outflow itself.
fn precondition(components: &mut [Multigrid; 3], periodic: bool, x: &[f64], y: &mut [f64]) {
    let n = x.len() / 4;
    let mut parts = y.chunks_exact_mut(n);
    let mut part = || parts.next().unwrap_or_default();
    let (y_x, y_y, y_z, y_p) = (part(), part(), part(), part());
    let [m_x, m_y, m_z] = components;
    let cycle = |m: &mut Multigrid, component: usize, y: &mut [f64]| {
        m.cycle(&x[component * n..(component + 1) * n], y);
        if periodic {
            remove_mean(y);
        }
    };
    rayon::join(
        || rayon::join(|| cycle(m_x, 0, y_x), || cycle(m_y, 1, y_y)),
        || cycle(m_z, 2, y_z),
    );
    y_p.copy_from_slice(&x[3 * n..]);
    remove_mean(y_p);
}

/// Takes the mean out of `values`.
fn remove_mean(values: &mut [f64]) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    for x in values {
        *x -= mean;
    }
}

impl StokesSolver for Sparse {
    fn solve(&mut self, force: &MacField, velocity: &mut MacField) -> Result<(), StokesError> {
        let cells = self.grid.cells();
        assert!(
            force.cells() == cells && velocity.cells() == cells,
            "fields of another grid"
        );
        let (n, scale) = (self.grid.n_cells(), self.scale());
        for (rhs, force) in self
            .minres
            .rhs()
            .chunks_exact_mut(n)
            .zip(force.components())
        {
            for (rhs, force) in rhs.iter_mut().zip(force) {
                *rhs = scale * force;
            }
        }
        self.run()?;
        for (u, x) in velocity
            .components_mut()
            .into_iter()
            .zip(self.minres.solution().chunks_exact(n))
        {
            u.copy_from_slice(x);
        }
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
        let (n, scale) = (self.grid.n_cells(), self.scale());
        let rhs = self.minres.rhs();
        rhs.fill(0.0);
        for ((component, index), force) in sites.iter().zip(forces) {
            rhs[component * n + index] = scale * force;
        }
        self.run()?;
        let solution = self.minres.solution();
        for ((component, index), velocity) in sites.iter().zip(velocities) {
            *velocity = solution[component * n + index];
        }
        self.n_solves[1] += 1;
        Ok(())
    }

    fn viscosity(&self) -> f64 {
        self.viscosity
    }

    fn n_solves(&self) -> [u64; 2] {
        self.n_solves
    }

    fn n_iterations(&self) -> u64 {
        self.n_iterations
    }

    fn set_counts(&mut self, n_solves: [u64; 2], n_iterations: u64) {
        (self.n_solves, self.n_iterations) = (n_solves, n_iterations);
    }

    fn n_bytes(&self) -> usize {
        self.minres.n_bytes()
            + self
                .components
                .iter()
                .map(Multigrid::n_bytes)
                .sum::<usize>()
    }

    fn name(&self) -> &'static str {
        "sparse"
    }
}

#[cfg(test)]
mod tests;
