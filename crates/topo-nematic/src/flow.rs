//! The flow that the director drives, and what it does to the director.

mod coupling;
mod force;
mod observables;
mod rate;
mod stencil;
mod terms;

pub(crate) use coupling::FlowMemory;
pub use coupling::{FlowCounters, FlowCoupling, FlowParameters, FlowSolver};
pub use stencil::Stored;

#[cfg(test)]
mod tests;
