//! Crossings of cubics against signs in more digits.

use crate::cubic::{Cubic, Side};
use crate::exact::{Digits, Exact};
use crate::number::Number;
use crate::real::Real;
use arbitrary::{Arbitrary, Result, Unstructured};

/// Points at which signs are taken.
const POINTS: u32 = 257;

/// A cubic as its coefficients, or as a product of three factors t - r, which is nastier.
#[derive(Arbitrary, Debug)]
enum Spelt {
    Coefficients([Number; 4]),
    Roots { at: [u16; 3], scale: Number, lift: Number },
}

#[derive(Arbitrary, Debug)]
struct Input {
    single: bool,
    cubic: Spelt,
    level: Number,
}

/// Crossings ascend inside (0, 1), there are three at most, and between points where the cubic is clearly not
/// zero there is an odd number of them if and only if its sign changes. At a crossing it is zero, to rounding. A side that
/// is certain is right.
pub fn roots(data: &[u8]) {
    let read = |data| -> Result<Input> { Input::arbitrary(&mut Unstructured::new(data)) };
    match read(data) {
        Ok(input) if input.single => check::<f32>(&input),
        Ok(input) => check::<f64>(&input),
        Err(_) => {}
    }
}

fn check<T: Real>(input: &Input) {
    let cubic = Cubic(match &input.cubic {
        Spelt::Coefficients(c) => c.map(|c| T::of(c.of::<f64>(1.0))),
        Spelt::Roots { at, scale, lift } => {
            let [a, b, c] = at.map(|r| f64::from(r) / 60_000.0);
            let scale = scale.of::<f64>(1.0);
            [-a * b * c, a * b + b * c + c * a, -(a + b + c), 1.0]
                .map(|c| T::of(c * scale))
                .map(|c| c + T::of(lift.of::<f64>(0.0)))
        }
    });
    let level = T::of(input.level.of::<f64>(0.0));
    let found = cubic.crossings(level);
    let side = cubic.side(level);
    for pair in found.windows(2) {
        assert!(pair[0] <= pair[1], "{found:?} of {cubic:?}");
    }
    assert!(found.iter().all(|&t| t > T::zero() && t < T::one()), "{found:?} of {cubic:?}");
    let size = cubic.0.iter().fold(level.abs(), |sum, c| sum + c.abs()).f64();
    // Sums of a few of its coefficients are numbers of the format.
    if size.is_nan() || size >= 0.01 * T::max_value().f64() {
        return;
    }
    let tiny = 64.0 * (T::min_positive_value() * T::epsilon()).f64();
    let noise = 64.0 * T::epsilon().f64() * size + tiny;
    // Clearly above or below, or neither. Horner's scheme in doubles is off by 8 of its roundings at most: 160 bits are
    // asked only where these decide.
    let slack = 8.0 * f64::EPSILON * size + 64.0 * f64::MIN_POSITIVE * f64::EPSILON;
    let [c0, c1, c2, c3] = cubic.0.map(Real::f64);
    let sign = |t: f64| {
        let mut value = c0 + t * (c1 + t * (c2 + t * c3)) - level.f64();
        if (value.abs() - noise).abs() <= slack {
            let at = Exact::of(t);
            let sum = [c3, c2, c1, c0].into_iter().fold(Exact::of(0.0), |sum, c| sum * &at + Exact::of(c));
            value = (sum - Exact::of(level.f64())).near();
        }
        (value.abs() > noise).then_some(value > 0.0)
    };
    for &t in &found {
        assert!(sign(t.f64()).is_none(), "not zero at {t:?}: {cubic:?}, level {level:?}");
    }
    let mut last: Option<(f64, bool)> = None;
    for i in 0..POINTS {
        let t = f64::from(i) / f64::from(POINTS - 1);
        let Some(above) = sign(t) else { continue };
        assert!(side != Side::Below || !above, "not below at {t}: {cubic:?}, level {level:?}");
        assert!(side != Side::Above || above, "not above at {t}: {cubic:?}, level {level:?}");
        if let Some((before, was)) = last {
            let between = found.iter().filter(|&&r| r.f64() > before && r.f64() <= t).count();
            let odd = between % 2 == 1;
            assert!(odd == (above != was), "{found:?} in ({before}, {t}): {cubic:?}, level {level:?}");
        }
        last = Some((t, above));
    }
}
