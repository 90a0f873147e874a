//! Why a step is refused, and how long the next one should be.

use serde::Serialize;

/// Why a candidate step was refused; a value, since most refusals are answered by a smaller step.
#[derive(Clone, Debug, PartialEq, Serialize, thiserror::Error)]
#[non_exhaustive]
pub enum Rejection {
    /// The embedded estimate of the local error exceeds twice the tolerance.
    #[error("local error {error:.3e} exceeds twice the tolerance {tolerance:.3e}")]
    ErrorTooLarge {
        /// Estimated error, in the unit of the tolerance.
        error: f64,
        /// The tolerance.
        tolerance: f64,
    },
    /// A vertex moved too far in one step.
    #[error("vertex {vertex} moved by {moved:.3e}, more than {limit:.3e}")]
    Displacement {
        /// Index of the vertex.
        vertex: usize,
        /// How far it moved.
        moved: f64,
        /// How far it may move.
        limit: f64,
    },
    /// The energy rose although nothing drives the system.
    #[error("energy rose by {relative:.3e} of itself")]
    EnergyRise {
        /// Rise over the energy before.
        relative: f64,
    },
    /// Two edges might have passed through each other.
    #[error("edges {} and {} might have crossed", edges.0, edges.1)]
    Crossing {
        /// Indices of the two edges.
        edges: (usize, usize),
    },
    /// A rate, state or error is NaN or infinite.
    #[error("{what} is not finite")]
    NotFinite {
        /// What is not finite.
        what: &'static str,
    },
    /// A matrix could not be factorised.
    #[error("{what} could not be factorised")]
    Factorisation {
        /// Which matrix.
        what: &'static str,
    },
    /// A stabilised explicit step would need more stages than allowed.
    #[error("step needs {needed} stages, more than {limit}")]
    TooManyStages {
        /// Stages needed for stability.
        needed: usize,
        /// Stages allowed.
        limit: usize,
    },
    /// The model refuses the state; a smaller step may avoid it.
    #[error("model refuses: {what}")]
    Domain {
        /// What is refused.
        what: &'static str,
    },
    /// The model refuses to go on at all: no smaller step helps, the run fails.
    #[error("run is broken: {what}")]
    Fatal {
        /// What is broken.
        what: &'static str,
    },
}

impl Rejection {
    /// Short name by which refusals are counted.
    pub fn name(&self) -> &'static str {
        match self {
            Self::ErrorTooLarge { .. } => "error-too-large",
            Self::Displacement { .. } => "displacement",
            Self::EnergyRise { .. } => "energy-rise",
            Self::Crossing { .. } => "crossing",
            Self::NotFinite { .. } => "not-finite",
            Self::Factorisation { .. } => "factorisation",
            Self::TooManyStages { .. } => "too-many-stages",
            Self::Domain { .. } => "domain",
            Self::Fatal { .. } => "fatal",
        }
    }
}
