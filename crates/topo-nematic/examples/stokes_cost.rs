//! Time and memory of the flow solvers against grid size: `cargo run --release -p topo-nematic --example stokes_cost`.

use std::error::Error;

use topo_core::CpuClock;
use topo_nematic::{Faces, Grid, MacField, NoSlip, Spectral, StokesSolver};

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    println!(
        "solver,n_x,n_y,n_z,cpu_seconds_a_solve,cpu_seconds_at_particle,ns_a_cell,mebibytes,iterations"
    );
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    for cells in [[32, 32, 32], [64, 64, 64], [100, 100, 75], [200, 200, 150]] {
        let sides = [Faces::Periodic, Faces::Periodic, Faces::Wall];
        let grid = Grid::new(cells, 1.0, sides)?;
        let mut solver = pool.install(|| Spectral::new(&grid, 1.38))?;
        pool.install(|| report(&grid, &mut solver))?;
    }
    Ok(())
}

/// One line: a solve for a smooth force, and one restricted to a sphere of diameter 0.35 of the box.
fn report(grid: &Grid, solver: &mut dyn StokesSolver) -> Result<(), Box<dyn Error + Send + Sync>> {
    let cells = grid.cells();
    let extent = grid.extent();
    let (mut force, mut velocity) = (MacField::zeros(grid), MacField::zeros(grid));
    for (n, f) in force.component_mut(0).iter_mut().enumerate() {
        let z = (n / (cells[0] * cells[1])) as f64 * grid.spacing();
        *f = (std::f64::consts::TAU * z / extent[2]).sin();
    }
    let sphere = NoSlip::sphere(grid, extent.map(|l| 0.5 * l), 0.175 * extent[0], 0.01)?;
    let forces = vec![1.0; sphere.sites().len()];
    let mut velocities = forces.clone();
    solver.solve(&force, &mut velocity)?;
    let n_before = solver.n_iterations();
    let n = (20_000_000 / grid.n_cells()).clamp(3, 50);
    // The fastest of several: other programs can only add.
    let time = |work: &mut dyn FnMut() -> Result<(), topo_nematic::StokesError>| {
        let mut fastest = f64::INFINITY;
        for _ in 0..n {
            let clock = CpuClock::start();
            work()?;
            fastest = fastest.min(clock.seconds());
        }
        Ok::<_, Box<dyn Error + Send + Sync>>(fastest)
    };
    let whole = time(&mut || solver.solve(&force, &mut velocity))?;
    let n_iterations = (solver.n_iterations() - n_before) / n as u64;
    let part = time(&mut || solver.solve_at(sphere.sites(), &forces, &mut velocities))?;
    let [n_x, n_y, n_z] = cells;
    println!(
        "{},{n_x},{n_y},{n_z},{whole:.4},{part:.4},{:.1},{:.0},{n_iterations}",
        solver.name(),
        1e9 * whole / grid.n_cells() as f64,
        solver.n_bytes() as f64 / f64::from(1 << 20),
    );
    Ok(())
}
