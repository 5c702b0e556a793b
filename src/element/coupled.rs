//! The tangent of one element in (w, theta, u, q), where conduction goes both ways.
//!
//! Nodes know u and q exactly from the penetration ([`crate::electric`]), so the coupled problem is one for the
//! penetration alone, and this is the exact derivative of its residual. With increments throughout, sigma is
//! constant on the element and D falls by what the current has grown:
//!
//! ```text
//!     e_u = -h (uu sigma + uq D_left) + stretch,   e_q = h (uq sigma - qq D_left) + charge
//!     D_right = D_left - total
//! ```
//!
//! where total, stretch and charge are the current 2 mu2 R~ R~' eta and what it does to u and q. The first line
//! gives the fluxes, these the slopes of q at both nodes, and so q inside the element as the contact sees it:
//! the cubic of [`crate::electric::potential`]. Its force on bending is mu1 R'(q) R~(eta) q.
//!
//! Rows of the block: force and moment; -sigma and -D, the forces that conjugate to u and q. The block is not
//! symmetric: current makes potential by mu2, potential makes force by mu1.

use super::Element;
use super::contact::{Contact, kinks, touching};
use super::hermite::work;
use crate::cubic::Cubic;
use crate::law::{truncate, truncate_positive};
use crate::profile::{Piece, Profile};
use crate::quadrature::add_moments;
use crate::real::{Pair, Quad, Real, Square};
use crate::scene::Model;
use crate::sweep::Stamp;
use crate::sweep::pair::Symmetric;
use crate::sweep::quad::Coupled;

/// What couples an element's penetration and potential, linearised at its state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coupling<T> {
    /// Integrals over t of mu1 R'(q) R~(eta) t^j.
    drive: [T; 7],
    /// Integrals over t of 2 mu2 R~ R~' t^j ...
    total: [T; 4],
    /// ... and of the same times what a current at t does to u and q.
    stretch: [T; 4],
    charge: [T; 4],
}

/// A linear form of the element's unknowns: e, then d.
type Form<T> = [T; 8];

fn sum<T: Real>(terms: &[(T, Form<T>)]) -> Form<T> {
    let mut form = [T::zero(); 8];
    for (factor, term) in terms {
        for (x, y) in form.iter_mut().zip(term) {
            *x = *x + *factor * *y;
        }
    }
    form
}

fn unknown<T: Real>(i: usize) -> Form<T> {
    core::array::from_fn(|j| if i == j { T::one() } else { T::zero() })
}

impl<T: Real> Coupling<T> {
    pub(crate) fn at<M: Model<T>>(model: &M, element: &Element<T, M>, eta: &Cubic<T>, q: &Cubic<T>) -> Self {
        let zero = T::zero();
        let mut coupling = Self { drive: [zero; 7], total: [zero; 4], stretch: [zero; 4], charge: [zero; 4] };
        if eta.side(zero) == crate::cubic::Side::Below {
            return coupling;
        }
        let bounds = model.conduction();
        let (most, most_q) = (bounds.truncation, bounds.potential_truncation);
        touching(eta, &mut kinks(model, eta, Some(q))).for_each(|(t, weight)| {
            let (r, slope) = truncate_positive(eta.at(t), most);
            let drive = element.mu1.at(t) * truncate(q.at(t), most_q).1 * r;
            add_moments(&mut coupling.drive, t, weight * drive);
            let current = weight * (T::of(2.0) * element.mu2.at(t) * r * slope);
            add_moments(&mut coupling.total, t, current);
            let lever = element.h * current;
            add_moments(&mut coupling.stretch, t, lever * element.flexibility.uq.integral(t));
            add_moments(&mut coupling.charge, t, lever * element.flexibility.qq.integral(t));
        });
        coupling
    }

    /// The element's tangent, with the forces `load` on e. The contact's own part is `contact`.
    pub(crate) fn stamp<M: Model<T>>(
        &self,
        element: &Element<T, M>,
        contact: &Contact<T>,
        load: T::Vec2,
    ) -> Stamp<T, Coupled> {
        let (zero, one, h) = (T::zero(), T::one(), element.h);
        let of = |moments: &[T; 4]| -> Form<T> {
            let (e, d) = work::<T>(h, *moments);
            [e.x(), e.y(), zero, zero, d.x(), d.y(), zero, zero]
        };
        let (total, stretch, charge) = (of(&self.total), of(&self.stretch), of(&self.charge));
        let (e_u, e_q, q_right) = (unknown(2), unknown(3), unknown(7));

        let k = element.flexibility.mean();
        let (sigma, left) = if M::Axial::PRESENT {
            let ratio = k.uq / k.uu;
            let whole = one / (h * (k.qq + k.uq * ratio));
            let left =
                sum(&[(ratio * whole, stretch), (-ratio * whole, e_u), (whole, charge), (-whole, e_q)]);
            let soft = one / (h * k.uu);
            (sum(&[(soft, stretch), (-soft, e_u), (-ratio, left)]), left)
        } else {
            let whole = one / (h * k.qq);
            // No stretching: its unknown is held at zero by a unit stiffness.
            (sum(&[(-one, e_u)]), sum(&[(whole, charge), (-whole, e_q)]))
        };
        let right = sum(&[(one, left), (-one, total)]);

        // q inside, in powers of t.
        let slope = |t: T, displacement: Form<T>| {
            let k = element.flexibility.at(t);
            sum(&[(-(h * k.qq), displacement), (h * k.uq, sigma)])
        };
        let (near, far) = (slope(zero, right), slope(one, left));
        let (two, three) = (T::of(2.0), T::of(3.0));
        let powers = [
            q_right,
            near,
            sum(&[(three, e_q), (-two, near), (-one, far)]),
            sum(&[(-two, e_q), (one, near), (one, far)]),
        ];

        let mut rows = [[zero; 8]; 8];
        for (moments, power) in self.drive.windows(4).zip(powers) {
            let &[zeroth, first, second, third] = moments else { continue };
            let (e, d) = work::<T>(h, [zeroth, first, second, third]);
            let [ew, et, _, _, dw, dt, ..] = &mut rows;
            for (row, force) in [(ew, e.x()), (et, e.y()), (dw, d.x()), (dt, d.y())] {
                *row = sum(&[(one, *row), (force, power)]);
            }
        }
        rows[2] = sum(&[(-one, sigma)]);
        rows[3] = sum(&[(-one, left)]);
        rows[7] = sum(&[(-one, total)]);

        let [e0, e1, e2, e3, d0, d1, d2, d3] = rows;
        let (on_e, on_d) = ([e0, e1, e2, e3], [d0, d1, d2, d3]);
        let by_e = |[a, b, c, d, ..]: Form<T>| [a, b, c, d];
        let by_d = |[.., a, b, c, d]: Form<T>| [a, b, c, d];
        let Stamp { ee, er, rr, .. } = contact.stamp(element);
        let er: T::Mat2 = er;
        Stamp {
            ee: T::Mat4::of(on_e.map(by_e)).turned() + bordered(&ee),
            er: T::Mat4::of(on_e.map(by_d)).turned() + corner::<T>(er.columns()),
            re: T::Mat4::of(on_d.map(by_e)).turned() + corner::<T>(er.turned().columns()),
            rr: T::Mat4::of(on_d.map(by_d)).turned() + bordered(&rr),
            fe: T::Vec4::of([load.x(), load.y(), zero, zero]),
            fr: T::Vec4::default(),
            free: false,
        }
    }
}

/// A block of bending as the corner of a coupled one.
fn corner<T: Real>([[xx, yx], [xy, yy]]: [[T; 2]; 2]) -> T::Mat4 {
    let zero = T::zero();
    T::Mat4::of([[xx, yx, zero, zero], [xy, yy, zero, zero], [zero; 4], [zero; 4]])
}

fn bordered<T: Real>(s: &Symmetric<T>) -> T::Mat4 {
    corner::<T>([[s.xx, s.xy], [s.xy, s.yy]])
}
