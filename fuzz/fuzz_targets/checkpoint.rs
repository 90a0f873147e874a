//! Checkpoints of any type.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| topo_tests::parsers::checkpoint(data));
