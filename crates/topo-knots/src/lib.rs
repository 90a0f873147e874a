//! Knot table, braid closures, tight shapes, and knot types from coordinates.
