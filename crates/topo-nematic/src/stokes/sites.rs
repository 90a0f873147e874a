//! A list of single faces.

use std::ops::Range;

use crate::grid::Grid;
use crate::stokes::MacField;

/// Single faces of a grid, ordered by plane along z, then component, then row, then place in the row.
#[derive(Debug, Clone)]
pub struct FaceSites {
    /// Component and index of the face in that component.
    faces: Vec<(u8, u32)>,
    /// Where the faces of each plane start, and the end.
    plane_starts: Vec<usize>,
    cells: [usize; 3],
}

impl FaceSites {
    /// The faces of `grid` (component, (i, j, k)) for which `chosen` holds.
    pub fn new(grid: &Grid, chosen: impl Fn(usize, [usize; 3]) -> bool) -> Self {
        let [n_x, n_y, n_z] = grid.cells();
        let mut faces = Vec::new();
        let mut plane_starts = vec![0];
        for k in 0..n_z {
            for axis in 0..3 {
                for (j, i) in (0..n_y).flat_map(|j| (0..n_x).map(move |i| (j, i))) {
                    if chosen(axis, [i, j, k]) {
                        faces.push((axis as u8, grid.index([i, j, k]) as u32));
                    }
                }
            }
            plane_starts.push(faces.len());
        }
        faces.shrink_to_fit();
        Self {
            faces,
            plane_starts,
            cells: grid.cells(),
        }
    }

    /// Number of faces.
    pub fn len(&self) -> usize {
        self.faces.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Component and index of each face.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (usize, usize)> + '_ {
        self.faces
            .iter()
            .map(|&(axis, index)| (usize::from(axis), index as usize))
    }

    /// Places in the list of the faces in plane `k`.
    pub(crate) fn plane(&self, k: usize) -> Range<usize> {
        self.plane_starts[k]..self.plane_starts[k + 1]
    }

    /// Component, row j and place i of the face at `place`.
    pub(crate) fn locate(&self, place: usize) -> (usize, usize, usize) {
        let (axis, index) = self.faces[place];
        let row = index as usize / self.cells[0];
        (
            usize::from(axis),
            row % self.cells[1],
            index as usize % self.cells[0],
        )
    }

    /// Copies the values of `field` at the faces.
    pub fn gather(&self, field: &MacField, values: &mut [f64]) {
        for ((axis, index), value) in self.iter().zip(values) {
            *value = field.component(axis)[index];
        }
    }

    /// Writes `values` to the faces of `field`.
    pub fn scatter(&self, values: &[f64], field: &mut MacField) {
        for ((axis, index), value) in self.iter().zip(values) {
            field.component_mut(axis)[index] = *value;
        }
    }

    /// Adds `values` to the faces of `field`.
    pub fn add_to(&self, values: &[f64], field: &mut MacField) {
        for ((axis, index), value) in self.iter().zip(values) {
            field.component_mut(axis)[index] += *value;
        }
    }

    /// Bytes held.
    pub fn n_bytes(&self) -> usize {
        self.faces.len() * size_of::<(u8, u32)>() + self.plane_starts.len() * size_of::<usize>()
    }
}
