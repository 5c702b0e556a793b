//! Crossings of cubics.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| piezobeam_fuzz::roots(data));
