//! Curves and runs that the physics tests share, and what the fuzz targets call.
//!
//! Reading order: [`curves`] (start shapes) → [`run`] (a rod with its model, and the loop that carries it through time);
//! [`parsers`] (what must hold of them for any bytes);
//! [`threads`] (a pool of a given size).
//!
//! Units are those of `topo-rod`: radius, bending modulus and viscosity are 1, energies are per cross section area, so that
//! the bending stiffness is B/A = 1/4 and the twist stiffness C/A = α/4.

pub mod curves;
pub mod parsers;
pub mod run;
pub mod threads;

/// The programs of the page are compiled and run as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

/// As [`Readme`].
#[cfg(doctest)]
#[doc = include_str!("../../docs/extending.md")]
pub struct Extending;

/// As [`Readme`].
#[cfg(doctest)]
#[doc = include_str!("../../docs/tutorial.md")]
pub struct Tutorial;
