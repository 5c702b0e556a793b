//! Constitutive laws of the contact: normal compliance p(x, r) and the truncations R and R~.
//!
//! p is zero for r <= 0 and does not decrease in r; the paper's examples are p = k r+ (2.5). The
//! truncations of the conduction terms are (2.9)
//!
//! ```text
//!     R(z) = max(-M, min(M, z)),   R~(z) = max(R(z), 0)
//! ```

use crate::error::{Error, Place, expect};
use crate::profile::{Piece, Profile};
use crate::real::Real;

/// R(z), and its generalised derivative: 1 where |z| < M, else 0.
#[inline(always)]
pub fn truncate<T: Real>(z: T, bound: T) -> (T, T) {
    if z >= bound {
        (bound, T::zero())
    } else if z <= -bound {
        (-bound, T::zero())
    } else {
        (z, T::one())
    }
}

/// R~(z) = max(R(z), 0), and its generalised derivative: 1 where 0 < z < M, else 0.
#[inline(always)]
pub fn truncate_positive<T: Real>(z: T, bound: T) -> (T, T) {
    if z >= bound {
        (bound, T::zero())
    } else if z > T::zero() {
        (z, T::one())
    } else {
        (T::zero(), T::zero())
    }
}

/// A normal compliance law: the foundation's pressure p(x, r) \[N/m\] at penetration r \[m\].
///
/// Implement it for a law of your own. It is called for r > 0 only, and has to be finite, zero in the limit
/// r -> 0 and nondecreasing in r: a solve that sees it is not ends with a status that says so.
pub trait Compliance<T: Real> {
    /// Is there a foundation? Only `()` says no.
    const PRESENT: bool = true;
    /// What an element keeps of the law's coefficients; `()` if there is nothing to sample.
    type Piece: Piece<T>;

    /// The coefficient to sample into [`Compliance::Piece`], at x on the piece that holds `mid`.
    fn coefficient(&self, x: T, mid: T) -> T;

    /// Where the coefficient may jump \[m\].
    fn breaks(&self) -> &[T] {
        &[]
    }

    /// (p, dp/dr) at x and r > 0, where the sampled coefficient has the value `k`.
    fn pressure(&self, k: T, x: T, r: T) -> (T, T);

    /// The coefficient `k`, or the largest for which the law is nowhere stiffer than `most` \[N/m^2\]. A law
    /// whose stiffness grows with the penetration has no such coefficient and keeps its own.
    fn at_most(&self, k: T, most: T) -> T {
        let _ = most;
        k
    }

    /// Is p = k r, k the sampled coefficient? Then whole elements in contact need no quadrature.
    const LINEAR: bool = false;

    /// Is p Lipschitz continuous in r, as hypothesis (2.7) of the paper asks?
    fn is_lipschitz(&self) -> bool {
        true
    }

    /// The law's own numbers.
    ///
    /// # Errors
    /// The field, the place, what was expected and what was found.
    fn validate(&self, length: T) -> Result<(), Error>;
}

/// Name under which a law's numbers are reported.
const FIELD: &str = "foundation.stiffness";

/// No foundation.
impl<T: Real> Compliance<T> for () {
    const PRESENT: bool = false;
    const LINEAR: bool = true;
    type Piece = ();
    #[inline(always)]
    fn coefficient(&self, _: T, _: T) -> T {
        T::zero()
    }
    #[inline(always)]
    fn pressure(&self, _: T, _: T, _: T) -> (T, T) {
        (T::zero(), T::zero())
    }
    fn validate(&self, _: T) -> Result<(), Error> {
        Ok(())
    }
}

/// p = k(x) r+, k >= 0 \[N/m^2\].
#[derive(Clone, Copy, Debug)]
pub struct Linear<K>(pub K);

impl<T: Real, K: Profile<T>> Compliance<T> for Linear<K> {
    const LINEAR: bool = true;
    type Piece = K::Piece;
    #[inline(always)]
    fn coefficient(&self, x: T, mid: T) -> T {
        self.0.value(x, mid)
    }
    fn breaks(&self) -> &[T] {
        self.0.breaks()
    }
    #[inline(always)]
    fn at_most(&self, k: T, most: T) -> T {
        k.min(most)
    }
    #[inline(always)]
    fn pressure(&self, k: T, _: T, r: T) -> (T, T) {
        (k * r, k)
    }
    fn validate(&self, length: T) -> Result<(), Error> {
        self.0.validate(FIELD, length)
    }
}

/// p = k(x) r+^a, k >= 0 \[N/m^(1+a)\], a >= 1.
#[derive(Clone, Copy, Debug)]
pub struct Power<T, K> {
    /// Stiffness k.
    pub stiffness: K,
    /// Exponent a: 1 is linear, 1.5 Hertz's.
    pub exponent: T,
}

/// r^n by repeated squaring: the same bits everywhere, unlike a library's power.
fn integer_power<T: Real>(r: T, mut n: u32) -> T {
    let (mut power, mut square) = (T::one(), r);
    while n > 0 {
        if n & 1 == 1 {
            power = power * square;
        }
        n >>= 1;
        if n > 0 {
            square = square * square;
        }
    }
    power
}

/// r^a for r >= 0.
fn power<T: Real>(r: T, a: T) -> T {
    // Halves of integers up to 64 need a square root at most.
    let twice = a + a;
    match twice.to_u32() {
        Some(n) if T::from(n) == Some(twice) && n <= 128 => {
            let whole = integer_power(r, n / 2);
            if n % 2 == 1 { whole * r.sqrt() } else { whole }
        }
        _ => r.powf(a),
    }
}

impl<T: Real, K: Profile<T>> Compliance<T> for Power<T, K> {
    type Piece = K::Piece;
    #[inline(always)]
    fn coefficient(&self, x: T, mid: T) -> T {
        self.stiffness.value(x, mid)
    }
    fn breaks(&self) -> &[T] {
        self.stiffness.breaks()
    }
    fn at_most(&self, k: T, most: T) -> T {
        if self.exponent == T::one() { k.min(most) } else { k }
    }
    #[inline]
    fn pressure(&self, k: T, _: T, r: T) -> (T, T) {
        // Not k r^a: a power may be below the number format where the pressure is not.
        let secant = k * power(r, self.exponent - T::one());
        (secant * r, self.exponent * secant)
    }
    fn is_lipschitz(&self) -> bool {
        self.exponent == T::one()
    }
    fn validate(&self, length: T) -> Result<(), Error> {
        let a = self.exponent;
        let ok = a >= T::one() && a.is_finite();
        expect(ok, "foundation.exponent", Place::Whole, "a finite number >= 1", a)?;
        self.stiffness.validate(FIELD, length)
    }
}

/// A law by points (penetration, pressure), linear between them and extended with its last slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tabulated<'a, T> {
    /// Penetrations \[m\], ascending from 0.
    pub penetration: &'a [T],
    /// Pressures \[N/m\], nondecreasing from 0.
    pub pressure: &'a [T],
}

impl<T: Real> Compliance<T> for Tabulated<'_, T> {
    type Piece = ();
    fn coefficient(&self, _: T, _: T) -> T {
        T::zero()
    }
    fn pressure(&self, _: T, _: T, r: T) -> (T, T) {
        let last = self.penetration.len().max(2) - 1;
        let upper = self.penetration.partition_point(|&x| x <= r).clamp(1, last);
        match (self.penetration.get(upper - 1..=upper), self.pressure.get(upper - 1..=upper)) {
            (Some(&[r0, r1]), Some(&[p0, p1])) => {
                // A slope may be below the number format where the pressure is not.
                let (run, rise) = (r1 - r0, p1 - p0);
                (p0 + (r - r0) / run * rise, rise / run)
            }
            _ => (T::nan(), T::nan()),
        }
    }
    fn validate(&self, _: T) -> Result<(), Error> {
        let (r, p) = (self.penetration, self.pressure);
        if r.len() < 2 || r.len() != p.len() {
            let what = "as many pressures as penetrations, two at least";
            let (expected, found) = (r.len().max(2), p.len());
            return Err(Error::Length { field: "foundation.law", what, expected, found });
        }
        let field = "foundation.law";
        let first = "a law that is zero at penetration zero";
        expect(r[0] == T::zero(), field, Place::Index(0), first, r[0])?;
        expect(p[0] == T::zero(), field, Place::Index(0), first, p[0])?;
        for i in 1..r.len() {
            let ok = r[i] > r[i - 1] && r[i].is_finite();
            expect(ok, field, Place::Index(i), "penetrations that increase", r[i])?;
            let ok = p[i] >= p[i - 1] && p[i].is_finite();
            expect(ok, field, Place::Index(i), "pressures that do not decrease", p[i])?;
        }
        Ok(())
    }
}

/// A law x, r -> (p, dp/dr) given as a closure.
#[derive(Clone, Copy, Debug)]
pub struct Law<F>(pub F);

impl<T: Real, F: Fn(T, T) -> (T, T)> Compliance<T> for Law<F> {
    type Piece = ();
    fn coefficient(&self, _: T, _: T) -> T {
        T::zero()
    }
    fn pressure(&self, _: T, x: T, r: T) -> (T, T) {
        (self.0)(x, r)
    }
    fn validate(&self, _: T) -> Result<(), Error> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_cmp, reason = "what is exact has to be exact")]
    use super::*;
    use proptest::prelude::*;
    use std::format;
    use std::string::String;

    fn text(result: Result<(), Error>) -> String {
        result.map_or_else(|error| format!("{error}"), |()| String::from("ok"))
    }

    fn numbers() -> impl Strategy<Value = f64> {
        prop_oneof![-3.0..3.0_f64, Just(0.0), Just(1.0), Just(-1.0), -1e300..1e300_f64]
    }

    proptest! {
        #[test]
        fn the_truncation_is_bounded_odd_monotone_and_lipschitz(y in numbers(), z in numbers(), bound in 1e-3..10.0_f64) {
            let (ry, rz) = (truncate(y, bound).0, truncate(z, bound).0);
            prop_assert!(rz.abs() <= bound);
            prop_assert_eq!(truncate(-z, bound), (-rz, truncate(z, bound).1));
            prop_assert!((ry <= rz) || y > z);
            prop_assert!((ry - rz).abs() <= (y - z).abs());
            prop_assert_eq!(rz, z.clamp(-bound, bound));
        }

        #[test]
        fn the_positive_truncation_is_the_positive_part_of_the_truncation(y in numbers(), z in numbers(), bound in 1e-3..10.0_f64) {
            let (ry, rz) = (truncate_positive(y, bound).0, truncate_positive(z, bound).0);
            prop_assert_eq!(rz, truncate(z, bound).0.max(0.0));
            prop_assert!((0.0..=bound).contains(&rz));
            prop_assert!((ry <= rz) || y > z);
            prop_assert!((ry - rz).abs() <= (y - z).abs());
            if z <= 0.0 {
                prop_assert_eq!(truncate_positive(z, bound), (0.0, 0.0));
            }
        }

        #[test]
        fn slopes_of_the_truncations_are_those_of_differences(z in -3.0..3.0_f64, bound in 0.1..2.0_f64) {
            let step = 1e-6;
            let kinks = [0.0, bound, -bound];
            prop_assume!(kinks.iter().all(|kink| (z - kink).abs() > 2.0 * step));
            for f in [truncate::<f64>, truncate_positive::<f64>] {
                let slope = (f(z + step, bound).0 - f(z - step, bound).0) / (2.0 * step);
                prop_assert!((f(z, bound).1 - slope).abs() < 1e-8);
            }
        }

        #[test]
        fn powers_agree_with_the_library(r in 1e-6..1e3_f64, n in 0_u32..24, twice in 0_u32..=128, a in 0.0..6.0_f64) {
            let near = |got: f64, want: f64| (got - want).abs() <= 1e-13 * want;
            prop_assert!(near(integer_power(r, n), r.powf(f64::from(n))));
            let half = f64::from(twice.min(40)) / 2.0;
            prop_assert!(near(power(r, half), r.powf(half)), "{half}");
            prop_assert_eq!(power(r, a), r.powf(a));
        }

        #[test]
        fn power_laws_have_the_slope_of_differences(k in 0.0..1e6_f64, a in 1.0..4.0_f64, r in 0.01..2.0_f64) {
            let law = Power { stiffness: k, exponent: a };
            let pressure = |r: f64| Compliance::<f64>::pressure(&law, k, 0.0, r);
            let step = 1e-5 * r;
            let slope = (pressure(r + step).0 - pressure(r - step).0) / (2.0 * step);
            prop_assert!((pressure(r).1 - slope).abs() <= 1e-8 * slope);
            prop_assert!((pressure(r).0 - k * r.powf(a)).abs() <= 1e-13 * k * r.powf(a));
        }

        #[test]
        fn pressures_are_numbers_where_powers_and_slopes_are_below_them(r in 1e-112..1e-108_f64, far in 0.0..1.0_f64) {
            let law = Power { stiffness: 1e300, exponent: 3.0 };
            let scaled = 1e110 * r;
            let want = 1e-30 * scaled * scaled * scaled;
            let (p, slope) = law.pressure(1e300, 0.0, r);
            prop_assert!((p - want).abs() <= 1e-14 * want, "{p:e} {want:e}");
            prop_assert!((slope * r - 3.0 * want).abs() <= 1e-13 * want);
            let law = Tabulated { penetration: &[0.0, 1e200], pressure: &[0.0, 1e-200] };
            let (p, _) = law.pressure(0.0, 0.0, far * 1e200);
            prop_assert!((p - far * 1e-200).abs() <= 1e-15 * 1e-200);
        }

        #[test]
        fn tables_are_continuous_nondecreasing_and_have_their_own_slope(r in 0.0..4.0_f64, more in 0.0..1.0_f64) {
            let (p, slope) = TABLE.pressure(0.0, 0.0, r);
            let (q, _) = TABLE.pressure(0.0, 0.0, r + more);
            prop_assert!(q >= p && p >= 0.0 && slope >= 0.0);
            // Up to the next point the slope is the same.
            if more < 1e-3 && [0.5, 1.0, 2.0].iter().all(|x| (r < *x) == (r + more < *x)) {
                prop_assert!((q - p - slope * more).abs() < 1e-13);
            }
            prop_assert!(q - p <= 6.0 * more + 1e-13, "the steepest slope is 6");
        }
    }

    const TABLE: Tabulated<'_, f64> =
        Tabulated { penetration: &[0.0, 0.5, 1.0, 2.0], pressure: &[0.0, 1.0, 4.0, 4.0] };

    #[test]
    fn truncations_at_their_kinks_take_the_flat_side() {
        assert_eq!(truncate(2.0, 2.0), (2.0, 0.0));
        assert_eq!(truncate(-2.0, 2.0), (-2.0, 0.0));
        assert_eq!(truncate_positive(2.0, 2.0), (2.0, 0.0));
        assert_eq!(truncate_positive(0.0, 2.0), (0.0, 0.0));
        assert_eq!(truncate(f64::INFINITY, 2.0).0, 2.0);
    }

    #[test]
    fn halves_of_integers_need_a_root_at_most() {
        assert_eq!(integer_power(3.0_f64, 0), 1.0);
        assert_eq!(integer_power(3.0_f64, 13), 1_594_323.0);
        assert_eq!(power(4.0_f64, 1.5), 8.0);
        assert_eq!(power(4.0_f64, 0.5), 2.0);
        assert_eq!(power(0.0_f64, 0.0), 1.0);
        assert_eq!(power(0.0_f64, 0.5), 0.0);
        assert_eq!(power(2.0_f64, 64.0), 18_446_744_073_709_551_616.0);
        // Beyond, the library's power.
        assert_eq!(power(2.0_f64, 65.0), 36_893_488_147_419_103_232.0);
        assert_eq!(power(2.0_f32, 1.5), 2.0 * 2.0_f32.sqrt());
    }

    #[test]
    fn a_power_of_one_is_linear_and_one_of_hertz_is_not_lipschitz() {
        let lipschitz = |exponent: f64| Power { stiffness: 1.0, exponent }.is_lipschitz();
        assert!(lipschitz(1.0) && !lipschitz(1.5));
        let law = Power { stiffness: 3.0, exponent: 1.0 };
        assert_eq!(law.pressure(3.0, 0.0, 0.25), Linear(3.0).pressure(3.0, 0.0, 0.25));
        assert_eq!(law.pressure(3.0, 0.0, 0.0), (0.0, 3.0));
    }

    #[test]
    fn tables_interpolate_and_go_on_with_their_last_slope() {
        let at = |r| TABLE.pressure(0.0, 0.0, r);
        assert_eq!(at(0.0), (0.0, 2.0));
        assert_eq!(at(0.25), (0.5, 2.0));
        // A point belongs to the line on its right.
        assert_eq!(at(0.5), (1.0, 6.0));
        assert_eq!(at(0.75), (2.5, 6.0));
        assert_eq!(at(1.5), (4.0, 0.0));
        assert_eq!(at(9.0), (4.0, 0.0));
        let rising = Tabulated { penetration: &[0.0, 1.0], pressure: &[0.0, 3.0] };
        assert_eq!(rising.pressure(0.0, 0.0, 5.0), (15.0, 3.0));
        assert_eq!(text(TABLE.validate(1.0)), "ok");
    }

    #[test]
    fn tables_that_are_no_law_say_why() {
        let wrong = |penetration, pressure| text(Tabulated::<f64> { penetration, pressure }.validate(1.0));
        assert_eq!(
            wrong(&[0.0], &[0.0]),
            "foundation.law: as many pressures as penetrations, two at least: expected 2, found 1"
        );
        assert_eq!(
            wrong(&[], &[]),
            "foundation.law: as many pressures as penetrations, two at least: expected 2, found 0"
        );
        assert_eq!(
            wrong(&[0.0, 1.0, 2.0], &[0.0, 1.0]),
            "foundation.law: as many pressures as penetrations, two at least: expected 3, found 2"
        );
        assert_eq!(
            wrong(&[0.1, 1.0], &[0.0, 1.0]),
            "foundation.law[0]: expected a law that is zero at penetration zero, found 0.1"
        );
        assert_eq!(
            wrong(&[0.0, 1.0], &[0.2, 1.0]),
            "foundation.law[0]: expected a law that is zero at penetration zero, found 0.2"
        );
        assert_eq!(
            wrong(&[0.0, 1.0, 1.0], &[0.0, 1.0, 2.0]),
            "foundation.law[2]: expected penetrations that increase, found 1"
        );
        assert_eq!(
            wrong(&[0.0, f64::INFINITY], &[0.0, 1.0]),
            "foundation.law[1]: expected penetrations that increase, found inf"
        );
        assert_eq!(
            wrong(&[0.0, f64::NAN], &[0.0, 1.0]),
            "foundation.law[1]: expected penetrations that increase, found NaN"
        );
        assert_eq!(
            wrong(&[0.0, 1.0, 2.0], &[0.0, 1.0, 0.5]),
            "foundation.law[2]: expected pressures that do not decrease, found 0.5"
        );
        assert_eq!(
            wrong(&[0.0, 1.0], &[0.0, f64::INFINITY]),
            "foundation.law[1]: expected pressures that do not decrease, found inf"
        );
    }

    #[test]
    fn exponents_below_one_or_not_finite_are_refused() {
        let with = |exponent: f64| text(Power { stiffness: 1.0, exponent }.validate(1.0));
        assert_eq!(with(1.0), "ok");
        assert_eq!(with(0.5), "foundation.exponent: expected a finite number >= 1, found 0.5");
        assert_eq!(with(f64::NAN), "foundation.exponent: expected a finite number >= 1, found NaN");
        assert_eq!(with(f64::INFINITY), "foundation.exponent: expected a finite number >= 1, found inf");
        let steps = crate::Steps { breaks: &[2.0], values: &[1.0, 2.0] };
        assert_eq!(
            text(Power { stiffness: steps, exponent: 2.0 }.validate(1.0)),
            "foundation.stiffness[0]: expected breaks that increase strictly inside (0, length), found 2"
        );
        assert_eq!(
            text(Linear(steps).validate(1.0)),
            "foundation.stiffness[0]: expected breaks that increase strictly inside (0, length), found 2"
        );
    }

    #[test]
    fn no_foundation_presses_on_nothing() {
        assert_eq!(Compliance::<f64>::pressure(&(), 5.0, 0.0, 1.0), (0.0, 0.0));
        const { assert!(!<() as Compliance<f64>>::PRESENT) };
    }
}
