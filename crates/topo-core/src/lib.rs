//! Shared ground of the topological batteries: units, curve geometry, integrators, step control, ledger, observers, checkpoints.
