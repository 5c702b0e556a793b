//! Several numbers in lockstep, and the pairs and blocks that are made of them.
//!
//! Each operation is a loop of known length over the lanes, which a compiler turns into one vector instruction where the
//! target has them that wide.

use crate::real::{Field, Pair, Real, Square, sealed::Sealed};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// `L` numbers in lockstep.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub(crate) struct Lanes<T, const L: usize>(pub(crate) [T; L]);

impl<T: Real, const L: usize> Lanes<T, L> {
    /// The same number in all lanes.
    #[inline(always)]
    pub(crate) fn splat(x: T) -> Self {
        Self([x; L])
    }

    #[inline(always)]
    pub(crate) fn from_fn(f: impl FnMut(usize) -> T) -> Self {
        Self(core::array::from_fn(f))
    }

    #[inline(always)]
    pub(crate) fn map(mut self, f: impl Fn(T) -> T) -> Self {
        for a in &mut self.0 {
            *a = f(*a);
        }
        self
    }

    #[inline(always)]
    pub(crate) fn with(mut self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        for (a, b) in self.0.iter_mut().zip(other.0) {
            *a = f(*a, b);
        }
        self
    }

    /// The larger one in each lane; of a number and NaN either.
    #[inline(always)]
    pub(crate) fn larger(self, other: Self) -> Self {
        self.with(other, |a, b| if b > a { b } else { a })
    }

    /// The smaller one in each lane; of a number and NaN either.
    #[inline(always)]
    pub(crate) fn smaller(self, other: Self) -> Self {
        self.with(other, |a, b| if b < a { b } else { a })
    }

    #[inline(always)]
    pub(crate) fn lane(&self, l: usize) -> T {
        self.0.get(l).copied().unwrap_or(T::ZERO)
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, l: usize, x: T) {
        if let Some(lane) = self.0.get_mut(l) {
            *lane = x;
        }
    }
}

impl<T: Real, const L: usize> Default for Lanes<T, L> {
    fn default() -> Self {
        Self::splat(T::ZERO)
    }
}

macro_rules! by_lanes {
    ($($op:ident $name:ident),*) => {$(
        impl<T: Real, const L: usize> $op for Lanes<T, L> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                self.with(other, |a, b| a.$name(b))
            }
        }
    )*};
}
by_lanes!(Add add, Sub sub, Mul mul, Div div);

impl<T: Real, const L: usize> Neg for Lanes<T, L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

impl<T, const L: usize> Sealed for Lanes<T, L> {}

impl<T: Real, const L: usize> Field for Lanes<T, L> {
    type Vec2 = Two<Self>;
    type Mat2 = Four<Self>;
    const ZERO: Self = Self([T::ZERO; L]);
    const EPSILON: Self = Self([T::EPSILON; L]);
    #[inline(always)]
    fn size(self) -> Self {
        self.map(T::abs)
    }
    #[inline(always)]
    fn of(x: f64) -> Self {
        Self::splat(T::of(x))
    }
    #[inline(always)]
    fn reciprocal(self) -> Option<Self> {
        Some(self.map(|a| T::one() / a))
    }
    #[inline(always)]
    fn is_number(self) -> bool {
        true
    }
    #[inline(always)]
    fn exceeds(self, other: Self) -> bool {
        self.0.iter().zip(&other.0).fold(false, |any, (a, b)| any | (a > b))
    }
}

/// Pairs in lockstep.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Two<F> {
    x: F,
    y: F,
}

impl<T: Real, const L: usize> Two<Lanes<T, L>> {
    #[inline(always)]
    pub(crate) fn lane(&self, l: usize) -> T::Vec2 {
        T::Vec2::of(self.x.lane(l), self.y.lane(l))
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, l: usize, pair: T::Vec2) {
        self.x.set(l, pair.x());
        self.y.set(l, pair.y());
    }
}

impl<F: Field> Add for Two<F> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

impl<F: Field> AddAssign for Two<F> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<F: Field> Sub for Two<F> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}

impl<F: Field> Neg for Two<F> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y }
    }
}

impl<F: Field> Mul<F> for Two<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, t: F) -> Self {
        Self { x: self.x * t, y: self.y * t }
    }
}

impl<F: Field> Pair<F> for Two<F> {
    #[inline(always)]
    fn of(x: F, y: F) -> Self {
        Self { x, y }
    }
    #[inline(always)]
    fn x(self) -> F {
        self.x
    }
    #[inline(always)]
    fn y(self) -> F {
        self.y
    }
    #[inline(always)]
    fn times(self, other: Self) -> F {
        self.x * other.x + self.y * other.y
    }
}

/// 2x2 matrices in lockstep, by columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Four<F>([[F; 2]; 2]);

impl<F: Field> Add for Four<F> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([[a, b], [c, d]], [[e, f], [g, h]]) = (self.0, other.0);
        Self([[a + e, b + f], [c + g, d + h]])
    }
}

impl<F: Field> Sub for Four<F> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([[a, b], [c, d]], [[e, f], [g, h]]) = (self.0, other.0);
        Self([[a - e, b - f], [c - g, d - h]])
    }
}

impl<F: Field> Mul<Two<F>> for Four<F> {
    type Output = Two<F>;
    #[inline(always)]
    fn mul(self, v: Two<F>) -> Two<F> {
        let [[a, b], [c, d]] = self.0;
        Two { x: a * v.x + c * v.y, y: b * v.x + d * v.y }
    }
}

impl<F: Field> Mul for Four<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        // Written out: a function of the columns is not inlined, and goes through memory.
        let [[a, b], [c, d]] = other.0;
        let (left, right) = (self * Two { x: a, y: b }, self * Two { x: c, y: d });
        Self([[left.x, left.y], [right.x, right.y]])
    }
}

impl<F: Field> Square<Two<F>, [[F; 2]; 2]> for Four<F> {
    const ZERO: Self = Self([[F::ZERO; 2]; 2]);
    #[inline(always)]
    fn of(columns: [[F; 2]; 2]) -> Self {
        Self(columns)
    }
    #[inline(always)]
    fn columns(self) -> [[F; 2]; 2] {
        self.0
    }
    #[inline(always)]
    fn turned(self) -> Self {
        let [[a, b], [c, d]] = self.0;
        Self([[a, c], [b, d]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_of_lanes_do_what_pairs_do() {
        type Scalar = <f64 as Field>::Vec2;
        let (one, other, by) = ([1.5, -2.0, 3.0, 0.25], [7.0, 0.5, -4.0, 8.0], [3.0, -0.5]);
        let lanes = |pairs: [f64; 4]| {
            let [a, b, c, d] = pairs;
            Two::<Lanes<f64, 2>>::of(Lanes([a, c]), Lanes([b, d]))
        };
        let alone = |pairs: [f64; 4], l: usize| Scalar::of(pairs[2 * l], pairs[2 * l + 1]);
        let mut sum = lanes(one);
        sum += lanes(other);
        for l in [0, 1] {
            let (a, b) = (alone(one, l), alone(other, l));
            assert_eq!(sum.lane(l), a + b);
            assert_eq!((lanes(one) - lanes(other)).lane(l), a - b);
            assert_eq!((-lanes(one)).lane(l), -a);
            assert_eq!((lanes(one) * Lanes(by)).lane(l), a * by[l]);
            assert_eq!(lanes(one).times(lanes(other)).lane(l), a.times(b));
        }
    }

    #[test]
    fn lanes_never_wait_for_one_that_is_no_number() {
        let mixed = Lanes([0.0, 4.0]);
        assert!(Lanes([f64::NAN, 1.0]).is_number());
        assert_eq!(mixed.reciprocal(), Some(Lanes([f64::INFINITY, 0.25])));
        assert!(mixed.exceeds(Lanes([1.0, 3.0])) && !mixed.exceeds(Lanes([0.0, 4.0])));
    }
}
