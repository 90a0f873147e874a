//! The degrees of freedom of a rod: vertices and integrated twists.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use topo_core::Polyline;

use crate::RodError;

/// How vertices and edges of a rod are joined, and the natural length of an edge.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Chain {
    n_vertices: usize,
    closed: bool,
    rest_length: f64,
}

impl Chain {
    /// Number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.n_vertices
    }

    /// Number of edges.
    pub fn n_edges(&self) -> usize {
        self.n_vertices - usize::from(!self.closed)
    }

    /// Whether the ends are fused.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Natural length of an edge, in h.
    pub fn rest_length(&self) -> f64 {
        self.rest_length
    }

    /// Natural length of the rod, in h.
    pub fn length(&self) -> f64 {
        self.rest_length * self.n_edges() as f64
    }

    /// Vertices that carry curvature and twist.
    pub fn interior(&self) -> std::ops::Range<usize> {
        if self.closed {
            0..self.n_vertices
        } else {
            1..self.n_vertices - 1
        }
    }

    /// Index of the edge that ends at vertex `i` (edge `i` starts there).
    #[inline]
    pub fn edge_before(&self, i: usize) -> usize {
        if i == 0 { self.n_edges() - 1 } else { i - 1 }
    }

    /// Vertex at the end of edge `j`.
    #[inline]
    pub fn edge_end(&self, j: usize) -> usize {
        if j + 1 == self.n_vertices { 0 } else { j + 1 }
    }
}

/// A discrete rod: vertices x_i and the integrated twist m_i of each interior vertex.
///
/// An isotropic rod needs no stored frames: the twist changes by the area that the tangents sweep on the unit sphere. Closed
/// rods have N vertices and N twists; open rods N + 1 vertices and N − 1 twists (those of the ends are kept at 0).
///
/// # References
/// The discrete rod of [bergou2008], with the twist per vertex as the variable.
///
/// [bergou2008]: https://doi.org/10.1145/1360612.1360662
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RodState {
    vertices: Vec<Vector3<f64>>,
    twists: Vec<f64>,
    chain: Chain,
    stamp: u64,
}

impl std::ops::Deref for RodState {
    type Target = Chain;

    fn deref(&self) -> &Chain {
        &self.chain
    }
}

impl RodState {
    /// A rod on `centreline` whose N edges have the same natural length l_0 = `length`/N (in h) and the uniform `twist_density`
    /// θ' (in radians per h).
    ///
    /// # Errors
    /// Too few edges, or a fold of a half turn.
    pub fn new(centreline: &Polyline, length: f64, twist_density: f64) -> Result<Self, RodError> {
        topo_core::positive("length", length)?;
        topo_core::finite("twist", twist_density)?;
        let n_edges = centreline.n_edges();
        if n_edges < crate::RodParameters::LEAST_EDGES {
            return Err(RodError::TooFewEdges {
                n_edges,
                least: crate::RodParameters::LEAST_EDGES,
            });
        }
        let rest_length = length / n_edges as f64;
        let closed = centreline.is_closed();
        let n = centreline.n_vertices();
        let mut twists = vec![twist_density * rest_length; n];
        if !closed {
            twists[0] = 0.0;
            twists[n - 1] = 0.0;
        }
        let chain = Chain {
            n_vertices: n,
            closed,
            rest_length,
        };
        let state = Self {
            vertices: centreline.vertices().to_vec(),
            twists,
            chain,
            stamp: 0,
        };
        for i in state.interior() {
            let (a, b) = (state.tangent(state.edge_before(i)), state.tangent(i));
            if a.dot(&b) < -1.0 + 1e-9 {
                return Err(RodError::Folded { vertex: i });
            }
        }
        Ok(state)
    }

    /// Positions, in h.
    pub fn vertices(&self) -> &[Vector3<f64>] {
        &self.vertices
    }

    /// Integrated twist of each vertex, in radians; 0 at free ends.
    pub fn twists(&self) -> &[f64] {
        &self.twists
    }

    /// How vertices and edges are joined.
    pub fn chain(&self) -> Chain {
        self.chain
    }

    /// Unit tangent of edge `j`.
    pub fn tangent(&self, j: usize) -> Vector3<f64> {
        (self.vertices[self.edge_end(j)] - self.vertices[j]).normalize()
    }

    /// Total twist Tw = Σ m_i / 2π, in turns.
    pub fn total_twist(&self) -> f64 {
        self.twists.iter().sum::<f64>() / std::f64::consts::TAU
    }

    /// Writhe of the centreline by the exact polygon formula.
    pub fn writhe(&self) -> f64 {
        topo_core::writhe(&self.vertices, self.chain.closed)
    }

    /// The centreline as a curve.
    ///
    /// # Errors
    /// Coincident vertices or numbers that are not finite.
    pub fn centreline(&self) -> Result<Polyline, RodError> {
        Ok(Polyline::new(self.vertices.clone(), self.chain.closed)?)
    }

    /// Distance between the two ends, in h (0 while closed).
    pub fn end_to_end(&self) -> f64 {
        if self.chain.closed {
            0.0
        } else {
            (self.vertices[self.vertices.len() - 1] - self.vertices[0]).norm()
        }
    }

    /// The same rod with its vertices elsewhere.
    pub(crate) fn with_vertices(&self, vertices: Vec<Vector3<f64>>) -> Self {
        Self {
            vertices,
            ..self.clone()
        }
    }

    /// Whether it is a rod joined like `chain`, all of whose numbers are finite.
    pub(crate) fn is_sound(&self, chain: Chain) -> bool {
        let n = chain.n_vertices;
        self.chain == chain
            && (self.vertices.len(), self.twists.len()) == (n, n)
            && self.vertices.iter().flatten().all(|x| x.is_finite())
            && self.twists.iter().all(|x| x.is_finite())
    }

    /// Identity of the numbers held: equal stamps mean equal states within one model.
    pub(crate) fn stamp(&self) -> u64 {
        self.stamp
    }

    /// The rod cut at `vertex`: the vertex is doubled, its twist dropped, the numbering starts there.
    ///
    /// # Errors
    /// The rod must be closed and the vertex exist.
    pub fn cut_at(&self, vertex: usize) -> Result<Self, RodError> {
        if !self.chain.closed {
            return Err(RodError::WrongTopology {
                operation: "a cut",
                needed: "a closed",
            });
        }
        let n = self.vertices.len();
        if vertex >= n {
            return Err(RodError::CutSite {
                at: vertex as f64 / n as f64,
            });
        }
        let vertices = (0..=n).map(|k| self.vertices[(vertex + k) % n]).collect();
        let twists = (0..=n)
            .map(|k| {
                if k == 0 || k == n {
                    0.0
                } else {
                    self.twists[(vertex + k) % n]
                }
            })
            .collect();
        let chain = Chain {
            n_vertices: n + 1,
            closed: false,
            ..self.chain
        };
        Ok(Self {
            vertices,
            twists,
            chain,
            stamp: self.stamp + 1,
        })
    }

    /// Moves the rod by a finite step: displacements (component-major, 3 × vertices) and, if twist is modelled, edge rotations.
    ///
    /// The twist of vertex i changes by the difference of the edge rotations and by the area that the two tangents sweep on
    /// the unit sphere, which keeps Tw + Wr of a closed rod to rounding:
    ///
    /// ```math
    /// m_i \leftarrow m_i + \delta\theta_i - \delta\theta_{i-1} + \Omega(a, b, b') + \Omega(a, b', a'), \qquad
    /// \tan \frac{\Omega(a, b, c)}{2} = \frac{a \cdot (b \times c)}{1 + a \cdot b + b \cdot c + c \cdot a}
    /// ```
    ///
    /// where a and b are the tangents before and after the vertex, a' and b' those after the step.
    pub(crate) fn moved_by(&self, step: &[f64], with_twist: bool, stamp: u64, to: &mut RodState) {
        let n = self.vertices.len();
        to.chain = self.chain;
        to.stamp = stamp;
        to.vertices.clear();
        to.vertices.extend(
            (0..n).map(|i| self.vertices[i] + Vector3::new(step[i], step[n + i], step[2 * n + i])),
        );
        to.twists.clear();
        to.twists.extend_from_slice(&self.twists);
        if !with_twist {
            return;
        }
        let turns = &step[3 * n..];
        let interior = self.interior();
        let before = self.edge_before(interior.start);
        let (mut a, mut a_new) = (self.tangent(before), to.tangent(before));
        let mut turn_before = turns[before];
        for i in interior {
            let (b, b_new) = (self.tangent(i), to.tangent(i));
            to.twists[i] += turns[i] - turn_before
                + spherical_area(&a, &b, &b_new)
                + spherical_area(&a, &b_new, &a_new);
            (a, a_new, turn_before) = (b, b_new, turns[i]);
        }
    }
}

/// Signed area of the spherical triangle of three unit vectors.
#[inline]
fn spherical_area(a: &Vector3<f64>, b: &Vector3<f64>, c: &Vector3<f64>) -> f64 {
    2.0 * a
        .dot(&b.cross(c))
        .atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

#[cfg(test)]
mod tests;
