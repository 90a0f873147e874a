//! Physics tests that cross crates live in `tests/`; see `docs/validation.md`.
