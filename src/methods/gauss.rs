//! Contact decided at the Gauss points one by one, as finite element programs do.
//!
//! Nothing pulls, but the quadrature goes across the contact's edge: points next to it count for a stretch on its
//! other side, too, and the order drops from four to about two.

use super::{Linear, Sight};
use crate::element::contact::Fault;
use crate::quadrature::POINTS;
use crate::real::Real;
use crate::scene::Model;

pub(super) fn linear<T: Real, M: Model<T>>(sight: &Sight<'_, T, M>) -> Result<Linear<T>, Fault> {
    sight.map(|point, r| if r > T::zero() { sight.pressed(point, r) } else { Ok(Default::default()) })
}

pub(super) fn pressures<T: Real, M: Model<T>>(sight: &Sight<'_, T, M>) -> Result<[T; POINTS], Fault> {
    sight.map(|point, r| if r > T::zero() { Ok(sight.law(point, r)?.0) } else { Ok(T::zero()) })
}
