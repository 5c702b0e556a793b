//! The scalars of the solver, `f32` and `f64`, and the glam blocks that go with each.
//!
//! Kernels are written once against [`Real`], those without branches against [`Field`]; the traits tie a scalar to its 2-vectors (a node's
//! deflection and slope), 2x2 and 4x4 matrices. They are sealed: a new scalar has to keep the promises
//! that the kernels rely on (IEEE operations, no hidden fusing).

use core::fmt::{Debug, Display};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A pair of numbers at a node or an element's end: (deflection, slope) or (force, moment).
pub trait Pair<T>:
    Copy
    + Debug
    + Default
    + PartialEq
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<T, Output = Self>
{
    /// The pair (x, y).
    fn of(x: T, y: T) -> Self;
    /// First component: a deflection or a force.
    fn x(self) -> T;
    /// Second component: a slope or a moment.
    fn y(self) -> T;
    /// Scalar product, rounded in the order x x' + y y' on every target.
    fn times(self, other: Self) -> T;
}

/// A vector of four numbers at a node, for the monolithic system in (w, theta, u, q).
pub trait Quad<T>: Copy + Debug + Default + Add<Output = Self> + Sub<Output = Self> {
    /// From components.
    fn of(v: [T; 4]) -> Self;
    /// To components.
    fn array(self) -> [T; 4];
}

/// A square matrix that acts on the vectors `V`; `C` is its array of columns.
///
/// There is no `Default`: glam's is the identity.
pub trait Square<V, C>:
    Copy + Debug + Add<Output = Self> + Sub<Output = Self> + Mul<V, Output = V> + Mul<Output = Self>
{
    /// All entries zero.
    const ZERO: Self;
    /// From columns.
    fn of(columns: C) -> Self;
    /// To columns.
    fn columns(self) -> C;
    /// The transposed matrix.
    fn turned(self) -> Self;
}

/// A number, or several in lockstep: the arithmetic of kernels that take the same steps whatever the numbers are, and
/// the types that hold its blocks.
pub trait Field:
    Copy
    + Debug
    + Default
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + sealed::Sealed
{
    /// Pairs at a node ([`glam::Vec2`] or [`glam::DVec2`]).
    type Vec2: Pair<Self>;
    /// Blocks of the bending recursion ([`glam::Mat2`] or [`glam::DMat2`]).
    type Mat2: Square<Self::Vec2, [[Self; 2]; 2]>;
    /// 0, as a constant.
    const ZERO: Self;
    /// The distance from 1 to the next larger number.
    const EPSILON: Self;
    /// Its size, |x|.
    fn size(self) -> Self;
    /// The nearest representable number.
    fn of(x: f64) -> Self;
    /// 1/x, if both are normal numbers. Several in lockstep do not wait for one that is not.
    fn reciprocal(self) -> Option<Self>;
    /// Is it finite? Of several, always: one that is not is found by its residual.
    fn is_number(self) -> bool;
    /// Is it larger? Of several, is any?
    fn exceeds(self, other: Self) -> bool;
}

/// `f32` or `f64`, with the glam types that hold its blocks.
pub trait Real: Field + num_traits::Float + Display + Send + Sync + 'static {
    /// Nodal unknowns of the monolithic system ([`glam::Vec4`] or [`glam::DVec4`]).
    type Vec4: Quad<Self>;
    /// Blocks of the monolithic recursion ([`glam::Mat4`] or [`glam::DMat4`]).
    type Mat4: Square<Self::Vec4, [[Self; 4]; 4]>;
    /// Is it `f64`?
    const DOUBLE: bool;
    /// As `f64`, exactly.
    fn f64(self) -> f64;
}

pub(crate) mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

macro_rules! real {
    ($t:ty, $v2:ty, $m2:ty, $v4:ty, $m4:ty) => {
        impl Pair<$t> for $v2 {
            #[inline(always)]
            fn of(x: $t, y: $t) -> Self {
                <$v2>::new(x, y)
            }
            #[inline(always)]
            fn x(self) -> $t {
                self.x
            }
            #[inline(always)]
            fn y(self) -> $t {
                self.y
            }
            #[inline(always)]
            fn times(self, other: Self) -> $t {
                self.x * other.x + self.y * other.y
            }
        }
        impl Quad<$t> for $v4 {
            #[inline(always)]
            fn of(v: [$t; 4]) -> Self {
                <$v4>::from_array(v)
            }
            #[inline(always)]
            fn array(self) -> [$t; 4] {
                self.to_array()
            }
        }
        impl Square<$v2, [[$t; 2]; 2]> for $m2 {
            const ZERO: Self = <$m2>::ZERO;
            #[inline(always)]
            fn of(columns: [[$t; 2]; 2]) -> Self {
                <$m2>::from_cols_array_2d(&columns)
            }
            #[inline(always)]
            fn columns(self) -> [[$t; 2]; 2] {
                self.to_cols_array_2d()
            }
            #[inline(always)]
            fn turned(self) -> Self {
                self.transpose()
            }
        }
        impl Square<$v4, [[$t; 4]; 4]> for $m4 {
            const ZERO: Self = <$m4>::ZERO;
            #[inline(always)]
            fn of(columns: [[$t; 4]; 4]) -> Self {
                <$m4>::from_cols_array_2d(&columns)
            }
            #[inline(always)]
            fn columns(self) -> [[$t; 4]; 4] {
                self.to_cols_array_2d()
            }
            #[inline(always)]
            fn turned(self) -> Self {
                self.transpose()
            }
        }
        impl Field for $t {
            type Vec2 = $v2;
            type Mat2 = $m2;
            const ZERO: Self = 0.0;
            const EPSILON: Self = <$t>::EPSILON;
            #[inline(always)]
            fn size(self) -> Self {
                self.abs()
            }
            #[inline(always)]
            #[allow(clippy::cast_possible_truncation, reason = "rounding to the scalar is the point")]
            fn of(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn reciprocal(self) -> Option<Self> {
                let inside = |x: $t| x.abs() >= <$t>::MIN_POSITIVE && x.abs() <= <$t>::MAX;
                let inverse = 1.0 / self;
                (inside(self) && inside(inverse)).then_some(inverse)
            }
            #[inline(always)]
            fn is_number(self) -> bool {
                self.is_finite()
            }
            #[inline(always)]
            fn exceeds(self, other: Self) -> bool {
                self > other
            }
        }
        impl Real for $t {
            type Vec4 = $v4;
            type Mat4 = $m4;
            const DOUBLE: bool = size_of::<Self>() == 8;
            #[inline(always)]
            fn f64(self) -> f64 {
                f64::from(self)
            }
        }
    };
}

real!(f32, glam::Vec2, glam::Mat2, glam::Vec4, glam::Mat4);
real!(f64, glam::DVec2, glam::DMat2, glam::DVec4, glam::DMat4);

/// Sum of many terms with the rounding of each addition carried along (Neumaier, 1974): the error does
/// not grow with the number of terms. Not `EXACT` it is a plain sum.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sum<T, const EXACT: bool = true> {
    sum: T,
    carry: T,
}

impl<T: Field, const EXACT: bool> Sum<T, EXACT> {
    #[inline(always)]
    pub(crate) fn from(sum: T) -> Self {
        Self { sum, carry: T::ZERO }
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, term: T) {
        let sum = self.sum + term;
        if !EXACT {
            self.sum = sum;
            return;
        }
        // Knuth's two-sum: branch-free, exact error of the addition above.
        let shadow = sum - self.sum;
        self.carry = self.carry + ((self.sum - (sum - shadow)) + (term - shadow));
        self.sum = sum;
    }

    /// The sum with one more term, which may cancel it.
    #[inline(always)]
    pub(crate) fn plus(mut self, term: T) -> T {
        self.add(term);
        self.value()
    }

    #[inline(always)]
    pub(crate) fn value(self) -> T {
        self.sum + self.carry
    }
}
