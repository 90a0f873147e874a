//! A sphere held at rest: unknown forces on the faces of its boundary.

use serde::{Deserialize, Serialize};
use topo_core::positive;

use crate::grid::{Faces, Grid};
use crate::stokes::field::dot;
use crate::stokes::{FaceSites, MacField, StokesError, StokesSolver};

use self::history::History;

mod history;

/// How far beyond the nominal radius the boundary layer sits, in spacings: the unknown forces act as if on a slightly larger
/// sphere than their faces, and this centres the drag.
const RADIUS_SHIFT: f64 = 0.25;

/// Most iterations of one update.
const MAX_ITERATIONS: usize = 500;

/// Forces on boundary faces that bring the fluid there to rest.
///
/// With P the extension of a list of forces to the grid and M the map from force to velocity, the forces λ follow from
///
/// ```math
/// P^T M P\, \lambda = -P^T u_0, \qquad u_0 = M f,
/// ```
///
/// a symmetric positive semi-definite system, solved by conjugate gradients with one restricted flow solve per iteration. The
/// boundary faces are those within R + h/4 of the centre that have a neighbour (of the 26 of the same component) outside that
/// distance: a layer that leaves no gap for the flow to leak through. The start is the combination of the last solutions that
/// is best in the norm of the system (linear extrapolation in time is one of the candidates).
///
/// # Validation
/// `val_drag_on_a_cubic_array_of_spheres`, `particle_holds_the_fluid_at_its_boundary`
///
/// # References
/// [hasimoto1959], [zick1982]
///
/// [hasimoto1959]: https://doi.org/10.1017/S0022112059000222
/// [zick1982]: https://doi.org/10.1017/S0022112082000627
pub struct NoSlip {
    sites: FaceSites,
    tolerance: f64,
    forces: Vec<f64>,
    history: History,
    /// Negative free velocities, then residual, direction and image of the direction.
    target: Vec<f64>,
    residual: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    n_iterations: u64,
}

/// Forces and earlier solutions, for a checkpoint.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct NoSlipMemory {
    forces: Vec<f64>,
    history: history::SavedHistory,
    n_iterations: u64,
}

/// The work of one solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoSlipReport {
    /// Iterations, each a flow solve restricted to the boundary faces.
    pub n_iterations: usize,
    /// Root mean square of the boundary velocities over that without the particle.
    pub residual: f64,
}

impl NoSlip {
    /// A sphere at `centre` of `radius` (ξ_N) in `grid`; boundary velocities fall to `tolerance` of those without it.
    ///
    /// # Errors
    /// [`StokesError::Value`] for a tolerance or radius that is not positive, [`StokesError::ParticleTooSmall`] for a sphere
    /// between the faces.
    pub fn sphere(
        grid: &Grid,
        centre: [f64; 3],
        radius: f64,
        tolerance: f64,
    ) -> Result<Self, StokesError> {
        let radius = positive("radius", radius)?;
        let tolerance = positive("boundary_residual", tolerance)?;
        let sites = boundary(grid, centre, radius + RADIUS_SHIFT * grid.spacing());
        if sites.is_empty() {
            let spacing = grid.spacing();
            return Err(StokesError::ParticleTooSmall { radius, spacing });
        }
        let n = sites.len();
        Ok(Self {
            tolerance,
            forces: vec![0.0; n],
            history: History::new(n),
            target: vec![0.0; n],
            residual: vec![0.0; n],
            direction: vec![0.0; n],
            image: vec![0.0; n],
            n_iterations: 0,
            sites,
        })
    }

    /// Finds the forces for a fluid that moves with `free_velocity` without the particle.
    ///
    /// # Errors
    /// [`StokesError::NotFinite`] for broken velocities, [`StokesError::NotConverged`], and those of the solver.
    pub fn solve(
        &mut self,
        solver: &mut dyn StokesSolver,
        free_velocity: &MacField,
    ) -> Result<NoSlipReport, StokesError> {
        self.sites.gather(free_velocity, &mut self.target);
        for x in &mut self.target {
            *x = -*x;
        }
        let norm = dot(&self.target, &self.target).sqrt();
        if !norm.is_finite() {
            return Err(StokesError::NotFinite);
        }
        if norm == 0.0 {
            self.forces.fill(0.0);
            return Ok(NoSlipReport {
                n_iterations: 0,
                residual: 0.0,
            });
        }
        self.history
            .guess(&self.target, &mut self.forces, &mut self.residual);
        let bound = self.tolerance * norm;
        let mut square = dot(&self.residual, &self.residual);
        self.direction.copy_from_slice(&self.residual);
        let mut n_iterations = 0;
        while square.sqrt() > bound {
            if n_iterations == MAX_ITERATIONS {
                return Err(self.not_converged(square.sqrt() / norm, n_iterations));
            }
            solver.solve_at(&self.sites, &self.direction, &mut self.image)?;
            n_iterations += 1;
            self.n_iterations += 1;
            let curvature = dot(&self.direction, &self.image);
            if !(curvature.is_finite() && curvature > 0.0) {
                return Err(self.not_converged(square.sqrt() / norm, n_iterations));
            }
            let step = square / curvature;
            add_scaled(&mut self.forces, step, &self.direction);
            add_scaled(&mut self.residual, -step, &self.image);
            let before = square;
            square = dot(&self.residual, &self.residual);
            for (d, r) in self.direction.iter_mut().zip(&self.residual) {
                *d = r + square / before * *d;
            }
        }
        self.history
            .push(&self.forces, &self.target, &self.residual);
        Ok(NoSlipReport {
            n_iterations,
            residual: square.sqrt() / norm,
        })
    }

    fn not_converged(&self, residual: f64, n_iterations: usize) -> StokesError {
        StokesError::NotConverged {
            what: "the no-slip condition on the particle",
            residual,
            tolerance: self.tolerance,
            n_iterations,
        }
    }

    /// Boundary faces.
    pub fn sites(&self) -> &FaceSites {
        &self.sites
    }

    /// Forces per volume that the particle exerts on the fluid, in L/ξ_N³, one per boundary face.
    pub fn forces(&self) -> &[f64] {
        &self.forces
    }

    /// Sum over the boundary faces of force times `velocity`.
    pub fn dot(&self, velocity: &MacField) -> f64 {
        let faces = self.sites.iter().zip(&self.forces);
        faces
            .map(|((axis, index), force)| force * velocity.component(axis)[index])
            .sum()
    }

    /// Force that the particle exerts on the fluid, in L: minus the drag, for cells of volume `volume` (ξ_N³).
    pub fn total_force(&self, volume: f64) -> [f64; 3] {
        let mut total = [0.0; 3];
        for ((axis, _), force) in self.sites.iter().zip(&self.forces) {
            total[axis] += force * volume;
        }
        total
    }

    /// Iterations so far.
    pub fn n_iterations(&self) -> u64 {
        self.n_iterations
    }

    /// What a later run needs to continue to the same bits.
    pub(crate) fn memory(&self) -> NoSlipMemory {
        NoSlipMemory {
            forces: self.forces.clone(),
            history: self.history.kept(),
            n_iterations: self.n_iterations,
        }
    }

    /// Continues from a memory; returns whether it is of the same boundary.
    pub(crate) fn restore(&mut self, memory: NoSlipMemory) -> bool {
        let fits = memory.forces.len() == self.forces.len()
            && memory.forces.iter().all(|x| x.is_finite())
            && memory.n_iterations < u64::MAX / 2
            && self.history.restore(memory.history);
        if fits {
            self.forces = memory.forces;
            self.n_iterations = memory.n_iterations;
        }
        fits
    }

    /// Forgets earlier solutions, for example after a jump in time.
    pub fn forget(&mut self) {
        self.history.clear();
    }

    /// Bytes held.
    pub fn n_bytes(&self) -> usize {
        5 * self.forces.len() * size_of::<f64>() + self.sites.n_bytes() + self.history.n_bytes()
    }
}

/// `y += factor x`.
fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// Faces within `radius` of `centre` of which one of the 26 neighbours of the same component is not.
fn boundary(grid: &Grid, centre: [f64; 3], radius: f64) -> FaceSites {
    let (cells, faces, h) = (grid.cells(), grid.faces(), grid.spacing());
    let inside = |component: usize, ijk: [i64; 3]| {
        let mut square = 0.0;
        for axis in 0..3 {
            let offset = if axis == component { 0.0 } else { 0.5 };
            let mut distance = (ijk[axis] as f64 + offset) * h - centre[axis];
            if faces[axis] == Faces::Periodic {
                let length = cells[axis] as f64 * h;
                distance -= length * (distance / length).round();
            }
            square += distance * distance;
        }
        square <= radius * radius
    };
    FaceSites::new(grid, |component, ijk| {
        let ijk = ijk.map(|i| i as i64);
        let on_wall = faces[component] == Faces::Wall && ijk[component] == 0;
        let neighbours = || {
            (0..27).map(|n| {
                [
                    ijk[0] + n % 3 - 1,
                    ijk[1] + n / 3 % 3 - 1,
                    ijk[2] + n / 9 - 1,
                ]
            })
        };
        !on_wall && inside(component, ijk) && neighbours().any(|n| !inside(component, n))
    })
}

#[cfg(test)]
mod tests;
