//! Errors of this crate, one enum per stage; each names the cause and the remedy.

use crate::check::InvalidValue;

/// Why a list of vertices is no curve, or why an operation on a curve was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    /// Too few vertices: a closed polyline needs 3, an open one 2.
    #[error("a polyline of {n_vertices} vertices is too short: give at least {needed}")]
    TooFewVertices {
        /// How many were given.
        n_vertices: usize,
        /// How many are needed.
        needed: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite: check the input")]
    NotFinite {
        /// Index of the vertex.
        vertex: usize,
    },
    /// Two successive vertices coincide, so that their edge has no direction.
    #[error(
        "vertices {first} and {second} coincide: remove one of them (a closed curve must not repeat its first vertex)"
    )]
    CoincidentVertices {
        /// Index of the edge's first vertex.
        first: usize,
        /// Index of the edge's second vertex.
        second: usize,
    },
    /// No placement of equal edges was found.
    #[error(
        "edges could not be made equal with {n_edges} edges (relative spread {spread:.1e}): use more edges or smooth the curve first"
    )]
    UnequalEdges {
        /// How many edges were requested.
        n_edges: usize,
        /// Largest relative deviation from the mean edge that remained.
        spread: f64,
    },
    /// A parameter of the operation is outside its domain.
    #[error(transparent)]
    Value(#[from] InvalidValue),
}
