//! Numbers with more digits than `f64`: twice as many, which are quick, and three times as many, to ask where those do not
//! decide.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use std::ops::{Add, Div, Mul, Sub};

/// A number of 160 bits.
pub type Exact = FBig<HalfEven, 2>;
/// A number of 106 bits, the sum of two doubles.
pub type Double = qd::Quad;

/// The arithmetic of either.
pub trait Digits:
    Clone + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The number x, which has to be finite.
    fn of(x: f64) -> Self;
    /// The nearest double.
    fn near(&self) -> f64;
}

impl Digits for Exact {
    fn of(x: f64) -> Self {
        FBig::try_from(x).unwrap_or_default().with_precision(160).value()
    }
    fn near(&self) -> f64 {
        self.to_f64().value()
    }
}

impl Digits for Double {
    fn of(x: f64) -> Self {
        x.into()
    }
    fn near(&self) -> f64 {
        self.0
    }
}
