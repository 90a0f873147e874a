//! Points of space.

/// A point or a vector.
pub type V = nalgebra::Vector3<f64>;
