//! Charged nematic colloids: patterned anchoring, a defect ring, its release, its flow.
//!
//! Units are reduced: lengths in the nematic correlation length xi_N, energies in L xi_N, times in tau_N.

mod grid;

pub use grid::{Faces, Grid, GridError};
