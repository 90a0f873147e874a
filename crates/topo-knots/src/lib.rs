//! Knot table, braid closures, tight shapes, and knot types from coordinates.

mod braid;
mod error;
mod identify;
mod invariant;
mod moebius;
mod segment;
mod start_file;
mod table;
mod thickness;
mod tighten;

pub use braid::{closed_braid, n_components};
pub use error::KnotError;
pub use identify::{Handedness, KnotType, OpenKnotType, identify, identify_open};
pub use invariant::{Invariants, alexander_polynomial, determinant, signature};
pub use moebius::relax_moebius;
pub use start_file::StartCurve;
pub use table::{Chirality, KnotEntry, KnotTable};
pub use thickness::{Thickness, thickness, thickness_brute_force, windowed_half_distance};
pub use tighten::{Centreline, Certificate, TightKnot, TightenSettings, tighten, tighten_entry};

/// A point or vector in space, in units of the tube radius where a tube is meant.
pub type V = nalgebra::Vector3<f64>;
