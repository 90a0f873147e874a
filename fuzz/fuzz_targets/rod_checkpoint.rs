//! Checkpoints of rods, gone on from.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| topo_tests::parsers::rod_checkpoint(data));
