//! Edge lengths, tangents and curvature binormals of a state, computed once and read by every term.

use nalgebra::Vector3;

use crate::state::{carried, turned};
use crate::{Chain, RodState};

/// Edges shorter than this share of their natural length have no reliable direction: rounding would turn it.
const COLLAPSED: f64 = 1e-3;

/// Geometry of one state: what bend, twist, stretch and twist viscosity share.
#[derive(Debug, Clone, Default)]
pub struct Geometry {
    /// Length of each edge, in h (0 where no edge is: [`Layout`](crate::Layout)).
    pub edge_length: Vec<f64>,
    /// Unit tangent of each edge.
    pub tangent: Vec<Vector3<f64>>,
    /// c_i = t_{i−1}·t_i of each interior vertex (1 at free ends).
    pub cosine: Vec<f64>,
    /// Curvature binormal kb_i = 2 t_{i−1} × t_i/(1 + c_i), |kb| = 2 tan(φ/2): no unit (0 at free ends).
    pub binormal: Vec<Vector3<f64>>,
    /// Director d_1 of each edge; none without a natural shape.
    pub director: Vec<Vector3<f64>>,
    /// Director d_1 of the first edge of each component as it is when carried once around it: where its ends were fused at an
    /// angle, the material jumps by that angle within this edge.
    pub seam: Vec<Vector3<f64>>,
}

impl Geometry {
    /// Geometry of `state`.
    pub fn new(state: &RodState) -> Self {
        let mut g = Self::default();
        g.update(state);
        g
    }

    /// Recomputes all; returns false if an edge has collapsed or a turning angle reached a half turn.
    pub fn update(&mut self, state: &RodState) -> bool {
        let (x, n, n_edges) = (state.vertices(), state.n_vertices(), state.n_edges());
        self.edge_length.resize(n_edges, 0.0);
        self.tangent.resize(n_edges, Vector3::zeros());
        self.cosine.clear();
        self.cosine.resize(n, 1.0);
        self.binormal.clear();
        self.binormal.resize(n, Vector3::zeros());
        self.director.clear();
        self.seam.clear();
        let mut sound = true;
        for chain in state.components() {
            let least = COLLAPSED * chain.rest_length();
            for j in chain.edges() {
                let e = x[chain.edge_end(j)] - x[j];
                let length = e.norm();
                sound &= length > least;
                self.edge_length[j] = length;
                self.tangent[j] = e / length;
            }
            for i in chain.interior() {
                let (a, b) = (self.tangent[chain.edge_before(i)], self.tangent[i]);
                let c = a.dot(&b);
                sound &= c > -1.0 + 1e-6;
                self.cosine[i] = c;
                self.binormal[i] = a.cross(&b) * (2.0 / (1.0 + c));
            }
        }
        if state.rest().is_some() {
            self.follow_directors(state);
        }
        sound
    }

    /// Directors d_1 and d_2 = t × d_1 of the edges before and after vertex `i` of component `c`, joined like `chain`.
    #[inline]
    pub(crate) fn directors_at(&self, c: usize, chain: &Chain, i: usize) -> [[Vector3<f64>; 2]; 2] {
        let before = chain.edge_before(i);
        let after = if i == chain.first() {
            self.seam[c]
        } else {
            self.director[i]
        };
        [(before, self.director[before]), (i, after)].map(|(j, d)| [d, self.tangent[j].cross(&d)])
    }

    /// From the first edge of each component on, carried over each vertex and turned by its twist.
    fn follow_directors(&mut self, state: &RodState) {
        self.director.resize(state.n_edges(), Vector3::zeros());
        for (c, chain) in state.components().iter().enumerate() {
            let Some(mut director) = state.first_director(c) else {
                continue;
            };
            self.director[chain.first()] = director;
            for j in chain.edges().skip(1) {
                let (a, b) = (self.tangent[j - 1], self.tangent[j]);
                director = turned(&carried(&director, &a, &b), &b, state.twists()[j]);
                self.director[j] = director;
            }
            let (last, first) = (chain.edges().end - 1, chain.first());
            let (a, b) = (self.tangent[last], self.tangent[first]);
            self.seam.push(turned(
                &carried(&director, &a, &b),
                &b,
                state.twists()[first],
            ));
        }
    }
}
