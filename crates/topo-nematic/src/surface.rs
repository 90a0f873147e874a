//! Isosurfaces of the order, and slices through the volume.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use crate::NematicState;
use crate::tensor::order_and_director;

/// A surface of triangles.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TriangleMesh {
    /// Corners (ξ_N).
    pub vertices: Vec<[f64; 3]>,
    /// Indices of the corners of each triangle, counter-clockwise seen from the side of higher order.
    pub triangles: Vec<[u32; 3]>,
}

/// Six tetrahedra that fill a cube, by the bits of their corners.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 3, 2, 7],
    [0, 2, 6, 7],
    [0, 6, 4, 7],
    [0, 4, 5, 7],
    [0, 5, 1, 7],
];

/// The surface on which the order S is `level`, in the fluid, by marching tetrahedra: watertight except where it meets the particle
/// or an outer face.
///
/// # Validation
/// `isosurface_of_a_ball_has_its_area_and_is_closed`
pub fn isosurface(state: &NematicState, level: f64) -> TriangleMesh {
    let grid = state.grid();
    let [nx, ny, nz] = grid.cells();
    let mut mesh = TriangleMesh::default();
    let mut vertices: HashMap<(usize, usize), u32> = HashMap::new();
    let order = state.order_field();
    for k in 0..nz - 1 {
        for j in 0..ny - 1 {
            for i in 0..nx - 1 {
                let corner = |b: usize| [i + (b & 1), j + (b >> 1 & 1), k + (b >> 2)];
                let cells: [usize; 8] = std::array::from_fn(|b| grid.index(corner(b)));
                let n_low = cells.iter().filter(|c| order[**c] < level).count();
                if n_low == 0 || n_low == 8 || !(0..8).all(|b| state.is_fluid(corner(b))) {
                    continue;
                }
                for tetrahedron in TETRAHEDRA {
                    let corners = tetrahedron.map(|b| (cells[b], grid.centre(corner(b))));
                    mesh.add(&mut vertices, &order, level, corners);
                }
            }
        }
    }
    mesh
}

impl TriangleMesh {
    /// The piece of the surface in one tetrahedron.
    fn add(
        &mut self,
        known: &mut HashMap<(usize, usize), u32>,
        order: &[f64],
        level: f64,
        corners: [(usize, [f64; 3]); 4],
    ) {
        let is_low = |corner: &(usize, [f64; 3])| order[corner.0] < level;
        let low: Vec<_> = corners.iter().filter(|c| is_low(c)).copied().collect();
        let high: Vec<_> = corners.iter().filter(|c| !is_low(c)).copied().collect();
        let mut edge = |a: (usize, [f64; 3]), b: (usize, [f64; 3])| {
            let key = (a.0.min(b.0), a.0.max(b.0));
            *known.entry(key).or_insert_with(|| {
                let t = (level - order[a.0]) / (order[b.0] - order[a.0]);
                let point = std::array::from_fn(|x| a.1[x] + t * (b.1[x] - a.1[x]));
                self.vertices.push(point);
                (self.vertices.len() - 1) as u32
            })
        };
        let triangles: Vec<[u32; 3]> = match (low.as_slice(), high.as_slice()) {
            ([a], [b, c, d]) => vec![[edge(*a, *b), edge(*a, *c), edge(*a, *d)]],
            ([b, c, d], [a]) => vec![[edge(*b, *a), edge(*c, *a), edge(*d, *a)]],
            ([a, b], [c, d]) => {
                let quad = [edge(*a, *c), edge(*a, *d), edge(*b, *d), edge(*b, *c)];
                vec![[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
            }
            _ => Vec::new(),
        };
        // From the low to the high corners.
        let mean = |set: &[(usize, [f64; 3])], x: usize| {
            set.iter().map(|c| c.1[x]).sum::<f64>() / set.len().max(1) as f64
        };
        let outwards: [f64; 3] = std::array::from_fn(|x| mean(&high, x) - mean(&low, x));
        for [a, b, c] in triangles {
            let [p, q, r] = [a, b, c].map(|v| self.vertices[v as usize]);
            let (u, v): ([f64; 3], [f64; 3]) = (
                std::array::from_fn(|x| q[x] - p[x]),
                std::array::from_fn(|x| r[x] - p[x]),
            );
            let normal = [
                u[1] * v[2] - u[2] * v[1],
                u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0],
            ];
            let along: f64 = normal.iter().zip(outwards).map(|(x, y)| x * y).sum();
            self.triangles
                .push(if along >= 0.0 { [a, b, c] } else { [a, c, b] });
        }
    }

    /// Sum of the areas of the triangles, in ξ_N².
    pub fn area(&self) -> f64 {
        let vector = |t: &[u32; 3]| {
            let [p, q, r] = t.map(|v| nalgebra::Vector3::from(self.vertices[v as usize]));
            0.5 * (q - p).cross(&(r - p)).norm()
        };
        self.triangles.iter().map(vector).sum()
    }
}

/// Order and director on a plane of cells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VolumeSlice {
    /// Axis normal to it: 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Which plane of cells.
    pub index: usize,
    /// Cells along the two other axes, the lower axis first; its index runs faster.
    pub cells: [usize; 2],
    /// Order S of each cell; none in the particle.
    pub order: Vec<Option<f64>>,
    /// Director of each cell, with n_z >= 0.
    pub director: Vec<[f64; 3]>,
}

/// The plane of cells number `index` along `axis` (0, 1, 2 for x, y, z); the last plane when there are fewer.
pub fn volume_slice(state: &NematicState, axis: usize, index: usize) -> VolumeSlice {
    let axis = axis.min(2);
    let cells = state.grid().cells();
    let index = index.min(cells[axis] - 1);
    let (fast, slow) = match axis {
        0 => (1, 2),
        1 => (0, 2),
        _ => (0, 1),
    };
    let (mut order, mut director) = (Vec::new(), Vec::new());
    for b in 0..cells[slow] {
        for a in 0..cells[fast] {
            let mut ijk = [index; 3];
            ijk[fast] = a;
            ijk[slow] = b;
            let (s, n) = order_and_director(&state.tensor(state.grid().index(ijk)));
            order.push(state.is_fluid(ijk).then_some(s));
            director.push(n);
        }
    }
    VolumeSlice {
        axis,
        index,
        cells: [cells[fast], cells[slow]],
        order,
        director,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::uniaxial;
    use crate::{Faces, Grid};

    #[test]
    fn isosurface_of_a_ball_has_its_area_and_is_closed() {
        let grid = Grid::new([24; 3], 1.0, [Faces::Wall; 3]).unwrap();
        let state = NematicState::from_fn(grid, None, |p| {
            let r = p
                .iter()
                .map(|x| (x - 12.1) * (x - 12.1))
                .sum::<f64>()
                .sqrt();
            uniaxial(0.1 * r, [0.0, 0.0, 1.0])
        })
        .unwrap();
        let mesh = isosurface(&state, 0.7);
        let exact = 4.0 * std::f64::consts::PI * 49.0;
        assert!((mesh.area() / exact - 1.0).abs() < 0.02, "{}", mesh.area());
        // Every edge is shared by two triangles that run along it in opposite directions.
        let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
        for [a, b, c] in &mesh.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*from.min(to), *from.max(to))).or_default() +=
                    if from < to { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|n| *n == 0));
        // Normals point outwards, to higher order.
        let volume: f64 = mesh
            .triangles
            .iter()
            .map(|t| {
                let [p, q, r] = t.map(|v| nalgebra::Vector3::from(mesh.vertices[v as usize]));
                p.dot(&q.cross(&r)) / 6.0
            })
            .sum();
        assert!(
            (volume / (exact * 7.0 / 3.0) - 1.0).abs() < 0.02,
            "{volume}"
        );
    }

    #[test]
    fn slices_show_the_particle_and_the_plane_asked_for() {
        let grid = Grid::new([12, 14, 16], 1.0, [Faces::Periodic; 3]).unwrap();
        let particle = crate::Particle::central(&grid, 3.0).unwrap();
        let state = NematicState::from_fn(grid, Some(particle), |[x, _, _]| {
            uniaxial(
                0.5,
                if x < 6.0 {
                    [1.0, 0.0, 0.0]
                } else {
                    [0.0, 0.0, 1.0]
                },
            )
        })
        .unwrap();
        let slice = volume_slice(&state, 1, 7);
        assert_eq!(slice.cells, [12, 16]);
        assert_eq!(slice.order[8 * 12 + 6], None);
        assert!((slice.order[0].unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(slice.director[11], [0.0, 0.0, 1.0]);
        assert_eq!(volume_slice(&state, 7, 99).index, 15);
    }
}
