//! Rows of its tables.

use serde::{Deserialize, Serialize};
use topo_analysis::Warnings;

/// Its row of the table: energies in C/h, times in ζ h²/C.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Row {
    pub case: String,
    pub length: f64,
    pub turn: f64,
    pub edges: f64,
    pub energy: f64,
    pub energy_left: f64,
    pub dissipated: f64,
    pub t50: Option<f64>,
    pub t90: Option<f64>,
    pub t95: Option<f64>,
    pub t99: Option<f64>,
    pub ledger_residual: f64,
    pub steps: u64,
    pub cpu_seconds: f64,
    pub warnings: Warnings,
}

impl topo_lab::Row for Row {
    fn cpu_seconds(&self) -> f64 {
        self.cpu_seconds
    }

    fn warnings(&self) -> &Warnings {
        &self.warnings
    }
}

/// A vertex of the fibre in `angles.csv`: as it was charged, and as the discharge ended.
#[derive(Debug, Serialize, Deserialize)]
pub struct Vertex {
    pub s: f64,
    pub charged: f64,
    pub end: f64,
}

/// A line of `series.csv`.
#[derive(Serialize)]
pub struct Sample {
    pub time: f64,
    pub energy: f64,
    pub dissipated: f64,
}
