//! The fuzz properties without a fuzzer: over the seeds, and over byte strings that look random.

use piezobeam_fuzz::{Property, TARGETS};
use std::{fs, panic};

/// The seeds: what was wrong once, and one of each kind.
#[test]
fn seeds() {
    let mut failed = Vec::new();
    for (target, property) in TARGETS {
        let folder = format!("{}/seeds/{target}", env!("CARGO_MANIFEST_DIR"));
        let mut paths: Vec<_> =
            fs::read_dir(folder).expect("the seeds").map(|f| f.expect("a seed").path()).collect();
        paths.sort();
        assert!(!paths.is_empty(), "{target}");
        for path in paths {
            let data = fs::read(&path).expect("a seed");
            if panic::catch_unwind(|| property(&data)).is_err() {
                failed.push(path);
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Byte strings whose bytes are, in part, below `plain`.
fn random(property: Property, count: usize, plain: u8) {
    let mut next = splitmix(0x0123_4567_89ab_cdef);
    for _ in 0..count {
        let length = 16 + next() as usize % 496;
        let mut data: Vec<u8> = (0..length).map(|_| next() as u8).collect();
        let share = next() % 256;
        for byte in &mut data {
            if next() % 256 < share {
                *byte %= plain;
            }
        }
        property(&data);
    }
}

#[test]
fn random_scenes() {
    // Numbers as their places suggest, mostly: else a scene has too much that is wrong with it.
    random(piezobeam_fuzz::scene, 2000, 96);
}

#[test]
fn random_cubics() {
    random(piezobeam_fuzz::roots, 20_000, 96);
}

#[test]
fn random_chains() {
    random(piezobeam_fuzz::recursion, 2000, 255);
}

#[test]
fn random_pairs() {
    random(piezobeam_fuzz::differential, 1000, 255);
}

#[test]
fn random_units() {
    random(piezobeam_fuzz::units, 5000, 255);
}

/// The stored scenes with a few bytes changed: what looks random is not even text.
#[test]
fn changed_scene_files() {
    let mut next = splitmix(0x0123_4567_89ab_cdef);
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/seeds/scene_file");
    for path in fs::read_dir(folder).expect("the seeds") {
        let seed = fs::read(path.expect("a seed").path()).expect("a seed");
        for _ in 0..500 {
            let mut data = seed.clone();
            for _ in 0..=next() % 4 {
                let at = next() as usize % data.len().max(1);
                match next() % 4 {
                    0 if !data.is_empty() => drop(data.remove(at)),
                    1 if !data.is_empty() => data[at] = next() as u8,
                    2 => data.insert(at.min(data.len()), b"[]{}=\"',.#\n0eE-x(^/*"[next() as usize % 20]),
                    _ => data.extend_from_within(at.min(data.len())..),
                }
                data.truncate(1 << 16);
            }
            piezobeam_fuzz::scene_file(&data);
        }
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
