//! Fourier symbols of the differences on the staggered grid.

use std::f64::consts::TAU;

use crate::grid::Grid;
use topo_fourier::Complex64;

/// Symbols of the backward difference, spacing 1, and the factor that turns forces into velocities.
pub(super) struct Symbol {
    /// 1 - exp(-i k) for every mode along x, y, z.
    pub gradient: [Vec<Complex64>; 3],
    /// Of minus the second difference: |gradient|^2.
    pub laplacian: [Vec<f64>; 3],
    /// h^2/η over the factor that transforms there and back leave.
    pub scale: f64,
    /// The same without the transform along z.
    pub plane_scale: f64,
}

impl Symbol {
    pub fn new(grid: &Grid, viscosity: f64) -> Self {
        let [n_x, n_y, n_z] = grid.cells();
        let plane_scale = grid.spacing().powi(2) / viscosity / (n_x * n_y) as f64;
        Self {
            gradient: grid
                .cells()
                .map(|n| (0..n).map(|k| gradient(k, n)).collect()),
            laplacian: grid.cells().map(|n| {
                let half = |k: usize| 0.5 * TAU * k as f64 / n as f64;
                (0..n).map(|k| 4.0 * half(k).sin().powi(2)).collect()
            }),
            scale: plane_scale / n_z as f64,
            plane_scale,
        }
    }
}

/// 1 - exp(-2 π i k/n), without cancellation.
fn gradient(k: usize, n: usize) -> Complex64 {
    let half = 0.5 * TAU * k as f64 / n as f64;
    2.0 * half.sin() * Complex64::new(half.sin(), half.cos())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradient_is_a_backward_difference() {
        for n in [4, 5] {
            for k in 0..n {
                let shift = Complex64::from_polar(1.0, -TAU * k as f64 / n as f64);
                assert!((gradient(k, n) - (1.0 - shift)).norm() < 1e-15);
            }
        }
    }
}
