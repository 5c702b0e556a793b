//! Any bytes through the reader of scene files.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| piezobeam_fuzz::scene_file(data));
