//! The sphere at rest.

use super::*;
use crate::stokes::{Drive, Spectral};

#[test]
fn particle_holds_the_fluid_at_its_boundary() {
    let grid = Grid::new(
        [16, 16, 16],
        1.0,
        [Faces::Periodic, Faces::Periodic, Faces::Wall],
    )
    .unwrap();
    let mut solver = Spectral::new(&grid, 1.38).unwrap();
    let mut no_slip = NoSlip::sphere(&grid, [8.0; 3], 4.0, 1e-6).unwrap();
    let drive = Drive {
        body_force: [1.0, 0.5, 0.0],
        ..Drive::default()
    };
    let (mut force, mut velocity) = (MacField::zeros(&grid), MacField::zeros(&grid));
    drive.add_force(&grid, 1.38, &mut force);
    solver.solve(&force, &mut velocity).unwrap();
    let free = velocity.max_abs();
    let report = no_slip.solve(&mut solver, &velocity).unwrap();
    assert!(
        report.n_iterations > 3 && report.residual < 1e-6,
        "{report:?}"
    );
    no_slip.sites().add_to(no_slip.forces(), &mut force);
    solver.solve(&force, &mut velocity).unwrap();
    let mut held = vec![0.0; no_slip.sites().len()];
    no_slip.sites().gather(&velocity, &mut held);
    assert!(held.iter().all(|u| u.abs() < 1e-5 * free));
    // Nothing moves inside either.
    let inside = velocity.at_centre([8, 8, 8]);
    assert!(inside.iter().all(|u| u.abs() < 1e-4 * free), "{inside:?}");
    // The same flow again needs no iteration.
    force.clear();
    drive.add_force(&grid, 1.38, &mut force);
    solver.solve(&force, &mut velocity).unwrap();
    assert_eq!(
        no_slip.solve(&mut solver, &velocity).unwrap().n_iterations,
        0
    );
}

#[test]
fn forces_at_sites_give_what_the_whole_field_gives() {
    for side in [Faces::Wall, Faces::Periodic] {
        let grid = Grid::new([9, 8, 10], 0.5, [Faces::Periodic, Faces::Periodic, side]).unwrap();
        let mut solver = Spectral::new(&grid, 0.7).unwrap();
        let no_slip = NoSlip::sphere(&grid, [0.3, 2.0, 2.4], 1.1, 1e-6).unwrap();
        let sites = no_slip.sites();
        let forces: Vec<f64> = (0..sites.len())
            .map(|n| (n * 37 % 19) as f64 - 9.0)
            .collect();
        let (mut force, mut velocity) = (MacField::zeros(&grid), MacField::zeros(&grid));
        sites.scatter(&forces, &mut force);
        solver.solve(&force, &mut velocity).unwrap();
        let (mut whole, mut part) = (vec![0.0; sites.len()], vec![0.0; sites.len()]);
        sites.gather(&velocity, &mut whole);
        solver.solve_at(sites, &forces, &mut part).unwrap();
        for (a, b) in whole.iter().zip(&part) {
            assert!((a - b).abs() < 1e-13 * velocity.max_abs());
        }
        assert_eq!(solver.n_solves(), [1, 1]);
    }
}

#[test]
fn a_sphere_between_the_faces_is_refused() {
    let grid = Grid::new([8; 3], 1.0, [Faces::Periodic; 3]).unwrap();
    let tiny = NoSlip::sphere(&grid, [4.25, 4.25, 4.25], 1e-3, 0.1);
    assert!(matches!(tiny, Err(StokesError::ParticleTooSmall { .. })));
    for bad in [0.0, -1.0, f64::NAN] {
        assert!(NoSlip::sphere(&grid, [4.0; 3], bad, 0.1).is_err());
        assert!(NoSlip::sphere(&grid, [4.0; 3], 2.0, bad).is_err());
    }
}
