//! A term of a scene and what a run with it or without it takes.

use topo_core::Interrupt;

use crate::error::LabError;

/// What one run took.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Taken {
    pub cpu_seconds: f64,
    pub calls: u64,
    pub peak_bytes: u64,
    pub term_bytes: u64,
    pub term_calls: u64,
}

/// Runs a scene, with the term or without.
pub(super) type Run = dyn Fn(bool, &Interrupt) -> Result<Taken, LabError> + Send + Sync;

/// A term and how a scene is run with and without it.
pub(super) struct Term {
    pub system: &'static str,
    pub name: &'static str,
    /// reported of both scenes.
    pub quantity: String,
    pub run: Box<Run>,
}
