//! The general 4x4 block of the coupled system: unknowns (w, theta, u, q); u and q are carried unchanged.
//!
//! The tangent of the coupled problem is not symmetric, so pivots are divided by Gaussian elimination with
//! row exchanges after an equilibration of rows and columns, which extreme units call for.

use super::{Block, Stamp};
use crate::real::{Quad, Real, Square};

/// The block of the coupled system.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coupled;

type Rows<T> = [[T; 4]; 4];

fn rows<T: Real>(m: &T::Mat4) -> Rows<T> {
    m.turned().columns()
}

fn matrix<T: Real>(rows: Rows<T>) -> T::Mat4 {
    T::Mat4::of(rows).turned()
}

/// Exchanges two of a list, if they are two: `swap` checks both places and would panic.
fn exchange<X>(list: &mut [X; 4], i: usize, j: usize) {
    if let Ok([one, other]) = list.get_disjoint_mut([i, j]) {
        core::mem::swap(one, other);
    }
}

/// A^-1 [B | v] over the rows and columns that are not held; held rows of the result are zero.
fn eliminate<T: Real>(a: &T::Mat4, b: &T::Mat4, v: T::Vec4, held: [bool; 4]) -> Option<(T::Mat4, T::Vec4)> {
    let (mut a, mut b, mut v) = (rows::<T>(a), rows::<T>(b), v.array());
    for i in 0..4 {
        if held[i] {
            // The held unknown is zero: its row says so, its column no longer matters.
            for j in 0..4 {
                a[i][j] = T::zero();
                a[j][i] = T::zero();
                b[i][j] = T::zero();
            }
            a[i][i] = T::one();
            v[i] = T::zero();
        }
    }
    // Rows and columns are scaled by the roots of the diagonal, so that pivots of different units compare.
    let mut unit = [T::one(); 4];
    for i in 0..4 {
        let size = a[i].iter().fold(T::zero(), |m, x| m.max(x.abs()));
        if !(size > T::zero() && size.is_finite()) {
            return None;
        }
        if a[i][i] != T::zero() {
            unit[i] = T::one() / a[i][i].abs().sqrt();
        }
    }
    for i in 0..4 {
        let scale = unit[i];
        for j in 0..4 {
            a[i][j] = scale * a[i][j] * unit[j];
        }
        b[i] = b[i].map(|x| scale * x);
        v[i] = scale * v[i];
    }
    for i in 0..4 {
        let (mut best, mut largest) = (i, a[i][i].abs());
        for (r, row) in a.iter().enumerate().skip(i + 1) {
            let size = row[i].abs();
            if size > largest {
                (best, largest) = (r, size);
            }
        }
        exchange(&mut a, i, best);
        exchange(&mut b, i, best);
        exchange(&mut v, i, best);
        let pivot = a[i][i];
        if pivot == T::zero() || !pivot.is_finite() {
            return None;
        }
        for r in i + 1..4 {
            let ratio = a[r][i] / pivot;
            for j in 0..4 {
                if j > i {
                    a[r][j] = a[r][j] - ratio * a[i][j];
                }
                b[r][j] = b[r][j] - ratio * b[i][j];
            }
            v[r] = v[r] - ratio * v[i];
        }
    }
    for below in 0..4 {
        let i = 3 - below;
        for k in i + 1..4 {
            let (row, above) = (b[k], &mut b[i]);
            for (x, y) in above.iter_mut().zip(row) {
                *x = *x - a[i][k] * y;
            }
            v[i] = v[i] - a[i][k] * v[k];
        }
        let pivot = a[i][i];
        b[i] = b[i].map(|x| x / pivot);
        v[i] = v[i] / pivot;
    }
    for i in 0..4 {
        let scale = unit[i];
        b[i] = b[i].map(|x| scale * x);
        v[i] = scale * v[i];
    }
    let finite = v.iter().chain(b.iter().flatten()).all(|x| x.is_finite());
    finite.then(|| (matrix::<T>(b), T::Vec4::of(v)))
}

impl<T: Real> Stamp<T, Coupled> {
    /// The transposed system's part, under the same loads.
    pub(crate) fn turned(self) -> Self {
        Self {
            ee: self.ee.turned(),
            er: self.re.turned(),
            re: self.er.turned(),
            rr: self.rr.turned(),
            ..self
        }
    }
}

impl<T: Real> Block<T> for Coupled {
    type Vector = T::Vec4;
    type Matrix = T::Mat4;
    type Energy = T::Mat4;
    type Held = [bool; 4];

    const NONE: T::Mat4 = T::Mat4::ZERO;
    const NOTHING: T::Mat4 = T::Mat4::ZERO;

    fn of_energy(s: &T::Mat4) -> T::Mat4 {
        *s
    }

    fn carry(h: T, v: T::Vec4) -> T::Vec4 {
        let [w, theta, u, q] = v.array();
        T::Vec4::of([w - h * theta, theta, u, q])
    }

    fn carry_back(h: T, v: T::Vec4) -> T::Vec4 {
        let [f, m, sigma, charge] = v.array();
        T::Vec4::of([f, m - h * f, sigma, charge])
    }

    fn carry_right(s: &T::Mat4, h: T) -> T::Mat4 {
        Self::matrix_carry(s, h)
    }

    fn carry_left(s: &T::Mat4, h: T, _: &T::Mat4) -> T::Mat4 {
        Self::carry_matrix(h, s)
    }

    fn congruence(s: &T::Mat4, h: T) -> T::Mat4 {
        Self::carry_matrix(h, &Self::matrix_carry(s, h))
    }

    fn carry_matrix(h: T, m: &T::Mat4) -> T::Mat4 {
        T::Mat4::of(m.columns().map(|[f, m, sigma, charge]| [f, m - h * f, sigma, charge]))
    }

    fn matrix_carry(m: &T::Mat4, h: T) -> T::Mat4 {
        let [w, mut theta, u, q] = m.columns();
        for (turned, straight) in theta.iter_mut().zip(w) {
            *turned = *turned - h * straight;
        }
        T::Mat4::of([w, theta, u, q])
    }

    fn energy_times(s: &T::Mat4, v: T::Vec4) -> T::Vec4 {
        *s * v
    }

    fn times(m: &T::Mat4, v: T::Vec4) -> T::Vec4 {
        *m * v
    }

    fn negate(m: &T::Mat4) -> T::Mat4 {
        T::Mat4::ZERO - *m
    }

    fn divide(a: &T::Mat4, b: &T::Mat4, v: T::Vec4) -> Option<(T::Mat4, T::Vec4)> {
        eliminate::<T>(a, b, v, [false; 4])
    }

    fn divide_free(a: &T::Mat4, b: &T::Mat4, v: T::Vec4, held: [bool; 4]) -> Option<(T::Mat4, T::Vec4)> {
        eliminate::<T>(a, b, v, held)
    }

    fn holds(held: [bool; 4]) -> bool {
        held != [false; 4]
    }

    fn reduce(s: &T::Mat4, left: &T::Mat4, gain: &T::Mat4) -> T::Mat4 {
        *s - *left * *gain
    }

    fn far_end(stamp: &Stamp<T, Self>, h: T) -> T::Mat4 {
        Self::congruence(&stamp.ee, h)
            + stamp.rr
            + <Self as Block<T>>::negate(
                &(Self::carry_matrix(h, &stamp.er) + Self::matrix_carry(&stamp.re, h)),
            )
    }

    fn lower(stamp: &Stamp<T, Self>) -> T::Mat4 {
        stamp.re
    }

    fn outweighs(s: &T::Mat4, element: &T::Mat4) -> bool {
        let (s, k) = (s.columns(), element.columns());
        (0..4).any(|i| s[i][i].abs() > T::of(8.0) * k[i][i].abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat4, DVec4};

    #[test]
    fn what_has_no_inverse_is_refused_and_pivots_of_zero_are_exchanged() {
        let v = DVec4::new(1.0, 2.0, 3.0, 4.0);
        let divide = |a: DMat4| <Coupled as Block<f64>>::divide(&a, &DMat4::IDENTITY, v);
        let with = |i: usize, j: usize, x: f64| {
            let mut columns = DMat4::IDENTITY.to_cols_array_2d();
            columns[j][i] = x;
            DMat4::from_cols_array_2d(&columns)
        };
        // A row of zeros, one that is no number, one that is another's.
        assert_eq!(divide(with(2, 2, 0.0)), None);
        assert_eq!(divide(with(1, 3, f64::INFINITY)), None);
        assert_eq!(divide(with(1, 3, f64::NAN)), None);
        assert_eq!(divide(DMat4::from_cols_array(&[1.0; 16])), None);
        // A quotient beyond the number format.
        assert_eq!(divide(with(0, 1, 1e308) * DMat4::from_diagonal(DVec4::new(1.0, 10.0, 1.0, 1.0))), None);
        // The unknowns in another order: no pivot on the diagonal.
        let turned = DMat4::from_cols(DVec4::Y, DVec4::Z, DVec4::W, DVec4::X);
        let (inverse, unknowns) = divide(turned).unwrap();
        assert_eq!((inverse, turned * unknowns), (turned.transpose(), v));
        // What is held matters to nobody.
        let held = <Coupled as Block<f64>>::divide_free(
            &with(2, 2, 0.0),
            &DMat4::ZERO,
            v,
            [false, false, true, false],
        );
        assert_eq!(held.map(|(_, unknowns)| unknowns), Some(DVec4::new(1.0, 2.0, 0.0, 4.0)));
    }
}
