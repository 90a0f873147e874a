//! Errors of the shared ground, one enum a stage; each names the culprit and the remedy.

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
        /// How many edges were wanted.
        n_edges: usize,
        /// Largest relative deviation from the mean edge that remained.
        spread: f64,
    },
    /// A parameter of the operation is outside its domain.
    #[error(transparent)]
    Value(#[from] InvalidValue),
}

/// Why a sparse matrix could not be set up or factorised.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SparseError {
    /// The matrix has no rows, or more than 32-bit indices can count.
    #[error("a matrix of {n} rows cannot be factorised: expected 1 to 2^31 - 2 rows")]
    Size {
        /// How many rows were asked for.
        n: usize,
    },
    /// The pattern names an entry outside the matrix.
    #[error("pattern entry ({row}, {column}) lies outside a matrix of {n} rows")]
    OutOfBounds {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
        /// Rows of the matrix.
        n: usize,
    },
    /// The given ordering is no permutation.
    #[error(
        "the ordering of {n} rows is no permutation (position {position}): give each index once"
    )]
    Ordering {
        /// First offending position, or the length when it is wrong.
        position: usize,
        /// Rows of the matrix.
        n: usize,
    },
    /// A value is NaN or infinite.
    #[error(
        "matrix entry ({row}, {column}) is not finite: the state or the step that made it is broken"
    )]
    NotFinite {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
    },
    /// A pivot is not positive.
    #[error(
        "matrix is not positive definite at column {column}: fix the gauge or add to the diagonal"
    )]
    NotPositiveDefinite {
        /// Column, in the caller's numbering.
        column: usize,
    },
    /// Memory for the factor could not be had.
    #[error("not enough memory for the factor of a matrix of {n} rows: use fewer unknowns")]
    OutOfMemory {
        /// Rows of the matrix.
        n: usize,
    },
}
