//! Where the search for the lowest mode begins.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Vector3};

use crate::domain::Domain;
use crate::tensor::{Tensor5, matrix};
use crate::{Grid, Particle};

/// A smooth change of the state `q` (components `stride` apart) without symmetry: the director turns about all three axes, most
/// between the plates and not at the particle, and the tensor changes a little besides.
///
/// Turns cost no order, so that little of it belongs to stiff modes. The factors and phases are arbitrary; what counts is that no
/// symmetry of a pattern or of the cell has them, or a mode of another symmetry would never be found.
pub(super) fn start(
    domain: &Domain,
    particle: Option<&Particle>,
    q: &[f64],
    stride: usize,
) -> Vec<f64> {
    let grid = &domain.grid;
    let mut change = vec![0.0; q.len()];
    let mut set = |cell: usize| {
        let here: Tensor5 = std::array::from_fn(|c| q[c * stride + cell]);
        let new = change_at(grid, particle, cell, &here);
        (0..5).for_each(|c| change[c * stride + cell] = new[c]);
    };
    for run in &domain.runs {
        (run.start..run.start + run.length).for_each(|cell| set(cell as usize));
    }
    (domain.special.iter()).for_each(|special| set(special.cell as usize));
    change
}

fn change_at(grid: &Grid, particle: Option<&Particle>, cell: usize, q: &Tensor5) -> Tensor5 {
    let [nx, ny, _] = grid.cells();
    let point = grid.centre([cell % nx, cell / nx % ny, cell / (nx * ny)]);
    let extent = grid.extent();
    let [x, y, z]: [f64; 3] = std::array::from_fn(|a| point[a] / extent[a]);
    let near = particle.map_or(1.0, |particle| {
        let far = crate::boundary::shares::norm(particle.offset(grid, point));
        (1.0 - particle.radius() / far.max(particle.radius())).max(0.0)
    });
    let profile = near * (PI * z).sin();
    let wave = |a: f64, b: f64, c: f64| {
        let sides = 0.3 * (TAU * x + a).cos() + 0.25 * (TAU * y + b).cos();
        profile * (1.0 + sides + 0.3 * (PI * z + c).cos())
    };
    let turn = Vector3::new(
        -0.8 * wave(0.7, 2.1, 0.4),
        wave(1.9, 0.5, 0.9),
        0.3 * wave(2.9, 1.3, 0.2),
    );
    let turned: Matrix3<f64> = turn.cross_matrix() * matrix(q);
    let turned = turned + turned.transpose();
    let small = 0.02 * wave(0.3, 2.6, 0.6);
    [
        turned[(0, 0)] + small,
        turned[(0, 1)] + 0.7 * small,
        turned[(0, 2)] + 0.9 * small,
        turned[(1, 1)] - 0.6 * small,
        turned[(1, 2)] + 0.5 * small,
    ]
}
