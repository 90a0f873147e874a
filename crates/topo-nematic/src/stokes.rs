//! Creeping flow on the staggered grid: the field, the solvers behind one trait, and the particle at rest in it.

mod drive;
mod error;
mod field;
mod no_slip;
mod reduce;
mod sites;
mod solver;
mod sparse;
mod spectral;

pub use drive::Drive;
pub use error::StokesError;
pub use field::MacField;
pub(crate) use no_slip::NoSlipMemory;
pub use no_slip::{NoSlip, NoSlipReport};
pub use sites::FaceSites;
pub use solver::StokesSolver;
pub use sparse::{Sparse, SparseOptions};
pub use spectral::Spectral;
