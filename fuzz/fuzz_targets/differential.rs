//! Two ways to one solution.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| piezobeam_fuzz::differential(data));
