//! Why a matrix was refused, with the cause and the remedy.

/// Why a sparse matrix could not be set up or factorised.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SparseError {
    /// The matrix has no rows, or more than 32-bit indices can count.
    #[error("a matrix of {n} rows cannot be factorised: expected 1 to 2^31 - 2 rows")]
    Size {
        /// How many rows were requested.
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
    /// There is not enough memory for the factor.
    #[error("not enough memory for the factor of a matrix of {n} rows: use fewer unknowns")]
    OutOfMemory {
        /// Rows of the matrix.
        n: usize,
    },
}
