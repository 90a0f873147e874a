//! Why a run ends, and how to stop it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use crate::control::Rejection;

/// Why a run ended: a value, not an error, since a run that stops early is still a run.
#[derive(Clone, Debug, PartialEq, Serialize, thiserror::Error)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StopReason {
    /// The requested time was reached.
    #[error("reached the requested time")]
    ReachedTime,
    /// The caller's condition was met.
    #[error("condition met: {0}")]
    Condition(String),
    /// The step would have to be shorter than allowed.
    #[error("step {dt:.3e} is too small to go on; last refusal: {last}")]
    StepTooSmall {
        /// Length of the last step tried.
        dt: f64,
        /// Why it was refused.
        last: Rejection,
    },
    /// The limit of trial steps was reached.
    #[error("limit of {n} trial steps reached")]
    StepLimit {
        /// The limit.
        n: u64,
    },
    /// An interrupt was requested.
    #[error("interrupted")]
    Interrupted,
    /// The run is broken and no smaller step helps.
    #[error("failed: {why}")]
    Failed {
        /// What is broken.
        why: Rejection,
    },
}

impl StopReason {
    /// Short name, for reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::ReachedTime => "reached-time",
            Self::Condition(_) => "condition",
            Self::StepTooSmall { .. } => "step-too-small",
            Self::StepLimit { .. } => "step-limit",
            Self::Interrupted => "interrupted",
            Self::Failed { .. } => "failed",
        }
    }

    /// Whether the run ended as requested: at its time or by its condition.
    pub fn is_success(&self) -> bool {
        matches!(self, Self::ReachedTime | Self::Condition(_))
    }
}

/// A token by which another thread or a signal handler stops runs after their present step.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// A token without a request to stop.
    pub fn new() -> Self {
        Self::default()
    }

    /// Requests all holders of this token to stop.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether a stop was requested.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
