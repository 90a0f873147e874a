//! The colloid: a sphere in the grid.

use serde::{Deserialize, Serialize};
use topo_core::{finite, positive};

use crate::{Faces, Grid, NematicError};

/// A sphere that is held in place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Particle {
    centre: [f64; 3],
    radius: f64,
}

#[derive(Deserialize)]
struct Unchecked {
    centre: [f64; 3],
    radius: f64,
}

impl TryFrom<Unchecked> for Particle {
    type Error = NematicError;
    fn try_from(raw: Unchecked) -> Result<Self, NematicError> {
        Self::new(raw.centre, raw.radius)
    }
}

impl Particle {
    /// A sphere of `radius` (ξ_N) about `centre`, in the coordinates of the grid.
    ///
    /// # Errors
    /// A radius that is not a positive finite number, or a centre that is not finite.
    pub fn new(centre: [f64; 3], radius: f64) -> Result<Self, NematicError> {
        for x in centre {
            finite("particle.centre", x)?;
        }
        positive("particle.radius", radius)?;
        Ok(Self { centre, radius })
    }

    /// A sphere in the middle of `grid`.
    ///
    /// With even numbers of cells its centre is a corner of cells, so that the lattice around it has all symmetries of a cube.
    ///
    /// # Errors
    /// As [`new`](Self::new) and [`checked_in`](Self::checked_in).
    pub fn central(grid: &Grid, radius: f64) -> Result<Self, NematicError> {
        let particle = Self::new(grid.extent().map(|length| 0.5 * length), radius)?;
        particle.checked_in(grid)?;
        Ok(particle)
    }

    /// Checks that the grid can hold and resolve the sphere.
    ///
    /// # Errors
    /// [`NematicError::ParticleTooLarge`] when less than two spacings are left to a wall or to a periodic image;
    /// [`NematicError::ParticleTooCoarse`] when the radius is below two spacings.
    pub fn checked_in(&self, grid: &Grid) -> Result<(), NematicError> {
        let (h, extent) = (grid.spacing(), grid.extent());
        if self.radius < 2.0 * h {
            return Err(NematicError::ParticleTooCoarse {
                radius: self.radius,
                spacing: h,
            });
        }
        for axis in 0..3 {
            let gap = match grid.faces()[axis] {
                Faces::Periodic => extent[axis] - 2.0 * self.radius,
                Faces::Wall => {
                    let x = self.centre[axis];
                    x.min(extent[axis] - x) - self.radius
                }
            };
            let inside = (0.0..=extent[axis]).contains(&self.centre[axis]);
            if gap < 2.0 * h || !inside {
                return Err(NematicError::ParticleTooLarge {
                    axis,
                    radius: self.radius,
                    extent: extent[axis],
                    gap,
                });
            }
        }
        Ok(())
    }

    /// Centre (ξ_N, from the lower corner of the grid).
    pub fn centre(&self) -> [f64; 3] {
        self.centre
    }

    /// Radius R (ξ_N).
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The vector from the centre to `point`, by the shortest way through periodic faces.
    pub fn offset(&self, grid: &Grid, point: [f64; 3]) -> [f64; 3] {
        let (extent, faces) = (grid.extent(), grid.faces());
        std::array::from_fn(|axis| {
            let d = point[axis] - self.centre[axis];
            match faces[axis] {
                Faces::Wall => d,
                Faces::Periodic if d.abs() < 0.49 * extent[axis] => d,
                Faces::Periodic => shortest(d, extent[axis]),
            }
        })
    }

    /// Distance of `point` from the surface (ξ_N), negative inside.
    pub fn distance(&self, grid: &Grid, point: [f64; 3]) -> f64 {
        let d = self.offset(grid, point);
        (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() - self.radius
    }

    /// Whether the centre of cell (i, j, k) lies inside.
    pub fn contains_cell(&self, grid: &Grid, ijk: [usize; 3]) -> bool {
        self.distance(grid, grid.centre(ijk)) < 0.0
    }

    /// Whether the centre of some cell of the row (., j, k) may lie inside.
    pub(crate) fn reaches_row(&self, grid: &Grid, j: usize, k: usize) -> bool {
        let [_, y, z] = self.offset(grid, grid.centre([0, j, k]));
        y * y + z * z <= self.radius * self.radius * (1.0 + 1e-9)
    }

    /// Marks the cells whose centre lies inside, in the order of the grid.
    pub fn mask(&self, grid: &Grid) -> Vec<bool> {
        let [nx, ny, nz] = grid.cells();
        let mut mask = vec![false; grid.n_cells()];
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    mask[grid.index([i, j, k])] = self.contains_cell(grid, [i, j, k]);
                }
            }
        }
        mask
    }
}

/// The shortest of the distances d + n extent; kept out of line, as rounding is a call on the least processor and would be made for
/// cells that need none.
#[inline(never)]
fn shortest(d: f64, extent: f64) -> f64 {
    d - extent * (d / extent).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(n: [usize; 3]) -> Grid {
        Grid::new(n, 1.5, [Faces::Periodic, Faces::Periodic, Faces::Wall]).unwrap()
    }

    #[test]
    fn the_mask_has_the_volume_and_the_symmetry_of_the_sphere() {
        let grid = cell([40, 40, 30]);
        let particle = Particle::central(&grid, 12.0).unwrap();
        let mask = particle.mask(&grid);
        let volume = mask.iter().filter(|m| **m).count() as f64 * 1.5_f64.powi(3);
        let exact = 4.0 / 3.0 * std::f64::consts::PI * 12.0_f64.powi(3);
        assert!((volume / exact - 1.0).abs() < 0.02, "{volume} {exact}");
        for (k, j, i) in [(15, 20, 27), (9, 14, 20)] {
            let at = |i, j, k| mask[grid.index([i, j, k])];
            assert_eq!(at(i, j, k), at(39 - i, j, k));
            assert_eq!(at(i, j, k), at(i, j, 29 - k));
            assert_eq!(at(i, j, k), at(j, i, k));
        }
    }

    #[test]
    fn spheres_that_do_not_fit_are_refused() {
        let grid = cell([40, 40, 30]);
        assert!(matches!(
            Particle::central(&grid, 21.0),
            Err(NematicError::ParticleTooLarge { axis: 2, .. })
        ));
        assert!(matches!(
            Particle::central(&grid, 2.9),
            Err(NematicError::ParticleTooCoarse { .. })
        ));
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Particle::new([0.0; 3], bad).is_err());
            assert!(Particle::new([f64::NAN, 0.0, bad], 1.0).is_err());
        }
        let outside = Particle::new([30.0, 30.0, 100.0], 5.0).unwrap();
        assert!(outside.checked_in(&grid).is_err());
    }

    #[test]
    fn the_shortest_way_leads_through_periodic_faces() {
        let grid = cell([40, 40, 30]);
        let particle = Particle::new([3.0, 30.0, 20.0], 6.0).unwrap();
        assert!((particle.distance(&grid, [58.0, 30.0, 20.0]) + 1.0).abs() < 1e-12);
        assert!(particle.distance(&grid, [3.0, 30.0, 44.0]) > 17.9);
    }
}
