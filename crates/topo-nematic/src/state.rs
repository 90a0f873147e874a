//! The degrees of freedom: the tensor field.

use serde::{Deserialize, Serialize};

use crate::tensor::Tensor5;
use crate::{Faces, Grid, NematicError, Particle};

/// The tensor field of a nematic on its grid.
///
/// Five components (xx, xy, xz, yy, yz), one after the other, each of n_cells numbers. Cells whose centre lies inside the
/// particle hold old values without meaning.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct NematicState {
    grid: Grid,
    particle: Option<Particle>,
    q: Vec<f64>,
}

#[derive(Deserialize)]
struct Unchecked {
    grid: Grid,
    particle: Option<Particle>,
    q: Vec<f64>,
}

impl TryFrom<Unchecked> for NematicState {
    type Error = NematicError;
    fn try_from(raw: Unchecked) -> Result<Self, NematicError> {
        Self::new(raw.grid, raw.particle, raw.q)
    }
}

impl NematicState {
    /// A state of given components.
    ///
    /// # Errors
    /// [`NematicError::Length`] unless `q` has 5 n_cells numbers, [`NematicError::NotFinite`] when one of them is not finite.
    pub fn new(grid: Grid, particle: Option<Particle>, q: Vec<f64>) -> Result<Self, NematicError> {
        if q.len() != 5 * grid.n_cells() {
            return Err(NematicError::Length {
                what: "the tensor field",
                found: q.len(),
                expected: 5 * grid.n_cells(),
            });
        }
        if let Some(at) = q.iter().position(|x| !x.is_finite()) {
            return Err(NematicError::NotFinite {
                what: "the tensor field",
                cell: at % grid.n_cells(),
            });
        }
        Ok(Self { grid, particle, q })
    }

    /// A state whose tensor at each cell centre is `f` of its coordinates.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_fn(
        grid: Grid,
        particle: Option<Particle>,
        f: impl Fn([f64; 3]) -> Tensor5,
    ) -> Result<Self, NematicError> {
        let (n, [nx, ny, nz]) = (grid.n_cells(), grid.cells());
        let mut q = vec![0.0; 5 * n];
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let tensor = f(grid.centre([i, j, k]));
                    let cell = grid.index([i, j, k]);
                    for (c, x) in tensor.into_iter().enumerate() {
                        q[c * n + cell] = x;
                    }
                }
            }
        }
        Self::new(grid, particle, q)
    }

    /// This field at the cells of another state, by trilinear interpolation; both boxes must have the same size.
    pub(crate) fn interpolated(&self, onto: &Self) -> Self {
        let (fine, coarse) = (onto.grid.cells(), self.grid.cells());
        let mut result = onto.clone();
        let (n, n_coarse) = (onto.grid.n_cells(), self.grid.n_cells());
        // The two nearest coarse cells along an axis, and the share of the second.
        let near = |axis: usize, i: usize| -> ([usize; 2], f64) {
            let size = coarse[axis] as f64;
            let x = (i as f64 + 0.5) / fine[axis] as f64 * size - 0.5;
            let (low, share) = (x.floor(), x - x.floor());
            let place = |x: f64| match self.grid.faces()[axis] {
                Faces::Periodic => x.rem_euclid(size) as usize,
                Faces::Wall => x.clamp(0.0, size - 1.0) as usize,
            };
            ([place(low), place(low + 1.0)], share)
        };
        for k in 0..fine[2] {
            let (ks, w) = near(2, k);
            for j in 0..fine[1] {
                let (js, v) = near(1, j);
                for i in 0..fine[0] {
                    let (is, u) = near(0, i);
                    let cell = onto.grid.index([i, j, k]);
                    for c in 0..5 {
                        let mut sum = 0.0;
                        for corner in 0..8 {
                            let (a, b, d) = (corner & 1, corner >> 1 & 1, corner >> 2);
                            let weight = [1.0 - u, u][a] * [1.0 - v, v][b] * [1.0 - w, w][d];
                            let from = self.grid.index([is[a], js[b], ks[d]]);
                            sum += weight * self.q[c * n_coarse + from];
                        }
                        result.q[c * n + cell] = sum;
                    }
                }
            }
        }
        result
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The particle, if there is one.
    pub fn particle(&self) -> Option<&Particle> {
        self.particle.as_ref()
    }

    /// All components: 5 n_cells numbers, component by component.
    pub fn q_tensor(&self) -> &[f64] {
        &self.q
    }

    /// All components, to be changed by this crate only.
    pub(crate) fn q_mut(&mut self) -> &mut [f64] {
        &mut self.q
    }

    /// The tensor of a cell.
    ///
    /// # Panics
    /// When there is no such cell.
    pub fn tensor(&self, cell: usize) -> Tensor5 {
        let n = self.grid.n_cells();
        std::array::from_fn(|c| self.q[c * n + cell])
    }

    /// Whether the centre of cell (i, j, k) lies in the fluid.
    pub fn is_fluid(&self, ijk: [usize; 3]) -> bool {
        self.particle
            .is_none_or(|p| !p.contains_cell(&self.grid, ijk))
    }

    /// [`is_fluid`](Self::is_fluid) of the cells of row (j, k), which is soon said where the particle does not reach.
    pub(crate) fn fluid_in_row(&self, j: usize, k: usize) -> impl Fn(usize) -> bool + '_ {
        let near = self
            .particle
            .filter(|particle| particle.reaches_row(&self.grid, j, k));
        move |i| near.is_none_or(|particle| !particle.contains_cell(&self.grid, [i, j, k]))
    }
}
