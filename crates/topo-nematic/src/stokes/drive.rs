//! What drives the fluid besides the director: a body force, moving walls, a mean flow.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::finite;

use crate::grid::{Faces, Grid};
use crate::stokes::{MacField, StokesError};

/// Uniform body force, velocities of the walls, mean velocity of a fully periodic fluid; all zero by default.
///
/// A wall that moves with U acts on its neighbours as the force 2 η U/h², since the ghost value 2U − u replaces −u. So every
/// drive is a force for a solver.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Drive {
    /// Uniform force per volume, in L/ξ_N³.
    #[schemars(extend("x-unit" = "L/ξ_N³", "examples" = [[0.001, 0.0, 0.0]]))]
    pub body_force: [f64; 3],
    /// Velocity of the lower and the upper wall along each axis, in ξ_N/τ_N: tangential.
    #[schemars(extend("x-unit" = "ξ_N/τ_N", "examples" = [[[[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], [[-0.01, 0.0, 0.0], [0.01, 0.0, 0.0]]]]))]
    pub wall_velocity: [[[f64; 3]; 2]; 3],
    /// Mean velocity, in ξ_N/τ_N; only where all sides are periodic.
    #[schemars(extend("x-unit" = "ξ_N/τ_N", "examples" = [[0.01, 0.0, 0.0]]))]
    pub mean_velocity: [f64; 3],
}

impl Drive {
    /// Whether everything is at rest.
    pub fn is_zero(&self) -> bool {
        *self == Self::default()
    }

    /// Checks the drive against the sides of `grid`.
    ///
    /// # Errors
    /// [`StokesError`] for numbers that are not finite, body forces that nothing balances, walls that move along their normal or
    /// do not exist, and mean velocities where walls decide.
    pub fn check(&self, grid: &Grid) -> Result<(), StokesError> {
        for x in self.body_force {
            finite("flow.drive.body_force", x)?;
        }
        for x in self.mean_velocity {
            finite("flow.drive.mean_velocity", x)?;
        }
        let periodic = grid.faces() == [Faces::Periodic; 3];
        if periodic && self.body_force != [0.0; 3] {
            return Err(StokesError::Unbalanced);
        }
        if !periodic && self.mean_velocity != [0.0; 3] {
            return Err(StokesError::MeanVelocity);
        }
        for axis in 0..3 {
            for (side, velocity) in ["lower", "upper"].into_iter().zip(self.wall_velocity[axis]) {
                for x in velocity {
                    finite("flow.drive.wall_velocity", x)?;
                }
                let walled = grid.faces()[axis] == Faces::Wall;
                if velocity[axis] != 0.0 || !(walled || velocity == [0.0; 3]) {
                    return Err(StokesError::WallVelocity { axis, side });
                }
            }
        }
        Ok(())
    }

    /// Adds the body force and the forces that represent the walls, in a fluid of viscosity `viscosity`.
    pub(crate) fn add_force(&self, grid: &Grid, viscosity: f64, force: &mut MacField) {
        if self.is_zero() {
            return;
        }
        for component in 0..3 {
            let body = self.body_force[component];
            if body != 0.0 {
                for x in force.component_mut(component) {
                    *x += body;
                }
            }
        }
        let stress = 2.0 * viscosity / grid.spacing().powi(2);
        self.for_wall_faces(grid, |component, index, velocity| {
            force.component_mut(component)[index] += stress * velocity;
        });
        self.clear_walls(grid, force);
    }

    /// Adds the mean velocity.
    pub(crate) fn add_mean(&self, velocity: &mut MacField) {
        for component in (0..3).filter(|&c| self.mean_velocity[c] != 0.0) {
            for u in velocity.component_mut(component) {
                *u += self.mean_velocity[component];
            }
        }
    }

    /// Sum over all faces of `velocity` times the forces that [`add_force`](Self::add_force) adds.
    pub(crate) fn dot(&self, grid: &Grid, viscosity: f64, velocity: &MacField) -> f64 {
        let stress = 2.0 * viscosity / grid.spacing().powi(2);
        let mut sum = velocity.dot_uniform(self.body_force);
        self.for_wall_faces(grid, |component, index, wall| {
            sum += stress * wall * velocity.component(component)[index];
        });
        sum
    }

    /// Work per time of body force and walls on a fluid that moves with `velocity`, in L ξ_N/τ_N.
    pub(crate) fn power(&self, grid: &Grid, viscosity: f64, velocity: &MacField) -> f64 {
        let stress = 2.0 * viscosity / grid.spacing().powi(2);
        let mut sum = velocity.dot_uniform(self.body_force);
        self.for_wall_faces(grid, |component, index, wall| {
            sum += stress * wall * (wall - velocity.component(component)[index]);
        });
        grid.spacing().powi(3) * sum
    }

    /// Calls `visit(component, index, wall velocity)` for every tangential face next to a moving wall.
    fn for_wall_faces(&self, grid: &Grid, mut visit: impl FnMut(usize, usize, f64)) {
        let cells = grid.cells();
        for axis in 0..3 {
            for (end, velocity) in [0, cells[axis] - 1]
                .into_iter()
                .zip(self.wall_velocity[axis])
            {
                for component in (0..3).filter(|&c| velocity[c] != 0.0) {
                    let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
                    for (m, n) in (0..cells[b]).flat_map(|n| (0..cells[a]).map(move |m| (m, n))) {
                        let mut ijk = [0; 3];
                        (ijk[axis], ijk[a], ijk[b]) = (end, m, n);
                        let on_other_wall =
                            grid.faces()[component] == Faces::Wall && ijk[component] == 0;
                        if !on_other_wall {
                            visit(component, grid.index(ijk), velocity[component]);
                        }
                    }
                }
            }
        }
    }

    /// No force acts on the normal component at a wall.
    fn clear_walls(&self, grid: &Grid, force: &mut MacField) {
        let [n_x, n_y, n_z] = grid.cells();
        for axis in (0..3).filter(|&a| grid.faces()[a] == Faces::Wall) {
            for n in 0..grid.n_cells() / grid.cells()[axis] {
                let ijk = match axis {
                    0 => [0, n % n_y, n / n_y],
                    1 => [n % n_x, 0, n / n_x],
                    _ => [n % n_x, n / n_x, 0],
                };
                debug_assert!(ijk[2] < n_z);
                force.component_mut(axis)[grid.index(ijk)] = 0.0;
            }
        }
    }
}
