//! Cubics on the unit interval: the penetration and the potential inside an element, and their roots.
//!
//! The local coordinate t runs from 0 at an element's *right* node to 1 at its left one, because there
//! the relative unknowns give the coefficients without a difference of nodal values (see [`crate::sweep`]).

use crate::real::{Field, Real};
use arrayvec::ArrayVec;

/// c0 + c1 t + c2 t^2 + c3 t^3 on 0 <= t <= 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cubic<T>(pub [T; 4]);

/// Where a cubic lies against a level on all of [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Nowhere above the level.
    Below,
    /// Everywhere above the level.
    Above,
    /// Undecided by the control values: roots have to be looked for.
    Both,
}

impl<T: Field> Cubic<T> {
    /// The control values of the Bernstein form above a level: their hull holds the curve.
    #[inline(always)]
    pub(crate) fn control(&self, level: T) -> [T; 4] {
        let [c0, c1, c2, c3] = self.0;
        let third = T::of(1.0 / 3.0);
        let b0 = c0 - level;
        let b1 = b0 + c1 * third;
        [b0, b1, b1 + (c1 + c2) * third, b0 + c1 + c2 + c3]
    }

    /// What rounding may make of a value on [0, 1].
    #[inline(always)]
    pub(crate) fn noise(&self) -> T {
        let [c0, c1, c2, c3] = self.0.map(T::size);
        (c0 + c1 + c2 + c3) * T::of(8.0) * T::EPSILON
    }
}

impl<T: Real> Cubic<T> {
    /// The cubic with values `right`, `left` at t = 0, 1 and derivatives `right_slope`, `left_slope` in t.
    #[inline(always)]
    pub(crate) fn hermite(right: T, right_slope: T, left: T, left_slope: T) -> Self {
        let (two, three) = (T::of(2.0), T::of(3.0));
        let rise = left - right;
        Self([
            right,
            right_slope,
            three * rise - two * right_slope - left_slope,
            right_slope + left_slope - two * rise,
        ])
    }

    /// Value at t.
    #[inline(always)]
    pub fn at(&self, t: T) -> T {
        let [c0, c1, c2, c3] = self.0;
        c0 + t * (c1 + t * (c2 + t * c3))
    }

    /// Derivative in t.
    #[inline(always)]
    pub fn slope(&self, t: T) -> T {
        let [_, c1, c2, c3] = self.0;
        c1 + t * (T::of(2.0) * c2 + t * (T::of(3.0) * c3))
    }

    /// Second derivative in t.
    #[inline(always)]
    pub(crate) fn curvature(&self, t: T) -> T {
        let [_, _, c2, c3] = self.0;
        T::of(2.0) * c2 + T::of(6.0) * c3 * t
    }

    /// A number that no value on [0, 1] exceeds: the largest control value of the Bernstein form.
    pub(crate) fn hull(&self) -> T {
        self.control(T::zero()).into_iter().fold(T::neg_infinity(), T::max)
    }

    /// Which side of `level` the whole cubic lies on, by the control values of its Bernstein form, whose
    /// hull holds the curve: `Below` and `Above` are certain up to rounding, `Both` is not.
    #[inline(always)]
    pub(crate) fn side(&self, level: T) -> Side {
        self.side_by_hull(level).unwrap_or_else(|| self.side_by_extremes(level))
    }

    /// The same, where the control values tell.
    #[inline(always)]
    fn side_by_hull(&self, level: T) -> Option<Side> {
        let [b0, b1, b2, b3] = self.control(level);
        let zero = T::zero();
        // Bitwise, so that no branch is taken but on the outcome.
        if (b0 <= zero) & (b1 <= zero) & (b2 <= zero) & (b3 <= zero) {
            Some(Side::Below)
        } else if (b0 > zero) & (b1 > zero) & (b2 > zero) & (b3 > zero) {
            Some(Side::Above)
        } else {
            None
        }
    }

    /// The same where the control values do not tell: by the values at both ends and turning points. One that may be
    /// rounding, as that of a cubic which ends in a zero at a clamp, is on neither side.
    #[inline(never)]
    fn side_by_extremes(&self, level: T) -> Side {
        let shifted = self.less(level);
        let noise = shifted.noise();
        let (mut least, mut most) = (T::infinity(), T::neg_infinity());
        for t in shifted.turning_points().into_iter().chain([T::zero(), T::one()]) {
            let value = shifted.at(t);
            (least, most) = (least.min(value), most.max(value));
        }
        if least >= -noise {
            Side::Above
        } else if most <= noise {
            Side::Below
        } else {
            Side::Both
        }
    }

    /// The cubic above a level.
    #[inline(always)]
    fn less(&self, level: T) -> Self {
        let [c0, c1, c2, c3] = self.0;
        Self([c0 - level, c1, c2, c3])
    }

    /// All t strictly inside (0, 1) where the cubic crosses `level` (changes its sign), ascending.
    ///
    /// The interval is cut at the critical points, so that each part is monotone and holds at most one
    /// root, which bisection-safeguarded Newton steps find to the last digit. A double root that does not
    /// change the sign is no crossing and is not reported. At most three roots; no failure: a cubic that is
    /// not finite has none.
    #[inline(always)]
    pub(crate) fn crossings(&self, level: T) -> ArrayVec<T, 3> {
        if self.side_by_hull(level).is_none() { self.search(level) } else { ArrayVec::new() }
    }

    #[inline(never)]
    fn search(&self, level: T) -> ArrayVec<T, 3> {
        let mut roots = ArrayVec::new();
        let shifted = self.less(level);
        // A value that may be rounding has no sign, and what lies between two such is no part to integrate.
        let noise = shifted.noise();
        let (mut from, mut before) = (T::zero(), shifted.at(T::zero()));
        for to in shifted.turning_points().into_iter().chain([T::one()]) {
            let value = shifted.at(to);
            if value.abs() <= noise {
                continue;
            }
            // A cubic that is not finite has a noise that nothing exceeds.
            if (before < T::zero()) != (value < T::zero()) && before.abs() > noise {
                let root = shifted.root_between(from, to, before < T::zero());
                if root > T::zero() && root < T::one() {
                    let _ = roots.try_push(root);
                }
            }
            (from, before) = (to, value);
        }
        roots
    }

    /// Zeros of the derivative inside (0, 1), ascending.
    pub(crate) fn turning_points(&self) -> ArrayVec<T, 2> {
        let [_, c1, c2, c3] = self.0;
        // Where the control values of the derivative have one sign there is none.
        let (zero, middle, end) = (T::zero(), c1 + c2, c1 + T::of(2.0) * c2 + T::of(3.0) * c3);
        if (c1 > zero) & (middle > zero) & (end > zero) | (c1 < zero) & (middle < zero) & (end < zero) {
            return ArrayVec::new();
        }
        // c1 + 2 c2 t + 3 c3 t^2 = 0, scaled so that the discriminant neither over- nor underflows.
        let size = c1.abs().max(c2.abs()).max(c3.abs());
        let mut points = ArrayVec::new();
        if size == T::zero() || !size.is_finite() {
            return points;
        }
        let (a, half_b, c) = (T::of(3.0) * (c3 / size), c2 / size, c1 / size);
        let discriminant = half_b * half_b - a * c;
        if discriminant <= T::zero() {
            return points;
        }
        let q = -(half_b + discriminant.sqrt().copysign(half_b));
        let (first, second) = (q / a, c / q);
        let mut keep = |t: T| {
            if t > T::zero() && t < T::one() {
                let _ = points.try_push(t);
            }
        };
        if first <= second {
            keep(first);
            keep(second);
        } else {
            keep(second);
            keep(first);
        }
        points
    }

    /// The root in [low, high], where the cubic is monotone and changes its sign.
    fn root_between(&self, mut low: T, mut high: T, rising: bool) -> T {
        // Terms cancel at a root: some units in the last place of their sum are all that a value can say.
        let [c0, c1, c2, c3] = self.0.map(T::abs);
        // Newton's step leaves half the curvature times its square at most.
        let bend = c2 + T::of(3.0) * c3;
        let mut t = T::of(0.5) * (low + high);
        // Each step either halves the bracket or is Newton's and at least halves the last step, so that
        // twice the scalar's digits and range of exponents bound the count; 200 covers both scalars.
        let mut last_step = high - low;
        for _ in 0..200 {
            let value = self.at(t);
            if (value < T::zero()) == rising {
                low = t;
            } else {
                high = t;
            }
            let newton = t - value / self.slope(t);
            let step = (newton - t).abs();
            let inside = newton > low && newton < high;
            let noise = T::of(0.5) * T::epsilon() * (c0 + t * (c1 + t * (c2 + t * c3)));
            // Where the slope is rounding, too, the step leads anywhere.
            let lands = inside && bend * step * step <= noise;
            if lands || value.abs() <= noise {
                return if lands { newton } else { t };
            }
            let next =
                if inside && step < T::of(0.5) * last_step { newton } else { T::of(0.5) * (low + high) };
            last_step = (next - t).abs();
            if next == t || next <= low || next >= high {
                return next;
            }
            t = next;
        }
        t
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec;
    use std::vec::Vec;

    #[test]
    fn hermite_form_takes_its_end_values() {
        let cubic = Cubic::hermite(2.0, -1.0, 5.0, 3.0);
        assert_eq!((cubic.at(0.0), cubic.at(1.0)), (2.0, 5.0));
        assert_eq!((cubic.slope(0.0), cubic.slope(1.0)), (-1.0, 3.0));
    }

    #[test]
    fn control_values_are_those_of_bernsteins_form() {
        let cubic = Cubic([0.3, -1.7, 2.9, -0.6]);
        let [b0, b1, b2, b3] = cubic.control(0.25);
        for t in [0.0_f64, 0.2, 0.5, 0.9, 1.0] {
            let s = 1.0 - t;
            let sum = s * s * (s * b0 + 3.0 * t * b1) + t * t * (3.0 * s * b2 + t * b3);
            assert!((sum - (cubic.at(t) - 0.25)).abs() < 1e-15, "{t}");
        }
    }

    #[test]
    fn three_crossings_are_found_and_touching_is_none() {
        // (t - 0.2)(t - 0.5)(t - 0.7)
        let three = Cubic([-0.07, 0.59, -1.4, 1.0]);
        let roots = three.crossings(0.0);
        assert_eq!(roots.len(), 3);
        for (root, want) in roots.iter().zip([0.2_f64, 0.5, 0.7]) {
            assert!((root - want).abs() < 1e-14);
        }
        // (t - 1/2)^2 touches zero.
        assert!(Cubic([0.25, -1.0, 1.0, 0.0]).crossings(0.0).len() % 2 == 0);
        let huge = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.5e308, -1.5e308];
        for (i, sign) in (0..4).flat_map(|i| [(i, 1.0), (i, -1.0)]) {
            for c in huge {
                let mut cubic = [-sign, 2.0 * sign, 0.5e308 * sign, -1.4e308];
                cubic[i] = c;
                assert!(Cubic(cubic).crossings(0.0).is_empty(), "{cubic:?}");
            }
        }
        assert!(Cubic([0.0; 4]).crossings(0.0).is_empty());
    }

    #[test]
    fn a_triple_root_whose_slope_is_rounding_is_where_it_is() {
        // k (t - 1/2)^3, rounded: bisection begins at the root.
        for cubic in [
            Cubic([-0.12638409443077228, 0.7583042575251655, -1.5166078969313945, 1.0110715192083057]),
            Cubic([-0.8017114172664475, 4.8102681705956405, -9.62053567518519, 6.413690006119402]),
            Cubic([-0.9042995900153832, 5.425800143449218, -10.851605493612283, 7.234407133550756]),
        ] {
            let roots = cubic.crossings(0.0);
            assert!(roots.iter().all(|t: &f64| (t - 0.5).abs() < 1e-4), "{roots:?} of {cubic:?}");
        }
    }

    proptest! {
        #[test]
        fn crossings_are_sign_changes_and_none_is_missed(
            c in prop::array::uniform4(-1.0_f64..1.0),
            exponent in prop::sample::select(vec![-300, -150, -20, 0, 20, 150, 300]),
        ) {
            let scale = 10f64.powi(exponent);
            let cubic = Cubic(c.map(|c| c * scale));
            let roots = cubic.crossings(0.0);
            prop_assert!(roots.windows(2).all(|w| w[0] <= w[1]));
            // The naive oracle: signs on a fine grid change as often as there are roots in between.
            let mut edges = vec![0.0];
            edges.extend(roots.iter().copied());
            edges.push(1.0);
            for part in edges.windows(2) {
                let inside = |i: i32| part[0] + (part[1] - part[0]) * f64::from(i) / 64.0;
                let tiny = 1e-14 * scale;
                let signs: Vec<f64> = (1..64).map(|i| cubic.at(inside(i))).filter(|v| v.abs() > tiny).collect();
                prop_assert!(signs.windows(2).all(|w| (w[0] > 0.0) == (w[1] > 0.0)));
            }
            match cubic.side(0.0) {
                Side::Below => prop_assert!((0..=64).all(|i| cubic.at(f64::from(i) / 64.0) <= 1e-14 * scale)),
                Side::Above => prop_assert!((0..=64).all(|i| cubic.at(f64::from(i) / 64.0) >= -1e-14 * scale)),
                Side::Both => {}
            }
        }
    }
}
