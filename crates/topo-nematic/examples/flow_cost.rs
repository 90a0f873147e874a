//! Time of the flow terms against that of copying their data: `cargo run --release -p topo-nematic --example flow_cost`;
//! `-- full` goes on to the published grid.

use std::error::Error;
use std::hint::black_box;

use topo_core::CpuClock;
use topo_nematic::flow::FlowCoupling;
use topo_nematic::{Faces, FlowParameters, Grid, Material, Particle};

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    println!(
        "n_x,n_y,n_z,particle,copy_ns_a_cell,rate_ns_a_cell,rate_f32_ns_a_cell,update_seconds,boundary_solves,mebibytes"
    );
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let full = std::env::args().any(|a| a == "full");
    let grids = [[32, 32, 24], [64, 64, 48], [200, 200, 150]];
    for cells in grids.into_iter().take(if full { 3 } else { 1 }) {
        for with_particle in [false, true] {
            pool.install(|| report(cells, with_particle))?;
        }
    }
    Ok(())
}

fn report(cells: [usize; 3], with_particle: bool) -> Result<(), Box<dyn Error + Send + Sync>> {
    let sides = [Faces::Periodic, Faces::Periodic, Faces::Wall];
    let grid = Grid::new(cells, 1.5, sides)?;
    let radius = 0.175 * grid.extent()[0];
    let particle = with_particle
        .then(|| Particle::central(&grid, radius))
        .transpose()?;
    let mut flow = FlowCoupling::new(
        &grid,
        particle.as_ref(),
        &Material::default(),
        &FlowParameters::default(),
    )?;
    let n = grid.n_cells();
    let wave = |shift: f64| -> Vec<f64> {
        (0..5 * n)
            .map(|i| (i as f64 * 1e-3 + shift).sin())
            .collect()
    };
    let (q, h) = (wave(0.0), wave(1.0));
    let single: Vec<f32> = q.iter().map(|x| *x as f32).collect();
    let mut rate = vec![0.0; 5 * n];
    let mut rate_f32 = vec![0.0_f32; 5 * n];
    flow.update(&q, &h)?;
    let n_boundary_solves = flow.counters().n_boundary_solves;
    flow.update(&q, &h)?;
    let clock = CpuClock::start();
    flow.update(&q, &h)?;
    let update = clock.seconds();
    let repeat = (12_000_000 / n).clamp(2, 60);
    // The fastest of three batches: other programs can only add.
    let time = |work: &mut dyn FnMut()| {
        let seconds = (0..3).map(|_| {
            let clock = CpuClock::start();
            (0..repeat).for_each(|_| work());
            clock.seconds() / repeat as f64
        });
        1e9 * seconds.fold(f64::INFINITY, f64::min) / n as f64
    };
    let copy = time(&mut || {
        rate.copy_from_slice(black_box(&q));
        black_box(&mut rate);
    });
    let whole = time(&mut || flow.add_rate(&q, &mut rate));
    let half = time(&mut || flow.add_rate(&single, &mut rate_f32));
    let [n_x, n_y, n_z] = cells;
    println!(
        "{n_x},{n_y},{n_z},{with_particle},{copy:.1},{whole:.1},{half:.1},{update:.3},{},{:.0}",
        n_boundary_solves,
        flow.n_bytes() as f64 / f64::from(1 << 20),
    );
    Ok(())
}
