//! Curves and runs that the physics tests share.
//!
//! Reading order: [`curves`] (start shapes) → [`run`] (a rod with its model, and the loop that carries it through time).
//!
//! Units are those of `topo-rod`: radius, bending modulus and viscosity are 1, energies are per cross section area, so that
//! the bending stiffness is B/A = 1/4 and the twist stiffness C/A = α/4.

pub mod curves;
pub mod run;
