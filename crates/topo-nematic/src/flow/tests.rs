//! Force and rate against each other, against smooth fields, and on other threads.

use std::f64::consts::TAU;

use fearless_simd::Level;

use super::force::{Director, Window};
use super::rate::Flow;
use super::stencil::{Either, Stencil};
use super::{FlowCoupling, FlowParameters};
use crate::grid::{Faces, Grid};
use crate::material::Material;
use crate::particle::Particle;
use crate::stokes::{Drive, MacField, StokesError};

fn noise(n: usize, seed: u64) -> Vec<f64> {
    crate::noise::noise(seed).take(n).collect()
}

fn place(grid: &Grid, n: usize) -> [usize; 3] {
    let [n_x, n_y, _] = grid.cells();
    [n % n_x, n / n_x % n_y, n / n_x / n_y]
}

/// A divergence-free field that vanishes on the walls: the curl of noise on the edges.
fn solenoidal(grid: &Grid) -> MacField {
    let (cells, faces) = (grid.cells(), grid.faces());
    let mut u = MacField::zeros(grid);
    for axis in 0..3 {
        let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
        let potential = noise(grid.n_cells(), 7 + axis as u64);
        let at = |ijk: [usize; 3]| {
            let on_wall = [a, b]
                .into_iter()
                .any(|c| faces[c] == Faces::Wall && ijk[c] == 0);
            if on_wall {
                0.0
            } else {
                potential[grid.index(ijk)]
            }
        };
        for n in 0..grid.n_cells() {
            let ijk = place(grid, n);
            for (component, across, sign) in [(a, b, 1.0), (b, a, -1.0)] {
                let mut next = ijk;
                next[across] = (next[across] + 1) % cells[across];
                u.component_mut(component)[n] += sign * (at(next) - at(ijk));
            }
        }
    }
    u
}

/// Sum over cells of weight H:R.
fn contraction(h: &[f64], r: &[f64], weights: Option<&[f64]>) -> f64 {
    let n = h.len() / 5;
    (0..n)
        .map(|cell| {
            let at = |field: &[f64], c: usize| field[c * n + cell];
            let diagonal = at(h, 0) * at(r, 0) + at(h, 3) * at(r, 3);
            let last = (at(h, 0) + at(h, 3)) * (at(r, 0) + at(r, 3));
            let off: f64 = [1, 2, 4].into_iter().map(|c| at(h, c) * at(r, c)).sum();
            weights.map_or(1.0, |w| w[cell]) * (diagonal + last + 2.0 * off)
        })
        .sum()
}

#[test]
fn force_is_the_adjoint_of_the_rate() {
    let (p, w) = (Faces::Periodic, Faces::Wall);
    let cases = [
        ([9, 7, 27], [p, p, p]),
        ([8, 5, 13], [p, p, w]),
        ([5, 6, 4], [w, w, w]),
        ([17, 4, 5], [w, p, w]),
        ([4, 12, 12], [p, w, p]),
    ];
    for (cells, faces) in cases {
        let grid = Grid::new(cells, 0.8, faces).unwrap();
        let n = grid.n_cells();
        let (q, h) = (noise(5 * n, 1), noise(5 * n, 2));
        let share: Vec<f64> = noise(n, 3).iter().map(|x| x.max(0.0)).collect();
        let u = solenoidal(&grid);
        let stencil = Stencil::new(&grid, Default::default());
        for weights in [None, Some(share.as_slice())] {
            let mut force = MacField::zeros(&grid);
            let mut windows = [Window::new(&stencil), Window::new(&stencil)];
            let director = Director {
                stencil: &stencil,
                q: Either::Double(&q),
                h: Either::Double(&h),
                weights,
                alignment: 0.7,
            };
            director.force(Level::new(), &mut windows, &mut force);
            let mut rate = vec![0.0; 5 * n];
            let flow = Flow {
                stencil: &stencil,
                velocity: &u,
                weights,
                alignment: 0.7,
            };
            flow.add_rate(Level::new(), &q, &mut rate);
            let (work, loss) = (force.dot(&u), contraction(&h, &rate, weights));
            let scale = force.dot(&force).sqrt() * u.dot(&u).sqrt();
            assert!(
                (work - loss).abs() < 1e-13 * scale,
                "{cells:?} {faces:?}: {work} {loss}"
            );
            assert!(work.abs() > 1e-4 * scale);
        }
    }
}

#[test]
fn rate_converges_to_that_of_smooth_fields() {
    // u = (sin z, 0, cos x) with Q of one component each way; waves of period 1.
    let errors: Vec<f64> = [16, 32]
        .map(|n| {
            let grid = Grid::new([n, 4, n], 1.0 / n as f64, [Faces::Periodic; 3]).unwrap();
            let cells = grid.n_cells();
            let mut u = MacField::zeros(&grid);
            let mut q = vec![0.0; 5 * cells];
            let field = |x: f64, z: f64| {
                [
                    (TAU * x).cos(),
                    0.3 * (TAU * z).sin(),
                    0.5 * (TAU * (x + z)).cos(),
                    0.2,
                    -0.4 * (TAU * x).sin(),
                ]
            };
            for cell in 0..cells {
                let [i, _, k] = place(&grid, cell);
                let [x, _, z] = grid.centre([i, 0, k]);
                u.component_mut(0)[cell] = (TAU * z).sin();
                u.component_mut(2)[cell] = (TAU * x).cos();
                for (c, value) in field(x, z).into_iter().enumerate() {
                    q[c * cells + cell] = value;
                }
            }
            let stencil = Stencil::new(&grid, Default::default());
            let flow = Flow {
                stencil: &stencil,
                velocity: &u,
                weights: None,
                alignment: 0.6,
            };
            let mut rate = vec![1.0; 5 * cells];
            flow.add_rate(Level::new(), &q, &mut rate);
            (0..cells)
                .map(|cell| {
                    let [x, _, z] = grid.centre(place(&grid, cell));
                    let exact = smooth_rate(&field, [x, z], 0.6);
                    (0..5)
                        .map(|c| (rate[c * cells + cell] - 1.0 - exact[c]).abs())
                        .fold(0.0, f64::max)
                })
                .fold(0.0, f64::max)
        })
        .to_vec();
    let order = (errors[0] / errors[1]).log2();
    assert!(order > 1.9 && errors[1] < 0.2, "{errors:?}");
}

/// The equation itself, with nalgebra's matrices.
fn smooth_rate(field: &dyn Fn(f64, f64) -> [f64; 5], [x, z]: [f64; 2], chi: f64) -> [f64; 5] {
    use nalgebra::Matrix3;
    let matrix = |[a, b, c, d, e]: [f64; 5]| Matrix3::new(a, b, c, b, d, e, c, e, -a - d);
    let q = matrix(field(x, z));
    let step = 1e-5;
    let q_x = (matrix(field(x + step, z)) - matrix(field(x - step, z))) / (2.0 * step);
    let q_z = (matrix(field(x, z + step)) - matrix(field(x, z - step))) / (2.0 * step);
    let (u_x, u_z) = ((TAU * z).sin(), (TAU * x).cos());
    let mut w = Matrix3::zeros();
    w[(2, 0)] = TAU * (TAU * z).cos();
    w[(0, 2)] = -TAU * (TAU * x).sin();
    let (d, o) = ((w + w.transpose()) / 2.0, (w - w.transpose()) / 2.0);
    let third = Matrix3::identity() / 3.0;
    let rate = -(q_x * u_x + q_z * u_z) - o * q + q * o + (d * (2.0 / 3.0) + d * q + q * d) * chi
        - (q + third) * (2.0 * chi * (q * d).trace());
    [
        rate[(0, 0)],
        rate[(0, 1)],
        rate[(0, 2)],
        rate[(1, 1)],
        rate[(1, 2)],
    ]
}

/// A pool of so many threads, whatever the machine has.
fn pool(n_threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new()
        .num_threads(n_threads)
        .build()
        .unwrap()
}

/// The cell of a battery of these tests.
fn colloid() -> (Grid, Particle) {
    let faces = [Faces::Periodic, Faces::Periodic, Faces::Wall];
    let grid = Grid::new([16, 16, 20], 1.0, faces).unwrap();
    (grid, Particle::central(&grid, 4.0).unwrap())
}

fn battery(n_threads: usize, parameters: &FlowParameters) -> (FlowCoupling, Vec<f64>, Vec<f64>) {
    let (grid, particle) = colloid();
    let n = grid.n_cells();
    // Anything may lie inside the particle.
    let mut q = noise(5 * n, 11);
    let inside = grid.index([8, 8, 10]);
    q[inside] = f64::NAN;
    let h = noise(5 * n, 12);
    pool(n_threads).install(|| {
        assert_eq!(rayon::current_num_threads(), n_threads);
        let mut flow =
            FlowCoupling::new(&grid, Some(&particle), &Material::default(), parameters).unwrap();
        flow.update(&q, &h).unwrap();
        let mut rate = vec![0.0; 5 * n];
        flow.add_rate(&q, &mut rate);
        assert_eq!((0..5).map(|c| rate[c * n + inside]).sum::<f64>(), 0.0);
        (flow, h, rate)
    })
}

#[test]
fn power_is_what_the_director_loses_around_a_particle() {
    let parameters = FlowParameters::default();
    let (flow, h, rate) = battery(2, &parameters);
    assert!(rate.iter().all(|x| x.is_finite()));
    let weights = flow.weights().unwrap_or_default().to_vec();
    let mut h = h;
    let n = weights.len();
    for (cell, weight) in weights.iter().enumerate() {
        for c in 0..5 {
            h[c * n + cell] *= weight;
        }
    }
    let loss = contraction(&h, &rate, None);
    assert!(
        (flow.power() - loss).abs() < 1e-11 * loss,
        "{} {loss}",
        flow.power()
    );
    // What the boundary residual took is all that separates power and dissipation.
    assert!(
        (flow.dissipation() / flow.power() - 1.0).abs() < 0.02
            && (1e-6..0.01).contains(&flow.boundary_residual())
    );
}

#[test]
fn estimated_bytes_are_within_a_tenth_on_any_number_of_threads() {
    let (parameters, material) = (FlowParameters::default(), Material::default());
    let faces = [Faces::Periodic, Faces::Periodic, Faces::Wall];
    let grid = Grid::new([96, 96, 72], 1.0, faces).unwrap();
    let particle = Particle::central(&grid, 16.0).unwrap();
    for n_threads in [1, 2, 3] {
        let [held, estimate] = pool(n_threads).install(|| {
            let flow = FlowCoupling::new(&grid, Some(&particle), &material, &parameters).unwrap();
            let estimate = FlowCoupling::n_bytes_estimate(&grid, true, &parameters);
            [flow.n_bytes() as f64, estimate as f64]
        });
        let ratio = held / estimate;
        assert!((0.9..1.1).contains(&ratio), "{n_threads}: {ratio}");
    }
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let parameters = FlowParameters::default();
    let (one, _, rate_one) = battery(1, &parameters);
    for n_threads in [2, 3] {
        let (several, _, rate) = battery(n_threads, &parameters);
        assert_eq!(one.velocity(), several.velocity());
        assert_eq!(one.power().to_bits(), several.power().to_bits());
        let mut pairs = rate_one.iter().zip(&rate);
        assert!(pairs.all(|(a, b)| a.to_bits() == b.to_bits()));
    }
}

#[test]
fn broken_input_is_refused() {
    let grid = Grid::new([4; 3], 1.0, [Faces::Periodic; 3]).unwrap();
    let material = Material::default();
    let refusal =
        |parameters: FlowParameters| FlowCoupling::new(&grid, None, &material, &parameters).err();
    let small = FlowParameters {
        memory_limit: 1000,
        ..FlowParameters::default()
    };
    assert!(matches!(
        refusal(small),
        Some(StokesError::Memory { limit: 1000, .. })
    ));
    let drive = Drive {
        body_force: [1.0, 0.0, 0.0],
        ..Drive::default()
    };
    let driven = FlowParameters {
        drive,
        ..FlowParameters::default()
    };
    assert_eq!(refusal(driven), Some(StokesError::Unbalanced));
    let mut flow = FlowCoupling::new(&grid, None, &material, &FlowParameters::default()).unwrap();
    let mut q = noise(320, 1);
    q[100] = f64::NAN;
    assert_eq!(flow.update(&q, &noise(320, 2)), Err(StokesError::NotFinite));
}

#[test]
fn walled_sides_take_the_sparse_solver() {
    let grid = Grid::new([8, 8, 10], 1.0, [Faces::Wall; 3]).unwrap();
    let mut flow = FlowCoupling::new(
        &grid,
        None,
        &Material::default(),
        &FlowParameters::default(),
    )
    .unwrap();
    assert_eq!(flow.solver(), "sparse");
    let n = 5 * grid.n_cells();
    let (q, h) = (noise(n, 1), noise(n, 2));
    flow.update(&q, &h).unwrap();
    let mut rate = vec![0.0; n];
    flow.add_rate(&q, &mut rate);
    let loss = contraction(&h, &rate, None);
    assert!(
        (flow.power() / loss - 1.0).abs() < 1e-6,
        "{} {loss}",
        flow.power()
    );
    assert!((flow.dissipation() / flow.power() - 1.0).abs() < 1e-12);
    assert!(flow.counters().n_iterations > 10);
}

#[test]
fn a_sheared_fluid_has_its_velocity_and_its_curl() {
    // Plates moving along x and y: u = (0.3, -0.2, 0) (2z/d - 1), curl u = (0.2, 0.3, 0) 2/d, exact on any grid.
    let faces = [Faces::Periodic, Faces::Periodic, Faces::Wall];
    let grid = Grid::new([6, 4, 10], 0.5, faces).unwrap();
    let mut parameters = FlowParameters::default();
    parameters.drive.wall_velocity[2] = [[-0.3, 0.2, 0.0], [0.3, -0.2, 0.0]];
    let mut flow = FlowCoupling::new(&grid, None, &Material::default(), &parameters).unwrap();
    let n = grid.n_cells();
    let still = vec![0.0; 5 * n];
    flow.update(&still, &still).unwrap();
    let (velocity, curl) = (flow.centred_velocity(), flow.vorticity());
    for cell in 0..n {
        let share = 2.0 * grid.centre(place(&grid, cell))[2] / 5.0 - 1.0;
        let exact = [0.3 * share, -0.2 * share, 0.0, 0.08, 0.12, 0.0];
        let found = [&velocity, &curl].map(|v| [0, 1, 2].map(|axis| v[axis * n + cell]));
        for (found, exact) in found.concat().iter().zip(exact) {
            assert!((found - exact).abs() < 1e-9, "{cell}: {found} {exact}");
        }
    }
    assert!(
        (flow.max_speed() - 0.27 * 1.0).abs() < 1e-9,
        "{}",
        flow.max_speed()
    );
}
