//! Scenes of any numbers through the library.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| piezobeam_fuzz::scene(data));
