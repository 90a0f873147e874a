//! Charged nematic colloids: patterned anchoring, a defect ring, its release, its flow.
//!
//! Units are reduced: lengths in the nematic correlation length xi_N, energies in L xi_N, times in tau_N.

mod error;
mod fft;
mod flow;
mod grid;
mod material;
mod particle;
mod stokes;
mod tensor;

pub use error::NematicError;
pub use flow::{FlowCounters, FlowCoupling, FlowParameters, Stored};
pub use grid::{Faces, Grid, GridError};
pub use material::Material;
pub use particle::Particle;
pub use stokes::{
    Drive, FaceSites, MacField, NoSlip, NoSlipReport, Spectral, StokesError, StokesSolver,
};
pub use tensor::{
    N_COMPONENTS, Tensor5, contract, largest_eigenvalue, matrix, order_and_director,
    square_traceless, uniaxial,
};
