//! Home of the benchmarks; each file in `benches/` is one subject, run by `cargo xtask bench`.
