//! The symmetric 2x2 block of bending: unknowns (w, theta), rigid motion T = [[1, -h], [0, 1]].

use super::{Block, Factor, Stamp};
use crate::real::{Field, Pair, Square};
use core::ops::Add;

/// A symmetric 2x2 matrix, three numbers: rounding cannot make it unsymmetric.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Symmetric<T> {
    pub(crate) xx: T,
    pub(crate) xy: T,
    pub(crate) yy: T,
}

impl<T: Field> Symmetric<T> {
    pub(crate) const fn of(xx: T, xy: T, yy: T) -> Self {
        Self { xx, xy, yy }
    }

    #[inline(always)]
    pub(crate) fn times(&self, v: T::Vec2) -> T::Vec2 {
        T::Vec2::of(self.xx * v.x() + self.xy * v.y(), self.xy * v.x() + self.yy * v.y())
    }

    /// The inverse; `None` where it does not exist or is not finite. It need not be positive definite: a
    /// conducting foundation at a negative potential pulls.
    #[inline(always)]
    pub(crate) fn inverse(&self) -> Option<Self> {
        // Away from the ends of the range the determinant says it all.
        match (self.xx * self.yy - self.xy * self.xy).reciprocal() {
            Some(scale) => Some(Self::of(self.yy * scale, -self.xy * scale, self.xx * scale)),
            None => self.inverse_by_pivots(),
        }
    }

    /// The inverse by two pivots, which neither over- nor underflows where its result does not.
    #[cold]
    fn inverse_by_pivots(&self) -> Option<Self> {
        let (one, ratio) = (T::of(1.0), self.xy / self.xx);
        let yy = one / (self.yy - ratio * self.xy);
        let xy = -ratio * yy;
        let xx = one / self.xx - ratio * xy;
        (xx.is_number() && yy.is_number() && xy.is_number()).then_some(Self::of(xx, xy, yy))
    }

    #[inline(always)]
    fn matrix(&self) -> T::Mat2 {
        T::Mat2::of([[self.xx, self.xy], [self.xy, self.yy]])
    }
}

impl<T: Field> Add for Symmetric<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::of(self.xx + other.xx, self.xy + other.xy, self.yy + other.yy)
    }
}

/// The block of bending.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bending;

impl<T: Field> Factor<T, Bending> {
    /// After back substitution a factor is spent: its room can hold four numbers.
    #[inline(always)]
    pub(crate) fn keep(&mut self, [a, b, c, d]: [T; 4]) {
        self.gain = T::Mat2::of([[a, b], [c, d]]);
    }

    /// The numbers in its room.
    #[inline(always)]
    pub(crate) fn kept(&self) -> [T; 4] {
        let [[a, b], [c, d]] = self.gain.columns();
        [a, b, c, d]
    }
}

impl<T: Field> Block<T> for Bending {
    type Vector = T::Vec2;
    type Matrix = T::Mat2;
    type Energy = Symmetric<T>;
    type Held = [bool; 2];

    const NONE: T::Mat2 = T::Mat2::ZERO;
    const NOTHING: Symmetric<T> = Symmetric { xx: T::ZERO, xy: T::ZERO, yy: T::ZERO };

    #[inline(always)]
    fn of_energy(s: &Symmetric<T>) -> T::Mat2 {
        s.matrix()
    }

    #[inline(always)]
    fn carry(h: T, v: T::Vec2) -> T::Vec2 {
        T::Vec2::of(v.x() - h * v.y(), v.y())
    }

    #[inline(always)]
    fn carry_back(h: T, v: T::Vec2) -> T::Vec2 {
        T::Vec2::of(v.x(), v.y() - h * v.x())
    }

    #[inline(always)]
    fn carry_right(s: &Symmetric<T>, h: T) -> T::Mat2 {
        T::Mat2::of([[s.xx, s.xy], [s.xy - h * s.xx, s.yy - h * s.xy]])
    }

    #[inline(always)]
    fn carry_left(_: &Symmetric<T>, _: T, right: &T::Mat2) -> T::Mat2 {
        right.turned()
    }

    #[inline(always)]
    fn congruence(s: &Symmetric<T>, h: T) -> Symmetric<T> {
        let xy = s.xy - h * s.xx;
        Symmetric::of(s.xx, xy, s.yy - h * (s.xy + xy))
    }

    #[inline(always)]
    fn carry_matrix(h: T, m: &T::Mat2) -> T::Mat2 {
        let [[xx, yx], [xy, yy]] = m.columns();
        T::Mat2::of([[xx, yx - h * xx], [xy, yy - h * xy]])
    }

    #[inline(always)]
    fn matrix_carry(m: &T::Mat2, h: T) -> T::Mat2 {
        let [[xx, yx], [xy, yy]] = m.columns();
        T::Mat2::of([[xx, yx], [xy - h * xx, yy - h * yx]])
    }

    #[inline(always)]
    fn energy_times(s: &Symmetric<T>, v: T::Vec2) -> T::Vec2 {
        s.times(v)
    }

    #[inline(always)]
    fn times(m: &T::Mat2, v: T::Vec2) -> T::Vec2 {
        *m * v
    }

    #[inline(always)]
    fn negate(m: &T::Mat2) -> T::Mat2 {
        T::Mat2::ZERO - *m
    }

    #[inline(always)]
    fn divide(a: &Symmetric<T>, b: &T::Mat2, v: T::Vec2) -> Option<(T::Mat2, T::Vec2)> {
        let inverse = a.inverse()?;
        Some((inverse.matrix() * *b, inverse.times(v)))
    }

    #[inline]
    fn divide_free(a: &Symmetric<T>, b: &T::Mat2, v: T::Vec2, held: [bool; 2]) -> Option<(T::Mat2, T::Vec2)> {
        let zero = T::ZERO;
        let single = |pivot: T| (pivot != zero && pivot.is_number()).then(|| T::of(1.0) / pivot);
        let inverse = match held {
            [false, false] => a.inverse()?,
            [true, false] => Symmetric::of(zero, zero, single(a.yy)?),
            [false, true] => Symmetric::of(single(a.xx)?, zero, zero),
            [true, true] => Symmetric::of(zero, zero, zero),
        };
        Some((inverse.matrix() * *b, inverse.times(v)))
    }

    #[inline(always)]
    fn holds(held: [bool; 2]) -> bool {
        held != [false, false]
    }

    #[inline(always)]
    fn reduce(s: &Symmetric<T>, left: &T::Mat2, gain: &T::Mat2) -> Symmetric<T> {
        let [[lxx, lyx], [lxy, lyy]] = left.columns();
        let [[gxx, gyx], [gxy, gyy]] = gain.columns();
        Symmetric::of(
            s.xx - (lxx * gxx + lxy * gyx),
            s.xy - (lxx * gxy + lxy * gyy),
            s.yy - (lyx * gxy + lyy * gyy),
        )
    }

    #[inline]
    fn far_end(stamp: &Stamp<T, Self>, h: T) -> Symmetric<T> {
        // T'A_ee T - (T'A_er + its transposed) + A_rr
        let [[xx, yx], [xy, yy]] = <Self as Block<T>>::carry_matrix(h, &stamp.er).columns();
        let two = T::of(2.0);
        <Self as Block<T>>::congruence(&stamp.ee, h)
            + Symmetric::of(stamp.rr.xx - two * xx, stamp.rr.xy - (xy + yx), stamp.rr.yy - two * yy)
    }

    #[inline(always)]
    fn lower(stamp: &Stamp<T, Self>) -> T::Mat2 {
        stamp.er.turned()
    }

    #[inline(always)]
    fn outweighs(s: &Symmetric<T>, element: &Symmetric<T>) -> bool {
        // Uniform meshes never come here: next to a clamp S is the element's own stiffness and falls from
        // there. Deflections matter too, where the element is stiff enough to hide the leap in rotation.
        s.yy.exceeds(T::of(8.0) * element.yy) || s.xx.exceeds(T::of(512.0) * element.xx)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat2, DVec2};

    #[test]
    fn what_has_no_inverse_is_refused() {
        for none in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, f64::NAN, 1.0]]
        {
            let [xx, xy, yy] = none;
            assert_eq!(Symmetric::<f64>::of(xx, xy, yy).inverse(), None, "{none:?}");
        }
        // The determinant is beyond the number format, the inverse is not.
        let inverse = Symmetric::<f64>::of(1e200, 0.0, 2e200).inverse();
        assert!(inverse.is_some_and(|s| (1e200 * s.xx - 1.0).abs() + (2e200 * s.yy - 1.0).abs() < 1e-15));
        let single = |pivot: f64, held| {
            let a = Symmetric::<f64>::of(pivot, 0.0, pivot);
            Bending::divide_free(&a, &DMat2::ZERO, DVec2::ONE, held).map(|(_, unknowns)| unknowns)
        };
        for pivot in [0.0, f64::NAN, f64::INFINITY] {
            assert_eq!(single(pivot, [true, false]), None);
            assert_eq!(single(pivot, [false, true]), None);
            assert_eq!(single(pivot, [true, true]), Some(DVec2::ZERO));
        }
        assert_eq!(single(4.0, [true, false]), Some(DVec2::new(0.0, 0.25)));
        assert_eq!(single(4.0, [false, true]), Some(DVec2::new(0.25, 0.0)));
    }
}
