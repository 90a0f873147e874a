//! Knot invariants from coordinates: project, simplify the diagram, then polynomial, determinant and signature.

mod alexander;
mod coordinates;
mod diagram;
mod field;
mod goeritz;
mod jones;
mod kauffman;
mod passes;
mod projection;

use crate::reduce::shortened;
use crate::{KnotError, V};

pub(crate) use coordinates::usable_vertices;
pub(crate) use diagram::Diagram;
#[cfg(test)]
pub(crate) use diagram::Visit;
pub use jones::Jones;
pub(crate) use jones::text as polynomial_text;
pub(crate) use kauffman::{kauffman, kauffman_of_name, numbers};
#[cfg(test)]
pub(crate) use projection::one_view;
pub(crate) use projection::{fibonacci_directions, least_crossing, least_crossing_of};

/// Directions tried for the projection with the fewest crossings.
const N_PROJECTIONS: usize = 30;

/// Most crossings of a diagram whose invariants are computed: the work grows with their fourth power.
const MOST_CROSSINGS: usize = 250;
/// Crossings up to which all numbers on the way are exact for certain.
const EXACT_CROSSINGS: usize = 40;

/// Vertices above which a curve is shortened before it is projected: the work of a projection grows with their square.
const LONGEST_PROJECTED: usize = 5000;

/// Invariants of a closed curve.
///
/// # Validation
/// `invariants_of_the_table`, `composite_knots_multiply`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Invariants {
    /// Coefficients of the Alexander polynomial, symmetric, the first one positive.
    pub alexander: Vec<i64>,
    /// Determinant, |Delta(-1)|.
    pub determinant: u64,
    /// Signature; -2 for the right-handed trefoil.
    pub signature: i32,
}

impl Invariants {
    /// Invariants of the closed polygon through `vertices`, from its projection with the fewest crossings.
    ///
    /// Determinant and signature come from the Goeritz matrix, the polynomial from Fox's derivative of the Wirtinger
    /// presentation, so that their agreement at t = -1 is a check.
    ///
    /// # Errors
    /// [`KnotError::TooFewVertices`], [`KnotError::NotFinite`], and [`KnotError::Degenerate`] when no projection is in
    /// general position or the two routes disagree, as they do when the curve runs through itself.
    ///
    /// # References
    /// [alexander1928], [gordon1978]
    ///
    /// [alexander1928]: https://doi.org/10.1090/S0002-9947-1928-1501429-1
    /// [gordon1978]: https://doi.org/10.1007/BF01609479
    pub fn of(vertices: &[V]) -> Result<Self, KnotError> {
        Self::of_diagram(&diagram(vertices)?)
    }

    /// Invariants of a diagram.
    ///
    /// # Errors
    /// [`KnotError::TooComplicated`] for more crossings than accepted, [`KnotError::Degenerate`] if polynomial and Goeritz
    /// matrix contradict each other.
    pub(crate) fn of_diagram(diagram: &Diagram) -> Result<Self, KnotError> {
        let n_crossings = diagram.n_crossings();
        // Beyond this, the determinant of the Goeritz matrix may lose its last digit.
        let failed = if n_crossings > EXACT_CROSSINGS {
            KnotError::TooComplicated { n_crossings }
        } else {
            KnotError::Degenerate
        };
        if n_crossings > MOST_CROSSINGS {
            return Err(failed);
        }
        let known = alexander::polynomial(diagram)
            .zip(goeritz::determinant_and_signature(diagram))
            .filter(|(alexander, (determinant, _))| at_minus_one(alexander) == *determinant);
        let Some((alexander, (determinant, signature))) = known else {
            return Err(failed);
        };
        Ok(Self {
            alexander,
            determinant,
            signature,
        })
    }

    /// Jones polynomial of a diagram; `None` if that would take too long.
    pub(crate) fn jones_of(diagram: &Diagram) -> Option<Jones> {
        jones::jones(diagram)
    }

    /// Kauffman's bracket of a diagram times (-A^3)^-w, w being the writhe of the components alone, in powers of t: four times the
    /// lowest, and the coefficients; `None` if that would take too long.
    pub(crate) fn bracket_of(diagram: &Diagram) -> Option<(i32, Vec<i64>)> {
        jones::bracket(diagram)?.in_powers_of_t(diagram.own_writhe())
    }

    /// Invariants of the unknot.
    pub(crate) fn unknot() -> Self {
        Self {
            alexander: vec![1],
            determinant: 1,
            signature: 0,
        }
    }

    /// The invariants of the mirror image.
    pub fn mirror(&self) -> Self {
        Self {
            signature: -self.signature,
            ..self.clone()
        }
    }

    /// The invariants of the connected sum of two knots: polynomials and determinants multiply, signatures add; `None` beyond 64 bits.
    pub fn sum(&self, other: &Self) -> Option<Self> {
        let mut alexander = vec![0; self.alexander.len() + other.alexander.len() - 1];
        for (i, a) in self.alexander.iter().enumerate() {
            for (j, b) in other.alexander.iter().enumerate() {
                let product = i64::checked_mul(*a, *b)?;
                alexander[i + j] = i64::checked_add(alexander[i + j], product)?;
            }
        }
        Some(Self {
            alexander,
            determinant: self.determinant.checked_mul(other.determinant)?,
            signature: self.signature.checked_add(other.signature)?,
        })
    }

    /// The polynomial as text, lowest power first, as `1 -1 1`.
    pub fn alexander_text(&self) -> String {
        self.alexander
            .iter()
            .map(|c| c.to_string())
            .collect::<Vec<_>>()
            .join(" ")
    }
}

/// |Delta(-1)|
pub(crate) fn at_minus_one(alexander: &[i64]) -> u64 {
    let sum = alexander.iter().enumerate().fold(0_i128, |sum, (k, c)| {
        sum + if k % 2 == 0 {
            i128::from(*c)
        } else {
            -i128::from(*c)
        }
    });
    u64::try_from(sum.unsigned_abs()).unwrap_or(u64::MAX)
}

/// The simplified diagram of the projection with the fewest crossings.
fn diagram(vertices: &[V]) -> Result<Diagram, KnotError> {
    let mut vertices = usable_vertices(vertices, true)?;
    if vertices.len() > LONGEST_PROJECTED {
        vertices = shortened(&vertices).into();
    }
    least_crossing(&vertices, N_PROJECTIONS, 0)
}

/// Jones polynomial of the closed polygon through `vertices`; `None` if its diagram has more than 60 crossings or is too
/// wide for the bracket to be summed in bounded time.
///
/// # Errors
/// As [`Invariants::of`].
pub fn jones_polynomial(vertices: &[V]) -> Result<Option<Jones>, KnotError> {
    Ok(jones::jones(&diagram(vertices)?))
}

/// Alexander polynomial of the closed polygon through `vertices`: symmetric coefficients, the first one positive.
///
/// # Errors
/// As [`Invariants::of`].
pub fn alexander_polynomial(vertices: &[V]) -> Result<Vec<i64>, KnotError> {
    Invariants::of(vertices).map(|found| found.alexander)
}

/// Determinant |Delta(-1)| of the closed polygon through `vertices`.
///
/// # Errors
/// As [`Invariants::of`].
pub fn determinant(vertices: &[V]) -> Result<u64, KnotError> {
    Invariants::of(vertices).map(|found| found.determinant)
}

/// Signature of the closed polygon through `vertices`; -2 for the right-handed trefoil.
///
/// # Errors
/// As [`Invariants::of`].
pub fn signature(vertices: &[V]) -> Result<i32, KnotError> {
    Invariants::of(vertices).map(|found| found.signature)
}
