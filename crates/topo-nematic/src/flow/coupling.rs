//! Director and flow together.

use fearless_simd::Level;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use topo_core::{finite, in_range, positive};

use super::force::{Director, Window};
use super::observables;
use super::rate::Flow;
use super::stencil::{Stencil, Stored};
use crate::grid::{Faces, Grid};
use crate::material::Material;
use crate::particle::Particle;
use crate::stokes::{
    Drive, MacField, NoSlip, NoSlipMemory, Sparse, SparseOptions, Spectral, StokesError,
    StokesSolver,
};

/// Which solver computes the flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FlowSolver {
    /// Spectral where x and y are periodic, else sparse.
    #[default]
    Auto,
    /// By Fourier modes along x and y, which are periodic then.
    Spectral,
    /// For any sides.
    Sparse,
}

/// How the flow is computed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FlowParameters {
    /// Root mean square velocity left on the particle's boundary, over that without the particle.
    #[schemars(extend("x-unit" = "1", "exclusiveMinimum" = 0), example = 0.02)]
    pub boundary_residual: f64,
    /// What drives the fluid besides the director.
    pub drive: Drive,
    /// Which solver computes the flow.
    #[schemars(example = FlowSolver::Sparse)]
    pub solver: FlowSolver,
    /// Relative residual of the sparse solver.
    #[schemars(range(min = 1e-14, max = 0.1), extend("x-unit" = "1"), example = 1e-6)]
    pub solver_tolerance: f64,
    /// Most memory the flow may take, in bytes.
    #[schemars(extend("x-unit" = "bytes"), example = 8_000_000_000_u64)]
    pub memory_limit: u64,
}

impl Default for FlowParameters {
    fn default() -> Self {
        Self {
            boundary_residual: 0.01,
            drive: Drive::default(),
            solver: FlowSolver::Auto,
            solver_tolerance: 1e-8,
            memory_limit: 16 << 30,
        }
    }
}

impl FlowParameters {
    /// Checks every number, and the drive and the solver against the sides of `grid`.
    ///
    /// # Errors
    /// [`StokesError`] for parameters outside their domain, drives or a solver that do not fit the sides, or too little memory.
    pub fn check(&self, grid: &Grid, with_particle: bool) -> Result<(), StokesError> {
        positive("flow.boundary_residual", self.boundary_residual)?;
        in_range("flow.solver_tolerance", self.solver_tolerance, 1e-14, 0.1)?;
        self.drive.check(grid)?;
        if self.solver == FlowSolver::Spectral
            && let Some(axis) = (0..2).find(|&axis| grid.faces()[axis] == Faces::Wall)
        {
            return Err(StokesError::Walls { axis });
        }
        let estimate = FlowCoupling::n_bytes_estimate(grid, with_particle, self);
        if estimate > self.memory_limit {
            return Err(StokesError::Memory {
                estimate,
                limit: self.memory_limit,
            });
        }
        Ok(())
    }

    /// Whether the flow in `grid` is found by the spectral solver.
    fn is_spectral(&self, grid: &Grid) -> bool {
        match self.solver {
            FlowSolver::Auto => grid.faces()[..2] == [Faces::Periodic; 2],
            FlowSolver::Spectral => true,
            FlowSolver::Sparse => false,
        }
    }

    fn sparse(&self) -> SparseOptions {
        SparseOptions {
            tolerance: self.solver_tolerance,
            memory_limit: self.memory_limit,
            ..SparseOptions::default()
        }
    }
}

/// Work of the flow so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct FlowCounters {
    /// Updates of the velocity.
    pub n_updates: u64,
    /// Flow solves over the whole grid.
    pub n_solves: u64,
    /// Flow solves restricted to the particle's boundary, one per iteration of the no-slip condition.
    pub n_boundary_solves: u64,
    /// Iterations inside the flow solver; none if it is direct.
    pub n_iterations: u64,
}

/// The velocity that the director drives, and its action on the director.
///
/// ```math
/// \partial_t Q = -u \cdot \nabla Q - \Omega Q + Q \Omega + \chi [\tfrac23 D + DQ + QD] - 2 \chi (Q + I/3)(Q:D) + \Gamma H
/// ```
/// ```math
/// \eta \nabla^2 u - \nabla p + f = 0, \qquad f_i = -H:\partial_i Q - \partial_j T_{ji}
/// ```
///
/// with W_ij = ∂_i u_j, D and Ω its symmetric and antisymmetric part, χ the flow alignment, H the molecular field and T the
/// stress of co-rotation and alignment. Velocities are stored on faces, Q in cells. The flow terms are a linear map from
/// velocity to rate, and the force is its discrete adjoint, so the power that the fluid takes from the director is exactly f·u
/// at any resolution.
///
/// The velocity is that of the last update. Memory is taken at set-up: neither [`update`](Self::update) nor
/// [`add_rate`](Self::add_rate) allocates, and both give the same bits for any number of threads.
///
/// # Validation
/// `law_flow_takes_the_energy_that_the_director_loses`, `val_director_aligns_at_the_leslie_angle`
///
/// # References
/// [beris1994], [patil2020discharging]
///
/// [beris1994]: https://doi.org/10.1093/oso/9780195076943.001.0001
/// [patil2020discharging]: https://doi.org/10.1103/PhysRevResearch.2.043196
pub struct FlowCoupling {
    grid: Grid,
    stencil: Stencil,
    alignment: f64,
    parameters: FlowParameters,
    solver: Box<dyn StokesSolver>,
    no_slip: Option<NoSlip>,
    weights: Option<Vec<f64>>,
    force: MacField,
    velocity: MacField,
    /// Unused between updates, so that an update needs no memory.
    windows: Vec<Window>,
    level: Level,
    n_updates: u64,
    power: f64,
    dissipation: f64,
    residual: f64,
}

/// What a checkpoint keeps of a flow.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct FlowMemory {
    velocity: MacField,
    no_slip: Option<NoSlipMemory>,
    n_updates: u64,
    n_solves: [u64; 2],
    n_iterations: u64,
    power: f64,
    dissipation: f64,
    residual: f64,
}

impl FlowCoupling {
    /// The flow in `grid` around `particle`, if there is one, at rest.
    ///
    /// # Errors
    /// [`StokesError`] for parameters outside their domain, drives that do not fit the sides, or too little memory.
    pub fn new(
        grid: &Grid,
        particle: Option<&Particle>,
        material: &Material,
        parameters: &FlowParameters,
    ) -> Result<Self, StokesError> {
        let alignment = finite("material.flow_alignment", material.flow_alignment)?;
        let viscosity = positive("material.viscosity", material.viscosity)?;
        parameters.check(grid, particle.is_some())?;
        let solver: Box<dyn StokesSolver> = if parameters.is_spectral(grid) {
            Box::new(Spectral::new(grid, viscosity)?)
        } else {
            Box::new(Sparse::new(grid, viscosity, &parameters.sparse())?)
        };
        let no_slip = particle
            .map(|p| NoSlip::sphere(grid, p.centre(), p.radius(), parameters.boundary_residual))
            .transpose()?;
        let weights = particle.map(|p| {
            let solid = p.mask(grid);
            solid.iter().map(|s| if *s { 0.0 } else { 1.0 }).collect()
        });
        let stencil = Stencil::new(grid, parameters.drive.wall_velocity);
        Ok(Self {
            grid: *grid,
            alignment,
            parameters: *parameters,
            solver,
            no_slip,
            weights,
            force: MacField::zeros(grid),
            velocity: MacField::zeros(grid),
            windows: (0..rayon::current_num_threads())
                .map(|_| Window::new(&stencil))
                .collect(),
            stencil,
            level: Level::new(),
            n_updates: 0,
            power: 0.0,
            dissipation: 0.0,
            residual: 0.0,
        })
    }

    /// Bytes the flow will take on `grid`, within a tenth with the spectral solver and a third with the sparse one.
    pub fn n_bytes_estimate(grid: &Grid, with_particle: bool, parameters: &FlowParameters) -> u64 {
        let cells = grid.n_cells() as u64;
        let fields = 6 + u64::from(with_particle);
        let plane = (grid.cells()[0] * grid.cells()[1]) as u64;
        let threads = rayon::current_num_threads() as u64;
        let solver = if parameters.is_spectral(grid) {
            Spectral::n_bytes_estimate(grid.cells())
        } else {
            Sparse::n_bytes_estimate(grid, &parameters.sparse())
        };
        8 * (fields * cells + 55 * plane * threads) + solver
    }

    /// Computes the velocity that `q` and the molecular field `h` drive; both component-major, 5 x n_cells.
    ///
    /// # Errors
    /// [`StokesError::NotFinite`] for broken fields, [`StokesError::NotConverged`] of the particle or the solver.
    ///
    /// # Panics
    /// When a field is not 5 x n_cells long.
    pub fn update<T: Stored>(&mut self, q: &[T], h: &[T]) -> Result<(), StokesError> {
        let n = 5 * self.grid.n_cells();
        assert!(q.len() == n && h.len() == n, "fields of another grid");
        let director = Director {
            stencil: &self.stencil,
            q: T::either(q),
            h: T::either(h),
            weights: self.weights.as_deref(),
            alignment: self.alignment,
        };
        director.force(self.level, &mut self.windows, &mut self.force);
        let viscosity = self.solver.viscosity();
        let drive = &self.parameters.drive;
        drive.add_force(&self.grid, viscosity, &mut self.force);
        self.solver.solve(&self.force, &mut self.velocity)?;
        let mut held = 0.0;
        if let Some(no_slip) = &mut self.no_slip {
            drive.add_mean(&mut self.velocity);
            let report = no_slip.solve(self.solver.as_mut(), &self.velocity)?;
            self.residual = report.residual;
            no_slip.sites().add_to(no_slip.forces(), &mut self.force);
            self.solver.solve(&self.force, &mut self.velocity)?;
        }
        let total = self.force.dot(&self.velocity);
        drive.add_mean(&mut self.velocity);
        if let Some(no_slip) = &self.no_slip {
            held = no_slip.dot(&self.velocity);
        }
        // Power against the whole velocity, of which `total` lacks the mean flow.
        let mean = self.force.dot_uniform(drive.mean_velocity);
        let driven = drive.dot(&self.grid, viscosity, &self.velocity);
        let volume = self.grid.spacing().powi(3);
        self.power = volume * (total + mean - driven - held);
        // The work of the pressure gradient that keeps the mean flow cancels that of the mean force.
        self.dissipation =
            volume * (total - driven) + drive.power(&self.grid, viscosity, &self.velocity);
        if !(self.power.is_finite() && self.dissipation.is_finite()) {
            return Err(StokesError::NotFinite);
        }
        self.n_updates += 1;
        Ok(())
    }

    /// What a later run needs to continue to the same bits: velocity, warm start and counters.
    pub(crate) fn memory(&self) -> FlowMemory {
        FlowMemory {
            velocity: self.velocity.clone(),
            no_slip: self.no_slip.as_ref().map(NoSlip::memory),
            n_updates: self.n_updates,
            n_solves: self.solver.n_solves(),
            n_iterations: self.solver.n_iterations(),
            power: self.power,
            dissipation: self.dissipation,
            residual: self.residual,
        }
    }

    /// Continues from a memory; returns whether it fits this grid and particle.
    pub(crate) fn restore(&mut self, memory: FlowMemory) -> bool {
        let counts = [memory.n_updates, memory.n_iterations];
        let numbers = [memory.power, memory.dissipation, memory.residual];
        let fits = memory.velocity.cells() == self.velocity.cells()
            && counts
                .iter()
                .chain(&memory.n_solves)
                .all(|n| *n < u64::MAX / 2)
            && numbers.iter().all(|x| x.is_finite())
            && match (&mut self.no_slip, memory.no_slip) {
                (Some(own), Some(kept)) => own.restore(kept),
                (None, None) => true,
                _ => false,
            };
        if fits {
            self.velocity = memory.velocity;
            self.n_updates = memory.n_updates;
            self.solver.set_counts(memory.n_solves, memory.n_iterations);
            self.power = memory.power;
            self.dissipation = memory.dissipation;
            self.residual = memory.residual;
        }
        fits
    }

    /// Adds what the velocity of the last update does to `q` to `rate`; both component-major, 5 x n_cells.
    ///
    /// It is zero in cells that are not fluid.
    ///
    /// # Panics
    /// When a field is not 5 x n_cells long.
    pub fn add_rate<T: Stored>(&self, q: &[T], rate: &mut [T]) {
        let n = 5 * self.grid.n_cells();
        assert!(q.len() == n && rate.len() == n, "fields of another grid");
        self.flow().add_rate(self.level, q, rate);
    }

    fn flow(&self) -> Flow<'_> {
        Flow {
            stencil: &self.stencil,
            velocity: &self.velocity,
            weights: self.weights.as_deref(),
            alignment: self.alignment,
        }
    }

    /// Sets the share of each cell that is fluid (0 to 1), as it weighs H in the energy; at first it is 1 outside the particle
    /// and 0 inside.
    ///
    /// # Panics
    /// When there are not n_cells weights, or there is no particle.
    pub fn set_weights(&mut self, weights: &[f64]) {
        assert_eq!(
            weights.len(),
            self.grid.n_cells(),
            "weights of another grid"
        );
        match &mut self.weights {
            Some(own) => own.copy_from_slice(weights),
            None => self.weights = Some(weights.to_vec()),
        }
    }

    /// Share of each cell that is fluid; none where all is.
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }

    /// Velocity of the last update, in ξ_N/τ_N.
    pub fn velocity(&self) -> &MacField {
        &self.velocity
    }

    /// Velocity at the cell centres, in ξ_N/τ_N, component-major, 3 x n_cells; newly allocated.
    pub fn centred_velocity(&self) -> Vec<f64> {
        observables::centred(&self.velocity)
    }

    /// Curl of the velocity at the cell centres, in 1/τ_N, component-major, 3 x n_cells; newly allocated.
    pub fn vorticity(&self) -> Vec<f64> {
        observables::vorticity(&self.flow(), self.level)
    }

    /// Largest velocity component on a face, in ξ_N/τ_N.
    pub fn max_speed(&self) -> f64 {
        self.velocity.max_abs()
    }

    /// Power f·u that the director gave to the fluid at the last update, in L ξ_N/τ_N: the flow lowers the energy of the
    /// director at this rate.
    ///
    /// With moving walls, the co-rotation and alignment of the cells next to them are not included.
    pub fn power(&self) -> f64 {
        self.power
    }

    /// Viscous dissipation at the last update, in L ξ_N/τ_N: the power, the work of the drive, and the work of the boundary
    /// residual of the particle.
    pub fn dissipation(&self) -> f64 {
        self.dissipation
    }

    /// Force that the particle exerts on the fluid, in L; none without a particle.
    pub fn particle_force(&self) -> Option<[f64; 3]> {
        let volume = self.grid.spacing().powi(3);
        self.no_slip.as_ref().map(|n| n.total_force(volume))
    }

    /// Root mean square velocity on the particle's boundary over that without the particle, at the last update.
    pub fn boundary_residual(&self) -> f64 {
        self.residual
    }

    /// Work of the flow so far.
    pub fn counters(&self) -> FlowCounters {
        let [n_solves, n_boundary_solves] = self.solver.n_solves();
        FlowCounters {
            n_updates: self.n_updates,
            n_solves,
            n_boundary_solves,
            n_iterations: self.solver.n_iterations(),
        }
    }

    /// Name of the flow solver.
    pub fn solver(&self) -> &'static str {
        self.solver.name()
    }

    /// Bytes held.
    pub fn n_bytes(&self) -> usize {
        let windows: usize = self.windows.iter().map(Window::n_bytes).sum();
        self.force.n_bytes()
            + self.velocity.n_bytes()
            + self.solver.n_bytes()
            + self.no_slip.as_ref().map_or(0, NoSlip::n_bytes)
            + self
                .weights
                .as_ref()
                .map_or(0, |w| size_of_val(w.as_slice()))
            + windows
    }
}
