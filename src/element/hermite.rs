//! The cubic Hermite element of bending in its relative unknowns.
//!
//! With e = (e_w, e_theta) the left end's motion relative to the rigid motion of the right end and
//! d = (w, theta) the right node's, the deflection at t (0 at the right node, 1 at the left one) is
//!
//! ```text
//!     w(t) = d_w - h d_theta t + (3 e_w + h e_theta) t^2 - (2 e_w + h e_theta) t^3
//! ```
//!
//! The curvature depends on e alone.

use crate::cubic::Cubic;
use crate::quadrature::{POINTS, add_moments, gauss};
use crate::real::{Field, Pair, Real};
use crate::sweep::pair::Symmetric;

/// An element's motion: its cubic in t.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion<T: Field> {
    pub(crate) e: T::Vec2,
    pub(crate) d: T::Vec2,
    h: T,
}

impl<T: Field> Motion<T> {
    #[inline(always)]
    pub(crate) fn new(h: T, e: T::Vec2, d: T::Vec2) -> Self {
        Self { e, d, h }
    }

    /// Deflection as a function of t.
    #[inline(always)]
    pub(crate) fn cubic(&self) -> Cubic<T> {
        let (two, three) = (T::of(2.0), T::of(3.0));
        let turn = self.h * self.e.y();
        Cubic([self.d.x(), -(self.h * self.d.y()), three * self.e.x() + turn, -(two * self.e.x() + turn)])
    }

    /// The motion of the part of the element between t = `right` and t = `right` + `share`: the same
    /// cubic, in the part's own relative unknowns. Exact: the relative unknowns of the part are formed from
    /// those of the whole, not from differences of values.
    pub(crate) fn part(&self, right: T, share: T) -> Self {
        let [_, _, c2, c3] = self.cubic().0;
        let (two, three) = (T::of(2.0), T::of(3.0));
        let slope = right * (two * c2 + three * c3 * right);
        let e = T::Vec2::of(
            share * share * (c2 + c3 * (three * right + share)),
            -(share * (two * c2 + three * c3 * (two * right + share))) / self.h,
        );
        let d = T::Vec2::of(
            self.d.x() + right * (right * (c2 + c3 * right) - self.h * self.d.y()),
            self.d.y() - slope / self.h,
        );
        Self { e, d, h: self.h * share }
    }
}

/// The matrix of the bending energy 1/2 e'K e, from the stiffness at the Gauss points:
/// K = integral of C B B' dx, B = ((6 - 12 t)/h^2, (2 - 6 t)/h) the curvatures of e_w and e_theta.
pub(crate) fn bending<T: Real>(h: T, stiffness: [T; POINTS]) -> Symmetric<T> {
    let (mut ww, mut wt, mut tt) = (T::zero(), T::zero(), T::zero());
    if stiffness.iter().all(|&c| c == stiffness[0]) {
        (ww, wt, tt) = (T::of(12.0) * stiffness[0], T::of(6.0) * stiffness[0], T::of(4.0) * stiffness[0]);
    } else {
        for (c, (t, weight)) in stiffness.iter().zip(gauss::<POINTS>()) {
            let (w, theta) = (6.0 - 12.0 * t, 2.0 - 6.0 * t);
            ww = ww + *c * T::of(weight * w * w);
            wt = wt + *c * T::of(weight * w * theta);
            tt = tt + *c * T::of(weight * theta * theta);
        }
    }
    Symmetric::of(ww / h / h / h, wt / h / h, tt / h)
}

/// Work of the load f on e and on the rigid motion with the right node, from f at the Gauss points.
pub(crate) fn loads<T: Real>(h: T, f: [T; POINTS]) -> (T::Vec2, T::Vec2) {
    let mut moments = [T::zero(); 4];
    if f.iter().all(|&v| v == f[0]) {
        moments = [f[0], f[0] * T::of(1.0 / 2.0), f[0] * T::of(1.0 / 3.0), f[0] * T::of(1.0 / 4.0)];
    } else {
        for (value, (t, weight)) in f.iter().zip(gauss::<POINTS>()) {
            add_moments(&mut moments, T::of(t), *value * T::of(weight));
        }
    }
    work(h, moments)
}

/// Work of a force per length on (e, d), from its moments: the integrals over t of f t^j, j = 0 .. 3.
#[inline(always)]
pub(crate) fn work<T: Field>(h: T, m: [T; 4]) -> (T::Vec2, T::Vec2) {
    let (two, three) = (T::of(2.0), T::of(3.0));
    let e = T::Vec2::of(h * (three * m[2] - two * m[3]), h * h * (m[2] - m[3]));
    let d = T::Vec2::of(h * m[0], -(h * h * m[1]));
    (e, d)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;
    use proptest::prelude::*;

    fn motion() -> Motion<f64> {
        Motion::new(0.5, DVec2::new(0.3, -0.7), DVec2::new(1.1, 0.4))
    }

    /// Nodal values of a motion: (w, theta) at the left and right node.
    fn nodal(m: &Motion<f64>) -> [f64; 4] {
        let left = [m.d.x - m.h * m.d.y + m.e.x, m.d.y + m.e.y];
        [left[0], left[1], m.d.x, m.d.y]
    }

    #[test]
    fn the_cubic_takes_nodal_values_and_slopes() {
        let m = motion();
        let [wl, tl, wr, tr] = nodal(&m);
        let c = m.cubic();
        assert!((c.at(0.0) - wr).abs() < 1e-15 && (c.at(1.0) - wl).abs() < 1e-15);
        assert!((-c.slope(0.0) / m.h - tr).abs() < 1e-15);
        assert!((-c.slope(1.0) / m.h - tl).abs() < 1e-14);
    }

    #[test]
    fn a_part_is_the_same_cubic() {
        let m = motion();
        let part = m.part(0.25, 0.5);
        for i in 0..=8 {
            let t = f64::from(i) / 8.0;
            assert!((part.cubic().at(t) - m.cubic().at(0.25 + 0.5 * t)).abs() < 1e-14);
        }
    }

    #[test]
    fn bending_is_the_textbook_stiffness() {
        let k = bending(0.5_f64, [3.0; 4]);
        assert_eq!(k, Symmetric::of(12.0 * 3.0 / 0.125, 6.0 * 3.0 / 0.25, 4.0 * 3.0 / 0.5));
        let varied = bending(0.5_f64, [3.0, 3.0, 3.0, 3.0 + 1e-13]);
        assert!((varied.xx - k.xx).abs() < 1e-10 * k.xx && (varied.yy - k.yy).abs() < 1e-10 * k.yy);
    }

    #[test]
    fn constant_loads_do_the_work_of_their_resultant() {
        let (e, d) = loads(2.0_f64, [5.0; 4]);
        assert_eq!((e.x, d.x, d.y), (5.0, 10.0, -10.0));
        assert!((e.y - 5.0 * 4.0 / 12.0).abs() < 1e-14);
    }

    /// The integral of f times a motion's deflection, and of C times its curvature squared, by a fine rule.
    fn fine(m: &Motion<f64>, c: impl Fn(f64) -> f64, f: impl Fn(f64) -> f64) -> (f64, f64) {
        let (mut energy, mut work) = (0.0, 0.0);
        let cubic = m.cubic();
        for i in 0..400 {
            for (z, weight) in gauss::<5>() {
                let t = (f64::from(i) + z) / 400.0;
                let curvature = (2.0 * cubic.0[2] + 6.0 * cubic.0[3] * t) / (m.h * m.h);
                energy += weight / 400.0 * m.h * c(t) * curvature * curvature;
                work += weight / 400.0 * m.h * f(t) * cubic.at(t);
            }
        }
        (energy, work)
    }

    proptest! {
        #[test]
        fn energy_and_work_are_integrals_over_the_element(
            h in 0.01..2.0_f64,
            x in prop::array::uniform4(-1.0..1.0_f64),
            a in prop::array::uniform4(-1.0..1.0_f64),
        ) {
            let m = Motion::new(h, DVec2::new(x[0], x[1]), DVec2::new(x[2], x[3]));
            let cubic = |t: f64| a[0] + t * (a[1] + t * (a[2] + t * a[3]));
            let stiffness = |t: f64| 5.0 + cubic(t);
            let (energy, work) = fine(&m, stiffness, cubic);
            let at_points = |f: &dyn Fn(f64) -> f64| gauss::<POINTS>().map(|(t, _)| f(t));
            let got = m.e.dot(bending(h, at_points(&stiffness)).times(m.e));
            prop_assert!((got - energy).abs() <= 1e-12 * energy);
            let (fe, fr) = loads(h, at_points(&cubic));
            let got = m.e.dot(fe) + m.d.dot(fr);
            prop_assert!((got - work).abs() <= 1e-13 * h * 20.0, "{got:e} {work:e}");
        }

        #[test]
        fn parts_of_parts_are_parts(
            x in prop::array::uniform4(-1.0..1.0_f64),
            right in 0.0..0.5_f64,
            share in 0.1..0.5_f64,
        ) {
            let m = Motion::new(0.5, DVec2::new(x[0], x[1]), DVec2::new(x[2], x[3]));
            let part = m.part(right, share);
            let twice = part.part(0.25, 0.5);
            let once = m.part(right + 0.25 * share, 0.5 * share);
            prop_assert!((twice.e - once.e).abs().max_element() < 1e-14);
            prop_assert!((twice.d - once.d).abs().max_element() < 1e-14);
            prop_assert!((twice.h - once.h).abs() < 1e-16);
            // The motion of a part deforms it as the whole is deformed there.
            let [_, _, c2, c3] = m.cubic().0;
            let [_, _, p2, p3] = part.cubic().0;
            prop_assert!((p2 - share * share * (c2 + 3.0 * c3 * right)).abs() < 1e-13);
            prop_assert!((p3 - share * share * share * c3).abs() < 1e-13);
        }
    }

    #[test]
    fn a_tiny_part_keeps_all_digits_of_its_deformation() {
        let m = motion();
        let share = 1e-9;
        let part = m.part(0.5, share);
        let [_, _, c2, c3] = m.cubic().0;
        let want = share * share * (c2 + c3 * (1.5 + share));
        assert!((part.e.x - want).abs() < 1e-15 * want.abs());
    }
}
