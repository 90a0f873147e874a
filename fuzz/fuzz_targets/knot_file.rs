//! TOML files of knots, with the curve that they may name.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| topo_tests::parsers::knot_file(data));
