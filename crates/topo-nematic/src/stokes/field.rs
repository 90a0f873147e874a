//! Vector fields on the faces of the cells.

use serde::{Deserialize, Serialize};

use crate::grid::Grid;
use crate::stokes::reduce::{larger, max_over, sum_over};

/// A vector field whose component a is stored on the cell faces normal to axis a (marker-and-cell staggering).
///
/// Component a of cell (i, j, k) is on the *lower* face of that cell along a, and all three components are indexed as the cells
/// are: (k n_y + j) n_x + i. Beyond a periodic pair of outer faces the field repeats. Between walls, face 0 is the lower wall,
/// where the normal component vanishes; so it does on the upper wall, which is not stored: wrapping the index along the normal
/// therefore reads the right value with walls too.
///
/// # Validation
/// `divergence_and_pressure_gradient_are_adjoint`
///
/// # References
/// [harlow1965]
///
/// [harlow1965]: https://doi.org/10.1063/1.1761178
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct MacField {
    cells: [usize; 3],
    components: [Vec<f64>; 3],
}

#[derive(Deserialize)]
struct Unchecked {
    cells: [usize; 3],
    components: [Vec<f64>; 3],
}

impl TryFrom<Unchecked> for MacField {
    type Error = &'static str;
    fn try_from(raw: Unchecked) -> Result<Self, &'static str> {
        let mut cells = raw.cells.iter();
        let n = cells.try_fold(1usize, |n, k| n.checked_mul(*k));
        if raw.components.iter().any(|c| Some(c.len()) != n) {
            return Err("the components do not fit the cells");
        }
        if raw.components.iter().flatten().any(|x| !x.is_finite()) {
            return Err("a component is not finite");
        }
        Ok(Self {
            cells: raw.cells,
            components: raw.components,
        })
    }
}

impl MacField {
    /// A field of zeros on `grid`.
    pub fn zeros(grid: &Grid) -> Self {
        let n = grid.n_cells();
        Self {
            cells: grid.cells(),
            components: std::array::from_fn(|_| vec![0.0; n]),
        }
    }

    /// Cells along x, y, z.
    pub fn cells(&self) -> [usize; 3] {
        self.cells
    }

    /// Component `axis` (0, 1, 2) on the lower faces of all cells.
    pub fn component(&self, axis: usize) -> &[f64] {
        &self.components[axis]
    }

    /// Component `axis`, to be written; keep the normal component on walls at zero.
    pub fn component_mut(&mut self, axis: usize) -> &mut [f64] {
        &mut self.components[axis]
    }

    /// All three components.
    pub fn components(&self) -> [&[f64]; 3] {
        self.components.each_ref().map(Vec::as_slice)
    }

    /// All three components, to be written.
    pub fn components_mut(&mut self) -> [&mut [f64]; 3] {
        self.components.each_mut().map(Vec::as_mut_slice)
    }

    /// Sets every value to zero.
    pub fn clear(&mut self) {
        for component in &mut self.components {
            component.fill(0.0);
        }
    }

    /// Sum over all faces of the product with `other`, the same to the bit for any number of threads.
    pub fn dot(&self, other: &Self) -> f64 {
        let plane = self.cells[0] * self.cells[1];
        sum_over(0..self.cells[2], &|k| {
            let range = k * plane..(k + 1) * plane;
            (0..3)
                .map(|axis| {
                    let (a, b) = (&self.components[axis], &other.components[axis]);
                    dot(&a[range.clone()], &b[range.clone()])
                })
                .sum()
        })
    }

    /// Sum over all faces of the product with the uniform vector `uniform`; skipped for components that are zero.
    pub fn dot_uniform(&self, uniform: [f64; 3]) -> f64 {
        let sum = |axis: usize| -> f64 { self.components[axis].iter().sum() };
        (0..3)
            .filter(|&axis| uniform[axis] != 0.0)
            .map(|axis| uniform[axis] * sum(axis))
            .sum()
    }

    /// Largest magnitude of a component.
    pub fn max_abs(&self) -> f64 {
        let plane = self.cells[0] * self.cells[1];
        max_over(0..self.cells[2], &|k| {
            let values = (0..3).flat_map(|axis| &self.components[axis][k * plane..(k + 1) * plane]);
            // A NaN must not be lost.
            values.fold(0.0, |max, x| larger(max, x.abs()))
        })
    }

    /// Vector at the centre of cell (i, j, k): mean of the two faces along each axis.
    pub fn at_centre(&self, ijk: [usize; 3]) -> [f64; 3] {
        let index = |[i, j, k]: [usize; 3]| (k * self.cells[1] + j) * self.cells[0] + i;
        std::array::from_fn(|axis| {
            let mut next = ijk;
            next[axis] = (next[axis] + 1) % self.cells[axis];
            0.5 * (self.components[axis][index(ijk)] + self.components[axis][index(next)])
        })
    }

    /// Divergence in cell (i, j, k) times the spacing.
    pub fn net_outflow(&self, ijk: [usize; 3]) -> f64 {
        let index = |[i, j, k]: [usize; 3]| (k * self.cells[1] + j) * self.cells[0] + i;
        (0..3)
            .map(|axis| {
                let mut next = ijk;
                next[axis] = (next[axis] + 1) % self.cells[axis];
                self.components[axis][index(next)] - self.components[axis][index(ijk)]
            })
            .sum()
    }

    /// Bytes of the values.
    pub fn n_bytes(&self) -> usize {
        self.components
            .iter()
            .map(|c| c.len() * size_of::<f64>())
            .sum()
    }
}

/// Dot product in eight partial sums, which the compiler can keep in vector registers.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, a_rest) = a.as_chunks::<8>();
    let (b, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for l in 0..8 {
            sums[l] += a[l] * b[l];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Faces;

    #[test]
    fn divergence_and_pressure_gradient_are_adjoint() {
        let grid = Grid::new([4, 5, 6], 1.0, [Faces::Periodic, Faces::Wall, Faces::Wall]).unwrap();
        let mut noise = crate::noise::noise(77);
        let mut u = MacField::zeros(&grid);
        let pressure: Vec<f64> = noise.by_ref().take(grid.n_cells()).collect();
        let (mut outflow, mut work) = (0.0, 0.0);
        for axis in 0..3 {
            for (n, x) in u.component_mut(axis).iter_mut().enumerate() {
                let ijk = [n % 4, n / 4 % 5, n / 20];
                let wall = grid.faces()[axis] == Faces::Wall && ijk[axis] == 0;
                if !wall {
                    *x = noise.next().unwrap();
                }
                let mut before = ijk;
                before[axis] = (ijk[axis] + grid.cells()[axis] - 1) % grid.cells()[axis];
                work += *x * (pressure[n] - pressure[grid.index(before)]);
            }
        }
        for n in 0..grid.n_cells() {
            outflow += pressure[n] * u.net_outflow([n % 4, n / 4 % 5, n / 20]);
        }
        assert!(
            (outflow + work).abs() < 1e-12 * work.abs(),
            "{outflow} {work}"
        );
    }

    #[test]
    fn sums_take_every_face() {
        let grid = Grid::new([5, 4, 7], 0.5, [Faces::Periodic; 3]).unwrap();
        let mut u = MacField::zeros(&grid);
        for axis in 0..3 {
            u.component_mut(axis).fill(1.0 + axis as f64);
        }
        assert_eq!(u.dot(&u), 140.0 * 14.0);
        assert_eq!(u.max_abs(), 3.0);
        assert_eq!(u.at_centre([4, 3, 6]), [1.0, 2.0, 3.0]);
        assert_eq!(u.n_bytes(), 3 * 140 * 8);
        u.component_mut(1)[77] = f64::NAN;
        assert!(u.max_abs().is_nan());
    }
}
