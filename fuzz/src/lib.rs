//! What has to hold of the library, as plain functions of a byte string: run by a fuzzer, or on what is stored.

mod differential;
mod exact;
mod form;
mod number;
mod property;
mod recursion;
mod roots;
mod scene;
mod scene_file;
mod units;

// What the library and the program keep to themselves, and an independent look at a solution: the same files.
#[path = "../../src/cubic.rs"]
#[allow(dead_code, reason = "the fuzz target asks for roots alone")]
mod cubic;
#[path = "../../tests/common/honest.rs"]
mod honest;
#[path = "../../src/bin/piezobeam/scene_file/mod.rs"]
#[allow(dead_code, unused_imports, reason = "the fuzz target reads alone")]
mod reader;
#[path = "../../src/real.rs"]
#[allow(dead_code, reason = "the fuzz target asks for roots alone")]
mod real;
#[path = "../../tests/common/tolerances.rs"]
#[allow(dead_code, reason = "tests have more to allow")]
mod tolerances;

pub use differential::differential;
pub use recursion::recursion;
pub use roots::roots;
pub use scene::scene;
pub use scene_file::scene_file;
pub use units::units;

/// A property of any byte string, which panics where it fails.
pub type Property = fn(&[u8]);

/// All targets by name.
pub const TARGETS: [(&str, Property); 6] = [
    ("differential", differential),
    ("recursion", recursion),
    ("roots", roots),
    ("scene", scene),
    ("scene_file", scene_file),
    ("units", units),
];
