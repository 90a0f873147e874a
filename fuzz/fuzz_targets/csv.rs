//! Curves and snapshots as comma-separated values.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| topo_tests::parsers::csv(data));
