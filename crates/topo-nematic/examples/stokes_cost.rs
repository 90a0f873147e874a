//! Time and memory of the flow solvers against grid size: `cargo run --release -p topo-nematic --example stokes_cost`;
//! `-- full` goes on to the large grids.

use std::error::Error;

use topo_core::CpuClock;
use topo_nematic::stokes::{
    MacField, NoSlip, Sparse, SparseOptions, Spectral, StokesError, StokesSolver,
};
use topo_nematic::{Faces, Grid};

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    println!(
        "solver,sides,n_x,n_y,n_z,cpu_seconds_a_solve,cpu_seconds_at_particle,ns_a_cell,mebibytes,iterations"
    );
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let full = std::env::args().any(|a| a == "full");
    let spectral = [[32, 32, 32], [64, 64, 64], [100, 100, 75], [200, 200, 150]];
    for cells in spectral.into_iter().take(if full { 4 } else { 1 }) {
        let sides = [Faces::Periodic, Faces::Periodic, Faces::Wall];
        let grid = Grid::new(cells, 1.0, sides)?;
        let mut solver = pool.install(|| Spectral::new(&grid, 1.38))?;
        pool.install(|| report(&grid, &mut solver))?;
    }
    // A factor of the whole grid up to 24^3 cells, multigrid beyond; periodic along x and y, and walls all around.
    let sparse = [(16, 4096), (24, 16_000), (24, 4096), (32, 4096), (64, 4096)];
    for (cells, direct_up_to) in sparse.into_iter().take(if full { 5 } else { 1 }) {
        for sides in [Faces::Periodic, Faces::Wall] {
            let grid = Grid::new([cells; 3], 1.0, [sides, sides, Faces::Wall])?;
            let options = SparseOptions {
                direct_up_to,
                ..SparseOptions::default()
            };
            let mut solver = pool.install(|| Sparse::new(&grid, 1.38, &options))?;
            pool.install(|| report(&grid, &mut solver))?;
        }
    }
    Ok(())
}

/// One line: a solve for a rough force, and one restricted to a sphere of diameter 0.35 of the box.
fn report(grid: &Grid, solver: &mut dyn StokesSolver) -> Result<(), Box<dyn Error + Send + Sync>> {
    let cells = grid.cells();
    let extent = grid.extent();
    let (mut force, mut velocity) = (MacField::zeros(grid), MacField::zeros(grid));
    // Every wavelength, no symmetry.
    for axis in 0..3 {
        for (n, f) in force.component_mut(axis).iter_mut().enumerate() {
            *f = (1e-3 * (n as f64 + 7.0 * axis as f64).powi(2)).sin();
        }
    }
    let sphere = NoSlip::sphere(grid, extent.map(|l| 0.5 * l), 0.175 * extent[0], 0.01)?;
    let forces = vec![1.0; sphere.sites().len()];
    let mut velocities = forces.clone();
    solver.solve(&force, &mut velocity)?;
    let n_before = solver.n_iterations();
    let direct = solver.n_iterations() == 0;
    let n = (if direct {
        10_000_000 / grid.n_cells()
    } else {
        1
    })
    .clamp(1, 300);
    // The fastest of three batches: other programs can only add.
    let time = |work: &mut dyn FnMut() -> Result<(), StokesError>| {
        let mut fastest = f64::INFINITY;
        for _ in 0..3 {
            let clock = CpuClock::start();
            for _ in 0..n {
                work()?;
            }
            fastest = fastest.min(clock.seconds() / n as f64);
        }
        Ok::<_, Box<dyn Error + Send + Sync>>(fastest)
    };
    let whole = time(&mut || solver.solve(&force, &mut velocity))?;
    let n_iterations = (solver.n_iterations() - n_before) / (3 * n as u64);
    let part = time(&mut || solver.solve_at(sphere.sites(), &forces, &mut velocities))?;
    let [n_x, n_y, n_z] = cells;
    println!(
        "{},{:?},{n_x},{n_y},{n_z},{whole:.4},{part:.4},{:.1},{:.0},{n_iterations}",
        solver.name(),
        grid.faces()[0],
        1e9 * whole / grid.n_cells() as f64,
        solver.n_bytes() as f64 / f64::from(1 << 20),
    );
    Ok(())
}
