//! The shape that a rod has at rest, and the directors that say how its material is turned.

use std::sync::Arc;

use nalgebra::Vector3;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::RodState;
use crate::{Chain, Geometry, Layout, RodError};

type V = Vector3<f64>;

/// Natural curvature and twist of each vertex, in the frame of the material.
///
/// The curvature is a vector κ_1 d_1 + κ_2 d_2 in the two directors across the rod, which turn with the material; a binormal, so that
/// κ_1 alone bends the rod about d_1. The twist is that of the directors along the rod. Ends of open components have none.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RestShape {
    /// (κ_1, κ_2) of each vertex, in 1/h.
    pub curvature: Vec<[f64; 2]>,
    /// Natural twist of each vertex, in radians per h.
    pub twist: Vec<f64>,
}

impl RestShape {
    /// The natural shape of the mirror image: (κ_1, −κ_2) and −θ'.
    ///
    /// A mirror M turns tangents t into M t, and binormals, which are axial, into −M kb. d_1 begins as a binormal and angles change
    /// their sign, so that d_1 becomes −M d_1 and d_2 = t × d_1 becomes M d_2 all along: kb·d_1 stays, kb·d_2 changes its sign.
    ///
    /// # Validation
    /// `law_fibres_with_a_natural_shape_are_mirrored_with_it`
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self {
            curvature: self.curvature.iter().map(|[a, b]| [*a, -b]).collect(),
            twist: self.twist.iter().map(|turn| -turn).collect(),
        }
    }
}

/// What a state with a natural shape holds beside its vertices and twists.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Material {
    #[serde(serialize_with = "write_shared", deserialize_with = "read_shared")]
    shape: Arc<RestShape>,
    /// Director d_1 of the first edge of each component: with the twists it gives that of every edge.
    directors: Vec<V>,
}

fn write_shared<S: Serializer>(shape: &Arc<RestShape>, to: S) -> Result<S::Ok, S::Error> {
    shape.as_ref().serialize(to)
}

fn read_shared<'de, D: Deserializer<'de>>(from: D) -> Result<Arc<RestShape>, D::Error> {
    RestShape::deserialize(from).map(Arc::new)
}

impl RodState {
    /// The same rods with a natural shape: `curvature` and `twist` give, for component c and the arclength s along it in h, the natural
    /// curvature (κ_1, κ_2) in 1/h and twist in radians per h.
    ///
    /// d_1 of the first edge is the present binormal at its end, or any normal where the rod is straight there, and the present
    /// twists say how the material is turned from there on: κ_1 > 0 bends an untwisted plane rod as it is bent now.
    ///
    /// # Errors
    /// A number that is not finite.
    ///
    /// # Validation
    /// `val_a_naturally_curved_ring_is_free_of_stress`, `val_half_a_turn_opened_straight`
    pub fn with_rest(
        self,
        curvature: impl Fn(usize, f64) -> [f64; 2],
        twist: impl Fn(usize, f64) -> f64,
    ) -> Result<Self, RodError> {
        let mut shape = RestShape::default();
        for (c, chain) in self.components().iter().enumerate() {
            for i in chain.vertices() {
                let s = (i - chain.first()) as f64 * chain.rest_length();
                let ([a, b], turn) = (curvature(c, s), twist(c, s));
                for x in [a, b, turn] {
                    topo_core::finite("rest", x)?;
                }
                let bends = chain.interior().contains(&i);
                shape.curvature.push(if bends { [a, b] } else { [0.0; 2] });
                shape.twist.push(if bends { turn } else { 0.0 });
            }
        }
        Ok(self.with_shape(shape))
    }

    /// The same rods with the natural shape `shape`, of as many vertices.
    pub(crate) fn with_shape(mut self, shape: RestShape) -> Self {
        let director = |chain: &Chain| {
            let (first, next) = (self.tangent(chain.first()), self.tangent(chain.first() + 1));
            across(&first, &first.cross(&next))
        };
        let directors = self.components().iter().map(director).collect();
        self.joined.material = Some(Box::new(Material {
            shape: Arc::new(shape),
            directors,
        }));
        self
    }

    /// The same rods with their present shape as the natural one: free of bending and twist.
    ///
    /// # Errors
    /// None in practice: a state has a curvature.
    pub fn at_rest(self) -> Result<Self, RodError> {
        let straight = self.with_rest(|_, _| [0.0; 2], |_, _| 0.0)?;
        let geometry = Geometry::new(&straight);
        let of = |i: usize| {
            let (c, chain) = (straight.component_of(i), straight.chain_of(i));
            let [before, after] = geometry.directors_at(c, chain, i);
            let omega = |k: usize| 0.5 * geometry.binormal[i].dot(&(before[k] + after[k]));
            let per_length = 1.0 / chain.rest_length();
            let curvature = [omega(0) * per_length, omega(1) * per_length];
            (curvature, straight.twists[i] * per_length)
        };
        let n = straight.n_vertices();
        let found: Vec<_> = (0..n)
            .map(|i| {
                if straight.is_interior(i) {
                    of(i)
                } else {
                    ([0.0; 2], 0.0)
                }
            })
            .collect();
        let (curvature, twist) = found.into_iter().unzip();
        Ok(straight.with_shape(RestShape { curvature, twist }))
    }

    /// Bytes held for a natural shape.
    pub(crate) fn n_rest_bytes(&self) -> usize {
        self.joined.material.as_deref().map_or(0, |material| {
            let shape = &material.shape;
            size_of_val(&shape.curvature[..])
                + size_of_val(&shape.twist[..])
                + size_of_val(&material.directors[..])
        })
    }

    /// The natural shape, if it is not straight and untwisted.
    pub fn rest(&self) -> Option<&RestShape> {
        self.joined
            .material
            .as_deref()
            .map(|material| &*material.shape)
    }

    /// Carries the first directors along with a step to `to`, whose vertices are moved already.
    pub(super) fn carry_directors(&self, step: &[f64], with_twist: bool, to: &mut Self) {
        let Some(material) = &self.joined.material else {
            to.joined.material = None;
            return;
        };
        let mut carried_there = to.joined.material.take().unwrap_or_default();
        carried_there.shape.clone_from(&material.shape);
        carried_there.directors.clear();
        let chains = self.components().iter();
        for (chain, director) in chains.zip(&material.directors) {
            let edge = chain.first();
            let (before, after) = (self.tangent(edge), to.tangent(edge));
            let turn = if with_twist {
                step[3 * self.n_vertices() + edge]
            } else {
                0.0
            };
            let there = carried(director, &before, &after);
            carried_there.directors.push(turned(&there, &after, turn));
        }
        to.joined.material = Some(carried_there);
    }

    /// Director d_1 of the first edge of component `c`.
    pub(crate) fn first_director(&self, c: usize) -> Option<V> {
        self.joined
            .material
            .as_ref()
            .map(|material| material.directors[c])
    }
}

impl Material {
    /// That of several rods; those that are straight and untwisted at rest have directors too where another one has.
    pub(crate) fn of_link(rods: &[&RodState]) -> Option<Box<Self>> {
        rods.iter().any(|rod| rod.rest().is_some()).then(|| {
            let (mut shape, mut directors) = (RestShape::default(), Vec::new());
            for rod in rods {
                let material = rod.joined.material.as_deref();
                let (straight, n) = (RestShape::default(), rod.n_vertices());
                let own = material.map_or(&straight, |material| &*material.shape);
                shape.curvature.extend_from_slice(&own.curvature);
                shape.twist.extend_from_slice(&own.twist);
                let (length, more) = (shape.twist.len(), n - own.twist.len());
                shape.curvature.resize(length + more, [0.0; 2]);
                shape.twist.resize(length + more, 0.0);
                for (c, chain) in rod.components().iter().enumerate() {
                    let any = across(&rod.tangent(chain.first()), &V::zeros());
                    directors.push(material.map_or(any, |material| material.directors[c]));
                }
            }
            Box::new(Self {
                shape: Arc::new(shape),
                directors,
            })
        })
    }

    /// The same with vertices in another order: `places` gives the old number of each, `is_end` says which are ends now; component
    /// `cut` starts with `director`. Vertices marked by `is_behind` lie behind the seam, over which directors now go on: they are
    /// turned by `seam`, in radians.
    pub(crate) fn rearranged(
        &self,
        places: &[usize],
        is_end: impl Fn(usize) -> bool,
        is_behind: impl Fn(usize) -> bool,
        (cut, director, seam): (usize, V, f64),
    ) -> Self {
        let mut shape = RestShape {
            curvature: places.iter().map(|&i| self.shape.curvature[i]).collect(),
            twist: places.iter().map(|&i| self.shape.twist[i]).collect(),
        };
        for k in (0..places.len()).filter(|&k| is_behind(places[k])) {
            let [a, b] = shape.curvature[k];
            shape.curvature[k] = [
                a * seam.cos() + b * seam.sin(),
                b * seam.cos() - a * seam.sin(),
            ];
        }
        for end in (0..places.len()).filter(|&k| is_end(k)) {
            (shape.curvature[end], shape.twist[end]) = ([0.0; 2], 0.0);
        }
        let mut directors = self.directors.clone();
        directors[cut] = director;
        Self {
            shape: Arc::new(shape),
            directors,
        }
    }

    /// The same with component `c` parted in two, the second of which starts with `director`: `places` gives the old number of each
    /// vertex, `is_end` says which are ends now.
    pub(crate) fn halved(
        &self,
        places: &[usize],
        is_end: impl Fn(usize) -> bool,
        (c, director): (usize, V),
    ) -> Self {
        let own = self.directors[c];
        let mut halved = self.rearranged(places, is_end, |_| false, (c, own, 0.0));
        halved.directors.insert(c + 1, director);
        halved
    }

    /// That of component `c` alone, joined like `chain` within the whole.
    pub(crate) fn component(&self, c: usize, vertices: std::ops::Range<usize>) -> Self {
        Self {
            shape: Arc::new(RestShape {
                curvature: self.shape.curvature[vertices.clone()].to_vec(),
                twist: self.shape.twist[vertices].to_vec(),
            }),
            directors: vec![self.directors[c]],
        }
    }

    /// Whether it is that of a state joined like `layout`, with the natural shape of `fresh`, and its numbers are finite.
    pub(crate) fn is_like(&self, fresh: &Self, layout: &Layout) -> bool {
        self.shape == fresh.shape
            && self.directors.len() == layout.n_components()
            && self.directors.iter().flatten().all(|x| x.is_finite())
    }
}

/// A unit vector across `tangent`: the part of `wanted` that is, or any one.
fn across(tangent: &V, wanted: &V) -> V {
    let part = wanted - tangent * tangent.dot(wanted);
    if part.norm() > 1e-9 {
        return part.normalize();
    }
    let axis = tangent.iamin();
    let other = V::ith(axis, 1.0);
    (other - tangent * tangent.dot(&other)).normalize()
}

/// A vector across tangent `a` carried over to tangent `b` by the least rotation.
#[inline]
pub(crate) fn carried(v: &V, a: &V, b: &V) -> V {
    v - (a + b) * (b.dot(v) / (1.0 + a.dot(b)))
}

/// A vector across `tangent` turned about it.
#[inline]
pub(crate) fn turned(v: &V, tangent: &V, angle: f64) -> V {
    v * angle.cos() + tangent.cross(v) * angle.sin()
}
