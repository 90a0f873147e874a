//! The second elastic constant: a separate pass, made only when the constant is set.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::domain::{Domain, neighbour};
use crate::real::Real;
use crate::tensor::Tensor5;

/// The energy of div Q on the cells whose six neighbours are fluid.
///
/// ```math
/// F = \tfrac{L_2}{2} h^3 \sum_{\text{cells}} v_i v_i, \quad v_i = \sum_j \frac{Q_{ij}(x + h e_j) - Q_{ij}(x - h e_j)}{2h}
/// ```
///
/// Central differences, and their adjoint for the field: exact for the discrete energy. The layer of cells next to walls and to the
/// particle is left out, an error of the order of h.
#[derive(Debug, Clone)]
pub(crate) struct SecondElastic {
    pub constant: f64,
    /// Numbers from one component to the next.
    stride: usize,
    spacing: f64,
    /// Cells with a divergence, and their neighbours.
    inner: Vec<(u32, [u32; 6])>,
    /// 1/mass of each cell, 0 where there is no field.
    inverse_mass: Vec<f64>,
    /// Passes over the cells so far, copies of the kernel included.
    n_passes: Arc<AtomicU64>,
}

impl SecondElastic {
    pub(crate) fn new(domain: &Domain, constant: f64, stride: usize) -> Self {
        let grid = &domain.grid;
        let masses = domain.masses();
        let [nx, ny, nz] = grid.cells();
        let mut inner = Vec::new();
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let mut around = [0; 6];
                    let is_inner = (0..6).all(|link| {
                        neighbour(grid, [i, j, k], link).is_some_and(|other| {
                            around[link] = grid.index(other) as u32;
                            masses[grid.index(other)] > 0.0
                        })
                    });
                    let cell = grid.index([i, j, k]);
                    if is_inner && masses[cell] > 0.0 {
                        inner.push((cell as u32, around));
                    }
                }
            }
        }
        Self {
            constant,
            stride,
            spacing: grid.spacing(),
            inner,
            inverse_mass: masses
                .iter()
                .map(|m| if *m > 0.0 { 1.0 / m } else { 0.0 })
                .collect(),
            n_passes: Arc::default(),
        }
    }

    fn count(&self) {
        self.n_passes.fetch_add(1, Ordering::Relaxed);
    }

    pub(crate) fn n_bytes(&self) -> u64 {
        (size_of_val(&self.inner[..]) + size_of_val(&self.inverse_mass[..])) as u64
    }

    /// Passes so far.
    pub(crate) fn n_passes(&self) -> u64 {
        self.n_passes.load(Ordering::Relaxed)
    }

    /// Energy of the second elastic constant.
    pub(crate) fn energy<T: Real>(&self, q: &[T]) -> f64 {
        self.count();
        let sum: f64 = self
            .inner
            .iter()
            .map(|(_, around)| {
                let v = self.divergence(q, around);
                v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
            })
            .sum();
        0.5 * self.constant * self.spacing.powi(3) * sum
    }

    /// Adds `factor` times its molecular field to `out`.
    pub(crate) fn add_field<T: Real>(&self, q: &[T], factor: f64, out: &mut [T]) {
        self.count();
        let scale = factor * self.constant / (2.0 * self.spacing);
        for (_, around) in &self.inner {
            let v = self.divergence(q, around);
            for axis in 0..3 {
                // v depends on row `axis` of Q at both sides: the traceless symmetric part of v e_axis.
                let third = v[axis] / 3.0;
                let mut field: Tensor5 = [-third, 0.0, 0.0, -third, 0.0];
                match axis {
                    0 => {
                        field[0] += v[0];
                        field[1] += 0.5 * v[1];
                        field[2] += 0.5 * v[2];
                    }
                    1 => {
                        field[1] += 0.5 * v[0];
                        field[3] += v[1];
                        field[4] += 0.5 * v[2];
                    }
                    _ => {
                        field[2] += 0.5 * v[0];
                        field[4] += 0.5 * v[1];
                    }
                }
                for (link, sign) in [(2 * axis, 1.0), (2 * axis + 1, -1.0)] {
                    let cell = around[link] as usize;
                    let scale = sign * scale * self.inverse_mass[cell];
                    for c in 0..5 {
                        let to = &mut out[c * self.stride + cell];
                        *to = T::of((*to).into() + scale * field[c]);
                    }
                }
            }
        }
    }

    fn divergence<T: Real>(&self, q: &[T], around: &[u32; 6]) -> [f64; 3] {
        let at =
            |c: usize, link: usize| -> f64 { q[c * self.stride + around[link] as usize].into() };
        let step = |c: usize, axis: usize| at(c, 2 * axis + 1) - at(c, 2 * axis);
        let zz = -step(0, 2) - step(3, 2);
        let scale = 0.5 / self.spacing;
        [
            scale * (step(0, 0) + step(1, 1) + step(2, 2)),
            scale * (step(1, 0) + step(3, 1) + step(4, 2)),
            scale * (step(2, 0) + step(4, 1) + zz),
        ]
    }
}
