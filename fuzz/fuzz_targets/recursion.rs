//! The block recursion against dense elimination.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| piezobeam_fuzz::recursion(data));
