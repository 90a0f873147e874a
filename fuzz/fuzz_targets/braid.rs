//! Braid words.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| topo_tests::parsers::braid(data));
