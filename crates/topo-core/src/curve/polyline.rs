//! A polyline, open or closed, whose edges all have a direction.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::check;
use crate::error::CurveError;

type V = Vector3<f64>;

/// A chain of straight edges in space; a closed one has an edge from its last vertex to its first.
///
/// Only checked constructors make one: vertices are finite and successive ones differ (also across the seam), so that every
/// edge has a length above zero and a direction. Lengths are in the caller's unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked")]
pub struct Polyline {
    vertices: Vec<V>,
    closed: bool,
}

#[derive(Deserialize)]
struct Unchecked {
    vertices: Vec<V>,
    closed: bool,
}

impl TryFrom<Unchecked> for Polyline {
    type Error = CurveError;
    fn try_from(raw: Unchecked) -> Result<Self, CurveError> {
        Self::new(raw.vertices, raw.closed)
    }
}

impl Polyline {
    /// A polyline through `vertices`, in order.
    ///
    /// # Errors
    /// [`CurveError`] for fewer than 3 (closed) or 2 (open) vertices, a coordinate that is not finite, or successive
    /// vertices that coincide (closer than the smallest length whose square can be represented counts as coincident).
    pub fn new(vertices: Vec<V>, closed: bool) -> Result<Self, CurveError> {
        let n = vertices.len();
        let needed = if closed { 3 } else { 2 };
        if n < needed {
            return Err(CurveError::TooFewVertices {
                n_vertices: n,
                needed,
            });
        }
        if let Some(vertex) = vertices.iter().position(|v| !v.norm_squared().is_finite()) {
            return Err(CurveError::NotFinite { vertex });
        }
        let n_edges = if closed { n } else { n - 1 };
        for first in 0..n_edges {
            let second = (first + 1) % n;
            let length = (vertices[second] - vertices[first]).norm();
            if !length.is_finite() {
                return Err(CurveError::NotFinite { vertex: second });
            }
            if length == 0.0 {
                return Err(CurveError::CoincidentVertices { first, second });
            }
        }
        Ok(Self { vertices, closed })
    }

    /// The vertices, in order.
    pub fn vertices(&self) -> &[V] {
        &self.vertices
    }

    /// The vertices, by value.
    pub fn into_vertices(self) -> Vec<V> {
        self.vertices
    }

    /// Whether the last vertex is joined to the first.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.vertices.len()
    }

    /// Number of edges: as many as vertices when closed, one fewer when open.
    pub fn n_edges(&self) -> usize {
        if self.closed {
            self.vertices.len()
        } else {
            self.vertices.len() - 1
        }
    }

    /// Edge `i`, from vertex `i` to the next one.
    ///
    /// # Panics
    /// When `i` is not below [`n_edges`](Self::n_edges).
    pub fn edge(&self, i: usize) -> V {
        assert!(
            i < self.n_edges(),
            "edge {i} of a polyline of {} edges",
            self.n_edges()
        );
        self.vertices[(i + 1) % self.vertices.len()] - self.vertices[i]
    }

    /// Lengths of the edges, in order.
    pub fn edge_lengths(&self) -> Vec<f64> {
        (0..self.n_edges()).map(|i| self.edge(i).norm()).collect()
    }

    /// Sum of the lengths of the edges.
    pub fn length(&self) -> f64 {
        (0..self.n_edges()).map(|i| self.edge(i).norm()).sum()
    }

    /// Mean of the vertices.
    pub fn centroid(&self) -> V {
        let n = self.vertices.len() as f64;
        // Dividing first keeps huge coordinates finite.
        self.vertices.iter().map(|v| v / n).sum()
    }

    /// The mirror image in the plane z = 0. Lengths and angles stay the same to the bit, the writhe changes its sign.
    pub fn mirrored(&self) -> Self {
        Self {
            vertices: self
                .vertices
                .iter()
                .map(|v| V::new(v.x, v.y, -v.z))
                .collect(),
            closed: self.closed,
        }
    }

    /// The polyline with every coordinate multiplied by `factor`.
    ///
    /// # Errors
    /// [`CurveError`] when `factor` is not a positive finite number, or so extreme that vertices coincide or overflow.
    pub fn scaled(&self, factor: f64) -> Result<Self, CurveError> {
        check::positive("factor", factor)?;
        Self::new(
            self.vertices.iter().map(|v| v * factor).collect(),
            self.closed,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn refuses_what_is_no_curve() {
        let p = |x: f64| V::new(x, 0.0, 0.0);
        let two = CurveError::TooFewVertices {
            n_vertices: 2,
            needed: 3,
        };
        assert_eq!(Polyline::new(vec![p(0.0), p(1.0)], true), Err(two));
        assert!(Polyline::new(vec![p(0.0), p(1.0)], false).is_ok());
        assert!(Polyline::new(vec![], false).is_err());
        let nan = CurveError::NotFinite { vertex: 1 };
        assert_eq!(Polyline::new(vec![p(0.0), p(f64::NAN)], false), Err(nan));
        let seam = CurveError::CoincidentVertices {
            first: 2,
            second: 0,
        };
        let vertices = vec![p(0.0), V::y(), p(0.0)];
        assert_eq!(Polyline::new(vertices.clone(), true), Err(seam));
        assert!(Polyline::new(vertices, false).is_ok());
    }

    #[test]
    fn unit_square() {
        let square =
            Polyline::new(vec![V::zeros(), V::x(), V::x() + V::y(), V::y()], true).unwrap();
        assert_eq!(
            (square.n_vertices(), square.n_edges(), square.length()),
            (4, 4, 4.0)
        );
        assert_eq!(square.edge(3), -V::y());
        assert_eq!(square.clone().into_vertices(), square.vertices());
        assert_eq!(square.centroid(), V::new(0.5, 0.5, 0.0));
        assert_eq!(square.scaled(2.0).unwrap().length(), 8.0);
        assert!(
            square.scaled(0.0).is_err()
                && square.scaled(f64::NAN).is_err()
                && square.scaled(1e300).is_err()
        );
    }

    proptest! {
        #[test]
        fn any_input_gives_a_sound_curve_or_an_error(
            raw in prop::collection::vec(prop::array::uniform3(any::<f64>()), 0..8), closed: bool,
        ) {
            if let Ok(curve) = Polyline::new(raw.into_iter().map(V::from).collect(), closed) {
                prop_assert!(curve.edge_lengths().iter().all(|l| l.is_finite() && *l > 0.0));
                prop_assert!(curve.centroid().iter().all(|x| x.is_finite()));
                prop_assert!(curve.writhe().is_finite());
                prop_assert_eq!(curve.mirrored().edge_lengths(), curve.edge_lengths());
                prop_assert_eq!(curve.mirrored().mirrored(), curve);
            }
        }
    }
}
