//! Numbers with three times the digits of `f64`.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;

/// A number of 160 bits.
pub type Exact = FBig<HalfEven, 2>;

/// The number x, which has to be finite.
pub fn exact(x: f64) -> Exact {
    FBig::try_from(x).unwrap_or_default().with_precision(160).value()
}

/// The nearest double.
pub fn double(x: &Exact) -> f64 {
    x.to_f64().value()
}
