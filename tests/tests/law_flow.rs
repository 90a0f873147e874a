//! Director and flow together: no energy is lost between them.

use std::f64::consts::TAU;

use topo_nematic::flow::{FlowCoupling, FlowSolver};
use topo_nematic::stokes::Drive;
use topo_nematic::tensor::contract;
use topo_nematic::{Faces, FlowParameters, Grid, Material, Particle};

const P: Faces = Faces::Periodic;
const W: Faces = Faces::Wall;

/// A plain nematic to test with: bulk energy, links between neighbouring fluid cells, plates that hold Q, nothing on the particle.
struct Nematic {
    grid: Grid,
    material: Material,
    fluid: Vec<bool>,
    wall: [f64; 5],
}

impl Nematic {
    fn tensor(&self, q: &[f64], cell: usize) -> [f64; 5] {
        std::array::from_fn(|c| q[c * self.grid.n_cells() + cell])
    }

    /// Neighbours above along each axis: the cell, or a wall at half the distance; and walls below.
    fn links(&self, cell: usize) -> Vec<Option<usize>> {
        let cells = self.grid.cells();
        let [n_x, n_y, _] = cells;
        let ijk = [cell % n_x, cell / n_x % n_y, cell / n_x / n_y];
        let mut links = Vec::new();
        for axis in 0..3 {
            let mut next = ijk;
            next[axis] = (ijk[axis] + 1) % cells[axis];
            let walled = self.grid.faces()[axis] == W;
            if walled && ijk[axis] == 0 {
                links.push(None);
            }
            if walled && next[axis] == 0 {
                links.push(None);
            } else if self.fluid[self.grid.index(next)] {
                links.push(Some(self.grid.index(next)));
            }
        }
        links
    }

    fn energy(&self, q: &[f64]) -> f64 {
        let (h, m) = (self.grid.spacing(), &self.material);
        let mut energy = 0.0;
        for cell in (0..self.fluid.len()).filter(|&cell| self.fluid[cell]) {
            let here = self.tensor(q, cell);
            let square = contract(&here, &here);
            energy += m.a / 2.0 * square + m.b / 3.0 * cube(here) + m.c / 4.0 * square * square;
            for link in self.links(cell) {
                let (other, share) = match link {
                    Some(next) => (self.tensor(q, next), 1.0),
                    None => (self.wall, 2.0),
                };
                let d: [f64; 5] = std::array::from_fn(|c| here[c] - other[c]);
                energy += share * m.elastic_constant / (2.0 * h * h) * contract(&d, &d);
            }
        }
        energy * h.powi(3)
    }

    /// Minus the traceless derivative of the energy, per volume.
    fn molecular_field(&self, q: &[f64]) -> Vec<f64> {
        let (h, m, n) = (self.grid.spacing(), &self.material, self.fluid.len());
        let mut field = vec![0.0; 5 * n];
        for cell in (0..n).filter(|&cell| self.fluid[cell]) {
            let here = self.tensor(q, cell);
            let square = contract(&here, &here);
            let quadratic = square_traceless(here);
            for c in 0..5 {
                field[c * n + cell] -= m.a * here[c] + m.b * quadratic[c] + m.c * square * here[c];
            }
            for link in self.links(cell) {
                for c in 0..5 {
                    let stiffness = m.elastic_constant / (h * h);
                    match link {
                        Some(next) => {
                            let pull = stiffness * (q[c * n + next] - here[c]);
                            field[c * n + cell] += pull;
                            field[c * n + next] -= pull;
                        }
                        None => field[c * n + cell] += 2.0 * stiffness * (self.wall[c] - here[c]),
                    }
                }
            }
        }
        field
    }

    /// A smooth field without symmetry.
    fn start(&self) -> Vec<f64> {
        let (n, cells) = (self.grid.n_cells(), self.grid.cells());
        let mut q = vec![0.0; 5 * n];
        for cell in 0..n {
            let place = [
                cell % cells[0],
                cell / cells[0] % cells[1],
                cell / cells[0] / cells[1],
            ];
            let [x, y, z]: [f64; 3] =
                std::array::from_fn(|axis| TAU * (place[axis] as f64 + 0.5) / cells[axis] as f64);
            let waves = [
                0.3 * (x + y).sin() - 0.2,
                0.3 * z.cos() * y.sin(),
                0.2 * (x - z).cos(),
                0.2 * (y + 2.0 * z).sin() - 0.2,
                0.25 * (x + 0.3).sin() * z.sin(),
            ];
            for c in 0..5 {
                q[c * n + cell] = waves[c];
            }
        }
        q
    }
}

/// Traceless part of Q^2.
fn square_traceless(q: [f64; 5]) -> [f64; 5] {
    let m = matrix(q);
    let square = m * m - nalgebra::Matrix3::identity() * ((m * m).trace() / 3.0);
    [
        square[(0, 0)],
        square[(0, 1)],
        square[(0, 2)],
        square[(1, 1)],
        square[(1, 2)],
    ]
}

fn cube(q: [f64; 5]) -> f64 {
    let m = matrix(q);
    (m * m * m).trace()
}

fn matrix([xx, xy, xz, yy, yz]: [f64; 5]) -> nalgebra::Matrix3<f64> {
    nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, -xx - yy)
}

/// Relative error of dF/dt = -int Gamma H:H - f.u, with dF/dt by central differences of the energy along the rate.
fn residual(faces: [Faces; 3], with_particle: bool, solver: FlowSolver, drive: Drive) -> f64 {
    let grid = Grid::new([12, 14, 16], 0.9, faces).unwrap();
    let particle = with_particle.then(|| Particle::central(&grid, 3.2).unwrap());
    let n = grid.n_cells();
    let nematic = Nematic {
        grid,
        material: Material::default(),
        fluid: particle.map_or_else(
            || vec![true; n],
            |p| p.mask(&grid).iter().map(|s| !s).collect(),
        ),
        wall: [-0.27, 0.0, 0.0, -0.27, 0.0],
    };
    let parameters = FlowParameters {
        solver,
        drive,
        solver_tolerance: 1e-11,
        ..FlowParameters::default()
    };
    let mut flow =
        FlowCoupling::new(&grid, particle.as_ref(), &nematic.material, &parameters).unwrap();
    let q = nematic.start();
    let h = nematic.molecular_field(&q);
    flow.update(&q, &h).unwrap();
    let mut rate: Vec<f64> = h.clone();
    flow.add_rate(&q, &mut rate);
    let at = |step: f64| -> Vec<f64> { q.iter().zip(&rate).map(|(q, r)| q + step * r).collect() };
    let energy = |step: f64| nematic.energy(&at(step));
    // Fourth order in a step at which rounding is as small.
    let step = 1e-3;
    let change = (8.0 * (energy(step) - energy(-step))
        - (energy(2.0 * step) - energy(-2.0 * step)))
        / (12.0 * step);
    let relaxed: f64 = (0..n)
        .map(|cell| contract(&nematic.tensor(&h, cell), &nematic.tensor(&h, cell)))
        .sum::<f64>()
        * grid.spacing().powi(3);
    assert!(
        flow.power().abs() > 1e-2 * relaxed,
        "the flow must matter: {} {relaxed}",
        flow.power()
    );
    let error = (change + relaxed + flow.power()).abs() / flow.power().abs();
    println!(
        "{faces:?}, particle {with_particle}: dF/dt {change:.6}, relaxation {relaxed:.6}, f.u {:.6}, error {error:.1e}",
        flow.power()
    );
    error
}

#[test]
fn law_flow_takes_the_energy_that_the_director_loses() {
    let rest = Drive::default();
    for (faces, solver) in [
        ([P, P, W], FlowSolver::Spectral),
        ([P, P, P], FlowSolver::Spectral),
        ([W, P, W], FlowSolver::Sparse),
    ] {
        for with_particle in [false, true] {
            let error = residual(faces, with_particle, solver, rest);
            assert!(error < 1e-6, "{faces:?} {with_particle}: {error:e}");
        }
    }
    // A body force drives a flow of its own: f.u then counts what the director gives to all of it.
    let pushed = Drive {
        body_force: [0.01, 0.02, 0.0],
        ..rest
    };
    let error = residual([P, P, W], true, FlowSolver::Spectral, pushed);
    assert!(error < 1e-6, "{error:e}");
}

#[test]
fn law_dissipation_is_what_drives_put_in() {
    // Director, body force and a plate together: f.u, their work and the boundary residual add up to the viscous loss, taken here
    // from the velocity itself.
    let grid = Grid::new([12, 12, 14], 1.0, [P, P, W]).unwrap();
    let mut drive = Drive {
        body_force: [0.05, 0.0, 0.0],
        ..Drive::default()
    };
    drive.wall_velocity[2] = [[0.0; 3], [0.3, -0.2, 0.0]];
    let parameters = FlowParameters {
        drive,
        ..FlowParameters::default()
    };
    let particle = Particle::central(&grid, 3.0).unwrap();
    let material = Material::default();
    let mut flow = FlowCoupling::new(&grid, Some(&particle), &material, &parameters).unwrap();
    let n = grid.n_cells();
    let field = |shift: f64| -> Vec<f64> {
        (0..5 * n)
            .map(|i| 0.3 * (0.37 * i as f64 + shift).sin())
            .collect()
    };
    flow.update(&field(0.0), &field(1.0)).unwrap();
    let [n_x, n_y, n_z] = grid.cells();
    let mut loss = 0.0;
    for component in 0..3 {
        let u = flow.velocity().component(component);
        for cell in 0..n {
            let ijk = [cell % n_x, cell / n_x % n_y, cell / n_x / n_y];
            for axis in 0..3 {
                let mut next = ijk;
                next[axis] = (ijk[axis] + 1) % [n_x, n_y, n_z][axis];
                let difference = u[grid.index(next)] - u[cell];
                let at_top = axis == 2 && next[2] == 0;
                if component != 2 && axis == 2 && (at_top || ijk[2] == 0) {
                    // Half a cell to each plate.
                    for (side, here) in [(0, ijk[2] == 0), (1, at_top)] {
                        if here {
                            let slip = u[cell] - drive.wall_velocity[2][side][component];
                            loss += 2.0 * slip * slip;
                        }
                    }
                    if at_top {
                        continue;
                    }
                }
                loss += difference * difference;
            }
        }
    }
    loss *= material.viscosity * grid.spacing();
    assert!(
        (flow.dissipation() / loss - 1.0).abs() < 1e-10,
        "{} {loss}",
        flow.dissipation()
    );
}
