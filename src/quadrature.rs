//! Gauss-Legendre rules on [0, 1] with a constant number of points.
//!
//! `Q` points integrate polynomials up to degree 2Q - 1 exactly. Four points are exact for a coefficient
//! that is constant times a product of two cubics (degree 6), which is all that a linear foundation asks
//! on a piece of an element between contact edges.

use crate::real::Real;

/// Points of the rule that samples coefficients and integrates contact.
pub(crate) const POINTS: usize = 4;

/// Nodes and weights of the `Q`-point rule on [0, 1], ascending; `Q` is 1 to 5.
///
/// Source: Abramowitz and Stegun, table 25.4, moved from [-1, 1] to [0, 1].
pub(crate) const fn gauss<const Q: usize>() -> [(f64, f64); Q] {
    const { assert!(Q >= 1 && Q <= 5, "rules have 1 to 5 points") };
    // (distance from the midpoint on [-1, 1], weight on [-1, 1]) of the right half, inner first.
    let half: &[(f64, f64)] = match Q {
        1 => &[(0.0, 2.0)],
        2 => &[(0.577_350_269_189_625_8, 1.0)],
        3 => &[(0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)],
        4 => &[
            (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
            (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
        ],
        _ => &[
            (0.0, 0.568_888_888_888_888_9),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (0.906_179_845_938_664, 0.236_926_885_056_189_08),
        ],
    };
    let mut rule = [(0.0, 0.0); Q];
    let mut i = 0;
    while i < half.len() {
        let (z, w) = half[i];
        let up = Q / 2 + i;
        rule[up] = (0.5 + 0.5 * z, 0.5 * w);
        rule[Q - 1 - up] = (0.5 - 0.5 * z, 0.5 * w);
        i += 1;
    }
    rule
}

/// The integral of `f` over [a, b] by the `Q`-point rule.
#[inline]
pub(crate) fn integrate<T: Real, const Q: usize>(a: T, b: T, mut f: impl FnMut(T) -> T) -> T {
    let length = b - a;
    let mut sum = T::zero();
    for (z, w) in gauss::<Q>() {
        sum = sum + T::of(w) * f(a + length * T::of(z));
    }
    sum * length
}

/// Adds the part of a force at t to its moments, the integrals of the force times t^j.
#[inline(always)]
pub(crate) fn add_moments<T: Real, const J: usize>(moments: &mut [T; J], t: T, mut part: T) {
    for moment in moments {
        *moment = *moment + part;
        part = part * t;
    }
}

/// Adds the integrals of `value` t^j from a to b, 0 <= a <= b, to its moments. With the length before the sum of
/// a^i b^(j - i), nothing cancels on a short part.
#[inline(always)]
pub(crate) fn add_powers<T: Real>(moments: &mut [T; 7], a: T, b: T, value: T) {
    const SHARES: [f64; 7] = [1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0, 1.0 / 6.0, 1.0 / 7.0];
    let whole = value * (b - a);
    let (mut sum, mut power) = (T::one(), a);
    for (moment, share) in moments.iter_mut().zip(SHARES) {
        *moment = *moment + whole * (T::of(share) * sum);
        sum = b * sum + power;
        power = power * a;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact_to_degree<const Q: usize>() {
        for degree in 0..2 * Q as i32 {
            let got = integrate::<f64, Q>(0.0, 1.0, |x| x.powi(degree));
            let want = 1.0 / f64::from(degree + 1);
            assert!((got - want).abs() < 4e-16, "Q = {Q}, degree {degree}: {got} for {want}");
        }
        let beyond = integrate::<f64, Q>(0.0, 1.0, |x| x.powi(2 * Q as i32));
        assert!((beyond - 1.0 / (2.0 * Q as f64 + 1.0)).abs() > 1e-7, "degree 2Q must not be exact");
    }

    #[test]
    fn rules_are_exact_to_their_degree_and_no_further() {
        exact_to_degree::<1>();
        exact_to_degree::<2>();
        exact_to_degree::<3>();
        exact_to_degree::<4>();
        exact_to_degree::<5>();
    }
}
