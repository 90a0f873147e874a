//! The grid: cells, spacing, and what is beyond each pair of outer faces.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// What is beyond a pair of opposite outer faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Faces {
    /// The opposite face.
    Periodic,
    /// A wall on the face, half a spacing from the nearest cell centres.
    Wall,
}

/// A box of cubic cells of edge h with the origin at its lower corner.
///
/// Cell (i, j, k) has its centre at ((i + 1/2) h, (j + 1/2) h, (k + 1/2) h) and the index (k n_y + j) n_x + i: x runs fastest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Grid {
    cells: [usize; 3],
    spacing: f64,
    faces: [Faces; 3],
}

#[derive(Deserialize)]
struct Unchecked {
    cells: [usize; 3],
    spacing: f64,
    faces: [Faces; 3],
}

impl TryFrom<Unchecked> for Grid {
    type Error = GridError;
    fn try_from(raw: Unchecked) -> Result<Self, GridError> {
        Self::new(raw.cells, raw.spacing, raw.faces)
    }
}

/// Why a grid is invalid.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum GridError {
    /// Too few cells for a stencil.
    #[error("a grid needs at least 4 cells along each axis, but axis {axis} has {cells}")]
    TooFewCells {
        /// 0, 1, 2 for x, y, z.
        axis: usize,
        /// Cells along it.
        cells: usize,
    },
    /// The spacing is not a length.
    #[error("the grid spacing must be positive and finite, but is {spacing}")]
    Spacing {
        /// The value given, in ξ_N.
        spacing: f64,
    },
    /// More cells than can be counted or held.
    #[error("a grid of {cells:?} cells is too large: at most {limit} cells are possible")]
    TooLarge {
        /// Cells along each axis.
        cells: [usize; 3],
        /// Largest total.
        limit: usize,
    },
}

/// Largest number of cells: indices fit in 31 bits.
const MAX_CELLS: usize = 1 << 31;

impl Grid {
    /// A box of `cells` cubes of edge `spacing` (ξ_N), with `faces` beyond its outer faces along x, y, z.
    ///
    /// # Errors
    /// [`GridError`] for fewer than 4 cells along an axis, more than 2^31 in all, or a spacing that is no length.
    pub fn new(cells: [usize; 3], spacing: f64, faces: [Faces; 3]) -> Result<Self, GridError> {
        if let Some(axis) = (0..3).find(|&axis| cells[axis] < 4) {
            return Err(GridError::TooFewCells {
                axis,
                cells: cells[axis],
            });
        }
        if !(spacing.is_finite() && spacing > 0.0) {
            return Err(GridError::Spacing { spacing });
        }
        let total = cells
            .iter()
            .try_fold(1usize, |product, &n| product.checked_mul(n));
        if total.is_none_or(|total| total > MAX_CELLS) {
            return Err(GridError::TooLarge {
                cells,
                limit: MAX_CELLS,
            });
        }
        Ok(Self {
            cells,
            spacing,
            faces,
        })
    }

    /// Cells along x, y, z.
    pub fn cells(&self) -> [usize; 3] {
        self.cells
    }

    /// Cells in all.
    pub fn n_cells(&self) -> usize {
        self.cells.iter().product()
    }

    /// Edge h of a cell (ξ_N).
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// What is beyond the outer faces along x, y, z.
    pub fn faces(&self) -> [Faces; 3] {
        self.faces
    }

    /// Edges of the box (ξ_N).
    pub fn extent(&self) -> [f64; 3] {
        self.cells.map(|n| n as f64 * self.spacing)
    }

    /// Index of cell (i, j, k).
    pub fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.cells[1] + j) * self.cells[0] + i
    }

    /// Centre of cell (i, j, k) (ξ_N).
    pub fn centre(&self, ijk: [usize; 3]) -> [f64; 3] {
        ijk.map(|i| (i as f64 + 0.5) * self.spacing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIODIC: [Faces; 3] = [Faces::Periodic; 3];

    #[test]
    fn indices_count_the_cells_with_x_fastest() {
        let grid = Grid::new([4, 5, 6], 0.5, PERIODIC).unwrap();
        let mut next = 0;
        for k in 0..6 {
            for j in 0..5 {
                for i in 0..4 {
                    assert_eq!(grid.index([i, j, k]), next);
                    next += 1;
                }
            }
        }
        assert_eq!(next, grid.n_cells());
        assert_eq!(grid.centre([3, 4, 5]), [1.75, 2.25, 2.75]);
        assert_eq!(grid.extent(), [2.0, 2.5, 3.0]);
    }

    #[test]
    fn refuses_what_is_no_grid() {
        let tiny = Grid::new([4, 3, 4], 1.0, PERIODIC);
        assert_eq!(tiny, Err(GridError::TooFewCells { axis: 1, cells: 3 }));
        for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                Grid::new([4; 3], spacing, PERIODIC),
                Err(GridError::Spacing { .. })
            ));
        }
        for n in [1 << 11, usize::MAX] {
            assert!(matches!(
                Grid::new([n; 3], 1.0, PERIODIC),
                Err(GridError::TooLarge { .. })
            ));
        }
    }
}
