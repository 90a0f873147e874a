//! The sparse solver against the spectral one, and its parts.

use super::operator::Operator;
use super::*;
use crate::stokes::{NoSlip, Spectral};

const P: Faces = Faces::Periodic;
const W: Faces = Faces::Wall;

fn noise(n: usize, seed: u64) -> Vec<f64> {
    crate::noise::noise(seed).take(n).collect()
}

fn random_force(grid: &Grid) -> MacField {
    let mut force = MacField::zeros(grid);
    for axis in 0..3 {
        force
            .component_mut(axis)
            .copy_from_slice(&noise(grid.n_cells(), 5 + axis as u64));
    }
    force
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[test]
fn agrees_with_the_spectral_solver() {
    for (cells, z, direct_up_to) in [
        ([8, 6, 10], W, 10_000),
        ([12, 16, 9], W, 200),
        ([9, 8, 12], P, 10_000),
        ([16, 12, 14], P, 200),
    ] {
        let grid = Grid::new(cells, 0.6, [P, P, z]).unwrap();
        let options = SparseOptions {
            direct_up_to,
            tolerance: 1e-11,
            ..SparseOptions::default()
        };
        let mut sparse = Sparse::new(&grid, 1.38, &options).unwrap();
        let mut spectral = Spectral::new(&grid, 1.38).unwrap();
        let force = random_force(&grid);
        let (mut a, mut b) = (MacField::zeros(&grid), MacField::zeros(&grid));
        sparse.solve(&force, &mut a).unwrap();
        spectral.solve(&force, &mut b).unwrap();
        let scale = b.max_abs();
        for axis in 0..3 {
            for (a, b) in a.component(axis).iter().zip(b.component(axis)) {
                assert!((a - b).abs() < 1e-9 * scale, "{cells:?} {z:?}");
            }
        }
        assert!(sparse.n_iterations() < 75, "{}", sparse.n_iterations());
    }
}

#[test]
fn walls_all_around_leave_no_outflow_and_a_symmetric_map() {
    for cells in [[7, 8, 9], [20, 16, 14]] {
        let grid = Grid::new(cells, 1.0, [W; 3]).unwrap();
        let options = SparseOptions {
            tolerance: 1e-12,
            direct_up_to: 600,
            ..SparseOptions::default()
        };
        let mut sparse = Sparse::new(&grid, 1.0, &options).unwrap();
        let f = random_force(&grid);
        let mut g = MacField::zeros(&grid);
        for axis in 0..3 {
            g.component_mut(axis)
                .copy_from_slice(f.component((axis + 1) % 3));
        }
        let (mut u, mut v) = (MacField::zeros(&grid), MacField::zeros(&grid));
        sparse.solve(&f, &mut u).unwrap();
        sparse.solve(&g, &mut v).unwrap();
        let (a, b) = (u.dot(&g), v.dot(&f));
        assert!((a - b).abs() < 1e-9 * u.dot(&f), "{a} {b}");
        for n in 0..grid.n_cells() {
            let ijk = [
                n % cells[0],
                n / cells[0] % cells[1],
                n / cells[0] / cells[1],
            ];
            assert!(u.net_outflow(ijk).abs() < 1e-10 * u.max_abs());
        }
    }
}

#[test]
fn iterations_do_not_grow_with_the_grid() {
    let n_iterations = [16, 32].map(|n| {
        let grid = Grid::new([n; 3], 1.0, [W, P, W]).unwrap();
        let options = SparseOptions {
            direct_up_to: 600,
            ..SparseOptions::default()
        };
        let mut sparse = Sparse::new(&grid, 1.0, &options).unwrap();
        let mut u = MacField::zeros(&grid);
        sparse.solve(&random_force(&grid), &mut u).unwrap();
        sparse.n_iterations()
    });
    assert!(
        n_iterations[1] <= n_iterations[0] + 8 && n_iterations[1] < 75,
        "{n_iterations:?}"
    );
}

#[test]
fn multigrid_is_symmetric_and_nearly_inverts() {
    for (cells, faces) in [
        ([16, 12, 20], [W; 3]),
        ([13, 17, 11], [W, P, W]),
        ([16, 9, 12], [P; 3]),
    ] {
        let grid = Grid::new(cells, 1.0, faces).unwrap();
        for component in 0..3 {
            let operator = Operator::new(&grid, component);
            let mut multigrid = Multigrid::new(operator, 100).unwrap();
            let n = grid.n_cells();
            let (mut a, mut b) = (noise(n, 3), noise(n, 4));
            for x in [&mut a, &mut b] {
                operator.clear_walls(x);
                if operator.is_singular() {
                    remove_mean(x);
                }
            }
            let (mut m_a, mut m_b) = (vec![0.0; n], vec![0.0; n]);
            multigrid.cycle(&a, &mut m_a);
            multigrid.cycle(&b, &mut m_b);
            let (left, right) = (dot(&m_a, &b), dot(&m_b, &a));
            assert!(
                (left - right).abs() < 1e-12 * dot(&m_a, &a),
                "{left} {right}"
            );
            // A cycle leaves less than half of any field, in the norm of the operator.
            let (mut image, mut back) = (vec![0.0; n], vec![0.0; n]);
            operator.apply(&m_b, &mut image);
            let whole = dot(&m_b, &image);
            multigrid.cycle(&image, &mut back);
            for (x, y) in back.iter_mut().zip(&m_b) {
                *x -= y;
            }
            operator.apply(&back, &mut image);
            let left = dot(&back, &image);
            assert!(
                left < 0.25 * whole,
                "{cells:?} {component}: {left} of {whole}"
            );
        }
    }
}

#[test]
fn a_particle_in_a_walled_box_is_held() {
    let grid = Grid::new([12; 3], 1.0, [W; 3]).unwrap();
    let mut sparse = Sparse::new(&grid, 1.0, &SparseOptions::default()).unwrap();
    let force = random_force(&grid);
    let mut u = MacField::zeros(&grid);
    sparse.solve(&force, &mut u).unwrap();
    let mut no_slip = NoSlip::sphere(&grid, [6.0; 3], 3.0, 1e-3).unwrap();
    let report = no_slip.solve(&mut sparse, &u).unwrap();
    assert!(report.residual <= 1e-3 && sparse.n_solves() == [1, report.n_iterations as u64]);
}

#[test]
fn refuses_too_much_memory_with_the_estimate() {
    let grid = Grid::new([256; 3], 1.0, [W; 3]).unwrap();
    let options = SparseOptions {
        memory_limit: 1 << 30,
        ..SparseOptions::default()
    };
    let refusal = Sparse::new(&grid, 1.0, &options).err();
    assert!(matches!(refusal, Some(StokesError::Memory { estimate, .. }) if estimate > 4 << 30));
    // The estimate is about what is held.
    let grid = Grid::new([24; 3], 1.0, [W; 3]).unwrap();
    for direct_up_to in [500, 100_000] {
        let options = SparseOptions {
            direct_up_to,
            ..SparseOptions::default()
        };
        let held = Sparse::new(&grid, 1.0, &options).unwrap().n_bytes() as f64;
        let ratio = Sparse::n_bytes_estimate(&grid, &options) as f64 / held;
        assert!((0.7..1.6).contains(&ratio), "{ratio}");
    }
    let broken = SparseOptions {
        tolerance: f64::NAN,
        ..SparseOptions::default()
    };
    assert!(matches!(
        Sparse::new(&grid, 1.0, &broken),
        Err(StokesError::Value(_))
    ));
    let mut sparse = Sparse::new(&grid, 1.0, &SparseOptions::default()).unwrap();
    let mut force = random_force(&grid);
    force.component_mut(1)[77] = f64::NAN;
    let mut u = MacField::zeros(&grid);
    assert_eq!(sparse.solve(&force, &mut u), Err(StokesError::NotFinite));
}
