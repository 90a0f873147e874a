//! The degrees of freedom of one or several rods: vertices and integrated twists.

mod measures;
mod rest;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use topo_core::Polyline;

pub use rest::RestShape;
pub(crate) use rest::{Material, carried, turned};

use crate::{Chain, Geometry, Layout, RodError};

/// A discrete rod: vertices x_i and the integrated twist m_i of each interior vertex.
///
/// An isotropic rod needs no stored frames: the twist changes by the area that the tangents sweep on the unit sphere. Closed
/// rods have N vertices and N twists; open rods N + 1 vertices and N − 1 twists (those of the ends are kept at 0).
///
/// Several rods, the components of a link, are one state: [`RodState::link`] puts their vertices one after the other, in the
/// order given, and [`Layout`] says which are whose.
///
/// # References
/// The discrete rod of [bergou2008], with the twist per vertex as the variable.
///
/// [bergou2008]: https://doi.org/10.1145/1360612.1360662
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RodState {
    vertices: Vec<Vector3<f64>>,
    twists: Vec<f64>,
    #[serde(rename = "chain")]
    joined: Joined,
    stamp: u64,
    /// Time in η/E_b, of a rod whose ends are driven in time; else it stands at 0.
    clock: f64,
    /// Turn of the two ends of each component against each other so far, in radians; empty unless they are twisted in time.
    turns: Vec<f64>,
}

/// How vertices are joined, and what their material is like at rest.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Joined {
    pub(crate) layout: Layout,
    /// None where all rods are straight and untwisted at rest.
    pub(crate) material: Option<Box<Material>>,
}

impl From<Layout> for Joined {
    fn from(layout: Layout) -> Self {
        Self {
            layout,
            material: None,
        }
    }
}

impl std::ops::Deref for RodState {
    type Target = Layout;

    fn deref(&self) -> &Layout {
        &self.joined.layout
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
        let state = Self {
            vertices: centreline.vertices().to_vec(),
            twists,
            joined: Layout::of([Chain::new(n, closed, rest_length)]).into(),
            stamp: 0,
            clock: 0.0,
            turns: Vec::new(),
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
    pub fn layout(&self) -> &Layout {
        &self.joined.layout
    }

    /// Unit tangent of edge `j`.
    pub fn tangent(&self, j: usize) -> Vector3<f64> {
        (self.vertices[self.edge_end(j)] - self.vertices[j]).normalize()
    }

    /// The same rod with its vertices elsewhere.
    pub(crate) fn with_vertices(&self, vertices: Vec<Vector3<f64>>) -> Self {
        Self {
            vertices,
            ..self.clone()
        }
    }

    /// Whether it is another state of the rods of `fresh`, all of whose numbers are finite.
    pub(crate) fn is_sound(&self, fresh: &Self) -> bool {
        let n = fresh.n_vertices();
        let is_alike = match (&self.joined.material, &fresh.joined.material) {
            (None, None) => true,
            (Some(own), Some(other)) => own.is_like(other, fresh),
            _ => false,
        };
        is_alike
            && self.joined.layout == fresh.joined.layout
            && (self.vertices.len(), self.twists.len()) == (n, n)
            && self.clock.is_finite()
            && self.turns.len() == fresh.turns.len()
            && self.turns.iter().all(|x| x.is_finite())
            && self.vertices.iter().flatten().all(|x| x.is_finite())
            && self.twists.iter().all(|x| x.is_finite())
    }

    /// Time in η/E_b, of a rod whose ends are driven in time.
    pub(crate) fn clock(&self) -> f64 {
        self.clock
    }

    /// Sets the clock.
    pub(crate) fn set_clock(&mut self, time: f64) {
        self.clock = time;
    }

    /// Turns the two ends of component `c`, held together at its first vertex `seam`, against each other, in radians.
    pub(crate) fn turn_seam(&mut self, c: usize, seam: usize, turn: f64) {
        self.twists[seam] += turn;
        self.turns[c] += turn;
    }

    /// Turn of the two ends of component `c` against each other so far, in radians.
    pub(crate) fn turned_by(&self, c: usize) -> f64 {
        self.turns.get(c).copied().unwrap_or(0.0)
    }

    /// Twist of an interior vertex beyond the natural one, in radians.
    #[inline]
    pub(crate) fn excess_twist(&self, i: usize) -> f64 {
        let natural = self.rest().map_or(0.0, |rest| rest.twist[i]);
        self.twists[i] - self.chain_of(i).rest_length() * natural
    }

    /// The rods with a twist density, in radians per h, taken out of all joints, before their ends are turned against each other.
    pub(crate) fn untwisted(mut self, density: f64) -> Self {
        self.turns = vec![0.0; self.n_components()];
        let chains = self.components().to_vec();
        for chain in chains {
            chain
                .interior()
                .for_each(|i| self.twists[i] -= density * chain.rest_length());
        }
        self
    }

    /// Identity of the numbers held: equal stamps mean equal states within one model.
    pub(crate) fn stamp(&self) -> u64 {
        self.stamp
    }

    /// Several rods as one state: their vertices one after the other, in the order given, wherever they are.
    ///
    /// # Errors
    /// No rod at all.
    ///
    /// # Validation
    /// `a_link_is_its_rods_one_after_the_other`
    pub fn link<'a>(rods: impl IntoIterator<Item = &'a Self>) -> Result<Self, RodError> {
        let (mut vertices, mut twists, mut chains) = (Vec::new(), Vec::new(), Vec::new());
        let rods: Vec<&Self> = rods.into_iter().collect();
        for rod in &rods {
            vertices.extend_from_slice(&rod.vertices);
            twists.extend_from_slice(&rod.twists);
            chains.extend_from_slice(rod.components());
        }
        if chains.is_empty() {
            return Err(RodError::NoComponent);
        }
        Ok(Self {
            vertices,
            twists,
            joined: Joined {
                layout: Layout::of(chains),
                material: Material::of_link(&rods),
            },
            stamp: 0,
            clock: 0.0,
            turns: Vec::new(),
        })
    }

    /// Component `c` alone.
    ///
    /// # Errors
    /// There is no such component.
    pub fn component(&self, c: usize) -> Result<Self, RodError> {
        let own = self.chain(c)?.vertices();
        let material = self.joined.material.as_ref();
        Ok(Self {
            vertices: self.vertices[own.clone()].to_vec(),
            twists: self.twists[own.clone()].to_vec(),
            joined: Joined {
                layout: Layout::of([*self.chain(c)?]),
                material: material.map(|m| Box::new(m.component(c, own))),
            },
            stamp: 0,
            clock: 0.0,
            turns: Vec::new(),
        })
    }

    /// How component `c` is joined.
    ///
    /// # Errors
    /// There is no such component.
    pub fn chain(&self, c: usize) -> Result<&Chain, RodError> {
        let n_components = self.n_components();
        let missing = RodError::Component { c, n_components };
        self.components().get(c).ok_or(missing)
    }

    /// The rods with the component cut that has `vertex`: the vertex is doubled, its twist dropped, and the numbering of a closed
    /// component starts there, while an open one becomes two. Vertices behind move up by one.
    ///
    /// # Errors
    /// The vertex must exist and, of an open component, leave two edges at least on either side.
    pub fn cut_at(&self, vertex: usize) -> Result<Self, RodError> {
        let n_vertices = self.vertices.len();
        let cut = *self.chain_of(vertex);
        if vertex >= n_vertices {
            return Err(RodError::CutSite {
                at: vertex as f64 / n_vertices as f64,
            });
        }
        if !cut.is_closed() {
            return self.halved_at(vertex, &cut);
        }
        let (first, n, behind) = (cut.first(), cut.n_vertices(), cut.vertices().end);
        let opened = (0..=n).map(|k| first + (vertex - first + k) % n);
        let places: Vec<usize> = (0..first).chain(opened).chain(behind..n_vertices).collect();
        let is_end = |k: usize| k == first || k == first + n;
        let chains = self.components().iter();
        let chains = chains.map(|chain| if *chain == cut { cut.opened() } else { *chain });
        let material = self.joined.material.as_ref().map(|material| {
            let (c, geometry) = (self.component_of(vertex), Geometry::new(self));
            let (own, around) = (geometry.director[first], geometry.seam[c]);
            let seam = geometry.tangent[first]
                .dot(&own.cross(&around))
                .atan2(own.dot(&around));
            let is_behind = |place: usize| first < place && place < vertex;
            let director = geometry.director[vertex];
            Box::new(material.rearranged(&places, is_end, is_behind, (c, director, seam)))
        });
        Ok(self.parted(&places, is_end, chains, material))
    }

    /// The rods with the open component `cut` parted at `vertex`.
    fn halved_at(&self, vertex: usize, cut: &Chain) -> Result<Self, RodError> {
        if !(cut.first() + 2..cut.last() - 1).contains(&vertex) {
            return Err(RodError::CutAtEnd {
                at: (vertex - cut.first()) as f64 / cut.n_edges() as f64,
            });
        }
        let places: Vec<usize> = (0..=vertex).chain(vertex..self.vertices.len()).collect();
        let is_end = |k: usize| k == vertex || k == vertex + 1;
        let chains = self.components().iter();
        let chains = chains.flat_map(|chain| {
            let halves = (chain == cut).then(|| chain.halves(vertex));
            halves.map_or_else(|| vec![*chain], Vec::from)
        });
        let material = self.joined.material.as_ref().map(|material| {
            let director = Geometry::new(self).director[vertex];
            Box::new(material.halved(&places, is_end, (self.component_of(vertex), director)))
        });
        Ok(self.parted(&places, is_end, chains, material))
    }

    /// The rods that a cut leaves: `places` gives the old number of each vertex, `is_end` says which are ends now and have no twist.
    fn parted(
        &self,
        places: &[usize],
        is_end: impl Fn(usize) -> bool,
        chains: impl IntoIterator<Item = Chain>,
        material: Option<Box<Material>>,
    ) -> Self {
        let twist = |(k, &place): (usize, &usize)| {
            if is_end(k) { 0.0 } else { self.twists[place] }
        };
        Self {
            vertices: places.iter().map(|&place| self.vertices[place]).collect(),
            twists: places.iter().enumerate().map(twist).collect(),
            joined: Joined {
                layout: Layout::of(chains),
                material,
            },
            stamp: self.stamp + 1,
            clock: 0.0,
            turns: Vec::new(),
        }
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
        to.joined.layout.clone_from(&self.joined.layout);
        to.stamp = stamp;
        to.clock = self.clock;
        to.turns.clone_from(&self.turns);
        to.vertices.clear();
        to.vertices.extend(
            (0..n).map(|i| self.vertices[i] + Vector3::new(step[i], step[n + i], step[2 * n + i])),
        );
        to.twists.clear();
        to.twists.extend_from_slice(&self.twists);
        self.carry_directors(step, with_twist, to);
        if !with_twist {
            return;
        }
        let turns = &step[3 * n..];
        for chain in self.components() {
            let tangent = |x: &[Vector3<f64>], j: usize| (x[chain.edge_end(j)] - x[j]).normalize();
            let interior = chain.interior();
            let before = chain.edge_before(interior.start);
            let mut a = tangent(&self.vertices, before);
            let mut a_new = tangent(&to.vertices, before);
            let mut turn_before = turns[before];
            for i in interior {
                let (b, b_new) = (tangent(&self.vertices, i), tangent(&to.vertices, i));
                to.twists[i] += turns[i] - turn_before
                    + spherical_area(&a, &b, &b_new)
                    + spherical_area(&a, &b_new, &a_new);
                (a, a_new, turn_before) = (b, b_new, turns[i]);
            }
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
