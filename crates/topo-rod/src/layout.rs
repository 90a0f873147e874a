//! How vertices and edges are joined: one chain, or several beside each other.

mod encoding;

use std::ops::Range;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// One component: a closed or open chain of consecutive vertices, and the natural length of its edges.
///
/// Edge j starts at vertex j. Indices are those of the whole state, so that the vertices of a single component begin at 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Chain {
    first: usize,
    n_vertices: usize,
    closed: bool,
    rest_length: f64,
}

impl Chain {
    /// A component alone.
    pub(crate) fn new(n_vertices: usize, closed: bool, rest_length: f64) -> Self {
        Self {
            first: 0,
            n_vertices,
            closed,
            rest_length,
        }
    }

    /// Its first vertex.
    pub fn first(&self) -> usize {
        self.first
    }

    /// Its last vertex.
    pub fn last(&self) -> usize {
        self.first + self.n_vertices - 1
    }

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

    /// Natural length, in h.
    pub fn length(&self) -> f64 {
        self.rest_length * self.n_edges() as f64
    }

    /// All vertices.
    #[inline]
    pub fn vertices(&self) -> Range<usize> {
        self.first..self.first + self.n_vertices
    }

    /// All edges.
    #[inline]
    pub fn edges(&self) -> Range<usize> {
        self.first..self.first + self.n_edges()
    }

    /// Vertices that carry curvature and twist.
    #[inline]
    pub fn interior(&self) -> Range<usize> {
        if self.closed {
            self.vertices()
        } else {
            self.first + 1..self.first + self.n_vertices - 1
        }
    }

    /// Index of the edge that ends at vertex `i` (edge `i` starts there).
    #[inline]
    pub fn edge_before(&self, i: usize) -> usize {
        if i == self.first {
            self.first + self.n_edges() - 1
        } else {
            i - 1
        }
    }

    /// Vertex at the end of edge `j`.
    #[inline]
    pub fn edge_end(&self, j: usize) -> usize {
        if j + 1 == self.first + self.n_vertices {
            self.first
        } else {
            j + 1
        }
    }

    /// Arclength that vertex `i` stands for, in h: that of an edge, half of it at a free end.
    #[inline]
    pub fn share(&self, i: usize) -> f64 {
        if self.interior().contains(&i) {
            self.rest_length
        } else {
            0.5 * self.rest_length
        }
    }

    /// The same component with its first vertex at `first`.
    fn moved_to(self, first: usize) -> Self {
        Self { first, ..self }
    }

    /// The two components of an open one that is cut at `vertex`.
    pub(crate) fn halves(self, vertex: usize) -> [Self; 2] {
        [vertex - self.first, self.last() - vertex].map(|n_edges| Self {
            n_vertices: n_edges + 1,
            ..self
        })
    }

    /// The same component cut open: one vertex more.
    pub(crate) fn opened(self) -> Self {
        Self {
            n_vertices: self.n_vertices + 1,
            closed: false,
            ..self
        }
    }
}

/// The two ends that a cut has made, in one place at first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tips {
    /// Those of this component, which was closed.
    Of(usize),
    /// The last of this component and the first of the next one, which were one open component.
    Between(usize),
}

impl Tips {
    /// The component that was cut, or the first of the two that it is now.
    pub fn component(self) -> usize {
        match self {
            Self::Of(c) | Self::Between(c) => c,
        }
    }
}

/// How the vertices of a state are joined: its components, one after the other.
///
/// Edge j starts at vertex j in every component. So the last vertex of an open component that is followed by another one leaves the
/// place of an edge unused: quantities of edges are zero there, and [`n_edges`](Self::n_edges) counts it.
///
/// A state of one component holds nothing for further ones.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// The only component, or all of them taken together.
    whole: Chain,
    parts: Option<Arc<[Chain]>>,
}

impl Layout {
    /// Components one after the other, in their order.
    pub(crate) fn of(chains: impl IntoIterator<Item = Chain>) -> Self {
        let mut n_vertices = 0;
        let parts: Vec<Chain> = chains
            .into_iter()
            .map(|chain| {
                let placed = chain.moved_to(n_vertices);
                n_vertices += chain.n_vertices;
                placed
            })
            .collect();
        if let [single] = parts[..] {
            return Self {
                whole: single,
                parts: None,
            };
        }
        let n_edges: usize = parts.iter().map(Chain::n_edges).sum();
        let length: f64 = parts.iter().map(Chain::length).sum();
        let whole = Chain {
            first: 0,
            n_vertices,
            closed: parts.iter().all(|chain| chain.closed),
            rest_length: length / n_edges.max(1) as f64,
        };
        Self {
            whole,
            parts: Some(parts.into()),
        }
    }

    /// The components.
    #[inline]
    pub fn components(&self) -> &[Chain] {
        match &self.parts {
            None => std::slice::from_ref(&self.whole),
            Some(parts) => parts,
        }
    }

    /// Number of components.
    pub fn n_components(&self) -> usize {
        self.components().len()
    }

    /// The component with vertex `i` (or, beyond the last vertex, the last one).
    pub fn component_of(&self, i: usize) -> usize {
        match &self.parts {
            None => 0,
            Some(parts) => parts
                .partition_point(|chain| chain.first <= i)
                .saturating_sub(1),
        }
    }

    /// The component with vertex `i`.
    #[inline]
    pub fn chain_of(&self, i: usize) -> &Chain {
        match &self.parts {
            None => &self.whole,
            Some(parts) => &parts[self.component_of(i)],
        }
    }

    /// The component that has both vertices, if there is one.
    #[inline]
    pub fn common_chain(&self, i: usize, j: usize) -> Option<&Chain> {
        let chain = self.chain_of(i);
        (self.parts.is_none() || chain.vertices().contains(&j)).then_some(chain)
    }

    /// Number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.whole.n_vertices
    }

    /// Number of places for edges: that of edges, and one more for each open component that is not the last.
    pub fn n_edges(&self) -> usize {
        match self.components() {
            [] => 0,
            [.., last] => last.edges().end,
        }
    }

    /// Places of edges that none is at.
    pub(crate) fn unused_edges(&self) -> impl Iterator<Item = usize> + '_ {
        let (_, but_last) = self.components().split_last().unwrap_or((&self.whole, &[]));
        let open = but_last.iter().filter(|chain| !chain.closed);
        open.map(Chain::last)
    }

    /// Whether all ends are fused.
    pub fn is_closed(&self) -> bool {
        self.whole.closed
    }

    /// Natural length of an edge, in h; of several components, the mean over all edges.
    pub fn rest_length(&self) -> f64 {
        self.whole.rest_length
    }

    /// Natural length of all components together, in h.
    pub fn length(&self) -> f64 {
        match &self.parts {
            None => self.whole.length(),
            Some(parts) => parts.iter().map(Chain::length).sum(),
        }
    }

    /// Vertices that carry curvature and twist.
    pub fn interior(&self) -> impl Iterator<Item = usize> + '_ {
        self.components().iter().flat_map(Chain::interior)
    }

    /// Whether vertex `i` carries curvature and twist.
    #[inline]
    pub fn is_interior(&self, i: usize) -> bool {
        self.chain_of(i).interior().contains(&i)
    }

    /// Index of the edge that ends at vertex `i` (edge `i` starts there).
    #[inline]
    pub fn edge_before(&self, i: usize) -> usize {
        self.chain_of(i).edge_before(i)
    }

    /// Vertex at the end of edge `j`.
    #[inline]
    pub fn edge_end(&self, j: usize) -> usize {
        self.chain_of(j).edge_end(j)
    }

    /// Bytes held for further components: none by a single one.
    pub(crate) fn n_bytes(&self) -> usize {
        self.parts
            .as_ref()
            .map_or(0, |parts| size_of_val(&parts[..]))
    }
}
