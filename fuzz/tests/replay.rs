//! The fuzz property without a fuzzer: over the seeds, and over byte strings that look random.

use piezobeam_fuzz::scene;
use std::{fs, panic};

/// The seeds: scenes that were wrong once, and one of each kind.
#[test]
fn seeds() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/seeds");
    let mut paths: Vec<_> =
        fs::read_dir(folder).expect("the seeds").map(|f| f.expect("a seed").path()).collect();
    paths.sort();
    assert!(!paths.is_empty());
    let mut failed = Vec::new();
    for path in paths {
        let data = fs::read(&path).expect("a seed");
        if panic::catch_unwind(|| scene(&data)).is_err() {
            failed.push(path);
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn random_bytes() {
    let mut next = splitmix(0x0123_4567_89ab_cdef);
    for _ in 0..2000 {
        let length = 16 + next() as usize % 496;
        let mut data: Vec<u8> = (0..length).map(|_| next() as u8).collect();
        // Numbers as their places suggest, mostly: else a scene has too much that is wrong with it.
        let plain = next() % 256;
        for byte in &mut data {
            if next() % 256 < plain {
                *byte %= 96;
            }
        }
        scene(&data);
    }
}

fn splitmix(mut state: u64) -> impl FnMut() -> u64 {
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}
