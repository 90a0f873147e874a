//! What a rod's model keeps between steps, and names.

use serde::{Deserialize, Serialize};
use topo_core::Rejection;
use topo_sparse::SparseError;

use crate::energy::Force;

/// Channels of dissipation, in the order of the ledger.
pub(crate) const CHANNELS: [&str; 3] = ["viscosity", "twist_viscosity", "friction"];

/// The channel of what a load takes up, the last one where there is one.
pub(crate) const LOAD: &str = "load";

/// What the ledger needs of the state accepted last.
#[derive(Clone, Default, Serialize, Deserialize)]
pub(super) struct Accepted {
    pub(super) stamp: Option<u64>,
    pub(super) total: f64,
    pub(super) cosine: Vec<f64>,
    pub(super) couplings: Vec<(u32, u32, f64)>,
    pub(super) joints: Vec<f64>,
    pub(super) force: Force,
    pub(super) rate: Vec<f64>,
    pub(super) rate_stamp: Option<u64>,
}

/// The Newton matrix in use: made for which step length, and how often used.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Frozen {
    pub(super) g_dt: f64,
    pub(super) n_uses: usize,
}

impl Frozen {
    pub(super) fn g_dt(&self) -> f64 {
        self.g_dt
    }
}

pub(super) fn unsolvable(error: SparseError, what: &'static str) -> Rejection {
    tracing::debug!(%error, what, "matrix refused");
    Rejection::Factorisation { what }
}
