//! The spectral solver against the equations, closed forms, and itself on other threads.

use std::f64::consts::TAU;

use super::*;
use crate::stokes::Drive;

fn grid(cells: [usize; 3], h: f64, z: Faces) -> Grid {
    Grid::new(cells, h, [Faces::Periodic, Faces::Periodic, z]).unwrap()
}

fn noise(grid: &Grid) -> MacField {
    let mut field = MacField::zeros(grid);
    let mut noise = crate::noise::noise(1);
    for component in field.components_mut() {
        component
            .iter_mut()
            .zip(&mut noise)
            .for_each(|(x, y)| *x = y);
    }
    field
}

/// η lap u + f, which must be a gradient, on the faces.
fn imbalance(grid: &Grid, viscosity: f64, u: &MacField, f: &MacField) -> MacField {
    let mut out = MacField::zeros(grid);
    let (cells, faces, h) = (grid.cells(), grid.faces(), grid.spacing());
    for component in 0..3 {
        for n in 0..grid.n_cells() {
            let ijk = [
                n % cells[0],
                n / cells[0] % cells[1],
                n / cells[0] / cells[1],
            ];
            let values = u.component(component);
            if faces[component] == Faces::Wall && ijk[component] == 0 {
                continue;
            }
            let mut sum = 0.0;
            for axis in 0..3 {
                for up in [false, true] {
                    let mut next = ijk;
                    let edge = if up { cells[axis] - 1 } else { 0 };
                    let ghost =
                        ijk[axis] == edge && faces[axis] == Faces::Wall && axis != component;
                    next[axis] = (ijk[axis] + if up { 1 } else { cells[axis] - 1 }) % cells[axis];
                    let value = if ghost {
                        -values[n]
                    } else {
                        values[grid.index(next)]
                    };
                    sum += value - values[n];
                }
            }
            out.component_mut(component)[n] = viscosity * sum / (h * h) + f.component(component)[n];
        }
    }
    out
}

/// Largest circulation of `field` around the edges of the cells: zero for a gradient.
fn circulation(grid: &Grid, field: &MacField) -> f64 {
    let cells = grid.cells();
    let mut largest = 0.0_f64;
    for n in 0..grid.n_cells() {
        let ijk = [
            n % cells[0],
            n / cells[0] % cells[1],
            n / cells[0] / cells[1],
        ];
        for [a, b] in [[0, 1], [1, 2], [2, 0]] {
            let on_wall = |axis: usize| grid.faces()[axis] == Faces::Wall && ijk[axis] == 0;
            if on_wall(a) || on_wall(b) {
                continue;
            }
            let before = |axis: usize| {
                let mut m = ijk;
                m[axis] = (m[axis] + cells[axis] - 1) % cells[axis];
                grid.index(m)
            };
            let (f_a, f_b) = (field.component(a), field.component(b));
            largest = largest.max((f_a[n] - f_a[before(b)] - f_b[n] + f_b[before(a)]).abs());
        }
    }
    largest
}

#[test]
fn velocity_solves_the_discrete_equations() {
    for (z, cells) in [Faces::Wall, Faces::Periodic]
        .into_iter()
        .flat_map(|z| [(z, [8, 20, 9]), (z, [7, 5, 4]), (z, [4, 33, 12])])
    {
        let grid = grid(cells, 0.7, z);
        let mut solver = Spectral::new(&grid, 1.3).unwrap();
        let force = noise(&grid);
        let mut u = noise(&grid);
        solver.solve(&force, &mut u).unwrap();
        let outflow = (0..grid.n_cells())
            .map(|n| {
                [
                    n % cells[0],
                    n / cells[0] % cells[1],
                    n / cells[0] / cells[1],
                ]
            })
            .fold(0.0, |max: f64, ijk| max.max(u.net_outflow(ijk).abs()));
        assert!(outflow < 1e-13, "{outflow:e}");
        let rest = imbalance(&grid, 1.3, &u, &force);
        assert!(circulation(&grid, &rest) < 1e-11, "{z:?} {cells:?}");
        assert!(circulation(&grid, &force) > 1.0 && u.max_abs() > 0.1);
        if z == Faces::Periodic {
            for axis in 0..3 {
                assert!(u.component(axis).iter().sum::<f64>().abs() < 1e-12);
            }
        }
    }
}

#[test]
fn the_map_from_force_to_velocity_is_symmetric() {
    let grid = grid([8, 6, 10], 1.0, Faces::Wall);
    let mut solver = Spectral::new(&grid, 1.0).unwrap();
    let f = noise(&grid);
    let mut g = noise(&grid);
    for axis in 0..3 {
        g.component_mut(axis).reverse();
    }
    let (mut u, mut v) = (MacField::zeros(&grid), MacField::zeros(&grid));
    solver.solve(&f, &mut u).unwrap();
    solver.solve(&g, &mut v).unwrap();
    let (a, b) = (u.dot(&g), v.dot(&f));
    assert!((a - b).abs() < 1e-12 * u.dot(&f), "{a} {b}");
}

#[test]
fn result_does_not_depend_on_the_number_of_threads() {
    let grid = grid([12, 10, 14], 1.0, Faces::Wall);
    let force = noise(&grid);
    let with = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(n)
            .build()
            .unwrap();
        pool.install(|| {
            let mut u = MacField::zeros(&grid);
            Spectral::new(&grid, 1.0)
                .unwrap()
                .solve(&force, &mut u)
                .unwrap();
            u
        })
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn plates_that_move_shear_the_fluid() {
    let grid = grid([4, 6, 9], 0.5, Faces::Wall);
    let mut solver = Spectral::new(&grid, 2.0).unwrap();
    let mut drive = Drive::default();
    drive.wall_velocity[2] = [[1.0, 0.0, 0.0], [-0.5, 2.0, 0.0]];
    drive.check(&grid).unwrap();
    let (mut force, mut u) = (MacField::zeros(&grid), MacField::zeros(&grid));
    drive.add_force(&grid, 2.0, &mut force);
    solver.solve(&force, &mut u).unwrap();
    for n in 0..grid.n_cells() {
        let s = (n / 24) as f64 / 9.0 + 0.5 / 9.0;
        let exact = [1.0 - 1.5 * s, 2.0 * s, 0.0];
        for axis in 0..3 {
            assert!((u.component(axis)[n] - exact[axis]).abs() < 1e-13);
        }
    }
    // Work of the plates: eta (dU/d)^2 times the volume.
    let power = drive.power(&grid, 2.0, &u);
    let exact = 2.0 * (1.5_f64.powi(2) + 4.0) / 4.5_f64.powi(2) * (2.0 * 3.0 * 4.5);
    assert!((power - exact).abs() < 1e-12 * exact, "{power} {exact}");
}

#[test]
fn long_waves_on_tall_grids_keep_their_digits() {
    let grid = grid([64, 4, 64], 1.0, Faces::Periodic);
    let mut solver = Spectral::new(&grid, 1.0).unwrap();
    let k = TAU / 64.0;
    let (mut force, mut u) = (MacField::zeros(&grid), MacField::zeros(&grid));
    for n in 0..grid.n_cells() {
        force.component_mut(1)[n] = (k * ((n % 64) as f64 + 0.5)).cos();
    }
    solver.solve(&force, &mut u).unwrap();
    let decay = 4.0 * (0.5 * k).sin().powi(2);
    for n in 0..grid.n_cells() {
        let exact = (k * ((n % 64) as f64 + 0.5)).cos() / decay;
        assert!((u.component(1)[n] - exact).abs() < 1e-11);
    }
}

#[test]
fn walled_sides_and_bad_numbers_are_refused() {
    let walled = Grid::new([4; 3], 1.0, [Faces::Periodic, Faces::Wall, Faces::Wall]).unwrap();
    let refusal = Spectral::new(&walled, 1.0).err();
    assert_eq!(refusal, Some(StokesError::Walls { axis: 1 }));
    let grid = grid([4; 3], 1.0, Faces::Periodic);
    assert!(Spectral::new(&grid, 0.0).is_err() && Spectral::new(&grid, f64::NAN).is_err());
    let body = Drive {
        body_force: [0.0, 1.0, 0.0],
        ..Drive::default()
    };
    assert_eq!(body.check(&grid), Err(StokesError::Unbalanced));
    assert_eq!(body.check(&walled), Ok(()));
    let mean = Drive {
        mean_velocity: [1.0, 0.0, 0.0],
        ..Drive::default()
    };
    assert_eq!(mean.check(&walled), Err(StokesError::MeanVelocity));
    let mut wall = Drive::default();
    wall.wall_velocity[2][1] = [0.0, 0.0, 1.0];
    assert!(matches!(
        wall.check(&walled),
        Err(StokesError::WallVelocity {
            axis: 2,
            side: "upper"
        })
    ));
    wall.wall_velocity[2][1] = [f64::NAN, 0.0, 0.0];
    assert!(wall.check(&walled).is_err());
}
