//! What resists a component of a link in moving as a whole.
//!
//! Internal viscosity resists no common motion. A single rod needs none: its forces sum to zero. The components of a link push each
//! other, so that each has a net force with nothing to resist it: without friction their relative motion would be quasi-static,
//! always at zero net force. A drag on the mean velocity of each component is the least that makes a velocity of it.

use nalgebra::{DMatrix, DVector, Dyn, LU};
use topo_sparse::SparseCholesky;

use crate::Layout;

/// Drag on the mean velocity V_c of every component that nothing holds, in a state of several components.
///
/// ```math
/// v \cdot Z v = \sum_c \zeta \frac{L_c}{L^2} |V_c|^2, \qquad V_c = \frac{1}{n_c} \sum_{i \in c} v_i
/// ```
///
/// It resists no deformation: a component without a net force moves as if it were alone. As Z_c is proportional to the length
/// L_c, forces between components leave the centroid Σ L_c X_c of all where it is.
#[derive(Debug, Clone, Default)]
pub(crate) struct Drag {
    parts: Vec<Part>,
    /// Whether no vertex of any component is held.
    is_free: bool,
    n_vertices: usize,
}

/// A component that floats.
#[derive(Debug, Clone)]
struct Part {
    vertices: std::ops::Range<usize>,
    /// Z_c, in 1/h.
    resistance: f64,
    /// What its first vertex is grounded by in a factorised matrix, in 1/h.
    ground: f64,
}

impl Drag {
    /// That of all components without a vertex marked in `fixed`; none for a single component.
    pub(crate) fn of(layout: &Layout, fixed: &[bool], ratio: f64) -> Option<Self> {
        if layout.n_components() == 1 {
            return None;
        }
        let length = layout.length();
        let floats = |chain: &&crate::Chain| !fixed[chain.vertices()].contains(&true);
        let floating = layout.components().iter().filter(floats);
        let parts: Vec<Part> = floating
            .map(|chain| Part {
                vertices: chain.vertices(),
                resistance: ratio * chain.length() / (length * length),
                ground: 1.0 / chain.rest_length(),
            })
            .collect();
        (!parts.is_empty()).then(|| Self {
            is_free: !fixed.contains(&true),
            parts,
            n_vertices: layout.n_vertices(),
        })
    }

    /// First vertices of the floating components, each with the ground that a factorised matrix must have there.
    pub(crate) fn grounds(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.parts.iter().map(|p| (p.vertices.start, p.ground))
    }

    fn mean(&self, part: &Part, u: &[f64], k: usize) -> f64 {
        let own =
            part.vertices.start + k * self.n_vertices..part.vertices.end + k * self.n_vertices;
        u[own].iter().sum::<f64>() / part.vertices.len() as f64
    }

    /// u·Z v of two component-major displacements or velocities.
    pub(crate) fn form(&self, u: &[f64], v: &[f64]) -> f64 {
        let of = |part: &Part| {
            let along = |k| self.mean(part, u, k) * self.mean(part, v, k);
            part.resistance * (0..3).map(along).sum::<f64>()
        };
        self.parts.iter().map(of).sum()
    }

    /// Adds Z u to `out`: component-major in, vertex-major out.
    pub(crate) fn add_product(&self, u: &[f64], out: &mut [f64]) {
        for part in &self.parts {
            for k in 0..3 {
                let each = part.resistance * self.mean(part, u, k) / part.vertices.len() as f64;
                part.vertices.clone().for_each(|i| out[3 * i + k] += each);
            }
        }
    }

    /// Takes the common motion that rounding leaves out of component-major velocities, unless something is held.
    pub(crate) fn keep_centroid(&self, v: &mut [f64]) {
        if !self.is_free {
            return;
        }
        let n = self.n_vertices;
        let whole: f64 = self.parts.iter().map(|p| p.resistance).sum();
        for k in 0..3 {
            let sum: f64 = (self.parts.iter().map(|p| p.resistance * self.mean(p, v, k))).sum();
            v[k * n..(k + 1) * n]
                .iter_mut()
                .for_each(|c| *c -= sum / whole);
        }
    }
}

/// Solutions with the drag, by the factor of a matrix that is grounded at the first vertex of each floating component instead.
///
/// ```math
/// (A + T S T^T)^{-1} = A^{-1} - Y (S^{-1} + T^T Y)^{-1} T^T A^{-1}, \qquad Y = A^{-1} T
/// ```
///
/// T has a column for the mean of each component and one for its first vertex, S the drags and minus the grounds: two of each per
/// component and direction. The matrix stays as sparse as that of single rods.
#[derive(Debug)]
pub(crate) struct DragCorrection {
    drag: Drag,
    /// Unknowns of a vertex: 1 where the three directions are alike, 3 where they are coupled.
    n_directions: usize,
    /// Y, column after column.
    columns: Vec<f64>,
    small: Option<LU<f64, Dyn, Dyn>>,
}

impl DragCorrection {
    pub(crate) fn new(drag: Drag, n_directions: usize) -> Self {
        Self {
            drag,
            n_directions,
            columns: Vec::new(),
            small: None,
        }
    }

    pub(crate) fn drag(&self) -> &Drag {
        &self.drag
    }

    fn n_rows(&self) -> usize {
        self.n_directions * self.drag.n_vertices
    }

    /// Solves that a new factor takes.
    pub(crate) fn n_columns(&self) -> usize {
        2 * self.n_directions * self.drag.parts.len()
    }

    /// Bytes held once it was prepared.
    pub(crate) fn n_bytes(&self) -> usize {
        size_of::<f64>() * self.n_columns() * (self.n_rows() + self.n_columns())
    }

    /// T^T x of one right-hand side.
    fn projected(&self, x: &[f64]) -> DVector<f64> {
        let d = self.n_directions;
        let mut out = DVector::zeros(self.n_columns());
        for (p, part) in self.drag.parts.iter().enumerate() {
            for k in 0..d {
                let sum: f64 = part.vertices.clone().map(|i| x[d * i + k]).sum();
                out[2 * d * p + k] = sum / part.vertices.len() as f64;
                out[2 * d * p + d + k] = x[d * part.vertices.start + k];
            }
        }
        out
    }

    /// Makes Y and its small matrix for the matrix that `solver` has just factorised.
    pub(crate) fn prepare(&mut self, solver: &mut SparseCholesky) {
        let (d, n, n_columns) = (self.n_directions, self.n_rows(), self.n_columns());
        self.columns.clear();
        self.columns.resize(n * n_columns, 0.0);
        for (p, part) in self.drag.parts.iter().enumerate() {
            for k in 0..d {
                let mean = &mut self.columns[n * (2 * d * p + k)..][..n];
                let each = 1.0 / part.vertices.len() as f64;
                part.vertices.clone().for_each(|i| mean[d * i + k] = each);
                let first = &mut self.columns[n * (2 * d * p + d + k)..][..n];
                first[d * part.vertices.start + k] = 1.0;
            }
        }
        solver.solve_in_place(&mut self.columns, n_columns);
        let mut small = DMatrix::zeros(n_columns, n_columns);
        for (j, column) in self.columns.chunks_exact(n).enumerate() {
            small.set_column(j, &self.projected(column));
        }
        for (p, part) in self.drag.parts.iter().enumerate() {
            for k in 0..d {
                let (mean, first) = (2 * d * p + k, 2 * d * p + d + k);
                small[(mean, mean)] += 1.0 / part.resistance;
                small[(first, first)] -= 1.0 / part.ground;
            }
        }
        self.small = Some(small.lu());
    }

    /// Turns a solution of the grounded matrix into one with the drag, for each of several right-hand sides.
    pub(crate) fn correct(&self, solutions: &mut [f64]) {
        let n = self.n_rows();
        let Some(small) = &self.small else {
            return;
        };
        for x in solutions.chunks_exact_mut(n) {
            let mut weights = self.projected(x);
            small.solve_mut(&mut weights);
            for (column, weight) in self.columns.chunks_exact(n).zip(&weights) {
                for (x, y) in x.iter_mut().zip(column) {
                    *x -= weight * y;
                }
            }
        }
    }
}
