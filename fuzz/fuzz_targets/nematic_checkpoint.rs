//! Checkpoints of nematics, gone on from.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| topo_tests::parsers::nematic_checkpoint(data));
