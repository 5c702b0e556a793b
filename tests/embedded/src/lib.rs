//! Scenes that every target has to solve alike, to the last bit, and what a solve costs on a board.
//!
//! The library is what all programs share; `src/bin` has one program for each kind of target. What they print must
//! be the same text; `run.sh` compares it.
#![no_std]

pub mod bits;
pub mod cost;
pub mod fixed;
pub mod random;

use core::fmt::{Result, Write};

/// All that must not depend on the target.
///
/// # Errors
/// What `out` says.
pub fn results(out: &mut impl Write) -> Result {
    fixed::press::<f32>(out)?;
    fixed::press::<f64>(out)?;
    fixed::control::<f32>(out)?;
    fixed::control::<f64>(out)?;
    random::report(out)
}

/// A scene that is refused is a mistake of this test.
fn refused(error: piezobeam::Error) -> core::fmt::Error {
    panic!("{error}")
}
